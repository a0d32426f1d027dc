//! Stored maps: an EXR file or a Zarr store, both read panel by panel.

use super::{ChannelValues, StoreError, StoredMap};
#[cfg(feature = "zarr")]
use super::{ZarrStore, tally};
use crate::plan::Digits;
use crate::scene::{Grid, Scene, SceneError};
use serde_json::Value;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

/// A stored map that is open for reading: an EXR file or a Zarr store.
#[derive(Debug)]
#[non_exhaustive]
pub enum MapSource {
    /// The stored map is an EXR file.
    Exr(Box<StoredMap>),
    /// The stored map is a Zarr store.
    #[cfg(feature = "zarr")]
    Zarr(Box<ZarrStore>),
}

impl MapSource {
    /// Opens the EXR map at `path`, or the Zarr store if it is a folder.
    ///
    /// # Errors
    /// It cannot be read, or this program did not write it.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        #[cfg(feature = "zarr")]
        if path.is_dir() {
            return Ok(Self::Zarr(Box::new(ZarrStore::open(path)?)));
        }
        Ok(Self::Exr(Box::new(StoredMap::open(path)?)))
    }

    /// Returns the title of the scene of the stored map, one line.
    #[must_use]
    pub fn title(&self) -> &str {
        match self {
            Self::Exr(map) => &map.title,
            #[cfg(feature = "zarr")]
            Self::Zarr(store) => &store.scene.title,
        }
    }

    /// Returns the axes of the stored map: push angles in degrees, distances in mm, and the sweep.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        match self {
            Self::Exr(map) => &map.grid,
            #[cfg(feature = "zarr")]
            Self::Zarr(store) => &store.scene.grid,
        }
    }

    /// Returns the names of all channels of the stored map, `[channel]`.
    #[must_use]
    pub fn channels(&self) -> Vec<&'static str> {
        match self {
            Self::Exr(map) => map.channels(),
            #[cfg(feature = "zarr")]
            Self::Zarr(store) => store.channels.names().collect(),
        }
    }

    /// Returns the attribute `name` of the stored map, such as `scene`, `engine` or `tolerances`.
    ///
    /// # Errors
    /// There is no such attribute.
    pub fn attribute(&self, name: &str) -> Result<Value, StoreError> {
        match self {
            Self::Exr(map) => map.attribute(name),
            #[cfg(feature = "zarr")]
            Self::Zarr(store) => store.attribute(name),
        }
    }

    /// Returns the scene of the stored map, or why this version refuses it.
    ///
    /// # Errors
    /// The map or store has no scene.
    pub fn scene(&self) -> Result<Result<Scene, SceneError>, StoreError> {
        let text = self.attribute("scene")?;
        Ok(Scene::parse(
            text.as_str().unwrap_or_default(),
            "the scene of the map",
        ))
    }

    /// Returns the digits to which the channels of the map are rounded.
    ///
    /// # Errors
    /// The attribute is damaged.
    pub fn digits(&self) -> Result<Digits, StoreError> {
        match self {
            Self::Exr(map) => map.digits(),
            #[cfg(feature = "zarr")]
            Self::Zarr(store) => Ok(store.digits),
        }
    }

    /// Returns the version that wrote the stored map, if it is not compatible with this version; otherwise `None`.
    ///
    /// # Errors
    /// There is no such attribute.
    pub fn foreign_version(&self) -> Result<Option<String>, StoreError> {
        let version = self.attribute("whiskmap_version")?;
        let version = version.as_str().unwrap_or_default();
        Ok((!is_compatible(version)).then(|| version.to_owned()))
    }

    /// Returns the names of the codes of `regime` or `status` of the stored map, by code; `None` for other channels.
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

    /// Returns the indices of the whiskers that are not computed yet, as ranges in order, `[range]`: those of unfinished blocks of a store.
    ///
    /// # Errors
    /// The file system refuses to look for a file.
    pub fn missing(&self) -> Result<Vec<Range<usize>>, StoreError> {
        match self {
            Self::Exr(_) => Ok(Vec::new()),
            #[cfg(feature = "zarr")]
            Self::Zarr(store) => store.missing(),
        }
    }

    /// Reads a channel of one whisker of the stored map: `[distance][push angle]`.
    ///
    /// # Errors
    /// There is no such channel or whisker, or it is missing or damaged.
    pub fn read_panel(&self, name: &str, whisker: usize) -> Result<ChannelValues, StoreError> {
        self.read_panels(name, whisker..whisker + 1)
    }

    /// Reads a channel of consecutive whiskers of the stored map: `[whisker][distance][push angle]`.
    ///
    /// # Errors
    /// There is no such channel or whisker, or it is missing or damaged.
    pub fn read_panels(
        &self,
        name: &str,
        whiskers: Range<usize>,
    ) -> Result<ChannelValues, StoreError> {
        match self {
            Self::Exr(map) => map.read_panels(name, whiskers),
            #[cfg(feature = "zarr")]
            Self::Zarr(store) => store.read_panels(name, whiskers),
        }
    }
}

/// Returns true if a file of `version` has this version's format.
pub(super) fn is_compatible(version: &str) -> bool {
    series(version) == series(env!("CARGO_PKG_VERSION"))
}

/// The numbers that compatible versions share: those up to the first that is not 0.
fn series(version: &str) -> Vec<&str> {
    let zeros = version.split('.').take_while(|number| *number == "0");
    let length = zeros.count() + 1;
    version.split('.').take(length).collect()
}

#[cfg(test)]
mod tests {
    use super::series;

    #[test]
    fn versions_are_compatible_up_to_the_first_number_that_is_not_0() {
        for (version, shared) in [
            ("0.4.1", &["0", "4"][..]),
            ("1.2.3", &["1"]),
            ("0.0.3", &["0", "0", "3"]),
        ] {
            assert_eq!(series(version), shared);
        }
    }
}
