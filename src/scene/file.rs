//! The tables of a scene file, as TOML has them: right in shape, not yet checked in value.

use serde::Deserialize;
use std::collections::BTreeMap;
use toml::Spanned;

use super::axis::Axis;
use super::limits::Number;
use super::parameter::Parameter;
use super::rows::Rows;

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
        title: Spanned<String>,
        whisker: WhiskerTable,
        pole: Option<PoleTable>,
        contact: Option<ContactTable>,
        grid: Spanned<GridTable>,
        output: Option<OutputTable>,
        uncertainty: Option<Spanned<BTreeMap<String, Number>>>,
    }
    /// `[whisker]`
    WhiskerTable {
        length_mm: Number,
        base_radius_um: Option<Number>,
        tip_radius_um: Option<Number>,
        youngs_modulus_gpa: Number,
        profile: Option<ProfileTable>,
        curvature: Option<Spanned<CurvatureTable>>,
        projection: Option<ProjectionTable>,
        modulus_gradient: Option<GradientTable>,
    }
    /// `[whisker.profile]`
    ProfileTable { rows: Spanned<Rows>, }
    /// `[whisker.curvature]`
    CurvatureTable {
        parabola_per_mm: Option<Number>,
        vertex_mm: Option<Number>,
        euler_spiral: Option<SpiralTable>,
    }
    /// `[whisker.curvature.euler_spiral]`
    SpiralTable { per_mm: Number, per_mm2: Number, }
    /// `[whisker.projection]`
    ProjectionTable { arc_stretch: Number, }
    /// `[whisker.modulus_gradient]`
    GradientTable { tip_to_base: Number, }
    /// `[pole]`
    PoleTable { radius_mm: Number, }
    /// `[contact]`
    ContactTable { friction: Number, }
    /// `[grid]`
    GridTable {
        push_angle_deg: Spanned<Axis>,
        distance_mm: Spanned<Axis>,
        taper: Option<Spanned<Axis>>,
        tip_radius_um: Option<Spanned<Axis>>,
        base_radius_um: Option<Spanned<Axis>>,
        length_mm: Option<Spanned<Axis>>,
        curvature_per_mm: Option<Spanned<Axis>>,
        vertex_mm: Option<Spanned<Axis>>,
        pole_radius_mm: Option<Spanned<Axis>>,
        friction: Option<Spanned<Axis>>,
        modulus_tip_to_base: Option<Spanned<Axis>>,
        arc_stretch: Option<Spanned<Axis>>,
    }
    /// `[output]`
    OutputTable { name: Option<Spanned<String>>, }
}

impl GridTable {
    /// The axes along which whiskers differ, in the order of the file.
    pub fn sweep(&self) -> Vec<(Parameter, &Spanned<Axis>)> {
        let axis = |parameter| match parameter {
            Parameter::Taper => self.taper.as_ref(),
            Parameter::TipRadiusUm => self.tip_radius_um.as_ref(),
            Parameter::BaseRadiusUm => self.base_radius_um.as_ref(),
            Parameter::LengthMm => self.length_mm.as_ref(),
            Parameter::ParabolaPerMm => self.curvature_per_mm.as_ref(),
            Parameter::VertexMm => self.vertex_mm.as_ref(),
            Parameter::PoleRadiusMm => self.pole_radius_mm.as_ref(),
            Parameter::Friction => self.friction.as_ref(),
            Parameter::ModulusTipToBase => self.modulus_tip_to_base.as_ref(),
            Parameter::ArcStretch => self.arc_stretch.as_ref(),
            _ => None,
        };
        let axes = Parameter::SWEPT.into_iter();
        let axes = axes.filter_map(|parameter| Some((parameter, axis(parameter)?)));
        let mut axes: Vec<_> = axes.collect();
        axes.sort_by_key(|(_, axis)| axis.span().start);
        axes
    }
}
