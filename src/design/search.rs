//! Search of a design for ends at a push angle: a scan, changes of kind, and Newton's method between turns.

use super::samples::{SAMPLES, samples};
use super::varied::DesignScene;
use super::{DesignEnd, DesignTarget, turn};
use crate::trace::DetachmentKind;
use rayon::prelude::*;
use std::convert::Infallible;
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap_mechanics::numerics::Bracket;

/// Width of the interval of a change of kind, in parts of the interval between two samples: 50 halvings.
const CHANGE_WIDTH: f64 = 1e-15;

/// Longest last step of Newton's method, relative to the value: the error is about its square.
const LAST_STEP: f64 = 1e-8;

/// Search of a design: the scene with the one number that varies, and the target.
pub struct DesignSearch<'a> {
    pub scene: &'a DesignScene<'a>,
    pub target: &'a DesignTarget,
    pub cancel: &'a AtomicBool,
}

impl DesignSearch<'_> {
    /// The end at a value of the parameter; `Unresolved` if the scene refuses the value, and after a cancellation.
    fn end(&self, value: f64) -> DesignEnd {
        let moved = || self.scene.at(&[value]).ok();
        let is_cancelled = self.cancel.load(Ordering::Relaxed);
        let moved = (!is_cancelled).then(moved).flatten();
        let reached = moved.map(|scene| self.target.reached(&scene));
        let (kind, reached) = reached.unwrap_or((DetachmentKind::Unresolved, None));
        DesignEnd {
            value,
            kind,
            reached,
        }
    }

    /// Value of an end less the target's value, in the unit of the goal; NaN for an end of another kind.
    fn miss(&self, end: &DesignEnd) -> f64 {
        let accepted = end.reached.filter(|_| self.target.accepts(end.kind));
        accepted.unwrap_or(f64::NAN) - self.target.value
    }

    fn miss_at(&self, value: f64) -> f64 {
        self.miss(&self.end(value))
    }

    /// The miss at a value of the parameter, and the next value by Newton's method: NaN for a bisection, without a derivative.
    fn newton(&self, value: f64) -> (f64, f64) {
        let miss = self.miss_at(value);
        // The largest value of a load may move from the end of the push to before it.
        let has_slope = self.target.goal.kind().is_some();
        let moved = has_slope.then(|| self.scene.at(&[value]).ok()).flatten();
        let slope = moved.and_then(|scene| {
            let directions = self.scene.directions(&scene);
            self.target.gradient(&scene, &directions)
        });
        let next = slope.map(|slope| value - miss / slope[0]);
        (miss, next.unwrap_or(f64::NAN))
    }

    /// Returns ends of pushes at values over the `range` of the parameter, in its unit, and on both sides of each change of kind: `[value]`.
    pub fn scan(&self, range: [f64; 2]) -> Vec<DesignEnd> {
        let scanned: Vec<DesignEnd> = samples(range, SAMPLES)
            .into_par_iter()
            .map(|value| self.end(value))
            .collect();
        let mut ends = Vec::with_capacity(scanned.len());
        for (i, end) in scanned.iter().enumerate() {
            if let Some(before) = i.checked_sub(1).map(|i| scanned[i])
                && before.kind != end.kind
            {
                ends.extend(self.change(before, *end));
            }
            ends.push(*end);
        }
        ends
    }

    /// The last end of the kind of `before`, and the first end of another kind between it and `after`.
    fn change(&self, mut before: DesignEnd, mut after: DesignEnd) -> [DesignEnd; 2] {
        let mut bracket = Bracket {
            below: before.value,
            above: after.value,
        };
        let width = CHANGE_WIDTH * (after.value - before.value).abs();
        let Ok(()) = bracket.halve(width, |value| {
            let middle = self.end(value);
            let is_before = middle.kind == before.kind;
            *(if is_before { &mut before } else { &mut after }) = middle;
            Ok::<bool, Infallible>(is_before)
        });
        [before, after]
    }

    /// Returns the values of the parameter, in its unit, at which a push ends at the target, `[solution]`. They lie within a `piece`
    /// where every end has the target's kind.
    pub fn solutions(&self, piece: &[DesignEnd]) -> Vec<f64> {
        let mut places: Vec<[f64; 2]> = piece
            .iter()
            .map(|end| [end.value, self.miss(end)])
            .collect();
        let turns = places.windows(3).filter_map(|three| {
            let three = [three[0], three[1], three[2]];
            turn::toward_zero(three, |value| self.miss_at(value))
        });
        let turns: Vec<[f64; 2]> = turns.collect();
        places.extend(turns);
        places.sort_by(|a, b| a[0].total_cmp(&b[0]));

        let crosses: Vec<bool> = places
            .windows(2)
            .map(|pair| (pair[0][1] < 0.0) != (pair[1][1] < 0.0))
            .collect();
        let mut solutions = Vec::new();
        for (i, [value, miss]) in places.iter().enumerate() {
            let after = crosses.get(i).is_some_and(|crosses| *crosses);
            let before = i.checked_sub(1).is_some_and(|before| crosses[before]);
            if after {
                let [next, miss_there] = places[i + 1];
                let bracket = Bracket::new([*value, next], [*miss, miss_there]);
                let start = bracket.middle();
                let last_step = |value: f64| LAST_STEP * value.abs();
                let root = bracket.newton(start, last_step, |value| self.newton(value));
                solutions.push(root.x);
            } else if !before && miss.abs() <= self.target.tolerance() {
                solutions.push(*value);
            }
        }
        solutions.retain(|value| self.miss_at(*value).abs() <= self.target.tolerance());
        solutions
    }
}
