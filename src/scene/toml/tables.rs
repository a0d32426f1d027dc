//! Tables of a scene file. Their values are right in type, but not yet checked.

use std::collections::BTreeMap;
use std::fmt;

use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

use super::pairs::{Pairs, points, rows};
use super::whiskers::{WhiskerRows, whisker_rows};
use crate::scene::Surface;
use crate::scene::axis::{AxisScale, AxisValues};

/// Scene file. Its numbers and sweep axes belong to parameters, whose table (`src/scene/parameter.rs`) names them.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct SceneFile {
    pub title: String,
    pub whisker: WhiskerTable,
    #[serde(default)]
    pub pole: PoleTable,
    #[serde(default)]
    pub contact: ContactTable,
    pub grid: GridTable,
    #[serde(default)]
    pub whiskers: WhiskersTable,
    #[serde(default)]
    pub output: OutputTable,
    /// Standard deviations of the scene's numbers by name, each in its unit.
    pub uncertainty: Option<BTreeMap<String, f64>>,
    pub surface: Option<Surface>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct WhiskerTable {
    pub length_mm: Option<f64>,
    pub base_radius_um: Option<f64>,
    pub tip_radius_um: Option<f64>,
    /// Taper instead of the radius at the tip, which it determines.
    pub taper: Option<f64>,
    pub youngs_modulus_gpa: Option<f64>,
    /// Largest bending strain that the whisker bears elastically.
    pub yield_strain: Option<f64>,
    #[serde(default)]
    pub profile: ProfileTable,
    #[serde(default)]
    pub curvature: CurvatureTable,
    #[serde(default)]
    pub rest: RestTable,
    #[serde(default)]
    pub modulus_gradient: GradientTable,
    #[serde(default)]
    pub projection: ProjectionTable,
    #[serde(default)]
    pub follicle: FollicleTable,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct ProfileTable {
    /// Measured rows of arclength in mm and radius in um.
    #[serde(deserialize_with = "rows")]
    pub rows: Option<Pairs>,
    /// True if a polynomial through the rows replaces their radii.
    #[serde(default)]
    pub smooth: bool,
    pub profile_scale: Option<f64>,
    pub tip_extension_mm: Option<f64>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct CurvatureTable {
    pub parabola_per_mm: Option<f64>,
    pub vertex_mm: Option<f64>,
    #[serde(default)]
    pub euler_spiral: SpiralTable,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct SpiralTable {
    #[serde(deserialize_with = "required")]
    pub per_mm: Option<f64>,
    #[serde(deserialize_with = "required")]
    pub per_mm2: Option<f64>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct RestTable {
    /// Traced points, in mm.
    #[serde(deserialize_with = "points")]
    pub points: Option<Pairs>,
    /// Degree of the traced curvature; cross-validation chooses it if it is left out.
    pub degree: Option<i64>,
    /// Coefficients of the traced curvature; if they are left out, the scene has the coefficients of the fit.
    pub curvature: Option<Vec<f64>>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct GradientTable {
    #[serde(deserialize_with = "required")]
    pub tip_to_base: Option<f64>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct ProjectionTable {
    #[serde(deserialize_with = "required")]
    pub arc_stretch: Option<f64>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct FollicleTable {
    #[serde(deserialize_with = "required")]
    pub stiffness_nnm_per_rad: Option<f64>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct PoleTable {
    #[serde(deserialize_with = "required")]
    pub radius_mm: Option<f64>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct ContactTable {
    #[serde(deserialize_with = "required")]
    pub friction: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct GridTable {
    pub push_angle_deg: AxisValues,
    pub distance_mm: AxisValues,
    pub taper: Option<AxisValues>,
    pub tip_radius_um: Option<AxisValues>,
    pub base_radius_um: Option<AxisValues>,
    pub length_mm: Option<AxisValues>,
    pub curvature_per_mm: Option<AxisValues>,
    pub vertex_mm: Option<AxisValues>,
    pub pole_radius_mm: Option<AxisValues>,
    pub friction: Option<AxisValues>,
    pub modulus_tip_to_base: Option<AxisValues>,
    pub arc_stretch: Option<AxisValues>,
    pub follicle_stiffness_nnm_per_rad: Option<AxisValues>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct WhiskersTable {
    #[serde(deserialize_with = "whisker_rows")]
    pub table: Option<WhiskerRows>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct OutputTable {
    pub name: Option<String>,
}

/// Reads a number that its table must have. It is missing only with the table.
fn required<'de, D: Deserializer<'de>>(number: D) -> Result<Option<f64>, D::Error> {
    f64::deserialize(number).map(Some)
}

/// `{ from, to, count, scale }`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RangeTable {
    from: f64,
    to: Option<f64>,
    count: i64,
    #[serde(default)]
    scale: AxisScale,
}

impl<'de> Deserialize<'de> for AxisValues {
    fn deserialize<D: Deserializer<'de>>(values: D) -> Result<Self, D::Error> {
        values.deserialize_any(AxisVisitor)
    }
}

/// Chooses by the value's kind. Unlike an untagged enum, it keeps the places and the inner messages.
struct AxisVisitor;

impl<'de> Visitor<'de> for AxisVisitor {
    type Value = AxisValues;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of numbers or { from, to, count }")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<AxisValues, A::Error> {
        Deserialize::deserialize(SeqAccessDeserializer::new(list)).map(AxisValues::List)
    }

    fn visit_map<A: MapAccess<'de>>(self, table: A) -> Result<AxisValues, A::Error> {
        let range: RangeTable = Deserialize::deserialize(MapAccessDeserializer::new(table))?;
        Ok(AxisValues::Range {
            from: range.from,
            to: range.to,
            // A negative count is refused like 0.
            count: usize::try_from(range.count).unwrap_or(0),
            scale: range.scale,
        })
    }
}
