//! The numbers of a scene that a fit, a design or an uncertainty varies.

/// Numbers, each with its name, its unit (`1` for a ratio), where a scene file has it, and what people call it.
macro_rules! parameters {
    ($(#[$outer:meta])* pub enum $kind:ident {
        $($(#[$inner:meta])* $parameter:ident = $name:literal, $unit:literal, $key:literal, $title:literal;)*
    }) => {
        $(#[$outer])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $kind { $($(#[$inner])* $parameter,)* }

        impl $kind {
            /// All of them.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$parameter),*];

            /// Its name, with its unit.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$parameter => $name),* }
            }

            /// Its unit; `1` for a ratio.
            #[must_use]
            pub const fn unit(self) -> &'static str {
                match self { $(Self::$parameter => $unit),* }
            }

            /// Where a scene file has it.
            #[must_use]
            pub const fn key(self) -> &'static str {
                match self { $(Self::$parameter => $key),* }
            }

            /// What people call it.
            #[must_use]
            pub const fn title(self) -> &'static str {
                match self { $(Self::$parameter => $title),* }
            }
        }
    };
}

parameters! {
    /// A number of the whisker or the pole.
    ///
    /// ```
    /// use whiskmap::scene::{Parameter, Scene};
    ///
    /// let cone = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml")?;
    /// let tip = Parameter::TipRadiusUm;
    /// assert_eq!((tip.value(&cone), tip.range(&cone)), (Some(1.5), [0.0, 30.0]));
    /// assert_eq!(cone.with(tip, 4.0)?.whisker.tip_radius_um, 4.0);
    /// # Ok::<(), whiskmap::scene::SceneError>(())
    /// ```
    pub enum Parameter {
        /// Arclength from base to tip.
        LengthMm = "length_mm", "mm", "whisker.length_mm", "length";
        /// Radius at the base.
        BaseRadiusUm = "base_radius_um", "um", "whisker.base_radius_um", "radius at the base";
        /// Radius at the tip.
        TipRadiusUm = "tip_radius_um", "um", "whisker.tip_radius_um", "radius at the tip";
        /// `1 - tip/base radius`, by way of the tip's radius.
        Taper = "taper", "1", "whisker.tip_radius_um", "taper (1 \u{2212} tip/base radius)";
        /// Young's modulus at the base, on which no detachment depends.
        YoungsModulusGpa = "youngs_modulus_gpa", "GPa", "whisker.youngs_modulus_gpa", "Young's modulus";
        /// Coefficient of the resting whisker's parabola.
        ParabolaPerMm = "parabola_per_mm", "1/mm", "whisker.curvature.parabola_per_mm", "curvature";
        /// Where that parabola has its vertex.
        VertexMm = "vertex_mm", "mm", "whisker.curvature.vertex_mm", "vertex of the parabola";
        /// Curvature of an Euler spiral at the base.
        SpiralPerMm = "spiral_per_mm", "1/mm", "whisker.curvature.euler_spiral.per_mm", "curvature of the spiral at the base";
        /// Its growth along the whisker.
        SpiralPerMm2 = "spiral_per_mm2", "1/mm2", "whisker.curvature.euler_spiral.per_mm2", "growth of the spiral's curvature";
        /// Young's modulus at the tip over that at the base.
        ModulusTipToBase = "modulus_tip_to_base", "1", "whisker.modulus_gradient.tip_to_base", "modulus, tip over base";
        /// Real arclength over that in the plane of contact.
        ArcStretch = "arc_stretch", "1", "whisker.projection.arc_stretch", "arc stretch";
        /// Radius of the pole.
        PoleRadiusMm = "pole_radius_mm", "mm", "pole.radius_mm", "pole radius";
        /// Coulomb's coefficient.
        Friction = "friction", "1", "contact.friction", "friction";
    }
}

impl Parameter {
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
}
