//! Course of a contact with friction whose push goes to and fro.
//!
//! The contact follows Prandtl's play on the two limits of sliding. On the way back it meets the base limit. If its slid distance is larger
//! than any on the stable states of that limit, it meets the unstable ones, and snaps to the stable state at the same push.
//!
//! Between two stops every limit is monotone, so that it passes a slid distance at most once, and the contact follows from its state at
//! the last stop. The course therefore keeps its state at stops, snaps and turning points alone. Any number of states may be read between
//! them, and change nothing.

use super::dissipation::Dissipation;
use super::history::ContactQuery;
use super::history::{ContactHistory, ContactPhase, HistoryKnot, SlidingEnd};
use super::limit::SlidingLimit;
use super::sliding::Sliding;
use super::states::held;
use crate::sheet::LevelCurve;
use whiskmap_mechanics::numerics::Bracket;

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
        let [tip, base] = [Sliding::Tip, Sliding::Base].map(|sliding| history.limit(sliding));
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
        ContactQuery { history: &self.history, push, phase }
    }

    /// Begins a course at first touch.
    #[must_use]
    pub fn begin(&self) -> FrictionCourse<'_> {
        let end = SlidingEnd { limit: Sliding::Tip, push: 0.0 };
        let tip = self.history.limit(Sliding::Tip);
        let slid = tip.and_then(|tip| tip.slid(0.0)).unwrap_or(f64::NAN);
        FrictionCourse {
            limits: self,
            knot: HistoryKnot { push: 0.0, slid, end },
            phase: ContactPhase::Slides(Sliding::Tip),
            dissipated: 0.0,
            snaps: Vec::new(),
            is_beyond: false,
            lost_at: None,
        }
    }

    /// Returns the base limit.
    fn base(&self) -> Option<&SlidingLimit> {
        self.history.limit(Sliding::Base)
    }

    /// Returns the first stop after `push` in one direction, in radians; `None` beyond the last one.
    fn stop(&self, push: f64, grows: bool) -> Option<f64> {
        let index = match grows {
            true => self.stops.partition_point(|stop| *stop <= push),
            false => self.stops.partition_point(|stop| *stop < push).checked_sub(1)?,
        };
        self.stops.get(index).copied()
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
pub struct FrictionCourse<'a> {
    limits: &'a CourseLimits,
    knot: HistoryKnot,
    /// Phase of the contact at the last push.
    pub phase: ContactPhase,
    /// Energy that friction and snaps have taken since first touch, in `E I_base/L_w`.
    pub dissipated: f64,
    /// Snaps since first touch, in order.
    pub snaps: Vec<Snap>,
    /// True if the contact is farther toward the tip than the unstable states of the base limit. The stable ones do not hold it then.
    pub is_beyond: bool,
    /// Push angle at which the contact left the limits that are known, a magnitude, in radians; `None` if it did not.
    pub lost_at: Option<f64>,
}

impl FrictionCourse<'_> {
    /// Moves the push to `push`, a magnitude in radians, at which it may turn back.
    pub fn to(&mut self, push: f64) {
        let push = self.limits.history.up_to_end(push);
        self.pass(push);
        self.step(push);
    }

    /// Returns the course up to `push`, a magnitude in radians, on the way to a push at least as far in this direction. This course only
    /// moves to the last stop or snap before.
    #[must_use]
    pub fn at(&mut self, push: f64) -> Self {
        let push = self.limits.history.up_to_end(push);
        self.pass(push);
        let mut reached = self.clone();
        reached.step(push);
        reached
    }

    /// Passes all stops and snaps before `push`.
    fn pass(&mut self, push: f64) {
        while push != self.knot.push && self.lost_at.is_none() {
            let grows = push > self.knot.push;
            let is_before = |at: f64| if grows { at < push } else { at > push };
            self.head(grows);
            let Some(stop) = self.limits.stop(self.knot.push, grows) else {
                return;
            };
            match self.snap_before(stop) {
                Some(snap) if is_before(snap) => self.snap(snap),
                None if is_before(stop) => self.step(stop),
                _ => return,
            }
        }
    }

    /// Begins a stretch along which the push grows or falls. Below the end of the base limit, the contact lies on one side of its unstable states.
    fn head(&mut self, grows: bool) {
        let Some(base) = self.limits.base() else {
            return;
        };
        let HistoryKnot { push, slid, .. } = self.knot;
        let end = base.end();
        if push >= end {
            self.is_beyond = !grows && base.slid(end).is_some_and(|base| slid > base);
        }
        // Without unstable states the base limit ends at the tip, and nothing is known of contacts beyond.
        let known = self.limits.retreat.as_ref();
        let known = known.map_or(end, SlidingLimit::begin);
        if !grows && self.is_beyond && push <= known {
            self.lost_at = Some(push);
        }
    }

    /// Returns the push at which the contact snaps up to the next `stop`, in radians; `None` if it does not.
    fn snap_before(&self, stop: f64) -> Option<f64> {
        let HistoryKnot { push, slid, .. } = self.knot;
        let retreat = self.limits.retreat.as_ref().filter(|_| self.is_beyond)?;
        let is_met = retreat.slid(stop).is_some_and(|at| at >= slid);
        is_met.then(|| meeting(retreat, slid, [push, stop]))
    }

    /// Moves the push to `push`, before which there is no stop and no snap.
    fn step(&mut self, push: f64) {
        if self.lost_at.is_some() {
            return;
        }
        let (limits, from) = (self.limits, self.knot);
        let base = limits.base();
        let base = base.filter(|base| !self.is_beyond && from.push <= base.end());
        let (knot, limit) = limits.history.advance(&from, push, base);
        if let Some(sliding) = limit {
            self.dissipated += self.taken(sliding, &from, &knot);
        }
        self.phase = limit.map_or(ContactPhase::Sticks(knot.end), ContactPhase::Slides);
        self.knot = knot;
    }

    /// Energy dissipated from one knot to the next by a contact that has reached the limit `sliding`.
    fn taken(&self, sliding: Sliding, from: &HistoryKnot, to: &HistoryKnot) -> f64 {
        let Some(limit) = self.limits.history.limit(sliding) else {
            return f64::NAN;
        };
        let dissipated = &self.limits.dissipated[usize::from(sliding == Sliding::Base)];
        // The contact sticks until the limit reaches it.
        let miss = limit.slid(from.push).map_or(f64::NAN, |at| at - from.slid);
        let is_there = miss.abs() <= f64::EPSILON || (miss > 0.0) == (sliding == Sliding::Tip);
        let start = match is_there {
            true => from.push,
            false => meeting(limit, from.slid, [from.push, to.push]),
        };
        (dissipated.at(limit, to.push) - dissipated.at(limit, start)).abs()
    }

    /// Snaps to the stable state of the base limit at `push`, in radians, where the unstable one reaches the contact.
    fn snap(&mut self, push: f64) {
        let limits = self.limits;
        let before = ContactPhase::Sticks(self.knot.end);
        let after = ContactPhase::Slides(Sliding::Base);
        let states = held(&[before, after].map(|phase| limits.query(phase, push)));
        let lost = match states[..] {
            [Some(before), Some(after)] => {
                before.variation.full.energy - after.variation.full.energy
            }
            _ => f64::NAN,
        };
        self.dissipated += lost;
        self.snaps.push(Snap { push, before, lost });
        self.is_beyond = false;
        self.knot = HistoryKnot {
            push,
            slid: limits.base().and_then(|base| base.slid(push)).unwrap_or(f64::NAN),
            end: SlidingEnd { limit: Sliding::Base, push },
        };
    }
}

/// Push between two others at which a limit has the slid distance `slid`, in radians.
fn meeting(limit: &SlidingLimit, slid: f64, between: [f64; 2]) -> f64 {
    let miss = |push: f64| limit.slid(push).map_or(f64::NAN, |at| at - slid);
    Bracket::new(between, between.map(miss)).bisect(miss)
}
