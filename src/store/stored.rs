//! What is at a path, a map or a store: both are read panel by panel.

use super::{Error, Samples, StoredMap};
#[cfg(feature = "zarr")]
use super::{ZarrStore, tally};
use crate::scene::Grid;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// A map or a store.
#[derive(Debug)]
pub enum Stored {
    /// An EXR file.
    Exr(Box<StoredMap>),
    /// A Zarr store.
    #[cfg(feature = "zarr")]
    Zarr(Box<ZarrStore>),
}

impl Stored {
    /// Opens what is at `path`; a folder is a store.
    ///
    /// # Errors
    ///
    /// It cannot be read, or is not of this program.
    pub fn open(path: &Path) -> Result<Self, Error> {
        #[cfg(feature = "zarr")]
        if path.is_dir() {
            return Ok(Self::Zarr(Box::new(ZarrStore::open(path)?)));
        }
        Ok(Self::Exr(Box::new(StoredMap::open(path)?)))
    }

    /// One line for people.
    #[must_use]
    pub fn title(&self) -> &str {
        match self {
            Self::Exr(map) => &map.title,
            #[cfg(feature = "zarr")]
            Self::Zarr(store) => store.title(),
        }
    }

    /// The axes.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        match self {
            Self::Exr(map) => &map.grid,
            #[cfg(feature = "zarr")]
            Self::Zarr(store) => store.grid(),
        }
    }

    /// The names of all channels.
    #[must_use]
    pub fn channels(&self) -> Vec<&'static str> {
        match self {
            Self::Exr(map) => map.channels(),
            #[cfg(feature = "zarr")]
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
            #[cfg(feature = "zarr")]
            Self::Zarr(store) => store.attribute(name),
        }
    }

    /// The version of the program that wrote it, if that is not compatible with this one.
    ///
    /// # Errors
    ///
    /// It does not say.
    pub fn foreign_version(&self) -> Result<Option<String>, Error> {
        let version = self.attribute("whiskmap_version")?;
        let version = version.as_str().unwrap_or_default();
        Ok((!is_compatible(version)).then(|| version.to_owned()))
    }

    /// The names of the codes of a channel that is made of codes.
    #[must_use]
    pub fn names(&self, channel: &str) -> Option<BTreeMap<u32, String>> {
        let [regimes, statuses] = match self {
            Self::Exr(map) => [map.regime_names.clone(), map.status_names.clone()],
            #[cfg(feature = "zarr")]
            Self::Zarr(_) => [tally::regimes(), tally::statuses()].map(|names| {
                let names = names.into_iter();
                names.map(|(code, name)| (code, name.to_owned())).collect()
            }),
        };
        match channel {
            "regime" => Some(regimes),
            "status" => Some(statuses),
            _ => None,
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
            #[cfg(feature = "zarr")]
            Self::Zarr(store) => store.read_panel(name, whisker),
        }
    }
}

/// Whether a map of this version of the program is one of this version's format.
pub(super) fn is_compatible(version: &str) -> bool {
    series(version) == series(env!("CARGO_PKG_VERSION"))
}

/// What compatible versions have in common: the numbers up to the first that is not 0.
fn series(version: &str) -> Vec<&str> {
    let zeros = version.split('.').take_while(|number| *number == "0");
    let length = zeros.count() + 1;
    version.split('.').take(length).collect()
}
