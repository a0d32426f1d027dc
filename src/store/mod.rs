//! The stored map: a multi-part EXR file that is enough to make the map again.
//!
//! A map is written panel by panel and read panel by panel, so neither side's memory grows with the number of
//! whiskers. The file has three parts, `regime`, `state` and `numerics`. Column 0 is the first push angle and row 0
//! the first distance. One whisker fills the image; a sweep of whiskers is an atlas with one tile per whisker, taper
//! along x and curvature along y. Every attribute is ASCII JSON: `axes`, `scene`, `title`, `whiskmap_version`,
//! `engine`, `adapter`, `tolerances`, `regime_names`, `status_names`, `counts` and `panels`.
//!
//! Invariant: a file that bears its final name is complete.

mod attributes;
mod error;
mod header;
mod layout;
mod output;
mod reader;
mod table;
mod tally;
mod unfinished;
mod writer;

pub use attributes::Description;
pub use error::Error;
pub use layout::Layout;
pub use output::Output;
pub use reader::{Samples, StoredMap};
pub use table::Table;
pub use tally::{Counts, Shots};
pub use unfinished::abandon;
pub use writer::MapWriter;

/// The channels of the part `state`, in the order of [`Panel::state`].
pub const STATE_CHANNELS: [&str; 9] = [
    "arc_length_mm",
    "contact_angle_deg",
    "force_un",
    "base_force_x_un",
    "base_force_y_un",
    "base_moment_nnm",
    "push_chord_deg",
    "contact_distance_mm",
    "energy_nj",
];

/// One whisker's map. Every vector has `distances * push_angles` cells; cell `(row, column)` is at
/// `row * push_angles + column`; row 0 is the first distance, column 0 the first push angle.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// [`crate::classify::Regime`] codes.
    pub regime: Vec<u32>,
    /// [`crate::classify::Status`] codes.
    pub status: Vec<u32>,
    /// One vector per name in [`STATE_CHANNELS`]; NaN where there is no contact.
    pub state: [Vec<f32>; STATE_CHANNELS.len()],
    /// Distance of the solution's pole centre from the wanted one, relative to the whisker's length; that of
    /// the last state computed where a cell is unresolved, NaN where there is no contact.
    pub residual: Vec<f32>,
    /// Push angle left until detachment; NaN where there is no contact.
    pub margin_deg: Vec<f32>,
    /// Newton steps taken, engine and refinement together.
    pub newton_steps: Vec<u32>,
}
