//! Search for the states of readings.
//!
//! With a measured moment, the turn of the base in a follicle is known. States are then searched with a clamped base, where no frame turns with
//! them, and the search in the follicle starts at its end.

use super::grid::SheetGrid;
use super::levers::PAIRS;
use super::newton::{BaseProblem, Triangle, base_derivatives, base_numbers};
use super::{BaseReading, Locator, NoLocation, SensorDeviations};
use crate::newton::{BatchNewton, NewtonIterate, NewtonOutcome};
use glam::{DVec2, DVec3};
use whiskmap_mechanics::shooting::{FirstVariation, FullState};

/// Maximum number of trajectories to a state. On a singular line each step halves the error.
const MOST_TRAJECTORIES: u32 = 40;

/// Difference of the logarithms of contact and load below which two solutions are one state.
const SAME_STATE: f64 = 1e-6;

/// Largest error of the logarithms of contact and load, over the condition of the inverse. Round trips of states stay within it.
const ERROR_BY_CONDITION: f64 = 1e-11;

/// Largest misfit of a state to two numbers, over the reading's size.
const MOST_MISFIT_OF_TWO: f64 = 1e-9;

/// Largest misfit of a state to three numbers without standard deviations, over the reading's size: the misfit of numbers with three digits.
const MOST_MISFIT_OF_THREE: f64 = 1e-3;

/// Largest misfit of a state to three numbers, in standard deviations: beyond it lies one of two million normal errors.
const MOST_DEVIATIONS: f64 = 5.0;

/// Reading in the units of the rod.
pub(super) struct Wanted<'a> {
    pub reading: &'a BaseReading,
    /// Moment and forces `[M, Fx, Fy]`; 0 if not measured.
    pub numbers: DVec3,
    /// 1 for each measured number, otherwise 0.
    pub measured: DVec3,
    /// Measured numbers over their standard deviations or, without these, [`Wanted::measured`].
    pub weights: DVec3,
    /// Reason why no state is searched; `None` if one is.
    pub reason: Option<NoLocation>,
}

/// State that a search has found.
pub(super) struct FoundState<'a> {
    /// Grid of the side of the pole.
    pub grid: &'a SheetGrid,
    /// Contact and load, `(tau, load)`.
    pub at: DVec2,
    /// State at the base, with first derivatives.
    pub full: FullState,
    /// Derivatives of `[M, Fx, Fy]` by the logarithms of contact and load.
    pub derivatives: [DVec3; 2],
    /// Condition of the inverse for the measured numbers.
    pub condition: f64,
    /// Direction of the pole in radians, continuous from first touch.
    pub phi: f64,
    /// Misfit to the measured numbers ([`Wanted::misfit`]).
    pub misfit: f64,
}

/// End of a search.
struct SearchEnd<'a> {
    /// Index of the reading, and grid of the search.
    origin: (usize, &'a SheetGrid),
    iterate: NewtonIterate<FullState>,
    /// The last trajectory.
    last: FirstVariation,
}

/// Largest difference of the logarithms of contact and load of one state, whatever the condition.
const MOST_DIFFERENT: f64 = 0.1;

/// Returns true if two solutions at `(tau, load)`, with an inverse of this `condition`, are one state to rounding.
fn is_same_state(one: DVec2, other: DVec2, condition: f64) -> bool {
    let change = (one - other).abs() / other.abs();
    change.max_element() < SAME_STATE.max((ERROR_BY_CONDITION * condition).min(MOST_DIFFERENT))
}

/// Yields the origins and points of distinct `ends`. The `ends` are in the order of the readings.
fn distinct<'a, 'e>(
    ends: &'e [SearchEnd<'a>],
) -> impl Iterator<Item = ((usize, &'a SheetGrid), DVec2)> + use<'a, 'e> {
    let is_new = |(place, end): &(usize, &SearchEnd)| {
        let (i, grid) = end.origin;
        let before = ends[..*place].iter().rev();
        let mut others = before.take_while(|other| other.origin.0 == i);
        others.all(|other| {
            let is_same = is_same_state(end.iterate.point, other.iterate.point, 1.0);
            !(is_same && std::ptr::eq(grid, other.origin.1))
        })
    };
    let new = ends.iter().enumerate().filter(is_new);
    new.map(|(_, end)| (end.origin, end.iterate.point))
}

impl Locator {
    /// Returns a reading in the units of the rod, with the weights of its numbers.
    pub(super) fn wanted<'a>(
        &self,
        reading: &'a BaseReading,
        deviations: Option<SensorDeviations>,
    ) -> Wanted<'a> {
        let units = &self.units;
        let given = [reading.moment_nnm, reading.force_x_un, reading.force_y_un];
        let measured = DVec3::from(given.map(|number| f64::from(u8::from(number.is_some()))));
        let in_rod = DVec3::new(units.moment_nnm, units.force_un, units.force_un);
        let sds = deviations.map(|deviations| {
            DVec3::new(deviations.moment_nnm, deviations.force_un, deviations.force_un)
        });
        let mut wanted = Wanted {
            reading,
            numbers: DVec3::from(given.map(Option::unwrap_or_default)) / in_rod,
            measured,
            weights: sds.map_or(measured, |sds| measured * in_rod / sds),
            reason: None,
        };
        let is_determined = |pair| self.sides.iter().any(|grid| grid.is_determined(pair));
        wanted.reason = match () {
            () if wanted.pairs().next().is_none() => Some(NoLocation::Incomplete),
            () if wanted.numbers == DVec3::ZERO => Some(NoLocation::NoLoad),
            () if !wanted.pairs().any(is_determined) => Some(NoLocation::Undetermined),
            () => None,
        };
        wanted
    }

    /// Finds the states for each of the `wanted` readings, `[reading][state]`.
    pub(super) fn solve(
        &self,
        wanted: &[Wanted],
        has_deviations: bool,
    ) -> Vec<Vec<FoundState<'_>>> {
        let mut points = Vec::new();
        let mut origins: Vec<(usize, &SheetGrid)> = Vec::new();
        let mut signs = Vec::new();
        for (i, wanted) in wanted.iter().enumerate() {
            let sides = self.sides.iter().filter(|_| wanted.reason.is_none());
            for grid in sides {
                let turn = wanted.turn(grid);
                for pair in wanted.pairs().filter(|pair| grid.is_determined(*pair)) {
                    grid.add_starts(pair, wanted.numbers, turn, &mut signs, &mut points);
                }
                origins.resize(points.len(), (i, grid));
            }
        }
        if self.sides.iter().any(|grid| grid.rod.mount != 0.0) {
            let ends = self.search(origins, points, |i, grid| wanted[i].in_clamp(grid));
            (origins, points) = distinct(&ends).unzip();
        }
        let ends = self.search(origins, points, |i, grid| wanted[i].in_follicle(grid));
        let mut found: Vec<Vec<FoundState>> = wanted.iter().map(|_| Vec::new()).collect();
        for end in ends {
            let SearchEnd { origin: (i, grid), iterate, last } = end;
            let (at, full) = (iterate.point, iterate.state);
            let derivatives = base_derivatives(&grid.rod, at, &last);
            let measured = derivatives.map(|by| wanted[i].measured * by);
            let condition = Triangle::new(measured).condition();
            let is_same = |other: &FoundState| {
                let condition = condition.min(other.condition);
                std::ptr::eq(grid, other.grid) && is_same_state(at, other.at, condition)
            };
            let misfit = wanted[i].misfit(&full, has_deviations);
            let Some(misfit) = misfit.filter(|_| !found[i].iter().any(is_same)) else {
                continue;
            };
            let direction = grid.direction(at, &full.map);
            found[i].extend(direction.map(|phi| FoundState {
                grid,
                at,
                full,
                derivatives,
                condition,
                phi,
                misfit,
            }));
        }
        found
    }

    /// Searches the states of problems by the indices of their readings and their grids, from `starts`. Returns the ends of the searches that
    /// converge, in the order of the problems.
    fn search<'a>(
        &self,
        origins: Vec<(usize, &'a SheetGrid)>,
        starts: Vec<DVec2>,
        problem: impl Fn(usize, &'a SheetGrid) -> BaseProblem<'a>,
    ) -> Vec<SearchEnd<'a>> {
        let mut problems: Vec<BaseProblem> =
            origins.iter().map(|(i, grid)| problem(*i, grid)).collect();
        let newton = BatchNewton::new(self.method, MOST_TRAJECTORIES);
        let iterates = newton.solve(&mut problems, starts).into_iter();
        let ends = origins.into_iter().zip(problems).zip(iterates);
        let ends = ends.map(|((origin, problem), iterate)| SearchEnd {
            origin,
            iterate,
            last: problem.last,
        });
        ends.filter(|end| end.iterate.outcome == NewtonOutcome::Converged).collect()
    }
}

impl Wanted<'_> {
    /// Returns the indices of the measured pairs of numbers.
    fn pairs(&self) -> impl Iterator<Item = usize> {
        let measured = self.measured;
        (0..PAIRS.len()).filter(move |&pair| PAIRS[pair].iter().all(|&i| measured[i] > 0.0))
    }

    /// Returns the angle, in radians, from the base's tangent to the axis of the follicle, which the measured moment gives; `None` if it is not known.
    fn turn(&self, grid: &SheetGrid) -> Option<f64> {
        let is_known = self.measured.x > 0.0 || grid.rod.mount == 0.0;
        is_known.then_some(-grid.rod.mount * self.numbers.x)
    }

    /// Returns the problem of the state with a clamped base that the measured moment turns, or in the follicle if the turn is not known.
    fn in_clamp<'a>(&self, grid: &'a SheetGrid) -> BaseProblem<'a> {
        let problem = self.in_follicle(grid);
        match self.turn(grid) {
            None => problem,
            Some(turn) => {
                BaseProblem { rod: &grid.clamped, tangent: DVec2::from_angle(-turn), ..problem }
            }
        }
    }

    /// Returns the problem of the state in the follicle, or in the clamp without one.
    fn in_follicle<'a>(&self, grid: &'a SheetGrid) -> BaseProblem<'a> {
        BaseProblem {
            rod: &grid.rod,
            wanted: self.numbers,
            weights: self.weights,
            tangent: DVec2::X,
            last: FirstVariation::default(),
        }
    }

    /// Returns the misfit of a state; `None` if it is too large.
    fn misfit(&self, full: &FullState, has_deviations: bool) -> Option<f64> {
        let difference = base_numbers(full) - self.numbers;
        let relative = (self.measured * difference).length() / self.numbers.length();
        let is_overdetermined = self.measured == DVec3::ONE;
        let (misfit, most) = match (has_deviations, is_overdetermined) {
            (true, true) => ((self.weights * difference).length(), MOST_DEVIATIONS),
            (false, true) => (relative, MOST_MISFIT_OF_THREE),
            (_, false) => (relative, MOST_MISFIT_OF_TWO),
        };
        (misfit <= most).then_some(misfit)
    }
}
