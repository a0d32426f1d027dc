//! The tables of a scene file, as TOML has them: right in shape, not yet checked in value.

use serde::Deserialize;
use toml::Spanned;

use super::axis::Axis;
use super::limits::Number;
use super::rows::Rows;

/// The whole file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneTable {
    pub title: Spanned<String>,
    pub whisker: WhiskerTable,
    pub pole: Option<PoleTable>,
    pub contact: Option<ContactTable>,
    pub grid: Spanned<GridTable>,
    pub output: Option<OutputTable>,
}

/// `[whisker]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WhiskerTable {
    pub length_mm: Number,
    pub base_radius_um: Option<Number>,
    pub tip_radius_um: Option<Number>,
    pub youngs_modulus_gpa: Number,
    pub profile: Option<ProfileTable>,
    pub curvature: Option<Spanned<CurvatureTable>>,
    pub projection: Option<ProjectionTable>,
    pub modulus_gradient: Option<GradientTable>,
}

/// `[whisker.modulus_gradient]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GradientTable {
    pub tip_to_base: Number,
}

/// `[whisker.projection]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ProjectionTable {
    pub arc_stretch: Number,
}

/// `[contact]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ContactTable {
    pub friction: Number,
}

/// `[whisker.curvature]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CurvatureTable {
    pub parabola_per_mm: Option<Number>,
    pub vertex_mm: Option<Number>,
    pub euler_spiral: Option<SpiralTable>,
}

/// `[whisker.curvature.euler_spiral]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SpiralTable {
    pub per_mm: Number,
    pub per_mm2: Number,
}

/// `[whisker.profile]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ProfileTable {
    pub rows: Spanned<Rows>,
}

/// `[pole]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PoleTable {
    pub radius_mm: Number,
}

/// `[grid]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GridTable {
    pub push_angle_deg: Spanned<Axis>,
    pub distance_mm: Spanned<Axis>,
    pub taper: Option<Spanned<Axis>>,
    pub curvature_per_mm: Option<Spanned<Axis>>,
}

/// `[output]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OutputTable {
    pub name: Option<Spanned<String>>,
}
