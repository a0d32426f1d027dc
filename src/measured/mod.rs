//! Measured detachments: points from a CSV file, and their differences from theory.

mod compare;
mod read;

pub use compare::{ComparedPoint, Comparison};

use crate::rod::Side;
use crate::trace::DetachmentKind;

/// Measured detachments, in the order of their file. Every value is in its range.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredPoints {
    /// Name of the file in messages.
    pub origin: String,
    /// Message that names unused columns of the file.
    pub note: Option<String>,
    /// The measured angle.
    pub angle: MeasuredAngle,
    /// True if the file gives standard deviations.
    pub have_deviations: bool,
    /// The points, at least one.
    pub points: Vec<MeasuredPoint>,
}

/// One measured detachment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredPoint {
    /// Line in the file, from 1.
    pub line: usize,
    /// Side of the whisker that the pole is on.
    pub side: Side,
    /// Distance from the base to the contact at first touch, in millimetres.
    pub distance_mm: f64,
    /// Angle at detachment in degrees: positive CB, negative CF.
    pub angle_deg: f64,
    /// Slip-off or pull-off, if the file says which.
    pub kind: Option<DetachmentKind>,
    /// Standard deviation of the angle in degrees; 1 without deviations in the file.
    pub sd_deg: f64,
}

/// Angle that was measured at detachment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeasuredAngle {
    /// Rotation of the base since first touch.
    Push,
    /// Angle at the base between the contact and the resting whisker as far away (Fig. 1D).
    Chord,
}

impl MeasuredAngle {
    /// Name of its column, in files of points and of detachment curves.
    #[must_use]
    pub const fn column(self) -> &'static str {
        match self {
            Self::Push => "push_angle_deg",
            Self::Chord => "push_chord_deg",
        }
    }
}
