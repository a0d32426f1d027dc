//! Where a push drags the contact, and where it sticks.
//!
//! With friction the contact may be anywhere between two limits: where it would slide toward the tip, which states are computed for,
//! and where it would slide toward the base, with friction the other way. At first touch the two are one. A
//! push moves the limits, and they drag the contact along: it is where the last of them has left it (Prandtl's play).

use super::Sliding;
use super::limit::Limit;
use crate::rod::Rod;
use crate::sheet::LevelCurve;

/// What a push from first touch makes of the contact of one row.
#[derive(Clone, Debug)]
pub struct Dragged {
    tip: Limit,
    /// The limit toward the base; `None` where the other one never leads there, so that it alone drags.
    base: Option<Limit>,
    /// Pushes between which neither limit turns back, and how far the contact has slid at each.
    dragged: Vec<(f64, f64)>,
}

impl Dragged {
    /// Returns one limit per row that begins at first touch; `None` where continuation fails. All rows have one method.
    #[must_use]
    pub fn of(levels: &[LevelCurve]) -> Vec<Option<Self>> {
        let tips = Limit::of(levels);
        let falls = |tip: &Option<Limit>| tip.as_ref().is_some_and(Limit::falls);
        let falling = levels.iter().zip(&tips).filter(|(_, tip)| falls(tip));
        let opposed: Vec<LevelCurve> = falling.map(|(level, _)| opposed(level)).collect();
        let mut bases = Limit::of(&opposed).into_iter();
        let with_base = |tip: Option<Limit>| {
            let base = if falls(&tip) {
                Some(bases.next()??)
            } else {
                None
            };
            Some(Self::new(tip?, base))
        };
        tips.into_iter().map(with_base).collect()
    }

    fn new(tip: Limit, base: Option<Limit>) -> Self {
        let limits = [Some(&tip), base.as_ref()].into_iter().flatten();
        let mut pushes: Vec<f64> = limits.flat_map(Limit::pushes).collect();
        pushes.sort_by(f64::total_cmp);
        let mut dragged = Self {
            dragged: Vec::with_capacity(pushes.len()),
            tip,
            base,
        };
        let mut slid = dragged.tip.slid(0.0).unwrap_or_default();
        for push in pushes {
            (slid, _) = dragged.along(slid, push);
            dragged.dragged.push((push, slid));
        }
        dragged
    }

    /// How far the contact has slid at `push`, to which no limit turns back from where it had `slid`, and the limit that it is at.
    fn along(&self, slid: f64, push: f64) -> (f64, Option<Sliding>) {
        let tip = self.tip.slid(push).filter(|tip| *tip >= slid);
        let base = self.base.as_ref().and_then(|base| base.slid(push));
        match (tip, base.filter(|base| *base <= slid)) {
            (Some(tip), _) if tip > slid => (tip, Some(Sliding::Tip)),
            (_, Some(base)) if base < slid => (base, Some(Sliding::Base)),
            (Some(tip), _) => (tip, Some(Sliding::Tip)),
            (_, base) => (slid, base.map(|_| Sliding::Base)),
        }
    }

    /// Which way the contact slides at `push`, a magnitude in radians, or that it sticks.
    #[must_use]
    pub fn sliding(&self, push: f64) -> Sliding {
        let Some(base) = &self.base else {
            return Sliding::Tip;
        };
        let after = self.dragged.partition_point(|(at, _)| *at < push);
        let before = after.checked_sub(1).map(|before| self.dragged[before].1);
        let slid = before.or(self.tip.slid(0.0)).unwrap_or_default();
        // Next to first touch rounding hides which limit moves: ahead it does not.
        let is_one = |limit: &Limit| {
            limit
                .slid(push)
                .is_some_and(|at| (at - slid).abs() < f64::EPSILON)
        };
        let mut ahead = self.dragged[after..].iter().filter(|(at, _)| *at > push);
        match ahead.next() {
            Some((next, _)) if is_one(&self.tip) && is_one(base) => self.along(slid, *next).1,
            _ => self.along(slid, push).1,
        }
        .unwrap_or(Sliding::Sticks)
    }
}

/// The row of `level` with friction that points toward the base.
fn opposed(level: &LevelCurve) -> LevelCurve {
    let rod = Rod {
        friction: -level.rod.friction,
        ..level.rod.clone()
    };
    LevelCurve::new(level.method, &rod, level.side, &level.row)
}
