//! Pictures: maps from the stored file alone, one panel at a time; charts from the lines they are given.
//!
//! Invariant: the picture of a map shows every cell of the map as it is stored, nearest cell by pixel; nothing is smoothed. Only
//! the detachment boundary is a curve, drawn from the margins that the cells carry.

mod atlas;
mod axis;
mod boundary;
mod brush;
mod canvas;
mod chart;
mod error;
mod legend;
mod palette;
mod panel;
mod shading;
mod single;
mod traces;

pub use chart::{Chart, ChartFormat, Disc, Dot, Ink, Line, Plot, Stroke};
pub use error::Error;
pub use traces::{BranchAxis, CurveAxis, Drawn, branches, curves, shapes};

use crate::store::StoredMap;
use shading::Shading;
use std::path::Path;

/// Draws which regime each cell is in, with the detachment boundary over it, as a PNG. A map of several whiskers
/// becomes a contact sheet.
///
/// # Errors
///
/// The map is damaged, or the picture cannot be written.
pub fn regimes(map: &StoredMap, out: &Path) -> Result<(), Error> {
    picture(map, "regime", out)
}

/// Draws one channel as a PNG: with a colour bar, or, for `regime` and `status`, with a legend.
///
/// # Errors
///
/// There is no such channel, the map is damaged, or the picture cannot be written.
pub fn channel(map: &StoredMap, name: &str, out: &Path) -> Result<(), Error> {
    picture(map, name, out)
}

fn picture(map: &StoredMap, channel: &str, out: &Path) -> Result<(), Error> {
    let shading = Shading::of(map, channel)?;
    let canvas = if map.layout().panels() == 1 {
        single::draw(map, channel, &shading)?
    } else {
        atlas::draw(map, channel, &shading)?
    };
    canvas.save(out)
}
