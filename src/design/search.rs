//! Search of a design for ends at a push angle: a scan, changes of kind, and Newton's method between turns.

use super::samples::{SAMPLES, samples};
use super::varied::DesignScene;
use super::{DesignEnd, DesignTarget, EQUAL, turn};
use crate::scene::Scene;
use crate::trace::{DetachmentKind, sides_at_once};
use rayon::prelude::*;
use std::convert::Infallible;
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap_mechanics::numerics::{Bracket, WIDTH};

/// Width of the interval of a change of kind, in parts of the interval between two samples.
const CHANGE_WIDTH: f64 = 1e-15;

/// Longest last step of Newton's method, relative to the value: the error is about its square.
const LAST_STEP: f64 = 1e-8;

/// Least width of a part in which every value is a solution, relative to its values and to the range of the parameter. Samples may be nearer to
/// each other, so that two of them reach one solution.
const LEAST_SPAN: f64 = 1e-3;

/// Search of a design: the scene with the one number that varies, and the target.
pub struct DesignSearch<'a> {
    pub scene: &'a DesignScene<'a>,
    pub target: &'a DesignTarget,
    /// Function that is called after some more pushes are computed, with their number.
    pub on_progress: &'a (dyn Fn(usize) + Sync),
    pub cancel: &'a AtomicBool,
}

impl DesignSearch<'_> {
    /// The ends at values of the parameter, `[value]`; `Unresolved` if the scene refuses a value, and after a cancellation.
    fn ends(&self, values: &[f64]) -> Vec<DesignEnd> {
        let is_cancelled = self.cancel.load(Ordering::Relaxed);
        let moved = |value: &f64| self.scene.at(&[*value]).ok().filter(|_| !is_cancelled);
        let scenes: Vec<Option<Scene>> = values.iter().map(moved).collect();
        let accepted: Vec<&Scene> = scenes.iter().flatten().collect();
        let mut reached = self.target.reached(&accepted).into_iter();
        (self.on_progress)(accepted.len());
        let end = |(value, scene): (&f64, &Option<Scene>)| {
            let found = scene.as_ref().and_then(|_| reached.next());
            let (kind, reached) = found.unwrap_or((DetachmentKind::Unresolved, None));
            DesignEnd { value: *value, kind, reached }
        };
        values.iter().zip(&scenes).map(end).collect()
    }

    /// Returns how many ends take about as long as one: they share trajectories, but a load needs a branch of its own for each.
    fn values_at_once(&self) -> usize {
        self.target.goal.load().map_or(WIDTH, |_| 1)
    }

    /// Value of an end less the target's value, in the unit of the goal; NaN for an end of another kind.
    fn miss(&self, end: &DesignEnd) -> f64 {
        let accepted = end.reached.filter(|_| self.target.accepts(end.kind));
        accepted.unwrap_or(f64::NAN) - self.target.value
    }

    fn miss_at(&self, value: f64) -> f64 {
        self.miss(&self.ends(&[value])[0])
    }

    fn is_reached(&self, miss: f64) -> bool {
        miss.abs() <= self.target.tolerance()
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
        let values = samples(range, SAMPLES);
        let scanned: Vec<DesignEnd> = values
            .par_chunks(sides_at_once(values.len(), 1).min(WIDTH))
            .flat_map_iter(|values| self.ends(values))
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
        let mut bracket = Bracket { below: before.value, above: after.value };
        let width = CHANGE_WIDTH * (after.value - before.value).abs();
        let Ok(()) = bracket.multisect(width, self.values_at_once(), |values| {
            let ends = self.ends(values);
            let are_before = ends.iter().take_while(|end| end.kind == before.kind);
            let count = are_before.count();
            after = ends.get(count).copied().unwrap_or(after);
            before = ends[..count].last().copied().unwrap_or(before);
            Ok::<usize, Infallible>(count)
        });
        [before, after]
    }

    /// Returns the parts of a `piece` of the `range` in which every value of the parameter reaches the target, `[part][least, greatest]`, in its
    /// unit. In a part, at least two neighbouring ends and the value in the middle between them reach it.
    pub fn spans(&self, piece: &[DesignEnd], range: [f64; 2]) -> Vec<[f64; 2]> {
        let is_level = |a: &DesignEnd, b: &DesignEnd| {
            let ends_reach = self.is_reached(self.miss(a)) && self.is_reached(self.miss(b));
            ends_reach && self.is_reached(self.miss_at(a.value.midpoint(b.value)))
        };
        let mut after = 0;
        let spans = piece.chunk_by(is_level).filter_map(|level| {
            let first = after;
            after += level.len();
            let [low, high] = [first, after - 1].map(|i| piece[i].value);
            let width = (range[1] - range[0]).min(low.abs().max(high.abs()));
            (high - low > LEAST_SPAN * width).then(|| {
                let before = first.checked_sub(1).map(|i| piece[i].value);
                let next = piece.get(after).map(|end| end.value);
                [self.edge(low, before), self.edge(high, next)]
            })
        });
        spans.collect()
    }

    /// Returns the last value from `inside` toward `outside` that reaches the target.
    fn edge(&self, inside: f64, outside: Option<f64>) -> f64 {
        let Some(outside) = outside else {
            return inside;
        };
        let mut bracket = Bracket { below: inside, above: outside };
        let width = EQUAL * (outside - inside).abs();
        let Ok(()) = bracket.multisect(width, self.values_at_once(), |values| {
            let ends = self.ends(values);
            let reached = ends.iter().take_while(|end| self.is_reached(self.miss(end)));
            Ok::<usize, Infallible>(reached.count())
        });
        bracket.below
    }

    /// Returns the values of the parameter, in its unit, at which a push ends at the target, outside the `spans` where every value does,
    /// `[solution]`. They lie within a `piece` where every end has the target's kind.
    pub fn solutions(&self, piece: &[DesignEnd], spans: &[[f64; 2]]) -> Vec<f64> {
        let is_free = |value: f64| {
            let mut spans = spans.iter();
            !spans.any(|[low, high]| (*low..=*high).contains(&value))
        };
        let mut places: Vec<[f64; 2]> =
            piece.iter().map(|end| [end.value, self.miss(end)]).collect();
        let turns = places.windows(3).filter_map(|three| {
            let three = [three[0], three[1], three[2]];
            turn::toward_zero(three, |value| self.miss_at(value))
        });
        let turns: Vec<[f64; 2]> = turns.collect();
        places.extend(turns);
        places.sort_by(|a, b| a[0].total_cmp(&b[0]));

        let crosses: Vec<bool> =
            places.windows(2).map(|pair| (pair[0][1] < 0.0) != (pair[1][1] < 0.0)).collect();
        let mut solutions = Vec::new();
        for (i, [value, miss]) in places.iter().enumerate() {
            let after = crosses.get(i).is_some_and(|crosses| *crosses);
            let before = i.checked_sub(1).is_some_and(|before| crosses[before]);
            if !is_free(*value) {
                continue;
            }
            if after {
                let [next, miss_there] = places[i + 1];
                let bracket = Bracket::new([*value, next], [*miss, miss_there]);
                let start = bracket.middle();
                let last_step = |value: f64| LAST_STEP * value.abs();
                let root = bracket.newton(start, last_step, |value| self.newton(value));
                solutions.push(root.x);
            } else if !before && self.is_reached(*miss) {
                solutions.push(*value);
            }
        }
        solutions.retain(|value| is_free(*value) && self.is_reached(self.miss_at(*value)));
        solutions
    }
}
