//! Designs with several parameters and as many targets.

use super::samples::samples;
use super::target::{ComputedPush, LargestOf, exactly};
use super::varied::DesignScene;
use super::{DesignError, DesignTarget, DesignVaried, checked};
use crate::least_squares::{self, BoundedProblem, FAINT, Svd, differences, norm};
use crate::scene::Scene;
use crate::sensitivity::Variable;
use crate::trace::StableBranch;
use rayon::prelude::*;
use std::cell::LazyCell;
use std::sync::atomic::{AtomicBool, Ordering};

/// Number of places from which starts are chosen, about: evenly distributed over the ranges of all variables.
const PLACES: f64 = 600.0;

/// Most starts of Newton's method.
const MOST_STARTS: usize = 48;

/// Relative change of the misses, and of the parameters, below which an iteration ends.
const TOLERANCE: f64 = 1e-12;

/// Largest miss of a solution, relative to the target. Where a load is largest at the fold, it is known to the root of the rounding error.
const LARGEST_MISS: f64 = 1e-6;

/// Relative difference within which the values of two solutions are equal, as values at a largest miss are.
const SAME: f64 = 1e-5;

/// Step of differences, in natural sizes of the variables: for strains, and at places without derivatives.
const STEP: f64 = 1e-6;

/// Solutions of a design with several varied numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Designs {
    /// Solutions of the design, each with the values of the varied numbers in their units: `[solution][variable]`, growing in the first one.
    pub solutions: Vec<Vec<f64>>,
    /// Ranges `[least, greatest]` of the varied numbers within their limits, each with the others as in the scene: `[variable]`.
    pub ranges: Vec<[f64; 2]>,
    /// True if the targets leave a line or an area of solutions, of which [`Self::solutions`] has some.
    pub is_undetermined: bool,
    /// Values with the least relative misses if there is no solution; `None` with a solution, and if no push within the limits has values.
    pub nearest: Option<DesignNearest>,
}

/// Values of a design that come nearest to its targets.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignNearest {
    /// Values of the varied numbers, in their units: `[variable]`.
    pub values: Vec<f64>,
    /// Values of the quantities of the targets, in their units: `[target]`.
    pub reached: Vec<f64>,
    /// True for a varied number at an end of its range there: `[variable]`.
    pub is_at_limit: Vec<bool>,
}

/// Finds the values of the `varied` numbers with which a push reaches all `targets`, of one distance and side. There are as many targets as
/// varied numbers, each of another quantity. The grid is not used.
///
/// Newton's method in a trust region, with exact derivatives, starts from many places within the limits. Starts are places whose
/// neighbours have larger misses, and places where all targets lie between the values of neighbours. Largest strains are differentiated by
/// differences.
///
/// ```
/// use whiskmap::design::{DesignGoal, DesignTarget, DesignVariable, designs};
/// use whiskmap::Side;
/// use whiskmap::scene::{Parameter, Scene};
///
/// let robot = Scene::parse(include_str!("../../scenes/robot.toml"), "robot.toml")?;
/// let target = |goal, value| DesignTarget { distance_mm: 60.0, side: Side::Cb, goal, value };
/// let targets = [target(DesignGoal::SlipOff, 30.0), target(DesignGoal::MaxMoment, 5e6)];
/// let varied = [Parameter::BaseRadiusUm, Parameter::Taper];
/// let varied = varied.map(|parameter| DesignVariable { variable: parameter.into(), limits: None });
/// let found = designs(&robot, &varied.into_iter().collect(), &targets)?;
/// let [solution] = &found.solutions[..] else { panic!("{found:?}") };
/// assert!((solution[1] - 0.935_453_623_8).abs() < 1e-6); // The push angle depends on the taper alone.
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the scene sweeps whiskers, does not give a number, or accepts no value within its limits, or if targets are more or fewer.
pub fn designs(
    scene: &Scene,
    varied: &DesignVaried,
    targets: &[DesignTarget],
) -> Result<Designs, DesignError> {
    designs_until(scene, varied, targets, &|_| {}, &AtomicBool::new(false))
}

/// Finds the values of several numbers as [`designs`] does. `on_progress(n)` is called after `n` more pushes are computed, from several threads. If
/// `cancel` is true, the function soon returns an error.
///
/// # Errors
/// Fails as [`designs`] does, and if it is cancelled.
pub fn designs_until(
    scene: &Scene,
    varied: &DesignVaried,
    targets: &[DesignTarget],
    on_progress: &(dyn Fn(usize) + Sync),
    cancel: &AtomicBool,
) -> Result<Designs, DesignError> {
    let (scene, scene_values, ranges) = &checked(scene, varied, targets)?;
    let search = TogetherSearch {
        scene: DesignScene { scene, varied, distance_mm: targets[0].distance_mm },
        sizes: sizes(scene, varied, scene_values),
        targets,
        on_progress,
        cancel,
    };
    let grid = Places::new(&search, ranges);
    let starts = grid.starts();
    let found: Vec<Vec<f64>> = starts
        .par_iter()
        .filter_map(|start| {
            let end = least_squares::search(&search, start, TOLERANCE, "");
            Some(end.ok()?.0)
        })
        .collect();
    if cancel.load(Ordering::Relaxed) {
        return Err(DesignError::Cancelled);
    }
    let mut ends: Vec<(Vec<f64>, f64)> = found
        .into_iter()
        .chain(grid.nearest().map(<[f64]>::to_vec))
        .filter_map(|x| Some((search.miss(&x)?, x)))
        .map(|(miss, x)| (x, miss))
        .collect();
    ends.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut solutions: Vec<&[f64]> = Vec::new();
    let reaching = ends.iter().take_while(|(_, miss)| *miss <= LARGEST_MISS);
    for (x, _) in reaching {
        let is_same = |other: &&[f64]| {
            let pairs = x.iter().zip(*other);
            pairs.map(|(a, b)| (a - b).abs() / (1.0 + a.abs())).fold(0.0, f64::max) <= SAME
        };
        if !solutions.iter().any(is_same) {
            solutions.push(x);
        }
    }
    let is_undetermined = solutions.iter().any(|x| search.is_singular(x));
    let nearest = ends.first().filter(|_| solutions.is_empty());
    let nearest = nearest.and_then(|(x, _)| search.described(x, ranges));
    let in_units = |x: &&[f64]| search.values(x);
    let mut solutions: Vec<Vec<f64>> = solutions.iter().map(in_units).collect();
    solutions.sort_by(|a, b| a[0].total_cmp(&b[0]));
    Ok(Designs { solutions, ranges: ranges.clone(), is_undetermined, nearest })
}

/// Natural sizes of the varied numbers of a scene, each in its unit: `[variable]`. In these units, all are of order 1.
fn sizes(scene: &Scene, varied: &DesignVaried, scene_values: &[f64]) -> Vec<f64> {
    let variables = varied.variables.iter().zip(scene_values);
    let sizes = variables.map(|(variable, value)| match variable.variable {
        Variable::Parameter(parameter) => parameter.size(&scene.whisker).max(value.abs()),
        _ => scene.whisker.length_mm,
    });
    sizes.collect()
}

/// Search of a design with several varied numbers. Parameters of this module are values over natural sizes.
struct TogetherSearch<'a> {
    scene: DesignScene<'a>,
    /// Natural size of each varied number, in its unit: `[variable]`.
    sizes: Vec<f64>,
    targets: &'a [DesignTarget],
    /// Function that is called after some more pushes are computed, with their number.
    on_progress: &'a (dyn Fn(usize) + Sync),
    cancel: &'a AtomicBool,
}

impl TogetherSearch<'_> {
    /// Returns the values of the varied numbers in their units, `[variable]`.
    fn values(&self, x: &[f64]) -> Vec<f64> {
        x.iter().zip(&self.sizes).map(|(x, size)| x * size).collect()
    }

    fn at(&self, x: &[f64]) -> Option<Scene> {
        let is_cancelled = self.cancel.load(Ordering::Relaxed);
        (!is_cancelled).then(|| self.scene.at(&self.values(x)).ok())?
    }

    /// Returns the values of the quantities of the targets, in their units; `None` if the push ends in another way.
    fn reached(&self, x: &[f64], largest: LargestOf) -> Option<Vec<f64>> {
        let scene = self.at(x)?;
        let push = ComputedPush::of(&[&scene], self.targets[0].side).pop()?;
        let values = self.targets.iter().map(|target| {
            let (kind, value) = push.reached(target.goal, largest);
            value.filter(|value| target.accepts(kind) && !value.is_nan())
        });
        let values = values.collect();
        (self.on_progress)(1);
        values
    }

    /// Returns the misses of the targets, each relative to its value.
    fn misses(&self, x: &[f64], largest: LargestOf) -> Option<Vec<f64>> {
        let reached = self.reached(x, largest)?;
        let pairs = reached.iter().zip(self.targets);
        let misses = pairs.map(|(reached, target)| reached / target.value - 1.0);
        Some(misses.collect())
    }

    /// Returns the largest relative miss of a target.
    fn miss(&self, x: &[f64]) -> Option<f64> {
        let misses = self.residuals(x)?;
        Some(misses.into_iter().fold(0.0, |most, miss| miss.abs().max(most)))
    }

    /// Returns true if the targets do not determine the varied numbers at a solution.
    fn is_singular(&self, x: &[f64]) -> bool {
        let Some(columns) = self.jacobian(x, &Vec::new()) else {
            return false;
        };
        let svd = Svd::new(columns);
        let least = svd.values().map(|(value, ..)| value);
        least.fold(f64::INFINITY, f64::min) <= FAINT * svd.largest()
    }

    fn described(&self, x: &[f64], ranges: &[[f64; 2]]) -> Option<DesignNearest> {
        let values = self.values(x);
        let near = self.scene.ranges(&values);
        let ends = near.into_iter().zip(ranges);
        let ends = ends.map(|(near, range)| near.unwrap_or(*range));
        let is_at_limit = ends.zip(&values).map(|([low, high], value)| {
            let width = 1e-9 * (high - low);
            value - low <= width || high - value <= width
        });
        Some(DesignNearest {
            is_at_limit: is_at_limit.collect(),
            reached: self.reached(x, exactly)?,
            values,
        })
    }
}

impl BoundedProblem for TogetherSearch<'_> {
    type Place = Vec<f64>;

    fn count(&self) -> usize {
        self.targets.len()
    }

    fn residuals(&self, x: &[f64]) -> Option<Vec<f64>> {
        self.misses(x, exactly)
    }

    fn jacobian(&self, x: &[f64], _: &Vec<f64>) -> Option<Vec<Vec<f64>>> {
        let scene = self.at(x)?;
        let directions = self.scene.directions(&scene);
        let by_differences = LazyCell::new(|| differences(|x| self.residuals(x), x, STEP));
        let row = |(i, target): (usize, &DesignTarget)| {
            let exact = target.gradient(&scene, &directions).map(|by| {
                let by = by.iter().zip(&self.sizes);
                by.map(|(by, size)| by * size / target.value).collect()
            });
            exact.or_else(|| {
                let columns = by_differences.as_ref()?.iter();
                Some(columns.map(|column| column[i]).collect())
            })
        };
        let rows = self.targets.iter().enumerate().map(row);
        let rows: Vec<Vec<f64>> = rows.collect::<Option<_>>()?;
        let column = |k: usize| rows.iter().map(|row| row[k]).collect();
        Some((0..x.len()).map(column).collect())
    }

    fn ranges(&self, x: &[f64]) -> Vec<[f64; 2]> {
        let ranges = self.scene.ranges(&self.values(x)).into_iter();
        let sized = ranges
            .zip(&self.sizes)
            .zip(x)
            .map(|((range, size), x)| range.map_or([*x; 2], |range| range.map(|end| end / size)));
        sized.collect()
    }
}

/// Misses at places all over the ranges of the varied numbers.
struct Places {
    /// Number of places along each variable.
    side: usize,
    /// Parameters of each place; the first one varies fastest: `[place][variable]`.
    places: Vec<Vec<f64>>,
    /// Misses of each place; `None` without a push: `[place][target]`.
    misses: Vec<Option<Vec<f64>>>,
}

impl Places {
    fn new(search: &TogetherSearch<'_>, ranges: &[[f64; 2]]) -> Self {
        let count = ranges.len();
        let side = libm::pow(PLACES, 1.0 / count as f64).round() as usize;
        let axes: Vec<Vec<f64>> = ranges
            .iter()
            .zip(&search.sizes)
            .map(|(range, size)| samples(range.map(|end| end / size), side))
            .collect();
        let place = |mut index: usize| -> Vec<f64> {
            let along = axes.iter().map(|axis| {
                let at = axis[(index % side).min(axis.len() - 1)];
                index /= side;
                at
            });
            along.collect()
        };
        let places: Vec<Vec<f64>> = (0..side.pow(count as u32)).map(place).collect();
        let rough = |x: &Vec<f64>| search.misses(x, StableBranch::rough_peak);
        let misses = places.par_iter().map(rough).collect();
        Self { side, places, misses }
    }

    /// Returns the size of the misses at a place; infinite without a push.
    fn size(&self, index: usize) -> f64 {
        let misses = self.misses[index].as_ref();
        misses.map_or(f64::INFINITY, |misses| norm(misses))
    }

    /// Returns the place with the smallest misses; `None` if no place has a push.
    fn nearest(&self) -> Option<&[f64]> {
        let known = (0..self.places.len()).filter(|index| self.size(*index).is_finite());
        let nearest = known.min_by(|a, b| self.size(*a).total_cmp(&self.size(*b)))?;
        Some(&self.places[nearest])
    }

    /// Returns the places from which searches start, the best ones first. They are the places with smaller misses than their neighbours, and the
    /// best corner of each cell in which every target lies between the values at corners.
    fn starts(&self) -> Vec<Vec<f64>> {
        let variables = self.places[0].len() as u32;
        let all = 0..self.places.len();
        let coordinate = |index: usize, k: u32| index / self.side.pow(k) % self.side;
        let is_least = |index: &usize| {
            let size = self.size(*index);
            let neighbours = (0..variables).flat_map(|k| {
                let (at, step) = (coordinate(*index, k), self.side.pow(k));
                let before = (at > 0).then(|| index - step);
                let after = (at + 1 < self.side).then(|| index + step);
                [before, after]
            });
            size.is_finite() && neighbours.flatten().all(|other| self.size(other) >= size)
        };
        let enclosing = |index: usize| {
            let is_inside = (0..variables).all(|k| coordinate(index, k) + 1 < self.side);
            let corner = |corner: usize| {
                let steps = (0..variables).filter(move |k| corner >> k & 1 == 1);
                index + steps.map(|k| self.side.pow(k)).sum::<usize>()
            };
            let corners: Vec<usize> =
                is_inside.then(|| (0..1 << variables).map(corner).collect())?;
            let misses: Vec<&Vec<f64>> =
                corners.iter().map(|place| self.misses[*place].as_ref()).collect::<Option<_>>()?;
            let between = |target: usize| {
                let signs = misses.iter().map(|miss| miss[target] < 0.0);
                signs.clone().any(|is_negative| is_negative)
                    && signs.clone().any(|is_negative| !is_negative)
            };
            let encloses = (0..misses[0].len()).all(between);
            corners
                .into_iter()
                .min_by(|a, b| self.size(*a).total_cmp(&self.size(*b)))
                .filter(|_| encloses)
        };
        let mut starts: Vec<usize> = all.clone().filter(is_least).collect();
        starts.extend(all.filter_map(enclosing));
        starts.sort_by(|a, b| self.size(*a).total_cmp(&self.size(*b)).then(a.cmp(b)));
        starts.dedup();
        starts.truncate(MOST_STARTS);
        starts.into_iter().map(|index| self.places[index].clone()).collect()
    }
}
