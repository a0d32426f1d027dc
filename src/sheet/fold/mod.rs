//! The fold edge: for each contact, the first load at which the Jacobian is singular.

pub mod contact_nodes;
pub mod coordinate;
mod predicted;

use crate::newton::{BatchNewton, LaneSharing, NewtonOutcome, NewtonProblem, NewtonStep};
use crate::sheet::case::SheetCase;
use glam::DVec2;
use whiskmap_mechanics::numerics::newton_form::{RootProblem, stencil, through_nodes};
use whiskmap_mechanics::numerics::{Bracket, nearest_turn};
use whiskmap_mechanics::rod::{Rod, arclength};
use whiskmap_mechanics::shooting::{SecondVariation, ShootingMap};

/// Point of the fold edge.
#[derive(Clone, Copy, Debug)]
pub struct FoldPoint {
    /// Contact coordinate `tau` of the fold point, dimensionless.
    pub tau: f64,
    /// Signed load `f/rho^2` at the fold point, dimensionless.
    pub load: f64,
    /// Pole and its first and second derivatives at the fold point.
    pub variation: SecondVariation,
    /// Direction of the pole at the fold point in radians, continuous from first touch.
    pub phi: f64,
    /// True if the loads up to the fold point were sampled, false if only loads around it were.
    pub has_marched: bool,
}

impl FoldPoint {
    /// Returns the distance of the pole at the fold point, in whisker lengths.
    pub fn distance(&self) -> f64 {
        self.variation.map.pole.length()
    }

    /// Returns the row parameter `|load| tau^2` of the fold point, dimensionless.
    pub fn q(&self) -> f64 {
        self.load.abs() * self.tau * self.tau
    }
}

/// Number of samples of `q = |load| s^2` for each round of the march. Measured radii and a mount multiply `q` by their softness.
const SAMPLES_PER_ROUND: usize = 11;

/// Spacing of the first samples of a march in `q`. The second fold is farther from the first one than this.
const FIRST_SPACING: f64 = 0.75;

/// Value of `q` at which the march begins. Measured radii, moduli that fall toward the tip and mounts do not enter `q`. Without them the sheet is
/// wider: no first fold of 2,000 random whiskers with friction up to 2 and `A*` up to 2 lay below 6.5.
const SURELY_STABLE: f64 = 4.5;

/// Relative widening of a bracket beyond its samples, whose signs come from the coarse resolution.
const BRACKET_SLACK: f64 = 1e-2;

/// Newton step toward the root between two samples, in parts of their spacing, after which the iteration stops. The remaining error is
/// its square.
const LAST_STEP_BETWEEN_SAMPLES: f64 = 1e-4;

/// Returns the value of `q = |load| s^2` up to which every state of `rod` is stable; 0 if it is not known.
pub fn surely_stable(rod: &Rod) -> f64 {
    if rod.profile.is_none() && rod.gradient >= 0.0 && rod.mount == 0.0 {
        SURELY_STABLE
    } else {
        0.0
    }
}

/// Value of `q` beyond which the spacing of the samples grows. The largest first fold known of a cone lies at 24.15: the limit at the tip
/// of a perfect cone that is slender against the pole.
const EVEN_UP_TO: f64 = 64.0;

/// Largest remaining Newton step, relative to the load, at a point that counts as a fold. At the tip of a perfect cone, rounding of `det`
/// leaves 2e-7; elsewhere the step is below 1e-13.
const STEP_LEFT: f64 = 1e-5;

/// Newton step in load, relative to the load, whose end is extrapolated. The remaining error is its square.
const LAST_LOAD_STEP: f64 = 1e-6;

/// Value of `q` at which the march ends without a fold.
const MARCH_END: f64 = 1e4;

/// Maximum number of trajectories for each fold; bisection alone would need 50.
const POLISH_TRAJECTORIES: u32 = 60;

/// Returns the first folds of `rod` at the contacts `taus`, in the same order, `[contact]`. An entry is `None` where there is no fold up
/// to [`MARCH_END`], or no stable state at first touch.
pub fn first_folds(case: SheetCase, taus: &[f64]) -> Vec<Option<FoldPoint>> {
    let mut folds = polish(case, march(case.coarsely(), taus, surely_stable(case.rod)));
    // With friction and a stiff tip, the first fold can lie at `q` of 1000, where the coarse resolution fails.
    let failed: Vec<usize> = (0..taus.len()).filter(|&i| folds[i].is_none()).collect();
    let again: Vec<f64> = failed.iter().map(|&i| taus[i]).collect();
    let fine = polish(case, march(case, &again, 0.0));
    for (i, fold) in failed.into_iter().zip(fine) {
        folds[i] = fold;
    }
    folds
}

/// Returns the samples of a march in `q`, from `begin` outward: at even steps, which grow with `q` beyond [`EVEN_UP_TO`].
fn march_samples(begin: f64) -> impl Iterator<Item = f64> {
    let next = |(first, step): &(f64, f64)| {
        let last = step.mul_add((SAMPLES_PER_ROUND - 1) as f64, *first);
        let step = match last < EVEN_UP_TO {
            true => *step,
            false => last / SAMPLES_PER_ROUND as f64,
        };
        Some((last + step, step))
    };
    let rounds = std::iter::successors(Some((begin, FIRST_SPACING)), next);
    rounds.flat_map(|(first, step)| {
        (0..SAMPLES_PER_ROUND).map(move |i| step.mul_add(i as f64, first))
    })
}

/// Signs of coarse trajectories are uncertain next to a fold. They do not count at loads that differ from the fold's load by less than this part of
/// it. Brackets around predicted folds allow as much.
const COARSE_OFF: f64 = 5e-4;

/// Returns true if the states of each contact of `folds` at loads below its fold, sampled as by a march, are all stable.
fn are_stable_below(case: SheetCase, folds: &[&FoldPoint]) -> bool {
    let begin = surely_stable(case.rod);
    let below = |fold: &&FoldPoint| {
        let (tau, scale) = (fold.tau, load_scale(case, fold.tau));
        let end = (1.0 - COARSE_OFF) * fold.load / scale;
        let samples = march_samples(begin).take_while(move |q| *q < end);
        samples.map(move |q| (tau, q * scale))
    };
    let maps: Vec<ShootingMap> = case.coarsely().shoot(folds.iter().flat_map(below));
    maps.iter().all(|map| map.det() > 0.0)
}

/// Returns the load of `q = 1` at the contact `tau`.
pub(super) fn load_scale(SheetCase { rod, side, .. }: SheetCase, tau: f64) -> f64 {
    side.sign() / (arclength(rod, tau).powi(2) * rod.softness(tau))
}

/// Returns the bracket of the fold at `tau` between the sample `at`, where the map and the direction of the pole are known, and the next of some
/// `samples` of `q` with these `dets`.
fn bracket(
    case: SheetCase,
    tau: f64,
    samples: &[f64],
    dets: &[f64],
    (at, map, phi): (usize, ShootingMap, f64),
) -> FoldBracket {
    let scale = load_scale(case, tau);
    let slack = BRACKET_SLACK * (samples[at + 1] - samples[at]);
    FoldBracket {
        tau,
        loads: Bracket {
            below: (samples[at] - slack) * scale,
            above: (samples[at + 1] + slack) * scale,
        },
        guess: root(samples, dets, at) * scale,
        before: (samples[at] * scale, map),
        phi,
        has_marched: true,
    }
}

/// Contact with two loads between which its `det` falls below zero.
#[derive(Clone, Copy, Debug)]
struct FoldBracket {
    tau: f64,
    /// Loads that bracket the root of `-det`.
    loads: Bracket,
    guess: f64,
    /// Load before the fold with its map, and the direction of the pole there in radians, continuous from first touch.
    before: (f64, ShootingMap),
    phi: f64,
    /// True if the loads up to the bracket were sampled.
    has_marched: bool,
}

/// Samples the loads of every contact from `q = begin` outward until `det` changes its sign. An entry is `None` also where the first
/// sample is not stable.
fn march(case: SheetCase, taus: &[f64], begin: f64) -> Vec<Option<FoldBracket>> {
    struct ContactMarch {
        index: usize,
        scale: f64,
        dets: Vec<f64>,
        /// Maps at first touch, and at the samples.
        maps: Vec<ShootingMap>,
    }
    let mut found = vec![None; taus.len()];
    let at_touch: Vec<ShootingMap> = case.shoot(taus.iter().map(|tau| (*tau, 0.0)));
    let mut open: Vec<ContactMarch> = (0..taus.len())
        .map(|index| ContactMarch {
            index,
            scale: load_scale(case, taus[index]),
            dets: Vec::new(),
            maps: vec![at_touch[index]],
        })
        .collect();
    let (mut samples, mut others) = (Vec::new(), march_samples(begin));
    while !open.is_empty() && samples.last().is_none_or(|q| *q < MARCH_END) {
        let from = samples.len();
        samples.extend(others.by_ref().take(SAMPLES_PER_ROUND));
        let points = |m: &ContactMarch| {
            let (tau, scale) = (taus[m.index], m.scale);
            samples[from..].iter().map(move |q| (tau, q * scale))
        };
        let points = open.iter().flat_map(points);
        let maps: Vec<ShootingMap> = case.shoot(points);
        let mut maps = maps.chunks(SAMPLES_PER_ROUND);
        open.retain_mut(|march| {
            let shot = maps.next().unwrap_or_default();
            march.dets.extend(shot.iter().map(ShootingMap::det));
            march.maps.extend(shot);
            if march.dets.first().is_none_or(|det| *det <= 0.0) {
                return false;
            }
            // The last sample of the previous round is compared again.
            let pairs = march.dets.windows(2).enumerate().skip(from.max(1) - 1);
            let changed = |(_, pair): &(usize, &[f64])| pair[0] * pair[1] <= 0.0;
            let Some((at, _)) = pairs.into_iter().find(changed) else {
                return true;
            };
            let loads = std::iter::once(0.0).chain(samples[..=at].iter().map(|q| q * march.scale));
            // The first map is that at first touch.
            let phis = directions(0.0, loads.zip(&march.maps));
            let before = (at, march.maps[at + 1], phis.last().unwrap_or_default());
            let tau = taus[march.index];
            found[march.index] = Some(bracket(case, tau, &samples, &march.dets, before));
            false
        });
    }
    found
}

/// Returns the directions of the pole in radians for maps of one contact with their growing loads, `[load]`. They are continuous; the first one
/// is near `first`, which is 0 at first touch.
pub fn directions<'a>(
    first: f64,
    maps: impl IntoIterator<Item = (f64, &'a ShootingMap)>,
) -> impl Iterator<Item = f64> {
    let mut before: Option<(f64, &ShootingMap, f64)> = None;
    maps.into_iter().map(move |(load, map)| {
        let near = before.map_or(first, |(load_there, there, phi)| {
            let slopes = there.by_load.y + map.by_load.y;
            0.5f64.mul_add(slopes * (load - load_there), phi)
        });
        let phi = nearest_turn(map.pole.to_angle(), near);
        before = Some((load, map, phi));
        phi
    })
}

/// Number of samples of the polynomial whose root is the zero of `det`.
const DET_STENCIL: usize = 10;

/// Returns the `q` at which `dets` vanishes between the sample `at` and the next one.
fn root(samples: &[f64], dets: &[f64], at: usize) -> f64 {
    let [from, to] = [samples[at], samples[at + 1]];
    let start = stencil(at, DET_STENCIL, dets.len());
    let around = samples.iter().copied().zip(dets).skip(start);
    let [det] = through_nodes::<DET_STENCIL, 1>(around.map(|(q, det)| (q, [*det])));
    let problem = RootProblem {
        target: 0.0,
        near: from + dets[at] / (dets[at] - dets[at + 1]) * (to - from),
        bracket: Bracket { below: to, above: from },
    };
    det.solve(&problem, LAST_STEP_BETWEEN_SAMPLES * (to - from))
}

/// Root-finding problem for the load at which `det` vanishes inside a bracket.
struct FoldProblem<'a> {
    rod: &'a Rod,
    /// Loads that bracket the root of `-det`, by the signs of coarse trajectories.
    loads: Bracket,
    /// Ends of the bracket whose signs no trajectory of this problem has shown.
    untested: [Option<f64>; 2],
}

impl<'a> FoldProblem<'a> {
    const fn new(rod: &'a Rod, loads: Bracket) -> Self {
        Self { rod, loads, untested: [Some(loads.above), Some(loads.below)] }
    }
}

impl<'a> NewtonProblem<'a> for FoldProblem<'a> {
    type Output = SecondVariation;

    fn rod(&self) -> &'a Rod {
        self.rod
    }

    fn step(&mut self, at: DVec2, here: &SecondVariation) -> NewtonStep {
        let det = here.map.det();
        let newton = at.y - det / here.det_gradient().y;
        let step = newton - at.y;
        if step.abs() <= LAST_LOAD_STEP * at.y.abs() {
            return NewtonStep::Extrapolate(DVec2::new(0.0, step));
        }
        let Bracket { below, above } = self.loads;
        if at.y == below && det <= 0.0 || at.y == above && det > 0.0 {
            // Coarse trajectories gave `det` another sign here: it does not change its sign in the bracket.
            return NewtonStep::Fail;
        }
        self.loads.shrink(at.y, -det);
        let loads = self.loads;
        let is_end = |end: &mut f64| *end == loads.below || *end == loads.above;
        // Before the bracket is halved, its ends are tested that are no iterates.
        let mut untested = self.untested.iter_mut();
        let next = match loads.is_inside(newton) {
            true => newton,
            false => untested.find_map(|end| end.take_if(is_end)).unwrap_or_else(|| loads.middle()),
        };
        if next == at.y { NewtonStep::Accept } else { NewtonStep::Shoot(DVec2::new(at.x, next)) }
    }
}

/// Solves `det(load) = 0` inside the brackets.
fn polish(case: SheetCase, brackets: Vec<Option<FoldBracket>>) -> Vec<Option<FoldPoint>> {
    let rod = case.rod;
    let found: Vec<FoldBracket> = brackets.iter().flatten().copied().collect();
    let problem = |bracket: &FoldBracket| FoldProblem::new(rod, bracket.loads);
    let newton = BatchNewton {
        // Solved folds stay in the batch: with fewer steps, at the tip of a perfect cone, `det` may have its root elsewhere. Along a
        // profile, each trajectory takes its own number of steps.
        sharing: match rod.profile {
            Some(_) => LaneSharing::Open,
            None => LaneSharing::All,
        },
        ..BatchNewton::new(case.method, POLISH_TRAJECTORIES)
    };
    let mut problems: Vec<FoldProblem> = found.iter().map(problem).collect();
    let starts = found.iter().map(|fold| DVec2::new(fold.tau, fold.guess));
    let mut iterates = newton.solve(&mut problems, starts).into_iter();
    let mut fold = |bracket: FoldBracket| {
        let iterate = iterates.next()?;
        let variation = iterate.state;
        let (before, map) = bracket.before;
        // A bracket that has not closed, or has closed on something other than a root, is no fold.
        let step = variation.map.det() / variation.det_gradient().y;
        let has_root = iterate.outcome != NewtonOutcome::Failed;
        let is_fold = has_root && step.abs() <= STEP_LEFT * iterate.point.y.abs();
        is_fold.then_some(FoldPoint {
            tau: iterate.point.x,
            load: iterate.point.y,
            variation,
            phi: directions(bracket.phi, [(before, &map), (iterate.point.y, &variation.map)])
                .last()
                .unwrap_or_default(),
            has_marched: bracket.has_marched,
        })
    };
    let folds = brackets.into_iter();
    folds.map(|bracket| bracket.and_then(&mut fold)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use whiskmap_mechanics::rod::Side;
    use whiskmap_mechanics::shooting::batch::Method;

    /// The cone of the paper.
    pub(super) fn cone() -> Rod {
        Rod { taper: 0.95, bend: 0.4, pole: 0.0125, ..Rod::default() }
    }

    /// Newton's method ends early in brackets on either side of a fold, and finds it in a wide bracket around it.
    #[test]
    fn a_bracket_without_a_root_has_no_fold() {
        let rod = cone();
        let case = SheetCase { method: Method::fine(), rod: &rod, side: Side::Cb };
        let tau = rod.tau(0.7);
        let Some(fold) = first_folds(case, &[tau]).pop().flatten() else {
            panic!("no fold");
        };
        let solved = |parts: [f64; 2]| {
            let loads = parts.map(|part| part * fold.load);
            let bracket = Bracket { below: loads[0], above: loads[1] };
            let mut problems = [FoldProblem::new(&rod, bracket)];
            let newton = BatchNewton::new(case.method, POLISH_TRAJECTORIES);
            let start = DVec2::new(tau, 0.5 * (loads[0] + loads[1]));
            let iterate = newton.solve(&mut problems, [start])[0];
            // Newton's method leaves these brackets at once, and their ends show that they have no root.
            (iterate.outcome, iterate.steps < 3)
        };
        assert_eq!(solved([0.4, 1.3]).0, NewtonOutcome::Converged);
        assert_eq!(solved([0.8, 0.9]), (NewtonOutcome::Failed, true));
        assert_eq!(solved([1.1, 1.2]), (NewtonOutcome::Failed, true));
    }
}
