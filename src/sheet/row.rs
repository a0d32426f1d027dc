//! Rows of a map, each at one distance, and the crossings at which they leave the stable sheet.

use glam::DVec2;
use whiskmap_mechanics::rod::{Rest, Rod};
use whiskmap_mechanics::shooting::{Reader, Reading, ShootingMap};

/// Distance beyond the tip, in whisker lengths, within which first touch counts as at the tip. Rounding of a distance in millimetres, of
/// its division by the length and of the rest shape is a hundred times smaller.
pub const REACH_SLACK: f64 = 1e-12;

/// One row of a map: one distance, for one whisker and side. Lengths are in whisker lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Distance `D` of the pole's centre from the base, in whisker lengths.
    pub pole_distance: f64,
    /// Arclength of the contact at first touch, in whisker lengths. Beyond 1, the whisker's shape at rest is continued.
    pub contact: f64,
    /// Direction of the pole's centre at first touch, in radians from the base's tangent.
    pub touch: f64,
    /// Arclength of the whisker's tip, in whisker lengths: 1, or a little less for a perfect cone.
    pub end: f64,
}

impl Row {
    /// Computes the row for `distance`, in whisker lengths, at first touch. Beyond the tip the rest shape is continued.
    #[must_use]
    pub fn new(rest: &Rest, distance: f64) -> Self {
        let (contact, pole) = rest.touch_at_distance(distance);
        Self { pole_distance: pole.length(), contact, touch: pole.to_angle(), end: rest.end() }
    }

    /// Returns true if the resting whisker is long enough to touch the pole. The shape at rest decides, so the result is the same at
    /// every resolution.
    #[must_use]
    pub fn is_reached(&self) -> bool {
        self.contact <= self.end + REACH_SLACK
    }

    /// Returns true if the tip of the resting whisker touches the pole.
    #[must_use]
    pub fn is_at_reach(&self) -> bool {
        (self.contact - self.end).abs() <= REACH_SLACK
    }

    /// Returns `(tau, load)` of `rod` at first touch of a row, where the load is 0.
    #[must_use]
    pub fn first_touch(&self, rod: &Rod) -> DVec2 {
        DVec2::new(rod.tau(self.contact).min(rod.tau_tip()), 0.0)
    }

    /// Returns the values of the state at first touch of a row, in the units of `reader`.
    #[must_use]
    pub fn read_first_touch(&self, reader: &Reader) -> Reading {
        reader.at_first_touch(self.contact.min(self.end), self.touch)
    }

    /// Returns the pole's centre in the frame of the base, in whisker lengths, after the base has turned by `signed_push` radians since
    /// first touch.
    #[must_use]
    pub fn pole(&self, signed_push: f64) -> DVec2 {
        self.pole_distance * DVec2::from_angle(self.touch + signed_push)
    }
}

/// Edge over which a row leaves the sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// Fold edge (saddle-node): the whisker slips off.
    Fold,
    /// Tip edge, with the contact at the tip: the whisker is pulled off.
    Tip,
}

impl Edge {
    /// Returns the derivative of the push angle by `ln D` along the edge, in radians, at the point with the map `map`. At the fold, both
    /// change in proportion in every direction.
    #[must_use]
    pub fn slope(self, map: &ShootingMap) -> f64 {
        let change = match self {
            Self::Fold => map.by_tau,
            Self::Tip => map.by_load,
        };
        change.y / change.x
    }
}

/// Crossing of an edge of the sheet by a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Edge that the row crosses.
    pub edge: Edge,
    /// Contact coordinate `tau` of the crossing, dimensionless.
    pub tau: f64,
    /// Signed load `f/rho^2` of the crossing, dimensionless.
    pub load: f64,
    /// Push angle of the crossing since first touch, in radians: a magnitude on the row's side.
    pub push: f64,
    /// Remaining relative error of the crossing: the miss in `ln D`, plus the square of the remaining step in `(tau, load)` (the push
    /// angle is flat at a fold). Infinite for a crossing that is not found.
    pub residual: f64,
    /// Derivative of the push angle by `ln D` along the edge, in radians ([`Edge::slope`]); NaN for a crossing that is not found.
    pub slope: f64,
}

/// Slope ([`Edge::slope`]) above which a crossing is computed with twice the steps. An error of 1e-11 in `ln D` then changes the push
/// angle by more than 1e-8 degrees.
pub const STEEP: f64 = 20.0;

/// Largest relative difference in contact and load, added, of two crossings that are the same.
const SAME_CROSSING: f64 = 1e-5;

/// Largest residual of a crossing that counts as found.
const SOUND: f64 = 1e-10;

impl Crossing {
    /// Returns true if the crossing is found: its residual is at most 1e-10. Otherwise it is only near the level curve.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        self.residual <= SOUND
    }

    /// Returns true if the push angle changes so fast along the edge that the crossing needs more steps.
    #[must_use]
    pub fn is_steep(&self) -> bool {
        self.slope.abs() > STEEP
    }

    /// Returns the crossing of a row that meets the tip edge at first touch: its load is 0 at every resolution.
    #[must_use]
    pub fn at_touch(rod: &Rod) -> Self {
        Self {
            edge: Edge::Tip,
            tau: rod.tau_tip(),
            load: 0.0,
            push: 0.0,
            residual: 0.0,
            slope: 0.0,
        }
    }

    /// Returns true if both are the same crossing from two computations, which differ by the error of the resolution.
    #[must_use]
    pub fn is_same(&self, other: &Self) -> bool {
        let apart = [self.tau / other.tau, self.load / other.load].map(|ratio| (ratio - 1.0).abs());
        self.edge == other.edge && apart.iter().sum::<f64>() < SAME_CROSSING
    }

    /// Returns true if the row meets the tip edge at first touch ([`Crossing::at_touch`]).
    #[must_use]
    pub fn is_at_touch(&self) -> bool {
        self.load == 0.0
    }

    /// Returns the placeholder for missing crossings, which follows the crossings that were found. Contact, load, push angle and slope are
    /// NaN.
    #[must_use]
    pub fn unknown() -> Self {
        Self {
            edge: Edge::Tip,
            tau: f64::NAN,
            load: f64::NAN,
            push: f64::NAN,
            residual: f64::INFINITY,
            slope: f64::NAN,
        }
    }

    /// Returns true if this is the placeholder for crossings that could not be found ([`Crossing::unknown`]).
    #[must_use]
    pub fn is_unknown(&self) -> bool {
        self.tau.is_nan()
    }
}

/// Returns the ends of the stable pieces of a row with these `crossings`, `[piece]`. If the row `touches` the pole, its first piece begins at first
/// touch, without a crossing. A last crossing without its partner is left out.
pub fn pieces(
    touches: bool,
    crossings: &[Crossing],
) -> impl Iterator<Item = (Option<&Crossing>, &Crossing)> {
    let (from_touch, others) = match crossings {
        [end, others @ ..] if touches => (Some((None, end)), others),
        all => (None, all),
    };
    let others = others.chunks_exact(2).map(|ends| (Some(&ends[0]), &ends[1]));
    from_touch.into_iter().chain(others)
}
