//! Sources of maps: an EXR file, a Zarr store, or a scene whose map is computed. All are read panel by panel.

#[cfg(feature = "zarr")]
use super::ZarrStore;
use super::{ChannelValues, ComputedMap, StoreError, StoredMap, tally};
use crate::plan::Digits;
use crate::scene::{Grid, Scene, SceneError};
use serde_json::Value;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// A map that is open for reading: an EXR file, a Zarr store, or a scene whose map is computed when it is read.
#[derive(Debug)]
#[non_exhaustive]
pub enum MapSource {
    /// The stored map is an EXR file.
    Exr(Box<StoredMap>),
    /// The stored map is a Zarr store.
    #[cfg(feature = "zarr")]
    Zarr(Box<ZarrStore>),
    /// The map is computed when it is read.
    Computed(Box<ComputedMap>),
}

impl From<ComputedMap> for MapSource {
    fn from(map: ComputedMap) -> Self {
        Self::Computed(Box::new(map))
    }
}

impl MapSource {
    /// Opens the EXR map at `path`, or the Zarr store if it is a folder.
    ///
    /// # Errors
    /// The map cannot be read, or this program did not write it.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        #[cfg(feature = "zarr")]
        if path.is_dir() {
            return Ok(Self::Zarr(Box::new(ZarrStore::open(path)?)));
        }
        Ok(Self::Exr(Box::new(StoredMap::open(path)?)))
    }

    /// Returns the title of the scene of the map, one line.
    #[must_use]
    pub fn title(&self) -> &str {
        match self {
            Self::Exr(map) => &map.title,
            #[cfg(feature = "zarr")]
            Self::Zarr(store) => &store.scene.title,
            Self::Computed(map) => &map.scene.title,
        }
    }

    /// Returns the axes of the map: push angles in degrees, distances in mm, and the sweep.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        match self {
            Self::Exr(map) => &map.grid,
            #[cfg(feature = "zarr")]
            Self::Zarr(store) => &store.scene.grid,
            Self::Computed(map) => &map.scene.grid,
        }
    }

    /// Returns the names of all channels of the map, `[channel]`.
    #[must_use]
    pub fn channels(&self) -> Vec<&'static str> {
        match self {
            Self::Exr(map) => map.channels(),
            #[cfg(feature = "zarr")]
            Self::Zarr(store) => store.channels.names().collect(),
            Self::Computed(map) => map.channels(),
        }
    }

    /// Returns the attribute `name` of the map, such as `scene`, `engine` or `tolerances`.
    ///
    /// # Errors
    /// There is no such attribute.
    pub fn attribute(&self, name: &str) -> Result<Value, StoreError> {
        match self {
            Self::Exr(map) => map.attribute(name),
            #[cfg(feature = "zarr")]
            Self::Zarr(store) => store.attribute(name),
            Self::Computed(map) => map.attribute(name),
        }
    }

    /// Returns the scene of the map, or why this version refuses it.
    ///
    /// # Errors
    /// The map or store has no scene.
    pub fn scene(&self) -> Result<Result<Scene, SceneError>, StoreError> {
        let text = self.attribute("scene")?;
        Ok(Scene::parse(text.as_str().unwrap_or_default(), "the scene of the map"))
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
            Self::Computed(_) => Ok(Digits::ALL),
        }
    }

    /// Returns the version that wrote the map, if it is not compatible with this version; otherwise `None`.
    ///
    /// # Errors
    /// There is no such attribute.
    pub fn foreign_version(&self) -> Result<Option<String>, StoreError> {
        let version = self.attribute("whiskmap_version")?;
        let version = version.as_str().unwrap_or_default();
        Ok((!is_compatible(version)).then(|| version.to_owned()))
    }

    /// Returns the names of the codes of `regime` or `status` of the map, by code; `None` for other channels.
    #[must_use]
    pub fn names(&self, channel: &str) -> Option<BTreeMap<u32, String>> {
        let [regimes, statuses] = match self {
            Self::Exr(map) => [map.regime_names.clone(), map.status_names.clone()],
            _ => [tally::regimes(), tally::statuses()].map(|names| {
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

    /// Returns the indices of the whiskers that are not computed yet, as ranges in order, `[range]`: the whiskers of unfinished blocks of a
    /// store.
    ///
    /// # Errors
    /// The file system refuses to look for a file.
    pub fn missing(&self) -> Result<Vec<Range<usize>>, StoreError> {
        match self {
            #[cfg(feature = "zarr")]
            Self::Zarr(store) => store.missing(),
            _ => Ok(Vec::new()),
        }
    }

    /// Reads a channel of one whisker of the map: `[distance][push angle]`.
    ///
    /// # Errors
    /// There is no such channel or whisker, or it is missing or damaged.
    pub fn read_panel(&self, name: &str, whisker: usize) -> Result<ChannelValues, StoreError> {
        self.read_panels(name, whisker..whisker + 1)
    }

    /// Reads a channel of consecutive whiskers of the map: `[whisker][distance][push angle]`.
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
            Self::Computed(map) => {
                let whiskers: Vec<usize> = whiskers.collect();
                map.read(name, &whiskers, &mut |_| {}, &AtomicBool::new(false))
            }
        }
    }

    /// Returns warnings about the whiskers that were computed since the last call, `[warning]`; none about a stored map.
    #[must_use]
    pub fn take_warnings(&self) -> Vec<String> {
        match self {
            Self::Computed(map) => map.take_warnings(),
            _ => Vec::new(),
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
        for (version, shared) in
            [("0.4.1", &["0", "4"][..]), ("1.2.3", &["1"]), ("0.0.3", &["0", "0", "3"])]
        {
            assert_eq!(series(version), shared);
        }
    }
}
