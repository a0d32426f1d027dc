//! Parameters: the numbers of a scene by name.

/// Parameters, each with its name, its unit (`1` for a ratio), its key in a scene file and its title.
macro_rules! parameters {
    ($(#[$outer:meta])* pub enum $kind:ident {
        $($(#[$inner:meta])* $parameter:ident = $name:literal, $unit:literal, $key:literal, $title:literal;)*
    }) => {
        $(#[$outer])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum $kind { $($(#[$inner])* $parameter,)* }

        impl $kind {
            /// All parameters.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$parameter),*];

            /// Name, with the unit.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$parameter => $name),* }
            }

            /// Unit; `1` for a ratio.
            #[must_use]
            pub const fn unit(self) -> &'static str {
                match self { $(Self::$parameter => $unit),* }
            }

            /// Key in a scene file.
            #[must_use]
            pub const fn key(self) -> &'static str {
                match self { $(Self::$parameter => $key),* }
            }

            /// The name as a key of the table `grid`.
            const fn grid_key(self) -> &'static str {
                match self { $(Self::$parameter => concat!("grid.", $name)),* }
            }

            /// Title in charts.
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
        /// `1 - tip/base radius`; it determines the radius at the tip.
        Taper = "taper", "1", "whisker.tip_radius_um", "taper (1 \u{2212} tip/base radius)";
        /// Young's modulus at the base, on which no detachment depends.
        YoungsModulusGpa = "youngs_modulus_gpa", "GPa", "whisker.youngs_modulus_gpa", "Young's modulus";
        /// Coefficient of the resting whisker's parabola.
        ParabolaPerMm = "parabola_per_mm", "1/mm", "whisker.curvature.parabola_per_mm", "curvature";
        /// Position of the vertex of the resting whisker's parabola.
        VertexMm = "vertex_mm", "mm", "whisker.curvature.vertex_mm", "vertex of the parabola";
        /// Curvature of an Euler spiral at the base.
        SpiralPerMm = "spiral_per_mm", "1/mm", "whisker.curvature.euler_spiral.per_mm", "curvature of the spiral at the base";
        /// Growth of an Euler spiral's curvature along the whisker.
        SpiralPerMm2 = "spiral_per_mm2", "1/mm2", "whisker.curvature.euler_spiral.per_mm2", "growth of the spiral's curvature";
        /// Young's modulus at the tip over that at the base.
        ModulusTipToBase = "modulus_tip_to_base", "1", "whisker.modulus_gradient.tip_to_base", "modulus, tip over base";
        /// Real arclength over that in the plane of contact.
        ArcStretch = "arc_stretch", "1", "whisker.projection.arc_stretch", "arc stretch";
        /// Radius of the pole.
        PoleRadiusMm = "pole_radius_mm", "mm", "pole.radius_mm", "pole radius";
        /// Coulomb's coefficient of friction.
        Friction = "friction", "1", "contact.friction", "friction";
    }
}

impl Parameter {
    /// The parameter of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|one| one.name() == name)
    }

    /// Parameters that an axis of a sweep can vary.
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

    /// Name of the axis of the sweep: the parameter's name, but `curvature_per_mm` for a parabola.
    #[must_use]
    pub const fn axis(self) -> &'static str {
        match self {
            Self::ParabolaPerMm => "curvature_per_mm",
            _ => self.name(),
        }
    }

    /// Key of the axis of the sweep in a scene file, such as `grid.taper`.
    #[must_use]
    pub const fn axis_key(self) -> &'static str {
        match self {
            Self::ParabolaPerMm => "grid.curvature_per_mm",
            _ => self.grid_key(),
        }
    }
}
