//! Charts: curves over axes that fit them, one plot or several.
//!
//! Invariant: every finite point of the data lies inside the frame of its plot; nothing is clipped but in insets, which show
//! a part once more.

mod data;
mod inset;
mod marks;
mod notes;
mod plot;
mod sheet;
mod window;

pub use data::{Band, Chart, Disc, Dot, Ink, Inset, Line, Note, Plot, Shade, Stroke};

use super::picture::Picture;
use sheet::Sheet;

impl Chart {
    /// Lays the chart out; equal charts give equal pictures. An axis whose label ends in a unit of length, force,
    /// moment or energy, such as `(mm)`, shows its numbers in the unit that suits them.
    #[must_use]
    pub fn picture(&self) -> Picture {
        Sheet::plan(self).draw()
    }
}
