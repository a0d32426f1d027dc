//! What is at a path, a map or a store: both are read panel by panel.

use super::{Error, Samples, StoredMap, ZarrStore};
use crate::scene::Grid;
use serde_json::Value;
use std::path::Path;

/// A map or a store.
#[derive(Debug)]
pub enum Stored {
    /// An EXR file.
    Exr(Box<StoredMap>),
    /// A Zarr store.
    Zarr(Box<ZarrStore>),
}

impl Stored {
    /// Opens what is at `path`; a folder is a store.
    ///
    /// # Errors
    ///
    /// It cannot be read, or is not of this program.
    pub fn open(path: &Path) -> Result<Self, Error> {
        Ok(if path.is_dir() {
            Self::Zarr(Box::new(ZarrStore::open(path)?))
        } else {
            Self::Exr(Box::new(StoredMap::open(path)?))
        })
    }

    /// One line for people.
    #[must_use]
    pub fn title(&self) -> &str {
        match self {
            Self::Exr(map) => &map.title,
            Self::Zarr(store) => store.title(),
        }
    }

    /// The axes.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        match self {
            Self::Exr(map) => &map.grid,
            Self::Zarr(store) => store.grid(),
        }
    }

    /// The names of all channels.
    #[must_use]
    pub fn channels(&self) -> Vec<&'static str> {
        match self {
            Self::Exr(map) => map.channels(),
            Self::Zarr(store) => store.channels().names().collect(),
        }
    }

    /// What both say of the whole, such as `scene`, `engine` and `tolerances`.
    ///
    /// # Errors
    ///
    /// There is no such attribute.
    pub fn attribute(&self, name: &str) -> Result<Value, Error> {
        match self {
            Self::Exr(map) => map.attribute(name),
            Self::Zarr(store) => store.attribute(name),
        }
    }

    /// A channel of one whisker: `[distance][push angle]`.
    ///
    /// # Errors
    ///
    /// There is no such channel or whisker, or it is missing or damaged.
    pub fn read_panel(&self, name: &str, whisker: usize) -> Result<Samples, Error> {
        match self {
            Self::Exr(map) => map.read_panel(name, whisker),
            Self::Zarr(store) => store.read_panel(name, whisker),
        }
    }
}
