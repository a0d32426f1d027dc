//! The Zarr store: a folder that several processes fill, block by block.
//!
//! A block is some whiskers of the sweep, and one file of each array. The blocks depend on the grid alone, and their bytes on the
//! scene and settings, so any process may compute any block, once or again.
//!
//! Every file of a block begins with a hash of the store's identity, so that no reader accepts a block of other settings.
//!
//! Invariant: a computed block is stored with its fill values, and its file of the regimes is written last.

mod array;
mod blocks;
mod blosc;
mod channels;
mod encoding;
mod files;
mod identity;
mod metadata;
mod pack;
mod planes;
mod read;
mod shard;
mod verification;

pub use self::channels::channel_attributes;
pub use self::metadata::{AxisCoordinate, coordinates};
pub use self::pack::PackedPanel;
pub use self::verification::{BlockState, CheckDepth};

use self::array::ZarrArray;
use self::blocks::Blocks;
use self::identity::StoreIdentity;
use super::attributes::DIGITS;
use super::stored::is_compatible;
use super::{MapDescription, StoreError};
use crate::plan::{Channels, Digits};
use crate::scene::{Grid, Scene};
use serde_json::{Map, Value};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Zarr store of a map on disk.
#[derive(Debug)]
#[non_exhaustive]
pub struct ZarrStore {
    /// Scene with which the store was created.
    pub scene: Scene,
    /// Channels of the map that are stored.
    pub channels: Channels,
    /// Digits to which the channels of the store are rounded.
    pub digits: Digits,
    path: PathBuf,
    attributes: Map<String, Value>,
    identity: StoreIdentity,
    /// True if the store may exist when it is begun.
    may_exist: bool,
    blocks: Blocks,
    arrays: Vec<ZarrArray>,
}

/// Name of a metadata file.
const METADATA: &str = "zarr.json";

impl ZarrStore {
    /// Joins the store at `path`, which [`begin`](Self::begin) creates; it exists already only if it `may_exist`. Regimes are always
    /// stored.
    ///
    /// # Errors
    /// The store was created with another scene, version, engine, accuracy, channels or digits, or it exists although it must
    /// not.
    pub fn join(
        path: &Path,
        scene: &Scene,
        about: &MapDescription<'_>,
        may_exist: bool,
    ) -> Result<Self, StoreError> {
        let about = MapDescription { channels: about.channels.with("regime"), ..*about };
        let attributes = metadata::attributes(&about, scene);
        let store = Self {
            may_exist,
            ..Self::new(path, attributes, scene.clone(), (about.channels, about.digits))
        };
        store.agree()?;
        Ok(store)
    }

    /// Returns true if there is a Zarr store at `path`, of this program or another one.
    #[must_use]
    pub fn is_at(path: &Path) -> bool {
        path.join(METADATA).exists()
    }

    /// Opens a store to read it.
    ///
    /// # Errors
    /// There is no store, another program wrote it, or its metadata are damaged.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let attributes = files::attributes(path)?;
        let foreign =
            |why: &dyn std::fmt::Display| StoreError::NotAStore(path.to_owned(), why.to_string());
        let text = |name: &str| {
            let value = attributes.get(name).and_then(Value::as_str);
            value.ok_or_else(|| foreign(&format!("there is no text attribute `{name}`")))
        };
        let version = text("whiskmap_version")?;
        if !is_compatible(version) {
            return Err(StoreError::OtherVersion(path.to_owned(), version.to_owned()));
        }
        if text(identity::IDENTITY)? != StoreIdentity::of(&attributes).text() {
            let names = identity::AGREED.join(", ");
            let why = format!(
                "its `identity` does not fit its attributes {names}: one of them was changed"
            );
            return Err(StoreError::Damaged(path.join(METADATA), why));
        }
        let scene = Scene::parse(text("scene")?, "its scene").map_err(|why| foreign(&why))?;
        let channels = text("channels")?.parse().map_err(|why: String| foreign(&why))?;
        let digits = match attributes.get(DIGITS) {
            None => Digits::ALL,
            Some(_) => text(DIGITS)?.parse().map_err(|why: String| foreign(&why))?,
        };
        let attributes = metadata::completed(&attributes, &scene.title);
        Ok(Self::new(path, attributes, scene, (channels, digits)))
    }

    fn new(
        path: &Path,
        attributes: Map<String, Value>,
        scene: Scene,
        (channels, digits): (Channels, Digits),
    ) -> Self {
        let digits = digits.of(channels);
        let blocks = Blocks::of(&scene.grid);
        Self {
            arrays: metadata::arrays(&scene.grid, &blocks, (channels, digits)),
            path: path.to_owned(),
            identity: StoreIdentity::of(&attributes),
            may_exist: true,
            attributes,
            scene,
            channels,
            digits,
            blocks,
        }
    }

    /// Returns the attribute `name` of the store, such as `scene` or `tolerances`.
    ///
    /// # Errors
    /// There is no such attribute.
    pub fn attribute(&self, name: &str) -> Result<Value, StoreError> {
        let value = self.attributes.get(name).cloned();
        value.ok_or_else(|| {
            StoreError::NotAStore(self.path.clone(), format!("there is no attribute `{name}`"))
        })
    }

    /// Returns the indices in the sweep of the whiskers of each block of a store of a sweep over `grid`, `[block]`.
    #[must_use]
    pub fn blocks(grid: &Grid) -> impl ExactSizeIterator<Item = Range<usize>> + use<> {
        let blocks = Blocks::of(grid);
        (0..blocks.count()).map(move |block| blocks.whiskers(block))
    }

    /// Returns the number of blocks of the store, done or not.
    #[must_use]
    pub fn block_count(&self) -> usize {
        self.blocks.count()
    }

    /// Returns the indices in the sweep of the whiskers of a block.
    #[must_use]
    pub fn whiskers(&self, block: usize) -> Range<usize> {
        self.blocks.whiskers(block)
    }

    fn file(&self, array: &ZarrArray, block: usize) -> PathBuf {
        let place = self.blocks.place(block);
        let name = ZarrArray::file(&place, array.dimensions - place.len());
        self.path.join(&array.name).join(name)
    }
}
