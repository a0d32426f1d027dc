//! Newton's method for the points in which a row leaves the sheet.

use crate::rod::{Rod, arclength};
use crate::shooting::batch::{Batch, InitialCondition, Method};
use crate::shooting::{SecondVariation, ShootingMap, limited};
use glam::DVec2;

/// The edge that a point lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// The saddle-node: the whisker slips off.
    Fold,
    /// The contact reaches the tip: the whisker is pulled off.
    Tip,
}

/// A point that is wanted on an edge: a fold, or a state with the contact where it is, for a pole at a distance.
#[derive(Clone, Copy, Debug)]
pub struct Wanted<'a> {
    /// The whisker and its pole.
    pub rod: &'a Rod,
    /// The edge.
    pub edge: Edge,
    /// Distance of the pole's centre.
    pub pole_distance: f64,
    /// `(tau, load)` to start from.
    pub from: DVec2,
}

/// Where Newton's method has led on the way to a [`Wanted`].
#[derive(Clone, Copy, Debug)]
pub struct Sought {
    /// `(tau, load)`.
    pub point: DVec2,
    /// The pole there.
    pub here: SecondVariation,
    /// What is missing in `ln D`.
    pub miss: f64,
    /// How far it still is, as [`limited`] measures lengths: the square of the last step, or the step not taken any more.
    pub left: f64,
    /// Whether the method came to its end.
    pub is_found: bool,
}

/// Rounds of Newton's method at the coarse resolution: from the guess of a cell next to the fold they lead to its error.
const COARSE_ROUNDS: usize = 2;

/// Rounds at the method's own resolution; 1 or 2 are the rule.
const ROUNDS: usize = 20;

/// The length of a step that needs no trajectory at its end: what is left after it is its square, and second derivatives
/// tell the rest to its cube.
const LAST_STEP: f64 = 3e-7;

/// How far off, relatively, second derivatives of the neighbours are at the most; 1e-3 is the rule.
const BORROWED: f64 = 1e-2;

/// Newton's method for all `wanted` at once; the caller judges what is left in `miss` and `left`. Each is alone: what is wanted
/// at once next to the folds of a map depends on its strips.
#[must_use]
pub fn seek(method: Method, wanted: &[Wanted]) -> Vec<Sought> {
    newton(method, wanted, COARSE_ROUNDS, Batch::new)
}

/// The same at the method's own resolution throughout: for starts that are good already, and for whiskers that friction lets
/// coil up, where the coarse one leads astray.
#[must_use]
pub fn seek_finely(method: Method, wanted: &[Wanted]) -> Vec<Sought> {
    newton(method, wanted, 0, |method| Batch::new(method).padded())
}

/// The same for starts whose second derivatives may be known from their neighbours (toward the tip those by the load are enough):
/// most then need a single trajectory, with first derivatives.
#[must_use]
pub fn seek_nearby(method: Method, wanted: &[Wanted], bends: &[Option<Bends>]) -> Vec<Sought> {
    let conditions: Vec<InitialCondition> = wanted
        .iter()
        .map(|wanted| InitialCondition {
            rod: wanted.rod,
            tau: wanted.from.x,
            load: wanted.from.y,
        })
        .collect();
    let maps = Batch::new(method)
        .padded()
        .shoot::<ShootingMap>(&conditions);
    let mut sought = Vec::with_capacity(wanted.len());
    let (mut left, mut again) = (Vec::new(), Vec::new());
    for (i, (goal, (map, bends))) in wanted.iter().zip(maps.iter().zip(bends)).enumerate() {
        let [by_tau_tau, by_tau_load, by_load_load] = bends.unwrap_or_default();
        let here = SecondVariation {
            map: *map,
            by_tau_tau,
            by_tau_load,
            by_load_load,
        };
        let last_step = bends.map(|_| LAST_STEP);
        let (mut found, next) = advance(goal, goal.from, &here, last_step);
        if found.is_found {
            found.left += BORROWED * found.left.sqrt();
        } else {
            // A long step, or one of second derivatives that nobody knows, can lead astray.
            let from = if bends.is_some() && found.left < BORROWED {
                next
            } else {
                goal.from
            };
            left.push(i);
            again.push(Wanted { from, ..*goal });
        }
        sought.push(found);
    }
    for (i, found) in left.into_iter().zip(seek_finely(method, &again)) {
        sought[i] = found;
    }
    sought
}

/// Second derivatives of `(ln D, phi)`: twice by `tau`, by `tau` and load, twice by load.
pub type Bends = [DVec2; 3];

fn newton(
    method: Method,
    wanted: &[Wanted],
    coarse_rounds: usize,
    batch: fn(Method) -> Batch,
) -> Vec<Sought> {
    let mut points: Vec<DVec2> = wanted.iter().map(|w| w.from).collect();
    let mut found: Vec<Option<Sought>> = vec![None; wanted.len()];
    let mut open: Vec<usize> = (0..wanted.len()).collect();
    for round in 0..coarse_rounds + ROUNDS {
        if open.is_empty() {
            break;
        }
        let is_coarse = round < coarse_rounds;
        let method = if is_coarse { method.coarsely() } else { method };
        let conditions: Vec<InitialCondition> = open
            .iter()
            .map(|&i| InitialCondition {
                rod: wanted[i].rod,
                tau: points[i].x,
                load: points[i].y,
            })
            .collect();
        let mut maps = batch(method).shoot(&conditions).into_iter();
        open.retain(|&i| {
            let Some(here) = maps.next() else {
                return false;
            };
            let last_step = (!is_coarse).then_some(LAST_STEP);
            let (sought, next) = advance(&wanted[i], points[i], &here, last_step);
            points[i] = next;
            found[i] = Some(sought);
            !sought.is_found && is_inside(next)
        });
    }
    found.into_iter().flatten().collect()
}

/// A step from `point`, which is `here`, toward the goal, where it leads, and where it ends; up to the length `last_step` there is
/// nothing more to find.
fn advance(
    goal: &Wanted,
    point: DVec2,
    here: &SecondVariation,
    last_step: Option<f64>,
) -> (Sought, DVec2) {
    let miss = (goal.pole_distance / here.map.pole.length()).ln();
    let step = match goal.edge {
        Edge::Fold => fold_step(here, miss),
        Edge::Tip => DVec2::new(0.0, load_step(here, miss)),
    };
    let (step, length) = limited(step, arclength(goal.rod, point.x), point.y);
    let next = point + step;
    let sought = if last_step.is_some_and(|last| length <= last) {
        let here = here.extrapolated(step);
        Sought {
            point: next,
            here,
            miss: (goal.pole_distance / here.map.pole.length()).ln(),
            left: length * length,
            is_found: true,
        }
    } else {
        Sought {
            point,
            here: *here,
            miss,
            left: length,
            is_found: false,
        }
    };
    (sought, next)
}

/// Whether a step has led to a place that a whisker has.
fn is_inside(point: DVec2) -> bool {
    point.is_finite() && point.x > 0.0
}

/// The step in load toward the point at the same contact whose `ln D` is larger by `miss`, to second order: where the distance is
/// largest, as that of a straight whisker is at first touch, a step of first order would go half the way.
fn load_step(here: &SecondVariation, miss: f64) -> f64 {
    let (slope, bend) = (here.map.by_load.x, here.by_load_load.x);
    let at_goal = (slope * slope + 2.0 * bend * miss).max(0.0).sqrt();
    2.0 * miss / (slope + at_goal.copysign(slope))
}

/// The step toward the point of the fold whose `ln D` is larger by `miss`.
fn fold_step(here: &SecondVariation, miss: f64) -> DVec2 {
    let by_distance = DVec2::new(here.map.by_tau.x, here.map.by_load.x);
    let by_det = here.det_gradient();
    let det = here.map.det();
    DVec2::new(
        miss * by_det.y + det * by_distance.y,
        -miss * by_det.x - det * by_distance.x,
    ) / by_distance.perp_dot(by_det)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Folds and places at the tip, from starts off by 1e-8 and 1e-5, with known second derivatives, with wrong ones and with none.
    #[test]
    fn neighbours_lead_to_the_same_place() {
        let rod = Rod {
            taper: 0.95,
            bend: 0.4,
            pole: 0.0125,
            ..Rod::default()
        };
        let method = Method::fine();
        let goals = [
            (Edge::Fold, rod.tau(0.8), 12.0),
            (Edge::Tip, rod.tau_tip(), 3.0),
        ];
        for (edge, tau, load) in goals {
            let start = Wanted {
                rod: &rod,
                edge,
                pole_distance: 0.75,
                from: DVec2::new(tau, load),
            };
            let distance = match edge {
                Edge::Fold => 0.75,
                Edge::Tip => Batch::new(method).shoot::<SecondVariation>(&[InitialCondition {
                    rod: &rod,
                    tau,
                    load,
                }])[0]
                    .map
                    .pole
                    .length(),
            };
            let goal = Wanted {
                pole_distance: distance,
                ..start
            };
            let known = seek_finely(method, &[goal])[0];
            assert!(known.is_found && known.miss.abs() < 1e-12, "{edge:?}");
            let here = &known.here;
            let bends = [here.by_tau_tau, here.by_tau_load, here.by_load_load];
            for off in [1e-8, 1e-5] {
                let moved = DVec2::new(if edge == Edge::Fold { off } else { 0.0 }, off);
                let from = known.point * (DVec2::ONE + moved);
                for bends in [Some(bends), Some(bends.map(|bend| 1.1 * bend)), None] {
                    let found = seek_nearby(method, &[Wanted { from, ..goal }], &[bends])[0];
                    let away = (found.point / known.point - DVec2::ONE).abs();
                    assert!(found.is_found && found.miss.abs() < 1e-12, "{edge:?} {off}");
                    assert!(away.max_element() < 2e-9, "{edge:?} {off}: {away}");
                    let [a, b] = [&found, &known].map(|sought| sought.here.map.pole.to_angle());
                    assert!((a - b).abs() < 1e-12, "{edge:?} {off}: {a} {b}");
                }
            }
        }
    }
}
