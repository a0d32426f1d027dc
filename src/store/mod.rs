//! Files: maps as EXR, sweeps as Zarr stores, tables as CSV. Slices of maps that are stored, or computed when they are read.
//!
//! An EXR map is written and read panel by panel, so its memory does not grow with the number of whiskers. It has three parts:
//! `regime`, `state` and `numerics`. Column 0 is the first push angle and row 0 the first distance. A sweep of whiskers is an atlas
//! with one tile per whisker, the first sweep axis along x and the second along y. Every attribute is ASCII JSON: `axes`, `scene`,
//! `title`, `whiskmap_version`, `engine`, `adapter`, `arithmetic`, `tolerances`, `regime_names`, `status_names`, `counts`, `panels`
//! and `checksum`. They are enough to compute the map again.
//!
//! A Zarr store is a folder that several processes fill.
//!
//! Invariant: a file with its final name is complete.

mod at;
mod attributes;
mod chunk;
mod computed;
mod error;
mod header;
mod layout;
mod output;
mod reader;
mod slice;
mod stored;
mod table;
mod tally;
mod temporary;
mod writer;
#[cfg(feature = "zarr")]
mod zarr;
mod zip;

pub use at::{AxisValue, ChosenValues, InvalidAxisValue, scene_at};
pub use attributes::MapDescription;
pub use computed::ComputedMap;
pub use error::StoreError;
pub use layout::AtlasLayout;
pub use output::{Output, resolved};
pub use reader::{ChannelValues, StoredMap};
pub use slice::{GridPart, MapSlice};
pub use stored::MapSource;
pub use table::TableFile;
pub use tally::{CellCounts, NOT_COMPUTED};
pub use temporary::TemporaryFiles;
#[cfg(feature = "zarr")]
pub use temporary::TemporaryFolder;
pub use writer::MapWriter;
#[cfg(feature = "zarr")]
pub use zarr::{
    AxisCoordinate, BlockState, CheckDepth, PackedPanel, ZarrStore, channel_attributes, coordinates,
};
