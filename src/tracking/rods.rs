//! Curves of a film with a pole: the whisker is a rod, whose shape at rest and taper are common to all frames.
//!
//! The shape at rest is that of frames in which the pole is far from the whisker. The taper follows from frames in contact: a loaded whisker
//! bends most where it is thin. With both known, few points determine a frame.

use super::bent::{FittedLoad, FrameFit, TrackedRod};
use super::common::{CommonRest, CommonTaper, RestScatter, RodFrame, TYPICAL_TAPER, polynomial};
use super::frame_curve::FrameCurve;
use super::options::TrackingOptions;
use super::sample::evenly;
use super::{ImageFrame, MORE_POINTS, NoFrame, Remarks};
use crate::least_squares::{FAINT, norm};
use crate::quantile::median;
use crate::scene::{digits, rounded};
use crate::traced::{LARGEST_RMS, MOST_DEGREE};
use rayon::prelude::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

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

/// Standard deviation of the taper from which on frames do not give it.
const UNKNOWN_TAPER: f64 = 0.1;

/// Degree of the curvature at rest with which the length is found.
const FIRST_DEGREE: usize = 2;

/// Distance of the pole from the line through the points, in lengths of the whisker, from which on a frame is without contact.
pub(super) const BESIDE: f64 = 0.1;

/// Largest distance of the points of a frame from its curve, in the usual one (root mean squares). In 4,200 made frames of 5 points, it was 3.7
/// with normal errors, and 5.7 with errors of Student's t distribution of five degrees of freedom; with 10 points, 2.2 and 4.0.
const OUTLYING: f64 = 6.0;

/// Frames in contact per frame near the pole without a curve, or per bent one that is too far from it, below which there is a warning.
const MANY: usize = 4;

/// What to check where the whisker near the pole is not that of the film.
const ADVICE: &str = "check `contact_within_mm`, the pole's position, `taper` and `mm_per_pixel`; friction and other objects bend a whisker, too";

/// Ratio of the distances of points near the pole and without contact from which on there is a warning.
const OFF: f64 = 2.0;

/// Returns the position of the pole in each frame, or in the nearest frame that has it, `[frame]`; `None` without any.
fn poles(frames: &[ImageFrame]) -> Option<Vec<[f64; 2]>> {
    let known: Vec<(usize, [f64; 2])> =
        frames.iter().enumerate().filter_map(|(i, frame)| Some((i, frame.pole_px?))).collect();
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

/// Reason why curves are no rods.
pub(super) enum NoRods {
    /// There is no pole, or the options select polynomials.
    Selected,
    /// Too few frames are farther from the pole than `beyond_mm`.
    Few { beyond_mm: f64 },
    /// Frames far from the pole have no shape in common. Scatter of points about a common shape, and about those of each frame, in mm.
    Unlike(Option<[f64; 2]>),
}

impl NoRods {
    /// Returns a warning; `None` if polynomials are selected.
    pub fn warning(&self, shows_contact: bool) -> Option<String> {
        let why = match self {
            Self::Selected => return None,
            Self::Few { beyond_mm } => format!(
                "fewer than {FEWEST_FREE} frames are more than {} mm from the pole and give the shape at rest",
                digits(rounded(*beyond_mm, 2))
            ),
            Self::Unlike(rms_mm) => {
                let scatter = rms_mm.map_or_else(String::new, |rms| {
                    let [common, alone] = rms.map(|mm| digits(rounded(mm, 2)));
                    format!(" (points are {common} mm from one shape, {alone} mm from shapes of each frame)")
                });
                format!("frames far from the pole have no shape at rest in common{scatter}")
            }
        };
        let contact = if shows_contact { "" } else { " that do not show contact, which is empty" };
        let advice = match self {
            Self::Unlike(_) => {
                "; check the pole's position, whose y axis points downward, and that the trace goes past it; only `mirror` mirrors the image"
            }
            _ => "",
        };
        Some(format!("{why}: curves are polynomials{contact}{advice}"))
    }
}

/// Shape at rest of the whisker of a film.
struct FilmRest {
    /// Coefficients of the curvature, `[degree]`.
    coefficients: Vec<f64>,
    scatter: RestScatter,
    length_mm: f64,
    /// Number of frames that give the shape.
    count: usize,
    /// Root mean square of the distances of their points, in mm.
    rms_mm: f64,
}

impl FilmRest {
    /// Returns the whisker with this taper.
    fn whisker(&self, taper: f64) -> TrackedRod {
        TrackedRod::new(taper, polynomial(&self.coefficients), self.length_mm)
    }
}

impl Film<'_> {
    /// Returns the frames in units of a length, `[frame]`; `None` without a base or with too few points.
    fn frames(&self, length_mm: f64) -> Vec<Option<RodFrame>> {
        let all = self.points.iter().zip(&self.poles);
        all.map(|(points, pole)| RodFrame::new(points.as_deref()?, *pole, length_mm)).collect()
    }

    /// Returns the shape at rest, with a curvature of this degree or of the best one.
    ///
    /// # Errors
    /// If too few frames are without contact, or no shape fits them.
    fn rest(&self, degree: Option<usize>) -> Result<FilmRest, NoRods> {
        let (cancel, unlike) = (self.cancel, || NoRods::Unlike(None));
        // The length is first that of chords, then that of the curve.
        let chords = self.frames(1.0);
        let ends = chords.iter().flatten();
        let chord_mm = median(ends.filter_map(|frame| frame.traced.places.last().copied()));
        if chord_mm <= 0.0 {
            return Err(unlike());
        }
        let frames = self.frames(chord_mm);
        let beyond = 2.0 * self.within_mm / chord_mm + FREE;
        let free = free(&frames, beyond).ok_or(NoRods::Few { beyond_mm: chord_mm * beyond })?;
        let sample: Vec<&RodFrame> = free.iter().filter_map(|i| frames[*i].as_ref()).collect();
        let first = CommonRest::new(&sample, &[], FIRST_DEGREE, cancel).ok_or_else(unlike)?;
        let whisker = TrackedRod::new(0.0, polynomial(&first.coefficients), chord_mm);
        let fits: Vec<FrameFit> = sample
            .par_iter()
            .map(|frame| frame.at_rest(&whisker, cancel))
            .collect::<Option<_>>()
            .ok_or_else(unlike)?;
        let length_mm = chord_mm * median(fits.iter().map(|fit| fit.end));
        if length_mm <= 0.0 {
            return Err(unlike());
        }
        let usual = median(fits.iter().map(FrameFit::rms));
        let frames = self.frames(length_mm);
        let pairs = free.iter().zip(&fits);
        let good = pairs.filter(|(_, fit)| fit.rms() <= OUTLIER * usual);
        let good: Vec<&RodFrame> = good.filter_map(|(i, _)| frames[*i].as_ref()).collect();
        let points = median(good.iter().map(|frame| frame.traced.points.len() as f64)) as usize;
        let most = points.saturating_sub(MORE_POINTS).min(MOST_DEGREE);
        let rest = CommonRest::best(&good, degree, most, cancel).ok_or_else(unlike)?;
        if let Some(rms) = rest.unlike(&good, cancel) {
            return Err(NoRods::Unlike(Some(rms.map(|rms| length_mm * rms))));
        }
        Ok(FilmRest {
            scatter: rest.scatter(&good, cancel).ok_or_else(unlike)?,
            length_mm,
            count: good.len(),
            rms_mm: length_mm * rest.rms(good.len()),
            coefficients: rest.coefficients,
        })
    }

    /// Returns the taper that frames in contact give, with a note.
    fn taper(&self, frames: &[Option<RodFrame>], rest: &FilmRest) -> (f64, String) {
        let typical = rest.whisker(TYPICAL_TAPER);
        let within = self.within_mm / typical.length_mm;
        let bent = most_bent(frames, &typical, within, self.cancel);
        let FilmRest { coefficients, scatter, length_mm, .. } = rest;
        let found = CommonTaper::new(&bent, coefficients, scatter, *length_mm, self.cancel);
        match found.filter(|taper| taper.deviation <= UNKNOWN_TAPER) {
            Some(found) => (found.taper, found.note(bent.len())),
            None => {
                let note = format!(
                    "{} frames near the pole do not show the taper: {TYPICAL_TAPER} is taken; give it by `taper`",
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
    fn fit(&self, whisker: &TrackedRod, frame: Option<&RodFrame>) -> Result<RodFit, NoFrame> {
        let within = self.within_mm / whisker.length_mm;
        let frame = frame.ok_or(NoFrame::Missing)?;
        let at_rest = |bent: Option<FrameFit>| {
            let fit = frame.at_rest(whisker, self.cancel).ok_or(NoFrame::NoCurve)?;
            Ok(RodFit { fit, bent })
        };
        if !self.is_near(whisker, frame) {
            return at_rest(None);
        }
        let bent = frame.bent(whisker, self.cancel).ok_or(NoFrame::NoCurve)?;
        match bent.offset {
            Some(offset) if offset.abs() <= within => Ok(RodFit { fit: bent, bent: None }),
            _ => at_rest(Some(bent)),
        }
    }

    /// Fits the rod to all frames, `[frame]`. Frames whose points are far from the curve are gaps. There is a warning if the whisker is bent at the
    /// pole in many of them, but farther from its centre than the largest distance in contact, or if many frames near the pole have no curve.
    fn fits(
        &self,
        whisker: &TrackedRod,
        frames: &[Option<RodFrame>],
        rest_rms: f64,
        warnings: &mut Vec<String>,
    ) -> Vec<Result<FrameFit, NoFrame>> {
        let found: Vec<Result<RodFit, NoFrame>> =
            frames.par_iter().map(|frame| self.fit(whisker, frame.as_ref())).collect();
        let held = || found.iter().flatten().filter(|found| found.is_held());
        let held_rms = median(held().map(|found| found.fit.rms()));
        let limit = |rms: f64| (OUTLYING * rms.max(FAINT)).min(LARGEST_RMS);
        let [free, held_most] = [rest_rms, rest_rms.max(held_rms)].map(limit);
        let apart = found.iter().flatten().filter_map(|found| {
            let bent = found.bent.as_ref()?;
            let is_bent = found.fit.rms() > free && bent.rms() <= held_most;
            bent.offset.map(f64::abs).filter(|_| is_bent)
        });
        let apart: Vec<f64> = apart.collect();
        let held = held().count();
        let is_many = |count: usize| count >= FEWEST_FREE && MANY * count > held;
        let is_apart = is_many(apart.len());
        if is_apart {
            let offset_mm = whisker.length_mm * median(apart.iter().copied());
            warnings.push(format!(
                "in {} frames, the whisker is bent at the pole, but is {} mm from its centre (median), more than {} mm: {ADVICE}",
                apart.len(),
                digits(rounded(offset_mm, 2)),
                digits(self.within_mm)
            ));
        }
        let kept = found.into_iter().map(|found| {
            let found = found?;
            let most = if found.is_held() { held_most } else { free };
            let kept = found.fit.rms() <= most;
            kept.then_some(found.fit).ok_or(NoFrame::NoCurve)
        });
        let kept: Vec<Result<FrameFit, NoFrame>> = kept.collect();
        let near = kept.iter().zip(frames).filter(|(_, frame)| {
            let frame = frame.as_ref();
            frame.is_some_and(|frame| self.is_near(whisker, frame))
        });
        let lost = near.filter(|(kept, _)| kept.is_err()).count();
        if !is_apart && is_many(lost) {
            warnings.push(format!(
                "in {lost} frames near the pole, points are along no curve of the rod, at rest or in contact: {ADVICE}; the trace may end before the pole"
            ));
        }
        kept
    }
}

/// Fit of the rod to a frame.
struct RodFit {
    fit: FrameFit,
    /// Fit with a load near the pole, of a whisker that is farther from it than in contact.
    bent: Option<FrameFit>,
}

impl RodFit {
    /// Returns true if the whisker is in contact.
    const fn is_held(&self) -> bool {
        self.fit.offset.is_some()
    }
}

/// Returns the curves of rods through the points of all frames, `[frame]`; adds notes and warnings.
///
/// # Errors
/// If there is no pole, if the options select polynomials, or if frames do not give the shape at rest.
pub(super) fn curves(
    frames: &[ImageFrame],
    options: &TrackingOptions,
    cancel: &AtomicBool,
    remarks: &mut Remarks,
) -> Result<Vec<Result<FrameCurve, NoFrame>>, NoRods> {
    let within_mm = options
        .contact_within_mm
        .filter(|_| options.fit_to_mm.is_none())
        .ok_or(NoRods::Selected)?;
    let scale = options.mm_per_pixel;
    let poles = poles(frames).ok_or(NoRods::Selected)?.into_iter();
    let film = Film {
        points: frames.iter().map(|frame| frame.points_mm(scale)).collect(),
        poles: poles.map(|[x, y]| [scale * x, -scale * y]).collect(),
        within_mm,
        cancel,
    };
    let rest = film.rest(options.degree)?;
    let Remarks { notes, warnings } = remarks;
    notes.push(format!(
        "curves are those of a rod: at rest, its curvature has the degree {}, from {} frames without contact",
        rest.coefficients.len() - 1,
        rest.count
    ));
    let frames = film.frames(rest.length_mm);
    let taper = options.taper.unwrap_or_else(|| {
        let (taper, note) = film.taper(&frames, &rest);
        notes.push(note);
        taper
    });
    let whisker = Arc::new(rest.whisker(taper));
    let fits = film.fits(&whisker, &frames, rest.rms_mm / rest.length_mm, warnings);
    let pairs = frames.iter().zip(&fits);
    let near = pairs.filter_map(|(frame, found)| {
        let is_near = film.is_near(&whisker, frame.as_ref()?);
        found.as_ref().ok().filter(|_| is_near)
    });
    if let Some((note, warning)) = compared(near, rest.rms_mm, rest.length_mm) {
        notes.push(note);
        warnings.extend(warning);
    }
    let usual = film.usual_contact(&whisker, &frames);
    let curve = |(frame, found): (&Option<RodFrame>, &Result<FrameFit, NoFrame>)| {
        let found = found.as_ref().map_err(|why| *why)?;
        if cancel.load(Ordering::Relaxed) {
            return Err(NoFrame::Missing);
        }
        let loaded = frame.as_ref().filter(|_| found.offset.is_none());
        let loaded = loaded.and_then(|frame| frame.fit(&whisker, FittedLoad::Place(usual), cancel));
        Ok(FrameCurve::rod(&whisker, found, loaded.as_ref()))
    };
    let pairs = frames.par_iter().zip(&fits);
    Ok(pairs.map(curve).collect())
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
    let near = frames.iter().flatten().filter(|frame| frame.far <= within + BESIDE);
    let near = evenly(&near.collect::<Vec<_>>(), CANDIDATES * SAMPLE);
    let moment = |frame: &&'a RodFrame| {
        let found = frame.bent(whisker, cancel)?;
        let [contact, force] = found.pose.load?;
        // With another taper, the curve is a little off the pole.
        (found.offset?.abs() <= 2.0 * within).then(|| (*frame, (contact * force).abs()))
    };
    let mut moments: Vec<(&RodFrame, f64)> = near.par_iter().filter_map(moment).collect();
    let usual = median(moments.iter().map(|(_, moment)| *moment));
    moments.retain(|(_, moment)| *moment >= usual);
    let bent: Vec<&RodFrame> = moments.into_iter().map(|(frame, _)| frame).collect();
    evenly(&bent, SAMPLE)
}

/// Returns a note with the distances of points from the rod in `fits` to frames near the pole, and those in frames without contact, `free_mm`;
/// and a warning if the former are far larger. `None` if no frame is near the pole.
fn compared<'a>(
    fits: impl Iterator<Item = &'a FrameFit>,
    free_mm: f64,
    length_mm: f64,
) -> Option<(String, Option<String>)> {
    let distances: Vec<&[f64]> = fits.map(FrameFit::distances).collect();
    let distances = distances.concat();
    if distances.is_empty() {
        return None;
    }
    let near_mm = length_mm * norm(&distances) / (distances.len() as f64).sqrt();
    let is_off = near_mm > OFF * free_mm && near_mm > FAINT * length_mm;
    let warning = is_off.then(|| format!("the whisker near the pole is off the rod: {ADVICE}"));
    let [near, free] = [near_mm, free_mm].map(|distance| digits(rounded(distance, 2)));
    let note =
        format!("points are {near} mm from the rod near the pole, {free} mm without contact (rms)");
    Some((note, warning))
}
