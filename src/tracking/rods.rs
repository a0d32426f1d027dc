//! Curves of a film with a pole: the whisker is a rod, whose shape at rest and taper are common to all frames.
//!
//! The shape at rest is that of frames in which the pole is far from the whisker. The taper follows from frames in contact: a loaded whisker
//! bends most where it is thin. With both known, few points determine a frame.

use super::bent::{FittedLoad, FrameFit, FramePoints, TrackedRod, fit};
use super::curve::{MORE_POINTS, points_mm};
use super::frame_curve::FrameCurve;
use super::options::TrackingOptions;
use super::orient::median;
use super::{ImageFrame, NoFrame};
use crate::least_squares::{BoundedProblem, FAINT, norm, search};
use crate::scene::{digits, rounded};
use crate::traced::{LARGEST_RMS, MOST_DEGREE};
use glam::DVec2;
use rayon::prelude::*;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use whiskmap_mechanics::rod::{CURVATURE_TERMS, CurvaturePolynomial};

/// Largest number of frames, from all over the film, that give the shape at rest or the taper.
const SAMPLE: usize = 40;

/// Number of frames per frame of the sample of which the most bent ones are chosen.
const CANDIDATES: usize = 4;

/// Distance of the pole from the line through the points, in lengths of the whisker beside twice the largest distance in contact, from which on a
/// frame gives the shape at rest.
const FREE: f64 = 0.02;

/// Fewest frames without contact that give the shape at rest.
const FEWEST_FREE: usize = 3;

/// Largest distance of the points from the curve, in medians of it, of a frame that gives the shape at rest.
const OUTLIER: f64 = 3.0;

/// Taper where frames do not give it: that of the whisker of Hires et al. (2013), as in `scenes/cone.toml`.
const TYPICAL_TAPER: f64 = 0.95;

/// Standard deviation of the taper from which on frames do not give it.
const UNKNOWN_TAPER: f64 = 0.1;

/// Standard deviation of the taper from which on a note advises to give it.
const ROUGH_TAPER: f64 = 0.02;

/// Degree of the curvature at rest with which the length is found.
const FIRST_DEGREE: usize = 2;

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

/// Distance of the pole from the line through the points, in lengths of the whisker, from which on a frame is without contact.
const BESIDE: f64 = 0.1;

/// Ratio of the distances of points near the pole and without contact from which on a note has a warning.
const OFF: f64 = 2.0;

/// Frame with what its fits need, in lengths of the whisker.
struct RodFrame {
    /// Points and pole of the frame.
    traced: FramePoints,
    /// Guess of the angle of the base, in radians.
    angle: f64,
    /// Place of the pole along the line through the points.
    contact: f64,
    /// Distance of the pole from this line.
    far: f64,
}

impl RodFrame {
    /// Creates the frame; `None` with too few points.
    fn new(points_mm: &[[f64; 2]], pole_mm: [f64; 2], length_mm: f64) -> Option<Self> {
        if points_mm.len() <= MORE_POINTS {
            return None;
        }
        let pole = DVec2::from(pole_mm) / length_mm;
        let points = points_mm
            .iter()
            .map(|point| DVec2::from(*point) / length_mm);
        let points: Vec<DVec2> = points.collect();
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
            traced: FramePoints {
                points,
                pole,
                places,
            },
        })
    }

    /// Fits the curve with this load.
    fn fit(&self, whisker: &TrackedRod, load: FittedLoad, cancel: &AtomicBool) -> Option<FrameFit> {
        fit(whisker, &self.traced, self.angle, load, cancel).ok()
    }

    /// Fits the shape at rest.
    fn at_rest(&self, whisker: &TrackedRod, cancel: &AtomicBool) -> Option<FrameFit> {
        self.fit(whisker, FittedLoad::Rest, cancel)
    }

    /// Fits the shape in contact.
    fn bent(&self, whisker: &TrackedRod, cancel: &AtomicBool) -> Option<FrameFit> {
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
    fn count(&self) -> usize {
        self.count
    }

    fn residuals(&self, x: &[f64]) -> Option<Vec<f64>> {
        (self.residuals)(x)
    }

    /// Differences inside the range.
    fn jacobian(&self, x: &[f64], _: &[f64]) -> Option<Vec<Vec<f64>>> {
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

/// Returns at most `most` of all, evenly spaced.
fn evenly<T: Copy>(all: &[T], most: usize) -> Vec<T> {
    let count = all.len().min(most);
    let chosen = (0..count).map(|i| (2 * i + 1) * all.len() / (2 * count));
    chosen.map(|i| all[i]).collect()
}

fn polynomial(coefficients: &[f64]) -> CurvaturePolynomial {
    let mut legendre = [0.0; CURVATURE_TERMS];
    legendre[..coefficients.len()].copy_from_slice(coefficients);
    CurvaturePolynomial::new(legendre)
}

/// Shape at rest that frames have in common.
struct CommonRest {
    /// Coefficients of the curvature over the length, `[degree]`.
    coefficients: Vec<f64>,
    /// Mean square of the residuals, in squared lengths, and their number.
    mean_square: f64,
    count: usize,
}

impl CommonRest {
    /// Fits a curvature of this degree, from `start` on.
    fn new(
        frames: &[&RodFrame],
        start: &[f64],
        degree: usize,
        cancel: &AtomicBool,
    ) -> Option<Self> {
        let mut start = start.to_vec();
        start.resize(degree + 1, 0.0);
        let problem = CommonProblem {
            residuals: |x: &[f64]| {
                let whisker = TrackedRod::new(0.0, polynomial(x), 1.0);
                residuals(frames, |frame| frame.at_rest(&whisker, cancel))
            },
            count: frames
                .iter()
                .map(|frame| frame.traced.points.len() + 1)
                .sum(),
            range: [f64::NEG_INFINITY, f64::INFINITY],
        };
        let found = search(&problem, &start, TOLERANCE, "a frame has no fit");
        let (coefficients, sum) = found.ok()?;
        Some(Self {
            coefficients,
            mean_square: sum / problem.count as f64,
            count: problem.count,
        })
    }

    /// Returns the root mean square of the distances of points in so many frames. Each frame has one more residual than points.
    fn rms(&self, frames: usize) -> f64 {
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
    fn best(
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

/// Taper that frames in contact have in common.
struct CommonTaper {
    taper: f64,
    /// Standard deviation of the taper, from the scatter of the points.
    deviation: f64,
}

impl CommonTaper {
    fn new(
        frames: &[&RodFrame],
        whisker: impl Fn(f64) -> TrackedRod + Sync,
        cancel: &AtomicBool,
    ) -> Option<Self> {
        let problem = CommonProblem {
            residuals: |x: &[f64]| {
                let whisker = whisker(x[0]);
                residuals(frames, |frame| frame.bent(&whisker, cancel))
            },
            count: frames
                .iter()
                .map(|frame| frame.traced.points.len() + 2)
                .sum(),
            range: [0.0, 1.0],
        };
        let found = search(&problem, &[TYPICAL_TAPER], TOLERANCE, "a frame has no fit");
        let (x, sum) = found.ok()?;
        let slopes = problem.jacobian(&x, &[])?;
        // Each frame has five unknowns.
        let left = problem.count.saturating_sub(5 * frames.len() + 1).max(1);
        Some(Self {
            taper: x[0],
            deviation: (sum / left as f64).sqrt() / norm(&slopes[0]),
        })
    }

    /// Returns a note on the taper, which `count` frames have given.
    fn note(&self, count: usize) -> String {
        let [taper, deviation] =
            [self.taper, self.deviation].map(|number| digits(rounded(number, 3)));
        let advice = if self.deviation > ROUGH_TAPER {
            ": give it by --taper, if it is known"
        } else {
            ""
        };
        format!(
            "the taper is {taper}, with a standard deviation of {deviation}, from {count} frames in contact{advice}"
        )
    }
}

/// Returns the position of the pole in each frame, or in the nearest frame that has it, `[frame]`; `None` without any.
fn poles(frames: &[ImageFrame]) -> Option<Vec<[f64; 2]>> {
    let known = frames.iter().enumerate();
    let known: Vec<(usize, [f64; 2])> = known
        .filter_map(|(i, frame)| Some((i, frame.pole_px?)))
        .collect();
    let nearest = |i: usize| {
        let after = known.partition_point(|(frame, _)| *frame < i);
        let around = [after.checked_sub(1), Some(after)].into_iter().flatten();
        let around = around.filter_map(|k| known.get(k));
        Some(around.min_by_key(|(frame, _)| frame.abs_diff(i))?.1)
    };
    (0..frames.len()).map(nearest).collect()
}

/// Points and poles of a film.
struct Film<'a> {
    /// Points of each frame in mm with the y axis upward, `[frame]`; `None` without a base.
    points: Vec<Option<Vec<[f64; 2]>>>,
    /// Position of the pole in each frame, in mm, `[frame]`.
    poles: Vec<[f64; 2]>,
    /// Largest distance of the whisker from the pole's centre in contact, in mm.
    within_mm: f64,
    cancel: &'a AtomicBool,
}

/// Shape at rest of the whisker of a film.
struct FilmRest {
    curvature: CurvaturePolynomial,
    length_mm: f64,
    /// Degree of the curvature.
    degree: usize,
    /// Number of frames that give the shape.
    count: usize,
    /// Root mean square of the distances of their points, in mm.
    rms_mm: f64,
}

impl Film<'_> {
    /// Returns the frames in units of a length, `[frame]`; `None` without a base or with too few points.
    fn frames(&self, length_mm: f64) -> Vec<Option<RodFrame>> {
        let all = self.points.iter().zip(&self.poles);
        all.map(|(points, pole)| RodFrame::new(points.as_deref()?, *pole, length_mm))
            .collect()
    }

    /// Returns the shape at rest, with a curvature of this degree or of the best one. `None` if too few frames are without contact, or no
    /// shape fits them.
    fn rest(&self, degree: Option<usize>) -> Option<FilmRest> {
        let cancel = self.cancel;
        // The length is first that of chords, then that of the curve.
        let chords = self.frames(1.0);
        let ends = chords.iter().flatten();
        let chord_mm = median(ends.filter_map(|frame| frame.traced.places.last().copied()));
        if chord_mm <= 0.0 {
            return None;
        }
        let frames = self.frames(chord_mm);
        let free = free(&frames, 2.0 * self.within_mm / chord_mm + FREE)?;
        let sample: Vec<&RodFrame> = free.iter().filter_map(|i| frames[*i].as_ref()).collect();
        let first = CommonRest::new(&sample, &[], FIRST_DEGREE, cancel)?;
        let whisker = TrackedRod::new(0.0, polynomial(&first.coefficients), chord_mm);
        let fits = sample
            .par_iter()
            .map(|frame| frame.at_rest(&whisker, cancel));
        let fits: Vec<FrameFit> = fits.collect::<Option<_>>()?;
        let length_mm = chord_mm * median(fits.iter().map(|fit| fit.end));
        if length_mm <= 0.0 {
            return None;
        }
        let usual = median(fits.iter().map(FrameFit::rms));
        let frames = self.frames(length_mm);
        let pairs = free.iter().zip(&fits);
        let good = pairs.filter(|(_, fit)| fit.rms() <= OUTLIER * usual);
        let good: Vec<&RodFrame> = good.filter_map(|(i, _)| frames[*i].as_ref()).collect();
        let points = median(good.iter().map(|frame| frame.traced.points.len() as f64)) as usize;
        let most = points.saturating_sub(MORE_POINTS).min(MOST_DEGREE);
        let rest = CommonRest::best(&good, degree, most, cancel)?;
        Some(FilmRest {
            curvature: polynomial(&rest.coefficients),
            length_mm,
            degree: rest.coefficients.len() - 1,
            count: good.len(),
            rms_mm: length_mm * rest.rms(good.len()),
        })
    }

    /// Returns the taper that frames in contact give, with a note.
    fn taper(
        &self,
        frames: &[Option<RodFrame>],
        whisker: impl Fn(f64) -> TrackedRod + Sync,
    ) -> (f64, String) {
        let typical = whisker(TYPICAL_TAPER);
        let within = self.within_mm / typical.length_mm;
        let bent = most_bent(frames, &typical, within, self.cancel);
        let found = CommonTaper::new(&bent, whisker, self.cancel);
        match found.filter(|taper| taper.deviation <= UNKNOWN_TAPER) {
            Some(found) => (found.taper, found.note(bent.len())),
            None => {
                let note = format!(
                    "{} frames near the pole do not show the taper: {TYPICAL_TAPER} is taken; give it by --taper",
                    bent.len()
                );
                (TYPICAL_TAPER, note)
            }
        }
    }

    /// Returns true if the pole is so near to the points that the whisker may be in contact.
    fn is_near(&self, whisker: &TrackedRod, frame: &RodFrame) -> bool {
        frame.far <= self.within_mm / whisker.length_mm + BESIDE
    }

    /// Returns the median place of the pole along the whisker, in lengths of it, in frames that may be in contact. A load there gives the
    /// curvature of a whisker at rest, so that its scatter is that of measured loads.
    fn usual_contact(&self, whisker: &TrackedRod, frames: &[Option<RodFrame>]) -> f64 {
        let near = frames.iter().flatten();
        let near = near.filter(|frame| self.is_near(whisker, frame));
        median(near.map(|frame| frame.contact))
    }

    /// Fits the rod to a frame: in contact if it is within the largest distance from the pole, or at rest.
    fn fit(&self, whisker: &TrackedRod, frame: Option<&RodFrame>) -> Result<FrameFit, NoFrame> {
        let within = self.within_mm / whisker.length_mm;
        let frame = frame.ok_or(NoFrame::Missing)?;
        let bent = if self.is_near(whisker, frame) {
            Some(frame.bent(whisker, self.cancel).ok_or(NoFrame::NoCurve)?)
        } else {
            None
        };
        let held = bent.filter(|fit| fit.offset.is_some_and(|offset| offset.abs() <= within));
        let found = held.or_else(|| frame.at_rest(whisker, self.cancel));
        let found = found.filter(|fit| fit.rms() <= LARGEST_RMS);
        found.ok_or(NoFrame::NoCurve)
    }
}

/// Returns the curves of rods through the points of all frames, `[frame]`; adds notes. `None` if there is no pole, if the options select
/// polynomials, or if frames do not give the shape at rest.
pub(super) fn curves(
    frames: &[ImageFrame],
    options: &TrackingOptions,
    cancel: &AtomicBool,
    notes: &mut Vec<String>,
) -> Option<Vec<Result<FrameCurve, NoFrame>>> {
    let within_mm = options
        .contact_within_mm
        .filter(|_| options.fit_to_mm.is_none())?;
    let scale = options.mm_per_pixel;
    let poles = poles(frames)?.into_iter();
    let film = Film {
        points: frames.iter().map(|frame| points_mm(frame, scale)).collect(),
        poles: poles.map(|[x, y]| [scale * x, -scale * y]).collect(),
        within_mm,
        cancel,
    };
    let Some(rest) = film.rest(options.degree) else {
        notes.push(format!(
            "fewer than {FEWEST_FREE} frames far from the pole give the shape at rest: curves are polynomials"
        ));
        return None;
    };
    notes.push(format!(
        "curves are those of a rod: at rest, its curvature has the degree {}, from {} frames without contact",
        rest.degree, rest.count
    ));
    let whisker = |taper: f64| TrackedRod::new(taper, rest.curvature, rest.length_mm);
    let frames = film.frames(rest.length_mm);
    let taper = options.taper.unwrap_or_else(|| {
        let (taper, note) = film.taper(&frames, whisker);
        notes.push(note);
        taper
    });
    let whisker = Arc::new(whisker(taper));
    let fits = frames
        .par_iter()
        .map(|frame| film.fit(&whisker, frame.as_ref()));
    let fits: Vec<Result<FrameFit, NoFrame>> = fits.collect();
    let pairs = frames.iter().zip(&fits);
    let near = pairs.filter_map(|(frame, found)| {
        let is_near = film.is_near(&whisker, frame.as_ref()?);
        found.as_ref().ok().filter(|_| is_near)
    });
    notes.extend(compared(near, rest.rms_mm, rest.length_mm));
    let usual = film.usual_contact(&whisker, &frames);
    let curve = |(frame, found): (&Option<RodFrame>, &Result<FrameFit, NoFrame>)| {
        let found = found.as_ref().map_err(|why| *why)?;
        let loaded = frame.as_ref().filter(|_| found.offset.is_none());
        let loaded = loaded.and_then(|frame| frame.fit(&whisker, FittedLoad::Place(usual), cancel));
        Ok(FrameCurve::rod(&whisker, found, loaded.as_ref()))
    };
    let pairs = frames.par_iter().zip(&fits);
    Some(pairs.map(curve).collect())
}

/// Returns the indices of frames without contact, from all over the film: those that are farther than `beyond` from the pole, in lengths of the
/// whisker. `None` if they are too few.
fn free(frames: &[Option<RodFrame>], beyond: f64) -> Option<Vec<usize>> {
    let is_free = |i: &usize| frames[*i].as_ref().is_some_and(|frame| frame.far > beyond);
    let free: Vec<usize> = (0..frames.len()).filter(is_free).collect();
    (free.len() >= FEWEST_FREE).then(|| evenly(&free, SAMPLE))
}

/// Returns frames in contact, from all over the film, that have the larger moments at the base.
fn most_bent<'a>(
    frames: &'a [Option<RodFrame>],
    whisker: &TrackedRod,
    within: f64,
    cancel: &AtomicBool,
) -> Vec<&'a RodFrame> {
    let near = frames
        .iter()
        .flatten()
        .filter(|frame| frame.far <= within + BESIDE);
    let near = evenly(&near.collect::<Vec<_>>(), CANDIDATES * SAMPLE);
    let moment = |frame: &&'a RodFrame| {
        let found = frame.bent(whisker, cancel)?;
        let [contact, force] = found.pose.load?;
        // With another taper, the curve is a little off the pole.
        (found.offset?.abs() <= 2.0 * within).then(|| (*frame, (contact * force).abs()))
    };
    let moments = near.par_iter().filter_map(moment);
    let mut moments: Vec<(&RodFrame, f64)> = moments.collect();
    let usual = median(moments.iter().map(|(_, moment)| *moment));
    moments.retain(|(_, moment)| *moment >= usual);
    let bent: Vec<&RodFrame> = moments.into_iter().map(|(frame, _)| frame).collect();
    evenly(&bent, SAMPLE)
}

/// Returns a note with the distances of points from the rod in `fits` to frames near the pole, and those in frames without contact, `free_mm`.
/// `None` if no frame is near the pole.
fn compared<'a>(
    fits: impl Iterator<Item = &'a FrameFit>,
    free_mm: f64,
    length_mm: f64,
) -> Option<String> {
    let distances: Vec<&[f64]> = fits.map(FrameFit::distances).collect();
    let distances = distances.concat();
    if distances.is_empty() {
        return None;
    }
    let near_mm = length_mm * norm(&distances) / (distances.len() as f64).sqrt();
    let warning = if near_mm > OFF * free_mm && near_mm > FAINT * length_mm {
        "; the whisker at the pole is off the rod: check the pole's position and --taper"
    } else {
        ""
    };
    let [near, free] = [near_mm, free_mm].map(|distance| digits(rounded(distance, 2)));
    Some(format!(
        "points are {near} mm from the rod near the pole, {free} mm without contact (rms){warning}"
    ))
}
