//! Sliding and sticking of the contact along a push (Prandtl's play operator).
//!
//! With friction the contact lies between two limits. At the tip limit it slides toward the tip. At the base limit it slides toward the
//! base, with the opposite sign of friction. At first touch both limits coincide. A push moves the limits. A limit that reaches the
//! contact moves it; between the limits the contact sticks.

use super::Sliding;
use super::limit::SlidingLimit;
use super::newton::with_friction;
use crate::sheet::{LevelCurve, Path};
use std::collections::BTreeSet;

/// Sliding history of the contact of one row, along a push from first touch.
#[derive(Clone, Debug)]
pub struct ContactHistory {
    tip: SlidingLimit,
    /// The base limit; `None` if the tip limit never moves toward the base, so that it alone moves the contact.
    base: Option<SlidingLimit>,
    /// Contact at pushes between which neither limit reverses.
    knots: Vec<HistoryKnot>,
}

/// Contact at a push of its history.
#[derive(Clone, Copy, Debug)]
pub(super) struct HistoryKnot {
    /// Push angle, a magnitude, in radians.
    pub push: f64,
    /// Slid distance, in whisker lengths.
    pub slid: f64,
    /// Last state in which the contact slid.
    pub end: SlidingEnd,
}

/// State of a limit at which a contact slid last before it stuck.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlidingEnd {
    /// Direction in which the contact slid: toward the tip or the base.
    pub limit: Sliding,
    /// Push angle at which the sliding ended, a magnitude, in radians.
    pub push: f64,
}

/// Phase of the contact at a push angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactPhase {
    /// The contact slides toward the tip or the base, at that limit.
    Slides(Sliding),
    /// The contact sticks where its sliding ended.
    Sticks(SlidingEnd),
}

impl ContactPhase {
    /// Returns the sliding direction of the phase.
    #[must_use]
    pub const fn sliding(self) -> Sliding {
        match self {
            Self::Slides(limit) => limit,
            Self::Sticks(_) => Sliding::Sticks,
        }
    }
}

impl ContactHistory {
    /// Computes the sliding histories of rows that begin at first touch, `[row]`; `None` where the continuation fails. All rows have one
    /// method, and their trajectories share batches.
    #[must_use]
    pub fn of(levels: &[LevelCurve]) -> Vec<Option<Self>> {
        Self::of_tips(levels, SlidingLimit::of(levels))
    }

    /// Computes the sliding history along a `path` from first touch; `None` where a continuation fails.
    #[must_use]
    pub fn along(path: &Path) -> Option<Self> {
        let tip = SlidingLimit::along(path);
        Self::of_tips(std::slice::from_ref(&path.level), vec![tip]).pop()?
    }

    /// Computes the sliding histories of rows with these tip limits, `[row]`.
    fn of_tips(levels: &[LevelCurve], tips: Vec<Option<SlidingLimit>>) -> Vec<Option<Self>> {
        let falls = |tip: &Option<SlidingLimit>| tip.as_ref().is_some_and(SlidingLimit::falls);
        let falling = levels.iter().zip(&tips).filter(|(_, tip)| falls(tip));
        let opposed: Vec<LevelCurve> = falling.map(|(level, _)| opposed(level)).collect();
        let mut bases = SlidingLimit::of(&opposed).into_iter();
        let with_base = |tip: Option<SlidingLimit>| {
            let base = match falls(&tip) {
                true => Some(bases.next()??),
                false => None,
            };
            Some(Self::new(tip?, base))
        };
        let histories: Vec<Option<Self>> = tips.into_iter().map(with_base).collect();
        Self::refined(&histories)
    }

    /// Histories with exact states where the contact changes its phase. Where the contact sticks, a small error of the slid distance changes its
    /// force ratio considerably.
    fn refined(histories: &[Option<Self>]) -> Vec<Option<Self>> {
        let limits = histories.iter().flatten().filter_map(|history| {
            let base = history.base.as_ref()?;
            let tip = (&history.tip, history.met(&history.tip, Sliding::Tip));
            Some([tip, (base, history.met(base, Sliding::Base))])
        });
        let limits: Vec<(&SlidingLimit, Vec<usize>)> = limits.flatten().collect();
        let exact = SlidingLimit::exact(&limits);
        let known: Vec<SlidingLimit> = exact.iter().flatten().cloned().collect();
        let mut polished = SlidingLimit::polished(&known).into_iter();
        let exact = exact.into_iter().map(|limit| limit.and_then(|_| polished.next()));
        let mut exact = exact.collect::<Vec<_>>().into_iter();
        let refined = histories.iter().map(|history| {
            let history = history.as_ref()?;
            if history.base.is_none() {
                return Some(history.clone());
            }
            let [tip, base] = [exact.next()?, exact.next()?];
            Some(Self::new(tip?, Some(base?)))
        });
        refined.collect()
    }

    /// Segments of a `limit` on which the contact stops or begins to slide in its direction.
    fn met(&self, limit: &SlidingLimit, direction: Sliding) -> Vec<usize> {
        let begins = self.knots.windows(2).filter(|pair| {
            let was_held = pair[0].end.push < pair[0].push;
            let SlidingEnd { limit, push } = pair[1].end;
            was_held && limit == direction && push == pair[1].push
        });
        let begins = begins.flat_map(|pair| limit.between(pair[0].push, pair[1].push));
        let met: BTreeSet<usize> = begins.chain(limit.around_reversals()).collect();
        met.into_iter().collect()
    }

    /// Computes the sliding history of the row of `level` with its base limit, and the unstable states of the base limit; `None` where the
    /// continuation fails.
    pub(super) fn with_retreat(level: &LevelCurve) -> Option<(Self, Option<SlidingLimit>)> {
        let tip = SlidingLimit::of(std::slice::from_ref(level)).pop()??;
        let (base, retreat) = SlidingLimit::with_unstable(&opposed(level))?;
        let limits = [Some(&tip), Some(&base), retreat.as_ref()].into_iter().flatten();
        let whole: Vec<_> = limits.map(|limit| (limit, limit.segments())).collect();
        let exact: Option<Vec<SlidingLimit>> = SlidingLimit::exact(&whole).into_iter().collect();
        let mut exact = SlidingLimit::polished(&exact?).into_iter();
        let (tip, base) = (exact.next()?, exact.next()?);
        Some((Self::new(tip, Some(base)), exact.next()))
    }

    fn new(tip: SlidingLimit, base: Option<SlidingLimit>) -> Self {
        let limits = [Some(&tip), base.as_ref()].into_iter().flatten();
        let mut pushes: Vec<f64> = limits.flat_map(SlidingLimit::pushes).collect();
        pushes.sort_by(f64::total_cmp);
        let mut knot = HistoryKnot {
            push: 0.0,
            slid: tip.slid(0.0).unwrap_or_default(),
            end: SlidingEnd { limit: Sliding::Tip, push: 0.0 },
        };
        let mut history = Self { knots: vec![knot], tip, base };
        for push in pushes {
            knot = history.advance(&knot, push, history.base.as_ref()).0;
            history.knots.push(knot);
        }
        history
    }

    /// Contact at `push`, and the limit at the contact, if any. No limit may reverse between the push of `from` and `push`. `base` is the
    /// base limit; `None` if it does not hold the contact.
    pub(super) fn advance(
        &self,
        from: &HistoryKnot,
        push: f64,
        base: Option<&SlidingLimit>,
    ) -> (HistoryKnot, Option<Sliding>) {
        let slid = from.slid;
        let tip = self.tip.slid(push).filter(|tip| *tip >= slid);
        let base = base.and_then(|base| base.slid(push));
        let (slid, limit) = match (tip, base.filter(|base| *base <= slid)) {
            (Some(tip), _) if tip > slid => (tip, Some(Sliding::Tip)),
            (_, Some(base)) if base < slid => (base, Some(Sliding::Base)),
            (Some(tip), _) => (tip, Some(Sliding::Tip)),
            (_, base) => (slid, base.map(|_| Sliding::Base)),
        };
        let end = limit.map_or(from.end, |limit| SlidingEnd { limit, push });
        (HistoryKnot { push, slid, end }, limit)
    }

    /// Returns the end of the tip limit if `push` exceeds it by at most [`SAME_END`], otherwise `push`. The end of the row's boundary is computed
    /// apart, and differs by as much. All are magnitudes in radians.
    pub(super) fn up_to_end(&self, push: f64) -> f64 {
        let end = self.tip.end();
        let is_at_end = push > end && push - end <= SAME_END * (1.0 + end);
        if is_at_end { end } else { push }
    }

    /// Returns the phase of the contact at `push`, a magnitude in radians.
    #[must_use]
    pub fn phase(&self, push: f64) -> ContactPhase {
        let Some(base) = &self.base else {
            return ContactPhase::Slides(Sliding::Tip);
        };
        // The end of the boundary may lie a rounding beyond the end of the limit.
        let push = push.min(self.tip.end());
        let after = self.knots.partition_point(|knot| knot.push < push).max(1);
        let before = &self.knots[after - 1];
        // Where both limits coincide, as near first touch, rounding hides which one moves. The next push shows it.
        let passed = |limit: &SlidingLimit| Some((limit.slid(push)? - before.slid).abs());
        let is_at = |limit| passed(limit).is_some_and(|passed| passed < f64::EPSILON);
        let mut ahead = self.knots[after..].iter().filter(|knot| knot.push > push);
        let limit = match ahead.next() {
            Some(next) if is_at(&self.tip) && is_at(base) => {
                self.advance(before, next.push, Some(base)).1
            }
            _ => self.advance(before, push, Some(base)).1,
        };
        let is_clear = |limit| passed(limit).is_some_and(|passed| passed > CLEAR_OF_CONTACT);
        // The contact stops at an exact reversal, but begins to slide at an interpolated place.
        let is_begun = limit.and_then(|sliding| self.limit(sliding)).is_none_or(is_clear);
        let begins =
            limit.is_some_and(|sliding| before.end.limit != sliding && before.end.push > 0.0);
        let slides = limit.filter(|_| !begins || is_begun);
        slides.map_or(ContactPhase::Sticks(before.end), ContactPhase::Slides)
    }

    /// Returns the limit of a sliding `direction`; `None` for a contact that sticks, and for a base limit that never moves the contact.
    pub(super) fn limit(&self, direction: Sliding) -> Option<&SlidingLimit> {
        match direction {
            Sliding::Tip => Some(&self.tip),
            Sliding::Base => self.base.as_ref(),
            Sliding::Sticks => None,
        }
    }

    /// Returns the sliding direction at the detachment `push`, a magnitude in radians, where the stable states of the tip limit end. A push
    /// detaches there if the contact slides toward the tip. `None` if the limit ends elsewhere, so that the history leads to another end.
    #[must_use]
    pub fn sliding_at_end(&self, push: f64) -> Option<Sliding> {
        let end = self.tip.end();
        let is_end = (push - end).abs() <= SAME_END * (1.0 + end);
        is_end.then(|| self.phase(end).sliding())
    }
}

/// Slid distance by which a limit must pass a contact that sticks, in whisker lengths, to move it without doubt. Limits are interpolated with
/// smaller errors. In doubt the contact sticks, and the force ratio of its state decides.
pub(super) const CLEAR_OF_CONTACT: f64 = 1e-8;

/// Maximum difference between the ends of a limit and of the boundary of its row, in parts of a radian and of the push. The two are
/// computed apart, and may take different numbers of steps.
const SAME_END: f64 = 1e-5;

/// Push angle in the history of a contact at which the state is wanted.
#[derive(Clone, Copy, Debug)]
pub struct ContactQuery<'a> {
    /// History of the contact.
    pub history: &'a ContactHistory,
    /// Push angle, a magnitude, in radians.
    pub push: f64,
    /// Phase of the contact at the push angle.
    pub phase: ContactPhase,
}

/// Level curve of the row of `level` with the opposite sign of friction.
fn opposed(level: &LevelCurve) -> LevelCurve {
    with_friction(level, -level.rod.friction)
}
