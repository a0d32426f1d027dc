//! Parameters: the numbers of a scene by name, and the table of all that is known of each.

use super::axis::AxisValues;
use super::limits::{NumberLimits, rounded};
use super::toml::SceneFile;
use super::whisker::Whisker;

/// Largest ratio of the moduli at tip and base, and of those at base and tip. Measured ratios lie between 0.7 and 1.4.
pub(super) const STIFFEST_TIP: f64 = 20.0;

/// Largest accepted arc stretch, a ratio.
pub(super) const MOST_STRETCH: f64 = 2.0;

/// Columns of a table with the derivatives of the push angle, force, moment, energy, arclength and contact angle by a variable.
macro_rules! derivative_columns {
    ($name:expr) => {
        [
            concat!("d_push_d_", $name),
            concat!("d_force_d_", $name),
            concat!("d_moment_d_", $name),
            concat!("d_energy_d_", $name),
            concat!("d_arc_length_d_", $name),
            concat!("d_contact_angle_d_", $name),
        ]
    };
}

pub(crate) use derivative_columns;

/// Key of a sweep axis: its own name, or else the name of the parameter.
macro_rules! axis {
    ($before:literal, $name:literal $axis:ident) => {
        concat!($before, stringify!($axis))
    };
    ($before:literal, $name:literal) => {
        concat!($before, $name)
    };
}

/// Parameters, each with its name, its unit (`1` for a ratio), its key in a scene file, its title, and its limits whatever the other
/// numbers are. There may follow the value of a scene that leaves it out (`or`), and the name of its sweep axis (`axis`).
///
/// Keys and axes are fields of [`SceneFile`].
macro_rules! parameters {
    ($(#[$outer:meta])* pub enum $kind:ident {
        $($(#[$inner:meta])* $parameter:ident = $name:literal, $unit:literal, $table:ident $(. $key:ident)+, $title:literal,
            [$least:expr, $most:expr] $(, or $neutral:literal)? $(, axis $axis:ident)?;)*
    }) => {
        $(#[$outer])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum $kind { $($(#[$inner])* $parameter,)* }

        impl $kind {
            /// All parameters of a scene.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$parameter),*];

            /// Parameters that a sweep axis can vary.
            pub const SWEPT: [Self; [$($(stringify!($axis),)?)*].len()] =
                [$($({ let _ = stringify!($axis); Self::$parameter },)?)*];

            /// Returns the name of the parameter, with its unit at the end.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$parameter => $name),* }
            }

            /// Returns the unit of the parameter; `1` for a ratio.
            #[must_use]
            pub const fn unit(self) -> &'static str {
                match self { $(Self::$parameter => $unit),* }
            }

            /// Returns the key of the parameter in a scene file.
            #[must_use]
            pub const fn key(self) -> &'static str {
                match self { $(Self::$parameter => concat!(stringify!($table) $(, ".", stringify!($key))+)),* }
            }

            /// Returns the title of the parameter in charts.
            #[must_use]
            pub const fn title(self) -> &'static str {
                match self { $(Self::$parameter => $title),* }
            }

            /// Returns the limits `[least, greatest]` of the parameter whatever the other numbers are, in its unit. Other numbers narrow
            /// some of these limits ([`Self::range`]).
            #[must_use]
            pub const fn limits(self) -> [f64; 2] {
                match self { $(Self::$parameter => [$least, $most]),* }
            }

            /// Returns the value of the parameter in a scene that leaves it out, in its unit; `None` if it has no value there.
            #[must_use]
            pub const fn neutral(self) -> Option<f64> {
                let neutral: &[f64] = match self { $(Self::$parameter => &[$($neutral)?]),* };
                neutral.first().copied()
            }

            /// Returns the name of the parameter's sweep axis: the parameter's name, but `curvature_per_mm` for a parabola.
            #[must_use]
            pub const fn axis(self) -> &'static str {
                match self { $(Self::$parameter => axis!("", $name $($axis)?)),* }
            }

            /// Returns the key of the parameter's sweep axis in a scene file, such as `grid.taper`.
            #[must_use]
            pub const fn axis_key(self) -> &'static str {
                match self { $(Self::$parameter => axis!("grid.", $name $($axis)?)),* }
            }

            /// Returns the number of a scene file under the key of the parameter.
            pub(super) const fn number_in(self, file: &SceneFile) -> Option<f64> {
                match self { $(Self::$parameter => file.$table $(. $key)+),* }
            }

            /// Returns the values of the parameter's sweep axis in a scene file.
            pub(super) fn axis_in(self, file: &mut SceneFile) -> Option<AxisValues> {
                match self { $($(Self::$parameter => file.grid.$axis.take(),)?)* _ => None }
            }

            /// Returns the name of the derivative of the push angle at detachment by the parameter, such as `d_push_d_taper`.
            #[must_use]
            pub const fn push_derivative(self) -> &'static str {
                self.derivative_columns()[0]
            }

            /// Returns the names of the columns with derivatives by the parameter.
            pub(crate) const fn derivative_columns(self) -> [&'static str; 6] {
                match self { $(Self::$parameter => derivative_columns!($name)),* }
            }
        }
    };
}

parameters! {
    /// Parameter of a scene: a number of the whisker or the pole.
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
        /// Arclength of the whisker from base to tip, in mm.
        LengthMm = "length_mm", "mm", whisker.length_mm, "length", [1e-3, 1e5], axis length_mm;
        /// Radius of the whisker at the base, in um.
        BaseRadiusUm = "base_radius_um", "um", whisker.base_radius_um, "radius at the base", [1e-3, 1e5], axis base_radius_um;
        /// Radius of the whisker at the tip, in um.
        TipRadiusUm = "tip_radius_um", "um", whisker.tip_radius_um, "radius at the tip", [0.0, 1e5], axis tip_radius_um;
        /// Taper of the whisker, `1 - tip/base radius`, dimensionless; it determines the radius at the tip.
        Taper = "taper", "1", whisker.tip_radius_um, "taper (1 \u{2212} tip/base radius)", [0.0, 1.0], axis taper;
        /// Factor of all measured radii, dimensionless; no detachment of a clamped whisker depends on it.
        ProfileScale = "profile_scale", "1", whisker.profile.profile_scale, "factor of the measured radii", [1e-3, 1e3], or 1.0;
        /// Length of the cone that continues the last two measured rows to the tip, in mm.
        TipExtensionMm = "tip_extension_mm", "mm", whisker.profile.tip_extension_mm, "cone beyond the last row", [0.0, 1e5], or 0.0;
        /// Young's modulus of the whisker at the base, in GPa; no detachment of a clamped whisker depends on it.
        YoungsModulusGpa = "youngs_modulus_gpa", "GPa", whisker.youngs_modulus_gpa, "Young's modulus", [1e-6, 1e4];
        /// Coefficient of the parabola of the resting whisker, in 1/mm.
        ParabolaPerMm = "parabola_per_mm", "1/mm", whisker.curvature.parabola_per_mm, "curvature", [0.0, 1e6], or 0.0, axis curvature_per_mm;
        /// Position of the vertex of the resting whisker's parabola, in mm.
        VertexMm = "vertex_mm", "mm", whisker.curvature.vertex_mm, "vertex of the parabola", [-1e6, 1e6], or 0.0, axis vertex_mm;
        /// Curvature of the resting whisker's Euler spiral at the base, in 1/mm.
        SpiralPerMm = "spiral_per_mm", "1/mm", whisker.curvature.euler_spiral.per_mm, "curvature of the spiral at the base", [-1e6, 1e6];
        /// Growth of the curvature of the resting whisker's Euler spiral along the whisker, in 1/mm2.
        SpiralPerMm2 = "spiral_per_mm2", "1/mm2", whisker.curvature.euler_spiral.per_mm2, "growth of the spiral's curvature", [-1e6, 1e6];
        /// Young's modulus of the whisker at the tip over that at the base, dimensionless.
        ModulusTipToBase = "modulus_tip_to_base", "1", whisker.modulus_gradient.tip_to_base, "modulus, tip over base",
            [1.0 / STIFFEST_TIP, STIFFEST_TIP], or 1.0, axis modulus_tip_to_base;
        /// Real arclength of the whisker over its arclength in the plane of contact, dimensionless.
        ArcStretch = "arc_stretch", "1", whisker.projection.arc_stretch, "arc stretch", [1.0, MOST_STRETCH], or 1.0, axis arc_stretch;
        /// Stiffness of the follicle that holds the base, in nN m/rad: the moment that turns the base by one radian.
        FollicleStiffness = "follicle_stiffness_nnm_per_rad", "nN m/rad", whisker.follicle.stiffness_nnm_per_rad,
            "stiffness of the follicle", [1e-6, 1e15], axis follicle_stiffness_nnm_per_rad;
        /// Radius of the pole, in mm.
        PoleRadiusMm = "pole_radius_mm", "mm", pole.radius_mm, "pole radius", [0.0, 1e6], or 0.0, axis pole_radius_mm;
        /// Coulomb's coefficient of friction between whisker and pole, dimensionless.
        Friction = "friction", "1", contact.friction, "friction", [0.0, 1.0], or 0.0, axis friction;
    }
}

impl Parameter {
    /// Returns the limits of the parameter, whatever the other numbers are.
    ///
    /// Coulomb's coefficient is about 0.5 for whiskers of rats on steel. Up to 1, every end of 25,000 random whiskers was found
    /// (`benches/NOTES.md`).
    pub(super) fn number_limits(self) -> NumberLimits {
        let [least, most] = self.limits();
        let remark =
            "with more, whiskers coil around the pole for turns on end, and not all ends are known";
        let remark = Some(remark).filter(|_| self == Self::Friction);
        NumberLimits::between(least, most).remarks(remark)
    }

    /// Returns the limits of the taper, of which `value` is given. Beyond 1 it may be a ratio of radii.
    pub(super) fn taper_limits(value: f64) -> NumberLimits {
        let is_ratio = value > 1.0 && value.is_finite();
        let remark = is_ratio.then(|| {
            let taper = rounded(1.0 - 1.0 / value, 6);
            format!("is it base/tip radius? The taper is then {taper}")
        });
        Self::Taper.number_limits().remarks(remark)
    }

    /// Returns the parameter with this name; `None` without one.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|one| one.name() == name)
    }

    /// Returns the parameter of a column of a table of whiskers, under its own name or the name of its sweep axis; `None` without one.
    #[must_use]
    pub fn of_column(name: &str) -> Option<Self> {
        Self::named(name).or_else(|| Self::SWEPT.into_iter().find(|one| one.axis() == name))
    }

    /// Returns the end of a message about a name that is not one of a parameter, but of its sweep axis; `None` for other names.
    ///
    /// ```
    /// use whiskmap::scene::Parameter;
    ///
    /// let hint = Parameter::suggested("curvature_per_mm");
    /// assert_eq!(hint.as_deref(), Some("; did you mean `parabola_per_mm`?"));
    /// ```
    #[must_use]
    pub fn suggested(name: &str) -> Option<String> {
        let mut all = Self::ALL.into_iter();
        let parameter = all.find(|parameter| parameter.axis() == name)?;
        Some(format!("; did you mean `{}`?", parameter.name()))
    }

    /// Returns the change of the parameter that changes a whisker or its contact altogether, in its unit.
    pub(crate) fn size(self, whisker: &Whisker) -> f64 {
        let length = whisker.length_mm;
        match self {
            Self::LengthMm | Self::TipExtensionMm | Self::VertexMm | Self::PoleRadiusMm => length,
            Self::BaseRadiusUm | Self::TipRadiusUm => whisker.base_radius_um,
            Self::YoungsModulusGpa => whisker.youngs_modulus_gpa,
            Self::FollicleStiffness => whisker.units().moment_nnm,
            Self::ParabolaPerMm | Self::SpiralPerMm => 1.0 / length,
            Self::SpiralPerMm2 => 1.0 / (length * length),
            Self::Taper
            | Self::ProfileScale
            | Self::ModulusTipToBase
            | Self::ArcStretch
            | Self::Friction => 1.0,
        }
    }
}
