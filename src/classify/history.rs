//! Sliding and sticking of the contact along a push (Prandtl's play operator).
//!
//! With friction the contact lies between two limits. At the tip limit it slides toward the tip, as states are computed.
//! At the base limit it slides toward the base, with the opposite sign of friction. At first touch both limits coincide.
//! A push moves the limits. A limit that reaches the contact moves it; between the limits the contact sticks.

use super::Sliding;
use super::limit::SlidingLimit;
use crate::rod::Rod;
use crate::sheet::LevelCurve;

/// Sliding history of the contact of one row, along a push from first touch.
#[derive(Clone, Debug)]
pub struct ContactHistory {
    tip: SlidingLimit,
    /// The base limit; `None` if the tip limit never moves toward the base, so that it alone moves the contact.
    base: Option<SlidingLimit>,
    /// Pushes between which neither limit reverses, in radians, and the slid distance at each, in whisker lengths.
    slid_by_push: Vec<(f64, f64)>,
}

impl ContactHistory {
    /// Computes the sliding histories of rows that begin at first touch, `[row]`; `None` where the continuation fails. All rows have one
    /// method, and their trajectories share batches.
    #[must_use]
    pub fn of(levels: &[LevelCurve]) -> Vec<Option<Self>> {
        let tips = SlidingLimit::of(levels);
        let falls = |tip: &Option<SlidingLimit>| tip.as_ref().is_some_and(SlidingLimit::falls);
        let falling = levels.iter().zip(&tips).filter(|(_, tip)| falls(tip));
        let opposed: Vec<LevelCurve> = falling.map(|(level, _)| opposed(level)).collect();
        let mut bases = SlidingLimit::of(&opposed).into_iter();
        let with_base = |tip: Option<SlidingLimit>| {
            let base = if falls(&tip) {
                Some(bases.next()??)
            } else {
                None
            };
            Some(Self::new(tip?, base))
        };
        tips.into_iter().map(with_base).collect()
    }

    fn new(tip: SlidingLimit, base: Option<SlidingLimit>) -> Self {
        let limits = [Some(&tip), base.as_ref()].into_iter().flatten();
        let mut pushes: Vec<f64> = limits.flat_map(SlidingLimit::pushes).collect();
        pushes.sort_by(f64::total_cmp);
        let mut history = Self {
            slid_by_push: Vec::with_capacity(pushes.len()),
            tip,
            base,
        };
        let mut slid = history.tip.slid(0.0).unwrap_or_default();
        for push in pushes {
            (slid, _) = history.advance(slid, push);
            history.slid_by_push.push((push, slid));
        }
        history
    }

    /// Slid distance at `push`, in whisker lengths, and the limit at the contact, if any. No limit may reverse between `push` and the
    /// push at which the contact had `slid`.
    fn advance(&self, slid: f64, push: f64) -> (f64, Option<Sliding>) {
        let tip = self.tip.slid(push).filter(|tip| *tip >= slid);
        let base = self.base.as_ref().and_then(|base| base.slid(push));
        match (tip, base.filter(|base| *base <= slid)) {
            (Some(tip), _) if tip > slid => (tip, Some(Sliding::Tip)),
            (_, Some(base)) if base < slid => (base, Some(Sliding::Base)),
            (Some(tip), _) => (tip, Some(Sliding::Tip)),
            (_, base) => (slid, base.map(|_| Sliding::Base)),
        }
    }

    /// Returns the sliding direction of the contact at `push`, a magnitude in radians.
    #[must_use]
    pub fn sliding(&self, push: f64) -> Sliding {
        let Some(base) = &self.base else {
            return Sliding::Tip;
        };
        let after = self.slid_by_push.partition_point(|(at, _)| *at < push);
        let before = after
            .checked_sub(1)
            .map(|before| self.slid_by_push[before].1);
        let slid = before.or(self.tip.slid(0.0)).unwrap_or_default();
        // Where both limits coincide, as near first touch, rounding hides which one moves. The next push shows it.
        let is_at = |limit: &SlidingLimit| {
            limit
                .slid(push)
                .is_some_and(|at| (at - slid).abs() < f64::EPSILON)
        };
        let mut ahead = self.slid_by_push[after..]
            .iter()
            .filter(|(at, _)| *at > push);
        match ahead.next() {
            Some((next, _)) if is_at(&self.tip) && is_at(base) => self.advance(slid, *next).1,
            _ => self.advance(slid, push).1,
        }
        .unwrap_or(Sliding::Sticks)
    }
}

/// Level curve of the row of `level` with the opposite sign of friction.
fn opposed(level: &LevelCurve) -> LevelCurve {
    let rod = Rod {
        friction: -level.rod.friction,
        ..level.rod.clone()
    };
    LevelCurve::new(level.method, &rod, level.side, &level.row)
}
