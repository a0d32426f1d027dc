//! Sets of mechanical effects. Each set has its own kernels.

use crate::rod::Rod;

/// Smallest `beta tau` at which a straight cone's derivatives by `tau` are integrated. They vanish with the radius toward the
/// tip, so that the formula from the base's pose cancels (`benches/NOTES.md`).
const SLENDER: f64 = 1.5;

/// Set of the mechanical effects of a whisker that its equations include.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Effects {
    /// True if the whisker is tapered: its stiffness falls toward the tip.
    pub taper: bool,
    /// True if the whisker is curved at rest, as a parabola.
    pub curvature: bool,
    /// True if the whisker is an Euler spiral at rest.
    pub spiral: bool,
    /// True if the curvature of the whisker at rest is a polynomial of the arclength.
    pub polynomial: bool,
    /// True if Young's modulus changes along the whisker.
    pub gradient: bool,
    /// True if the whisker's radii follow a measured profile.
    pub profile: bool,
}

impl Effects {
    /// Returns true if a property of the rod changes along it, so that integration steps have to advance the cross-section.
    #[must_use]
    pub fn advances(self) -> bool {
        self.taper || self.spiral || self.polynomial || self.gradient || self.profile
    }

    /// Returns true if all parts of the rod toward the base are similar except for their size: see `shooting::sensitivity::similar`.
    #[must_use]
    pub const fn similar(self) -> bool {
        !(self.curvature || self.spiral || self.polynomial || self.gradient || self.profile)
    }

    /// Returns the effects of the kernel for a contact of `rod` at `tau`. On a straight cone beyond `beta tau = 1.5`, or in a mount that
    /// turns, `gradient` is set: its kernel carries all derivatives.
    #[must_use]
    pub fn reaching(self, rod: &Rod, tau: f64) -> Self {
        let needs_all = rod.taper * tau > SLENDER || rod.mount != 0.0;
        Self { gradient: self.gradient || self.similar() && needs_all, ..self }
    }

    /// Returns the effects that at least one of `rods` has.
    pub fn of<'a>(rods: impl IntoIterator<Item = &'a Rod>) -> Self {
        rods.into_iter().fold(Self::default(), |set, rod| Self {
            curvature: set.curvature || rod.bend != 0.0,
            spiral: set.spiral || rod.spiral.is_some(),
            polynomial: set.polynomial || rod.polynomial.is_some(),
            ..set.and(rod)
        })
    }

    /// Returns these effects and all effects of `rod`. No kernel has two rest shapes: the rest shape of `rod` replaces the rest
    /// shape of this set.
    #[inline]
    #[must_use]
    pub fn and(self, rod: &Rod) -> Self {
        let polynomial = rod.polynomial.is_some();
        let spiral = rod.spiral.is_some() && !polynomial;
        let curvature = rod.bend != 0.0 && !spiral && !polynomial;
        Self {
            taper: self.taper | (rod.taper != 0.0),
            curvature: curvature | (self.curvature & !(spiral | polynomial)),
            spiral: spiral | (self.spiral & !(curvature | polynomial)),
            polynomial: polynomial | (self.polynomial & !(curvature | spiral)),
            gradient: self.gradient | (rod.gradient != 0.0),
            profile: self.profile | rod.profile.is_some(),
        }
    }
}
