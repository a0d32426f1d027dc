//! Options of a course: its start, the point of its curvature, gaps that it bridges, and cancellation.

use crate::names::names;
use crate::scene::Whisker;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

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

impl CurvatureAtError {
    /// Checks the arclength of a curvature, in mm, if there is one.
    pub(crate) fn check(whisker: &Whisker, at_mm: Option<f64>) -> Result<(), Self> {
        let length_mm = whisker.length_mm;
        let outside = at_mm.filter(|at_mm| !(0.0..=length_mm).contains(at_mm));
        outside.map_or(Ok(()), |at_mm| Err(Self { at_mm, length_mm }))
    }
}
