//! Fits to frames, and to what frames have in common: the shape at rest, and the taper.

use super::MORE_POINTS;
use super::bent::{FittedLoad, FrameFit, FramePoints, TrackedRod, fit};
use crate::least_squares::{BoundedProblem, FAINT, Svd, dot, norm, search};
use crate::scene::{digits, rounded};
use glam::DVec2;
use rayon::prelude::*;
use std::sync::atomic::AtomicBool;
use whiskmap_mechanics::rod::{CURVATURE_TERMS, CurvaturePolynomial};

/// Taper where frames do not give it: that of the whisker of Hires et al. (2013), as in `scenes/cone.toml`.
pub(super) const TYPICAL_TAPER: f64 = 0.95;

/// Standard deviation of the taper from which on a note advises to give it.
const ROUGH_TAPER: f64 = 0.02;

/// Steps of differences by coefficients of the curvature, in radians, and by the taper.
const DIFFERENCE: f64 = 1e-4;

/// Relative change of the sum of squares, and of common parameters, below which the iteration ends. Residuals are exact within 1e-9.
const TOLERANCE: f64 = 1e-7;

/// Squared distance, in units of the squared length, that counts as 0: the error of trajectories.
const EXACT: f64 = 1e-12;

/// Most chords along which the places of points are estimated: noise hardly lengthens them.
const CHORDS: usize = 16;

/// Part of the whisker whose chord gives the angle of the base with which a fit begins.
const FIRST_CHORD: f64 = 0.3;

/// Ratio of the scatter about a common shape at rest to that about shapes of each frame from which on frames have no shape in common.
const UNLIKE: f64 = 2.0;

/// Standard deviations of the logarithm of this ratio beyond which it counts.
const SURE: f64 = 4.0;

/// Frame with what its fits need, in lengths of the whisker.
pub(super) struct RodFrame {
    /// Points and pole of the frame.
    pub traced: FramePoints,
    /// Guess of the angle of the base, in radians.
    angle: f64,
    /// Place of the pole along the line through the points.
    pub contact: f64,
    /// Distance of the pole from this line.
    pub far: f64,
}

impl RodFrame {
    /// Creates the frame; `None` with too few points.
    pub fn new(points_mm: &[[f64; 2]], pole_mm: [f64; 2], length_mm: f64) -> Option<Self> {
        if points_mm.len() <= MORE_POINTS {
            return None;
        }
        let pole = DVec2::from(pole_mm) / length_mm;
        let points: Vec<DVec2> =
            points_mm.iter().map(|point| DVec2::from(*point) / length_mm).collect();
        let places = places(&points);
        let near = |i: usize| {
            let (from, step) = (points[i], points[i + 1] - points[i]);
            let part = (pole - from).dot(step) / step.length_squared().max(f64::MIN_POSITIVE);
            let part = part.clamp(0.0, 1.0);
            let place = places[i] + part * (places[i + 1] - places[i]);
            (place, (from + part * step).distance(pole))
        };
        let nearest = (0..points.len() - 1).map(near);
        let (contact, far) = nearest.min_by(|one, other| one.1.total_cmp(&other.1))?;
        let end = places.partition_point(|s| *s < FIRST_CHORD);
        let chord = points[end.min(points.len() - 1)] - points[0];
        Some(Self {
            angle: libm::atan2(chord.y, chord.x),
            contact,
            far,
            traced: FramePoints { points, pole, places },
        })
    }

    /// Fits the curve with this load.
    pub fn fit(
        &self,
        whisker: &TrackedRod,
        load: FittedLoad,
        cancel: &AtomicBool,
    ) -> Option<FrameFit> {
        fit(whisker, &self.traced, self.angle, load, cancel).ok()
    }

    /// Fits the shape at rest.
    pub fn at_rest(&self, whisker: &TrackedRod, cancel: &AtomicBool) -> Option<FrameFit> {
        self.fit(whisker, FittedLoad::Rest, cancel)
    }

    /// Fits the shape in contact.
    pub fn bent(&self, whisker: &TrackedRod, cancel: &AtomicBool) -> Option<FrameFit> {
        self.fit(whisker, FittedLoad::Pole(self.contact), cancel)
    }
}

/// Places of points along the whisker, `[point]`, by chords.
fn places(points: &[DVec2]) -> Vec<f64> {
    let step = points.len().div_ceil(CHORDS);
    let mut places = vec![0.0_f64];
    for i in 1..points.len() {
        let before = (i - 1) / step * step;
        let place = places[before] + points[i].distance(points[before]);
        places.push(place.max(places[i - 1]));
    }
    places
}

/// Search for common parameters of frames.
struct CommonProblem<F> {
    /// Residuals of all frames at the minima of their own unknowns, `[residual]`, as a function of the parameters.
    residuals: F,
    count: usize,
    /// Range of each parameter.
    range: [f64; 2],
}

impl<F: Fn(&[f64]) -> Option<Vec<f64>>> BoundedProblem for CommonProblem<F> {
    type Place = Vec<f64>;

    fn count(&self) -> usize {
        self.count
    }

    fn residuals(&self, x: &[f64]) -> Option<Vec<f64>> {
        (self.residuals)(x)
    }

    /// Differences inside the range.
    fn jacobian(&self, x: &[f64], _: &Vec<f64>) -> Option<Vec<Vec<f64>>> {
        let [least, most] = self.range;
        let column = |i: usize| {
            let ends = [x[i] - DIFFERENCE, x[i] + DIFFERENCE].map(|end| end.clamp(least, most));
            let at = |parameter: f64| {
                let mut moved = x.to_vec();
                moved[i] = parameter;
                (self.residuals)(&moved)
            };
            let pairs = at(ends[0])?.into_iter().zip(at(ends[1])?);
            let slopes = pairs.map(|(from, to)| (to - from) / (ends[1] - ends[0]));
            Some(slopes.collect())
        };
        (0..x.len()).map(column).collect()
    }

    fn ranges(&self, x: &[f64]) -> Vec<[f64; 2]> {
        vec![self.range; x.len()]
    }
}

/// Residuals of all fits, `[residual]`; `None` if one is missing.
fn residuals(
    frames: &[&RodFrame],
    fit: impl Fn(&RodFrame) -> Option<FrameFit> + Sync,
) -> Option<Vec<f64>> {
    let each = frames.par_iter().map(|frame| Some(fit(frame)?.residuals));
    let each: Option<Vec<Vec<f64>>> = each.collect();
    Some(each?.concat())
}

pub(super) fn polynomial(coefficients: &[f64]) -> CurvaturePolynomial {
    let mut legendre = [0.0; CURVATURE_TERMS];
    legendre[..coefficients.len()].copy_from_slice(coefficients);
    CurvaturePolynomial::new(legendre)
}

/// Shape at rest that frames have in common.
pub(super) struct CommonRest {
    /// Coefficients of the curvature over the length, `[degree]`.
    pub coefficients: Vec<f64>,
    /// Mean square of the residuals, in squared lengths, and their number.
    mean_square: f64,
    count: usize,
}

impl CommonRest {
    /// Fits a curvature of this degree, from `start` on.
    pub fn new(
        frames: &[&RodFrame],
        start: &[f64],
        degree: usize,
        cancel: &AtomicBool,
    ) -> Option<Self> {
        let mut start = start.to_vec();
        start.resize(degree + 1, 0.0);
        let problem = Self::problem(frames, cancel);
        let found = search(&problem, &start, TOLERANCE, "a frame has no fit");
        let (coefficients, sum) = found.ok()?;
        Some(Self {
            coefficients,
            mean_square: sum / problem.count() as f64,
            count: problem.count(),
        })
    }

    /// Returns the search for the coefficients.
    fn problem(frames: &[&RodFrame], cancel: &AtomicBool) -> impl BoundedProblem<Place = Vec<f64>> {
        CommonProblem {
            residuals: |x: &[f64]| {
                let whisker = TrackedRod::new(0.0, polynomial(x), 1.0);
                residuals(frames, |frame| frame.at_rest(&whisker, cancel))
            },
            count: frames.iter().map(|frame| frame.traced.points.len() + 1).sum(),
            range: [f64::NEG_INFINITY, f64::INFINITY],
        }
    }

    /// Returns the scatter of the coefficients, which were fitted to these frames.
    pub fn scatter(&self, frames: &[&RodFrame], cancel: &AtomicBool) -> Option<RestScatter> {
        let problem = Self::problem(frames, cancel);
        let left = self.left(frames.len()).max(1);
        Some(RestScatter {
            slopes: Svd::new(problem.jacobian(&self.coefficients, &Vec::new())?),
            rms: (self.mean_square * self.count as f64 / left as f64).sqrt(),
        })
    }

    /// Returns the standard deviations of a residual, in lengths, about the common shape and about a shape of each frame, `[common, alone]`, if
    /// the former is far larger. The logarithm of their ratio scatters as Fisher's z.
    pub fn unlike(&self, frames: &[&RodFrame], cancel: &AtomicBool) -> Option<[f64; 2]> {
        let each = frames.par_iter().filter_map(|frame| {
            let most = frame.traced.points.len() - MORE_POINTS;
            let degree = most.min(self.coefficients.len() - 1);
            let alone = Self::new(&[*frame], &self.coefficients[..=degree], degree, cancel)?;
            Some((alone.mean_square * alone.count as f64, alone.left(1)))
        });
        let (sums, left): (Vec<f64>, Vec<usize>) = each.unzip();
        let left = [self.left(frames.len()), left.iter().sum()].map(|left| left.max(1) as f64);
        let common = (self.mean_square * self.count as f64 / left[0]).sqrt();
        let alone = (sums.iter().sum::<f64>() / left[1]).sqrt();
        let deviation = (0.5 * (left[0].recip() + left[1].recip())).sqrt();
        let most = UNLIKE * libm::exp(SURE * deviation) * alone;
        (common > most.max(FAINT)).then_some([common, alone])
    }

    /// Returns the number of residuals over that of unknowns, with the pose of each frame.
    fn left(&self, frames: usize) -> usize {
        self.count.saturating_sub(3 * frames + self.coefficients.len())
    }

    /// Returns the root mean square of the distances of points in so many frames. Each frame has one more residual than points.
    pub fn rms(&self, frames: usize) -> f64 {
        let points = self.count - frames;
        (self.mean_square * self.count as f64 / points as f64).sqrt()
    }

    /// Returns Schwarz's criterion (1978), which is least for the best degree.
    fn criterion(&self) -> f64 {
        let count = self.count as f64;
        count * libm::log(self.mean_square + EXACT)
            + self.coefficients.len() as f64 * libm::log(count)
    }

    /// Fits a curvature of the degree that is given, or the best one up to `most`.
    pub fn best(
        frames: &[&RodFrame],
        degree: Option<usize>,
        most: usize,
        cancel: &AtomicBool,
    ) -> Option<Self> {
        if let Some(degree) = degree {
            return Self::new(frames, &[], degree, cancel);
        }
        let mut best = Self::new(frames, &[], 0, cancel)?;
        let mut start = best.coefficients.clone();
        for degree in 1..=most {
            let next = Self::new(frames, &start, degree, cancel)?;
            start.clone_from(&next.coefficients);
            if next.criterion() < best.criterion() {
                best = next;
            }
        }
        Some(best)
    }
}

/// Scatter of the coefficients of a common shape at rest.
pub(super) struct RestScatter {
    /// Derivatives of the residuals by the coefficients.
    slopes: Svd,
    /// Standard deviation of a residual, in lengths.
    rms: f64,
}

impl RestScatter {
    /// Returns the standard deviation of a quantity with this `gradient` by the coefficients.
    fn deviation(&self, gradient: &[f64]) -> f64 {
        let values = self.slopes.values();
        let parts = values.map(|(value, direction, _)| dot(direction, gradient) / value);
        self.rms * norm(&parts.collect::<Vec<_>>())
    }
}

/// Taper that frames in contact have in common.
pub(super) struct CommonTaper {
    pub taper: f64,
    /// Standard deviation of the taper, from the scatter of the points in contact and without.
    pub deviation: f64,
}

impl CommonTaper {
    pub fn new(
        frames: &[&RodFrame],
        coefficients: &[f64],
        scatter: &RestScatter,
        length_mm: f64,
        cancel: &AtomicBool,
    ) -> Option<Self> {
        let of_rod = |taper: f64, coefficients: &[f64]| {
            let whisker = TrackedRod::new(taper, polynomial(coefficients), length_mm);
            residuals(frames, |frame| frame.bent(&whisker, cancel))
        };
        let count = frames.iter().map(|frame| frame.traced.points.len() + 2).sum();
        let problem = CommonProblem {
            residuals: |x: &[f64]| of_rod(x[0], coefficients),
            count,
            range: [0.0, 1.0],
        };
        let found = search(&problem, &[TYPICAL_TAPER], TOLERANCE, "a frame has no fit");
        let (x, sum) = found.ok()?;
        let slopes = problem.jacobian(&x, &Vec::new())?.swap_remove(0);
        let at_rest = CommonProblem {
            residuals: |coefficients: &[f64]| of_rod(x[0], coefficients),
            count,
            range: [f64::NEG_INFINITY, f64::INFINITY],
        };
        // The taper at which the sum of squares is least follows the coefficients (implicit function theorem).
        let by_coefficients = at_rest.jacobian(coefficients, &Vec::new())?;
        let gradient = by_coefficients.iter().map(|by| -dot(&slopes, by) / dot(&slopes, &slopes));
        let of_rest = scatter.deviation(&gradient.collect::<Vec<_>>());
        // Each frame has five unknowns.
        let left = count.saturating_sub(5 * frames.len() + 1).max(1);
        Some(Self {
            taper: x[0],
            deviation: libm::hypot((sum / left as f64).sqrt() / norm(&slopes), of_rest),
        })
    }

    /// Returns a note on the taper, which `count` frames have given.
    pub fn note(&self, count: usize) -> String {
        let [taper, deviation] =
            [self.taper, self.deviation].map(|number| digits(rounded(number, 3)));
        let advice =
            if self.deviation > ROUGH_TAPER { ": give it by `taper`, if it is known" } else { "" };
        format!(
            "the taper is {taper}, with a standard deviation of {deviation}, from {count} frames in contact{advice}"
        )
    }
}
