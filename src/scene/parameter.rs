//! The numbers of a scene that a fit, a design or an uncertainty varies.

/// A number of the whisker or the pole.
///
/// ```
/// use whiskmap::scene::{Parameter, Scene};
///
/// let cone = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml")?;
/// let tip = Parameter::TipRadiusUm;
/// assert_eq!((tip.value(&cone), tip.range(&cone)), (Some(1.5), [0.0, 30.0]));
/// assert_eq!(cone.with_parameters(&[(tip, 4.0)])?.whisker.tip_radius_um, 4.0);
/// # Ok::<(), whiskmap::scene::SceneError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Parameter {
    /// Arclength from base to tip.
    LengthMm,
    /// Radius at the base.
    BaseRadiusUm,
    /// Radius at the tip.
    TipRadiusUm,
    /// `1 - tip/base radius`, by way of the tip's radius.
    Taper,
    /// Young's modulus at the base, on which no detachment depends.
    YoungsModulusGpa,
    /// Coefficient of the resting whisker's parabola.
    ParabolaPerMm,
    /// Where that parabola has its vertex.
    VertexMm,
    /// Curvature of an Euler spiral at the base.
    SpiralPerMm,
    /// Its growth along the whisker.
    SpiralPerMm2,
    /// Young's modulus at the tip over that at the base.
    ModulusTipToBase,
    /// Real arclength over that in the plane of contact.
    ArcStretch,
    /// Radius of the pole.
    PoleRadiusMm,
    /// Coulomb's coefficient.
    Friction,
}

impl Parameter {
    /// All of them.
    pub const ALL: [Self; 13] = [
        Self::LengthMm,
        Self::BaseRadiusUm,
        Self::TipRadiusUm,
        Self::Taper,
        Self::YoungsModulusGpa,
        Self::ParabolaPerMm,
        Self::VertexMm,
        Self::SpiralPerMm,
        Self::SpiralPerMm2,
        Self::ModulusTipToBase,
        Self::ArcStretch,
        Self::PoleRadiusMm,
        Self::Friction,
    ];

    /// Its name, with its unit.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::LengthMm => "length_mm",
            Self::BaseRadiusUm => "base_radius_um",
            Self::TipRadiusUm => "tip_radius_um",
            Self::Taper => "taper",
            Self::YoungsModulusGpa => "youngs_modulus_gpa",
            Self::ParabolaPerMm => "parabola_per_mm",
            Self::VertexMm => "vertex_mm",
            Self::SpiralPerMm => "spiral_per_mm",
            Self::SpiralPerMm2 => "spiral_per_mm2",
            Self::ModulusTipToBase => "modulus_tip_to_base",
            Self::ArcStretch => "arc_stretch",
            Self::PoleRadiusMm => "pole_radius_mm",
            Self::Friction => "friction",
        }
    }

    /// The one of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|one| one.name() == name)
    }

    /// Those that an axis of the sweep can have.
    pub const SWEPT: [Self; 10] = [
        Self::Taper,
        Self::TipRadiusUm,
        Self::BaseRadiusUm,
        Self::LengthMm,
        Self::ParabolaPerMm,
        Self::VertexMm,
        Self::PoleRadiusMm,
        Self::Friction,
        Self::ModulusTipToBase,
        Self::ArcStretch,
    ];

    /// The name of its axis: its own, but a parabola's is `curvature_per_mm`.
    #[must_use]
    pub const fn axis(self) -> &'static str {
        match self {
            Self::ParabolaPerMm => "curvature_per_mm",
            _ => self.name(),
        }
    }

    /// Its unit; `1` for a ratio.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            Self::LengthMm | Self::VertexMm | Self::PoleRadiusMm => "mm",
            Self::BaseRadiusUm | Self::TipRadiusUm => "um",
            Self::YoungsModulusGpa => "GPa",
            Self::ParabolaPerMm | Self::SpiralPerMm => "1/mm",
            Self::SpiralPerMm2 => "1/mm2",
            Self::Taper | Self::ModulusTipToBase | Self::ArcStretch | Self::Friction => "1",
        }
    }

    /// What people call it.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::LengthMm => "length",
            Self::BaseRadiusUm => "radius at the base",
            Self::TipRadiusUm => "radius at the tip",
            Self::Taper => "taper (1 \u{2212} tip/base radius)",
            Self::YoungsModulusGpa => "Young's modulus",
            Self::ParabolaPerMm => "curvature",
            Self::VertexMm => "vertex of the parabola",
            Self::SpiralPerMm => "curvature of the spiral at the base",
            Self::SpiralPerMm2 => "growth of the spiral's curvature",
            Self::ModulusTipToBase => "modulus, tip over base",
            Self::ArcStretch => "arc stretch",
            Self::PoleRadiusMm => "pole radius",
            Self::Friction => "friction",
        }
    }

    /// Where a scene file has it.
    #[must_use]
    pub const fn key(self) -> &'static str {
        match self {
            Self::LengthMm => "whisker.length_mm",
            Self::BaseRadiusUm => "whisker.base_radius_um",
            Self::TipRadiusUm | Self::Taper => "whisker.tip_radius_um",
            Self::YoungsModulusGpa => "whisker.youngs_modulus_gpa",
            Self::ParabolaPerMm => "whisker.curvature.parabola_per_mm",
            Self::VertexMm => "whisker.curvature.vertex_mm",
            Self::SpiralPerMm => "whisker.curvature.euler_spiral.per_mm",
            Self::SpiralPerMm2 => "whisker.curvature.euler_spiral.per_mm2",
            Self::ModulusTipToBase => "whisker.modulus_gradient.tip_to_base",
            Self::ArcStretch => "whisker.projection.arc_stretch",
            Self::PoleRadiusMm => "pole.radius_mm",
            Self::Friction => "contact.friction",
        }
    }

    /// Its number in the `tables` of a scene file.
    pub(super) fn number_in(self, tables: &toml::Table) -> Option<f64> {
        let (path, last) = self.key().rsplit_once('.')?;
        let mut names = path.split('.');
        let table = names.try_fold(tables, |table, name| table.get(name)?.as_table());
        let found = table?.get(last)?;
        let whole = || Some(found.as_integer()? as f64);
        found.as_float().or_else(whole)
    }
}
