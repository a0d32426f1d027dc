//! Baseline of the curvature: what frames without contact show beside the scene's shape at rest.

use super::bending::Bending;
use super::{CurvatureFrame, CurvatureFrames};
use crate::input::CsvError;
use crate::scene::{Whisker, digits, rounded};

/// Mean change of the curvature from that at rest, in frames without contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvatureBaseline {
    /// Mean change of the curvature, in 1/mm.
    pub mean_per_mm: f64,
    /// Scatter: standard deviation of the change of the curvature in one frame, in 1/mm.
    pub sd_per_mm: f64,
    /// Number of frames of the baseline, at least 2.
    pub count: usize,
}

impl CurvatureBaseline {
    /// Computes the baseline of `whisker` from changes of the curvature in `frames` that all are without contact. Frames without a curvature
    /// do not count. The error is the number of the others, if there are fewer than 2.
    fn new<'a>(
        whisker: &Whisker,
        frames: impl Iterator<Item = &'a CurvatureFrame>,
    ) -> Result<Self, usize> {
        let changes = frames.map(|frame| Bending::new(whisker, frame).change_per_mm);
        let changes: Vec<f64> = changes.filter(|change| !change.is_nan()).collect();
        let count = changes.len();
        if count < 2 {
            return Err(count);
        }
        let mean_per_mm = changes.iter().sum::<f64>() / count as f64;
        let squares = changes.iter().map(|change| (change - mean_per_mm).powi(2));
        Ok(Self {
            mean_per_mm,
            sd_per_mm: (squares.sum::<f64>() / (count - 1) as f64).sqrt(),
            count,
        })
    }

    /// Returns one line with the baseline, its standard error and the scatter.
    #[must_use]
    pub fn note(&self) -> String {
        let error = self.sd_per_mm / (self.count as f64).sqrt();
        let [mean, error, scatter] =
            [self.mean_per_mm, error, self.sd_per_mm].map(|number| digits(rounded(number, 4)));
        format!(
            "baseline of {} frames without contact: {mean} per mm from the curvature at rest, with a standard error of {error}; the scatter of a frame is {scatter} per mm",
            self.count
        )
    }
}

impl CurvatureFrames {
    /// Returns the baseline of `whisker`: of the frames from `span_s[0]` to `span_s[1]`, in s, or without a span of all frames that the column
    /// `contact` gives as free. `None` without a span, if fewer than 2 free frames have a curvature. A frame for which this column has no value does not count.
    ///
    /// # Errors
    /// If a frame of the span is in contact, or fewer than 2 frames of the span have a curvature.
    pub fn baseline(
        &self,
        whisker: &Whisker,
        span_s: Option<[f64; 2]>,
    ) -> Result<Option<CurvatureBaseline>, CsvError> {
        let is_free = |frame: &&CurvatureFrame| frame.contact.is_none();
        if span_s.is_none() && !self.have_contacts {
            return Ok(None);
        }
        let is_inside = |frame: &CurvatureFrame| {
            span_s.is_none_or(|[from, to]| (from..=to).contains(&frame.time_s))
        };
        let place = span_s.map_or_else(String::new, |[from, to]| {
            format!(" from {} to {} s", digits(from), digits(to))
        });
        let in_span = self.frames.iter().filter(|frame| is_inside(frame));
        let is_in_contact =
            |frame: &&CurvatureFrame| frame.contact.is_some_and(|contact| contact.is_known);
        if let Some(frame) = in_span.clone().find(is_in_contact)
            && span_s.is_some()
        {
            let time = digits(frame.time_s);
            let what = format!(
                "time_s = {time}: is in contact; the baseline{place} must have frames without contact only"
            );
            return Err(CsvError::at(&self.origin, frame.line, what));
        }
        let free = in_span.filter(is_free);
        match CurvatureBaseline::new(whisker, free) {
            Ok(baseline) => Ok(Some(baseline)),
            Err(_) if span_s.is_none() => Ok(None),
            Err(count) => {
                let what = format!(
                    "has {count} frames without contact and with a curvature{place}: a baseline must have at least 2"
                );
                Err(CsvError::whole(&self.origin, what))
            }
        }
    }
}
