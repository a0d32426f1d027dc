//! The tables of a scene file: right in shape, not yet checked in value.

use std::collections::BTreeMap;
use std::fmt;

use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};

use super::rows::ListedRows;
use crate::scene::axis::{AxisScale, AxisValues};
use crate::scene::builder::Numbers;
use crate::scene::parameter::Parameter;

/// Tables with these keys and no others.
macro_rules! tables {
    ($($(#[$doc:meta])* $name:ident { $($key:ident: $kind:ty,)* })*) => {$(
        $(#[$doc])*
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        pub(super) struct $name {
            $(pub $key: $kind,)*
        }
    )*};
}

tables! {
    /// The whole file.
    SceneTable {
        title: String,
        whisker: WhiskerTable,
        pole: Option<PoleTable>,
        contact: Option<ContactTable>,
        grid: GridTable,
        output: Option<OutputTable>,
        uncertainty: Option<BTreeMap<String, f64>>,
    }
    /// `[whisker]`
    WhiskerTable {
        length_mm: f64,
        base_radius_um: Option<f64>,
        tip_radius_um: Option<f64>,
        youngs_modulus_gpa: f64,
        profile: Option<ProfileTable>,
        curvature: Option<CurvatureTable>,
        projection: Option<ProjectionTable>,
        modulus_gradient: Option<GradientTable>,
    }
    /// `[whisker.profile]`
    ProfileTable { rows: ListedRows, }
    /// `[whisker.curvature]`
    CurvatureTable {
        parabola_per_mm: Option<f64>,
        vertex_mm: Option<f64>,
        euler_spiral: Option<SpiralTable>,
    }
    /// `[whisker.curvature.euler_spiral]`
    SpiralTable { per_mm: f64, per_mm2: f64, }
    /// `[whisker.projection]`
    ProjectionTable { arc_stretch: f64, }
    /// `[whisker.modulus_gradient]`
    GradientTable { tip_to_base: f64, }
    /// `[pole]`
    PoleTable { radius_mm: f64, }
    /// `[contact]`
    ContactTable { friction: f64, }
    /// `[grid]`
    GridTable {
        push_angle_deg: AxisValues,
        distance_mm: AxisValues,
        taper: Option<AxisValues>,
        tip_radius_um: Option<AxisValues>,
        base_radius_um: Option<AxisValues>,
        length_mm: Option<AxisValues>,
        curvature_per_mm: Option<AxisValues>,
        vertex_mm: Option<AxisValues>,
        pole_radius_mm: Option<AxisValues>,
        friction: Option<AxisValues>,
        modulus_tip_to_base: Option<AxisValues>,
        arc_stretch: Option<AxisValues>,
    }
    /// `[output]`
    OutputTable { name: Option<String>, }
}

impl SceneTable {
    /// The numbers that the tables give.
    pub fn numbers(&self) -> Numbers {
        let whisker = &self.whisker;
        let curvature = whisker.curvature.as_ref();
        let spiral = curvature.and_then(|own| own.euler_spiral.as_ref());
        let gradient = whisker.modulus_gradient.as_ref();
        let projection = whisker.projection.as_ref();
        let mut numbers = Numbers::default();
        for (parameter, value) in [
            (Parameter::LengthMm, Some(whisker.length_mm)),
            (Parameter::BaseRadiusUm, whisker.base_radius_um),
            (Parameter::TipRadiusUm, whisker.tip_radius_um),
            (
                Parameter::YoungsModulusGpa,
                Some(whisker.youngs_modulus_gpa),
            ),
            (
                Parameter::ParabolaPerMm,
                curvature.and_then(|own| own.parabola_per_mm),
            ),
            (Parameter::VertexMm, curvature.and_then(|own| own.vertex_mm)),
            (Parameter::SpiralPerMm, spiral.map(|own| own.per_mm)),
            (Parameter::SpiralPerMm2, spiral.map(|own| own.per_mm2)),
            (
                Parameter::ModulusTipToBase,
                gradient.map(|own| own.tip_to_base),
            ),
            (Parameter::ArcStretch, projection.map(|own| own.arc_stretch)),
            (
                Parameter::PoleRadiusMm,
                self.pole.as_ref().map(|own| own.radius_mm),
            ),
            (
                Parameter::Friction,
                self.contact.as_ref().map(|own| own.friction),
            ),
        ] {
            if let Some(value) = value {
                numbers.set(parameter, value);
            }
        }
        numbers
    }
}

impl GridTable {
    /// Takes out the axes along which whiskers differ.
    pub fn take_sweep(&mut self) -> Vec<(Parameter, AxisValues)> {
        let axes = [
            (Parameter::Taper, self.taper.take()),
            (Parameter::TipRadiusUm, self.tip_radius_um.take()),
            (Parameter::BaseRadiusUm, self.base_radius_um.take()),
            (Parameter::LengthMm, self.length_mm.take()),
            (Parameter::ParabolaPerMm, self.curvature_per_mm.take()),
            (Parameter::VertexMm, self.vertex_mm.take()),
            (Parameter::PoleRadiusMm, self.pole_radius_mm.take()),
            (Parameter::Friction, self.friction.take()),
            (Parameter::ModulusTipToBase, self.modulus_tip_to_base.take()),
            (Parameter::ArcStretch, self.arc_stretch.take()),
        ];
        let axes = axes.into_iter();
        axes.filter_map(|(parameter, axis)| Some((parameter, axis?)))
            .collect()
    }
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
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(AxisVisitor)
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
