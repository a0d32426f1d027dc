//! Pictures of maps, curves, branches, shapes and designs, drawn by the crate [`whiskmap_plot`].
//!
//! This module turns stored maps into heat maps and computed rows into plots: it chooses titles, labels, names and colours. Maps
//! are read panel by panel.

mod boundary;
mod courses;
mod labels;
mod map;
mod marks;
mod options;
mod overlays;
mod plots;
mod row;
mod sensitivities;
mod shared;
mod textures;

pub use courses::{courses, forces};
pub use labels::{
    DISTANCE, END_CHORD, END_FORCE, END_MOMENT, END_PUSH, PUSH_ANGLE, axis_title, column_label,
    end_title, regions,
};
pub use map::{map, regime_fill};
pub use options::MapOptions;
pub use overlays::{bands, error_bars, measured};
pub use plots::{
    BranchAxis, CurveAxis, DrawnBranch, DrawnCurve, DrawnShape, PlotAxis, branches, contacts,
    curves, designs, shapes, yielding_ends,
};
pub use sensitivities::sensitivities;
pub use shared::shared_states;
pub use textures::{STUCK, TIP, textures, tip_histogram, tip_lines};
pub use whiskmap_plot::{
    Band, Chart, Disc, Dot, EncodeError, Fill, Ink, Inset, Line, Note, Picture, PictureFormat,
    PictureSize, Plot, PrintSize, Region, SizeError, Stroke,
};

use crate::store;
use whiskmap_plot::ScaleError;

/// Error of a picture that cannot be drawn. Every message is complete; there is no chain of sources to print.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The stored map lacks the channel that is to be drawn, or it is damaged.
    #[error(transparent)]
    Store(#[from] store::StoreError),
    /// The channel cannot have the requested colour scale.
    #[error("colour scale of `{channel}`: {cause}")]
    Scale {
        /// Name of the channel with the impossible colour scale.
        channel: String,
        /// Fault of the colour scale: what is wrong, and what is allowed.
        cause: ScaleError,
    },
    /// The picture has no room in its size on paper.
    #[error("the picture is {0}")]
    Size(#[from] SizeError),
    /// A colour scale is requested for a channel of codes.
    #[error(
        "colour scale of `{0}`: the channel is made of codes; choose a channel of quantities, such as force_un"
    )]
    Codes(String),
    /// The map has more than two sweep axes, with these names.
    #[error(
        "a picture has room for two sweep axes, there are {0}; choose a value of each other one by --at"
    )]
    TooManyAxes(String),
}
