//! Measured detachments: points from a CSV file, and their differences from theory.

mod compare;
mod read;
#[cfg(feature = "fit")]
mod together;
mod whiskers;

pub use compare::{ComparedPoint, Comparison, NotCompared};
#[cfg(feature = "fit")]
pub(crate) use together::Residuals;

#[cfg(feature = "fit")]
use crate::sensitivity::Derivatives;
use crate::trace::{Detachment, DetachmentKind};
use whiskmap_mechanics::rod::Side;

/// Measured detachments, in the order of their file. Every value is in its range.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredPoints {
    /// Name of the file of measured points in messages.
    pub origin: String,
    /// Message that names unused columns of the file of points; `None` without such columns.
    pub note: Option<String>,
    /// Kind of the measured angles: push angle or chord angle.
    pub angle: MeasuredAngle,
    /// True if the file of points gives standard deviations.
    pub have_deviations: bool,
    /// Names of the whiskers to which the points belong, each once, in the order of the file: `[whisker]`. Empty if the file names none.
    pub whiskers: Vec<String>,
    /// Measured points with all of their values, at least one: `[point]`.
    pub points: Vec<MeasuredPoint>,
    /// Measured points with a missing value, which is NaN. They are not compared: `[point]`.
    pub incomplete: Vec<MeasuredPoint>,
}

/// Measured detachment: side, distance, angle and kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredPoint {
    /// Line of the measured point in its file, from 1.
    pub line: usize,
    /// Index of the point's whisker in [`MeasuredPoints::whiskers`]; 0 without names.
    pub whisker: usize,
    /// Side of the whisker that the pole is on.
    pub side: Side,
    /// Distance from the base to the contact at first touch, in millimetres.
    pub distance_mm: f64,
    /// Angle at the measured detachment, in degrees: positive CB, negative CF.
    pub angle_deg: f64,
    /// Kind of the measured detachment, slip-off or pull-off; `None` if the file does not give it.
    pub kind: Option<DetachmentKind>,
    /// Standard deviation of the measured angle in degrees; 1 without deviations in the file.
    pub sd_deg: f64,
}

/// Kind of the angle that was measured at detachment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeasuredAngle {
    /// The push angle: rotation of the base since first touch.
    Push,
    /// The chord angle: at the base between the contact and the resting whisker as far away (Fig. 1D).
    Chord,
}

impl MeasuredAngle {
    /// Returns the name of the angle's column, in files of points and of detachment curves.
    #[must_use]
    pub const fn column(self) -> &'static str {
        match self {
            Self::Push => "push_angle_deg",
            Self::Chord => "push_chord_deg",
        }
    }

    /// Returns the derivative of this angle, in degrees per unit of the variable.
    #[cfg(feature = "fit")]
    const fn of_derivatives(self, by: &Derivatives) -> f64 {
        match self {
            Self::Push => by.push_angle_deg,
            Self::Chord => by.push_chord_deg,
        }
    }

    /// Returns this angle of a predicted detachment, in degrees; `None` without a detachment.
    const fn of_end(self, end: &Detachment) -> Option<f64> {
        match self {
            Self::Push => end.push_angle_deg,
            Self::Chord => end.push_chord_deg,
        }
    }
}
