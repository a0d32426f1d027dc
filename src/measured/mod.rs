//! Measured detachments: points from a CSV file, and how far the theory of a whisker is from each.

mod compare;
mod read;

pub use compare::{Compared, Comparison};

use crate::rod::Side;
use crate::trace::DetachmentKind;

/// Detachments as measured, in the order of their file; no value is out of its range.
#[derive(Clone, Debug, PartialEq)]
pub struct Points {
    /// The name of their file.
    pub origin: String,
    /// Message that names unused columns of the file.
    pub note: Option<String>,
    /// The angle that was measured.
    pub angle: Angle,
    /// Whether every point has a standard deviation of its own.
    pub have_deviations: bool,
    /// The points, at least one.
    pub points: Vec<Point>,
}

/// One measured detachment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Its line in the file, from 1.
    pub line: usize,
    /// Side of the whisker that the pole is on.
    pub side: Side,
    /// Distance from the base to the contact at first touch.
    pub distance_mm: f64,
    /// The angle at detachment: positive CB, negative CF.
    pub angle_deg: f64,
    /// Slip-off or pull-off, if it was seen which.
    pub kind: Option<DetachmentKind>,
    /// Standard deviation of the angle; 1 degree where the file has none.
    pub sd_deg: f64,
}

/// What was measured at detachment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Angle {
    /// Rotation of the base since first touch.
    Push,
    /// Angle at the base between the contact and the resting whisker as far away (Fig. 1D).
    Chord,
}

impl Angle {
    /// Its column, here and in detachment curves.
    #[must_use]
    pub const fn column(self) -> &'static str {
        match self {
            Self::Push => "push_angle_deg",
            Self::Chord => "push_chord_deg",
        }
    }
}
