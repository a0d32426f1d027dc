//! Pictures: maps from the stored file alone, one panel at a time; charts from the lines they are given.
//!
//! Both are laid out as a [`Picture`], a list of marks, which becomes pixels or an SVG document when it is saved.
//!
//! Invariant: the picture of a map shows every cell of the map as it is stored, nearest cell by pixel; nothing is smoothed. Only
//! the detachment boundary is a curve, drawn from the margins that the cells carry.

mod axes;
mod bands;
mod bitmap;
mod chart;
mod designs;
mod error;
mod font;
mod format;
mod heading;
mod map;
mod palette;
mod picture;
mod polygons;
mod strokes;
mod svg;
mod ticks;
mod traces;
mod units;

pub use bands::bands;
pub use chart::{Band, Chart, Disc, Dot, Ink, Inset, Line, Note, Plot, Shade, Stroke};
pub use designs::designs;
pub use error::Error;
pub use font::missing_glyphs;
pub use format::Format;
pub use map::{MapOptions, map};
pub use picture::Picture;
pub use traces::{Axis, BranchAxis, CurveAxis, Drawn, Ends, branches, curves, measured, shapes};
