//! The sets of effects that kernels are made for.

use crate::rod::Rod;

/// `beta tau` from which on derivatives by `tau` are carried even where they follow from the base: toward the tip of a cone
/// they vanish with the radius, and what follows is a small difference (`benches/NOTES.md`).
const SLENDER: f64 = 1.5;

/// The effects that a scene calls for; each set has kernels of its own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Effects {
    /// The stiffness falls toward the tip.
    pub taper: bool,
    /// The whisker is curved at rest, as a parabola.
    pub curvature: bool,
    /// It is an Euler spiral at rest.
    pub spiral: bool,
    /// The modulus changes along the whisker.
    pub gradient: bool,
    /// The radii follow a measured profile, the same for all rods.
    pub profile: bool,
}

impl Effects {
    /// Whether something changes along the rod, so that a trajectory must know where it is. Without, a step does not
    /// advance the section at all.
    #[must_use]
    pub fn advances(self) -> bool {
        self.taper || self.spiral || self.gradient || self.profile
    }

    /// Whether the rod looks the same from each of its points, but for its size: see `shooting::sensitivity::similar`.
    #[must_use]
    pub const fn similar(self) -> bool {
        !(self.curvature || self.spiral || self.gradient || self.profile)
    }

    /// The effects whose kernel is right for contacts up to `beta tau` of `taper_tau`: beyond 1.5 on a straight cone it
    /// is the one for a gradient, which carries all derivatives.
    #[must_use]
    pub fn reaching(self, taper_tau: f64) -> Self {
        Self {
            gradient: self.gradient || self.similar() && taper_tau > SLENDER,
            ..self
        }
    }

    /// The effects that at least one of `rods` has.
    pub fn of<'a>(rods: impl IntoIterator<Item = &'a Rod>) -> Self {
        rods.into_iter().fold(Self::default(), |set, rod| Self {
            curvature: set.curvature || rod.bend != 0.0,
            spiral: set.spiral || rod.spiral.is_some(),
            ..set.and(rod)
        })
    }

    /// These effects, and those of `rod`: none of its own is missing. No kernel has two rest shapes; that of the rod goes before.
    #[inline]
    #[must_use]
    pub fn and(self, rod: &Rod) -> Self {
        let spiral = rod.spiral.is_some();
        let curvature = rod.bend != 0.0 && !spiral;
        Self {
            taper: self.taper | (rod.taper != 0.0),
            curvature: curvature | (self.curvature & !spiral),
            spiral: spiral | (self.spiral & !curvature),
            gradient: self.gradient | (rod.gradient != 0.0),
            profile: self.profile | rod.profile.is_some(),
        }
    }
}
