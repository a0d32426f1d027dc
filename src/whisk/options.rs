//! Options of a course: its start, the point of its curvature, gaps that it bridges, and cancellation.

use crate::names::names;
use crate::scene::{Pole, Whisker};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap_mechanics::rod::{Rest, Side};

/// State in which a course begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CourseStart {
    /// The whisker is free. At an angle beyond first touch, it has passed the pole.
    Free,
    /// The pole bends the whisker, as after a push from first touch to the first angle: on CB if that side holds it, otherwise on CF.
    Contact,
}

names!(CourseStart { Free = "free", Contact = "contact" });

/// Start of a course, point of its curvature, gaps that it bridges, and cancellation.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct WhiskOptions {
    /// State in which the course begins, at its first known angle. `None` assumes a free whisker, unless angles before are missing.
    pub start: Option<CourseStart>,
    /// Arclength from the base, in mm, at which samples have the curvature; `None` for samples without it.
    pub curvature_at_mm: Option<f64>,
    /// Longest gap, in s, across which the course continues along a straight line: the time between the angles before and after missing
    /// ones. The default 0 bridges none.
    pub bridge_s: f64,
    /// Flag that cancels: if true, the course soon ends with [`WhiskError::Cancelled`](super::WhiskError::Cancelled). `None` if nothing cancels.
    pub cancel: Option<Arc<AtomicBool>>,
}

impl WhiskOptions {
    /// Returns true if the course is cancelled.
    pub(super) fn is_cancelled(&self) -> bool {
        let cancel = self.cancel.as_ref();
        cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed))
    }
}

/// Error of a curvature that should be taken at a place that the whisker does not have.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("curvature_at_mm = {at_mm}: must be between 0 and {length_mm}, the whisker's length in mm")]
pub struct CurvatureAtError {
    /// Arclength of the place, in mm.
    pub at_mm: f64,
    /// Length of the whisker, in mm.
    pub length_mm: f64,
}

/// Point of the whisker at which samples have the curvature.
#[derive(Clone, Copy)]
pub struct CurvaturePoint {
    /// Arclength from the base, in mm.
    pub at_mm: f64,
    /// Curvature there at rest, in 1/mm.
    pub at_rest_per_mm: f64,
}

impl CurvaturePoint {
    /// Creates the point of `whisker` at the arclength `at_mm`; `None` without an arclength.
    ///
    /// # Errors
    /// The arclength is not on the whisker.
    pub fn of(whisker: &Whisker, at_mm: Option<f64>) -> Result<Option<Self>, CurvatureAtError> {
        let Some(at_mm) = at_mm else { return Ok(None) };
        let length_mm = whisker.length_mm;
        if !(0.0..=length_mm).contains(&at_mm) {
            return Err(CurvatureAtError { at_mm, length_mm });
        }
        let rest = Rest::new(&whisker.rod(&Pole::smooth(0.0), Side::Cb));
        Ok(Some(Self { at_mm, at_rest_per_mm: rest.curvature(at_mm / length_mm) / length_mm }))
    }
}
