//! Course of a contact with friction whose push goes to and fro.
//!
//! The contact follows Prandtl's play on the two limits of sliding. On the way back it meets the base limit. If its slid distance is larger
//! than any on the stable states of that limit, it meets the unstable ones, and snaps to the stable state at the same push.

use super::dissipation::Dissipation;
use super::history::ContactQuery;
use super::history::{ContactHistory, ContactPhase, HistoryKnot, SlidingEnd};
use super::limit::SlidingLimit;
use super::sliding::Sliding;
use super::states::held;
use crate::numerics::Bracket;
use crate::sheet::LevelCurve;

/// Limits of sliding of one contact, with the energy that friction dissipates along them.
#[derive(Clone, Debug)]
pub struct CourseLimits {
    history: ContactHistory,
    /// Unstable states of the base limit, by push up to its fold; `None` if the base limit ends at the tip.
    retreat: Option<SlidingLimit>,
    /// Energy dissipated along the tip limit and the base limit.
    dissipated: [Dissipation; 2],
    /// Pushes between which no limit reverses or ends, in radians; they grow.
    stops: Vec<f64>,
}

impl CourseLimits {
    /// Computes the limits of the contact of `level`, which begins at first touch; `None` where the continuation fails.
    #[must_use]
    pub fn new(level: &LevelCurve) -> Option<Self> {
        let (history, retreat) = ContactHistory::with_retreat(level)?;
        let [tip, base] = [Sliding::Tip, Sliding::Base].map(|way| history.limit(way));
        let (tip, base) = (tip?, base?);
        let pushes = tip.pushes().chain(base.pushes());
        let pushes = pushes.chain(retreat.iter().flat_map(SlidingLimit::pushes));
        let mut stops: Vec<f64> = pushes.collect();
        stops.sort_by(f64::total_cmp);
        Some(Self {
            dissipated: [Dissipation::new(tip)?, Dissipation::new(base)?],
            history,
            retreat,
            stops,
        })
    }

    /// Returns true if a first push detaches at `push`, a magnitude in radians.
    #[must_use]
    pub fn detaches_at(&self, push: f64) -> bool {
        self.history.sliding_at_end(push) == Some(Sliding::Tip)
    }

    /// Returns the query of the state in `phase` at `push`, a magnitude in radians.
    #[must_use]
    pub const fn query(&self, phase: ContactPhase, push: f64) -> ContactQuery<'_> {
        ContactQuery {
            history: &self.history,
            push,
            phase,
        }
    }

    /// Begins a course at first touch.
    #[must_use]
    pub fn begin(&self) -> ContactCourse<'_> {
        let end = SlidingEnd {
            limit: Sliding::Tip,
            push: 0.0,
        };
        let tip = self.history.limit(Sliding::Tip);
        let slid = tip.and_then(|tip| tip.slid(0.0)).unwrap_or(f64::NAN);
        ContactCourse {
            limits: self,
            knot: HistoryKnot {
                push: 0.0,
                slid,
                end,
            },
            phase: ContactPhase::Slides(Sliding::Tip),
            dissipated: 0.0,
            snaps: Vec::new(),
            is_lost: false,
        }
    }

    /// Returns true if a contact with the slid distance `slid` is farther toward the tip at `push` than the unstable states of the base
    /// limit, so that it sticks.
    fn is_beyond(&self, push: f64, slid: f64) -> bool {
        let unstable = self.retreat.as_ref().and_then(|retreat| retreat.slid(push));
        unstable.is_some_and(|unstable| slid > unstable)
    }
}

/// Change of a contact that snaps toward the base, at one push.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Snap {
    /// Push angle of the snap, a magnitude, in radians.
    pub push: f64,
    /// Phase of the contact before the snap.
    pub before: ContactPhase,
    /// Energy that the snap loses, in `E I_base/L_w`; NaN if a state is not found.
    pub lost: f64,
}

/// Course of a contact from first touch to a push angle.
#[derive(Clone, Debug)]
pub struct ContactCourse<'a> {
    limits: &'a CourseLimits,
    knot: HistoryKnot,
    /// Phase of the contact at the last push.
    pub phase: ContactPhase,
    /// Energy that friction and snaps have taken since first touch, in `E I_base/L_w`.
    pub dissipated: f64,
    /// Snaps since first touch, in order.
    pub snaps: Vec<Snap>,
    /// True if the contact has left the limits that are known.
    pub is_lost: bool,
}

impl ContactCourse<'_> {
    /// Moves the push to `push`, a magnitude in radians.
    pub fn to(&mut self, push: f64) {
        let push = self.limits.history.up_to_end(push);
        let from = self.knot.push;
        let [low, high] = [from.min(push), from.max(push)];
        let stops = &self.limits.stops;
        let first = stops.partition_point(|stop| *stop <= low);
        let last = stops.partition_point(|stop| *stop < high).max(first);
        let between = &stops[first..last];
        if push > from {
            between.iter().for_each(|stop| self.step(*stop));
        } else {
            between.iter().rev().for_each(|stop| self.step(*stop));
        }
        self.step(push);
    }

    /// Moves the push to `push`, before which no limit reverses or ends.
    fn step(&mut self, push: f64) {
        let (limits, slid) = (self.limits, self.knot.slid);
        let base = limits.history.limit(Sliding::Base);
        let meets_base = base
            .and_then(|base| base.slid(push))
            .is_some_and(|base| base < slid);
        // Without unstable states the base limit ends at the tip, and nothing is known of contacts beyond.
        let fold = base.map_or(push, SlidingLimit::end);
        self.is_lost |= meets_base && limits.retreat.is_none() && self.knot.push > fold;
        let is_unknown = |retreat: &SlidingLimit| push < retreat.begin();
        self.is_lost |= meets_base && limits.retreat.as_ref().is_some_and(is_unknown);
        let is_held = meets_base && limits.is_beyond(push, slid);
        if meets_base && !is_held {
            let from = self.knot.push.min(fold);
            if limits.is_beyond(from, slid) {
                self.snap([push, from]);
            }
        }
        let from = self.knot;
        let (knot, limit) = match is_held {
            true => (HistoryKnot { push, ..from }, None),
            false => limits.history.advance(&from, push),
        };
        if let Some(way) = limit {
            self.dissipated += self.taken(way, &from, &knot);
        }
        self.phase = limit.map_or(ContactPhase::Sticks(knot.end), ContactPhase::Slides);
        self.knot = knot;
    }

    /// Energy dissipated from one knot to the next by a contact that has reached the limit `way`.
    fn taken(&self, way: Sliding, from: &HistoryKnot, to: &HistoryKnot) -> f64 {
        let Some(limit) = self.limits.history.limit(way) else {
            return f64::NAN;
        };
        let dissipated = &self.limits.dissipated[usize::from(way == Sliding::Base)];
        // The contact sticks until the limit reaches it.
        let is_before = |push: f64| limit.slid(push).map(|at| at - from.slid);
        let start = match is_before(from.push) {
            Some(miss) if miss.abs() <= f64::EPSILON || (miss > 0.0) == (way == Sliding::Tip) => {
                from.push
            }
            other => {
                let edge = other.map_or(limit.end(), |_| from.push);
                meeting(limit, from.slid, [edge, to.push])
            }
        };
        (dissipated.at(limit, to.push) - dissipated.at(limit, start)).abs()
    }

    /// Snaps to the stable state of the base limit where the unstable one reaches the contact, between two pushes.
    fn snap(&mut self, between: [f64; 2]) {
        let limits = self.limits;
        let Some(retreat) = &limits.retreat else {
            return;
        };
        let push = meeting(retreat, self.knot.slid, between);
        let before = ContactPhase::Sticks(self.knot.end);
        let after = ContactPhase::Slides(Sliding::Base);
        let states = held(&[before, after].map(|phase| limits.query(phase, push)));
        let lost = match states[..] {
            [Some(before), Some(after)] => before.full.energy - after.full.energy,
            _ => f64::NAN,
        };
        self.dissipated += lost;
        self.snaps.push(Snap { push, before, lost });
        let base = limits.history.limit(Sliding::Base);
        self.knot = HistoryKnot {
            push,
            slid: base.and_then(|base| base.slid(push)).unwrap_or(f64::NAN),
            end: SlidingEnd {
                limit: Sliding::Base,
                push,
            },
        };
    }
}

/// Push between two others at which a limit has the slid distance `slid`, in radians.
fn meeting(limit: &SlidingLimit, slid: f64, between: [f64; 2]) -> f64 {
    let miss = |push: f64| limit.slid(push).map_or(f64::NAN, |at| at - slid);
    Bracket::new(between, between.map(miss)).bisect(miss)
}
