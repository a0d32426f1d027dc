//! The Zarr store: a folder that any number of processes fill, block by block.
//!
//! A block is some whiskers of the sweep: one file of each array, whole or not there. Which blocks there are depends on
//! the grid alone, and what is in a block on the scene alone, so it does not matter who computes it, when, or how often.
//!
//! Invariant: what has been computed is stored, fill values too, and the file of the regimes comes last.

mod array;
mod blocks;
mod chunk;
mod kind;
mod metadata;
mod pack;
mod read;

pub use self::pack::PackedPanel;

use self::array::Array;
use self::blocks::Blocks;
use self::metadata::AGREED;
use super::{Channels, Description, Error, Output};
use crate::scene::{Grid, Scene};
use serde_json::{Map, Value};
use std::fs;
use std::io::{self, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A store on disk.
#[derive(Debug)]
pub struct ZarrStore {
    path: PathBuf,
    attributes: Map<String, Value>,
    scene: Scene,
    channels: Channels,
    blocks: Blocks,
    arrays: Vec<Array>,
}

/// The name of every file of metadata.
const METADATA: &str = "zarr.json";

impl ZarrStore {
    /// The store at `path`, there already if it `may_exist`, or yet to [begin](Self::begin). The regimes are always stored.
    ///
    /// # Errors
    ///
    /// The store was begun with another scene, version, engine, accuracy or choice of channels, or it is there although it
    /// must not be.
    pub fn join(
        path: &Path,
        scene: &Scene,
        about: &Description<'_>,
        may_exist: bool,
    ) -> Result<Self, Error> {
        let about = Description {
            channels: about.channels.with("regime"),
            ..*about
        };
        let attributes = metadata::attributes(&about, scene);
        let own = Self::new(path, attributes, scene.clone(), about.channels)?;
        if path.join(METADATA).exists() {
            if !may_exist {
                return Err(Error::Exists(path.to_owned()));
            }
            own.agree_with(&Self::open(path)?)?;
        }
        Ok(own)
    }

    /// Writes what there is before any block, unless it is there, and removes what killed runs have left.
    ///
    /// # Errors
    ///
    /// The store, or one of its folders, cannot be written.
    pub fn begin(&self) -> Result<(), Error> {
        if !self.path.join(METADATA).exists() {
            self.write_metadata()?;
        }
        let folders = self.arrays.iter().map(|array| self.path.join(&array.name));
        for folder in folders.chain([self.path.clone()]) {
            // Whoever begins a file removes what killed runs have left beside it.
            Output::create(&folder.join(METADATA)).map_err(Error::at(&folder, Error::Write))?;
        }
        Ok(())
    }

    /// Opens a store to read it.
    ///
    /// # Errors
    ///
    /// There is none, or it is not one of this program.
    pub fn open(path: &Path) -> Result<Self, Error> {
        let file = path.join(METADATA);
        let text = fs::read(&file).map_err(Error::at(&file, Error::Read))?;
        let foreign =
            |why: &dyn std::fmt::Display| Error::NotAStore(path.to_owned(), why.to_string());
        let mut root: Value = serde_json::from_slice(&text).map_err(|why| foreign(&why))?;
        let Value::Object(attributes) = root["attributes"].take() else {
            return Err(foreign(&"it has no attributes"));
        };
        let text = |name: &str| {
            let value = attributes.get(name).and_then(Value::as_str);
            value.ok_or_else(|| foreign(&format!("there is no text attribute `{name}`")))
        };
        let scene = Scene::parse(text("scene")?, "its scene").map_err(|why| foreign(&why))?;
        let channels = text("channels")?
            .parse()
            .map_err(|why: String| foreign(&why))?;
        Self::new(path, attributes, scene, channels)
    }

    fn new(
        path: &Path,
        attributes: Map<String, Value>,
        scene: Scene,
        channels: Channels,
    ) -> Result<Self, Error> {
        let blocks = Blocks::of(&scene.grid);
        let arrays = metadata::arrays(&scene.grid, &blocks, channels);
        Ok(Self {
            arrays: arrays.map_err(Error::at(path, Error::Pack))?,
            path: path.to_owned(),
            attributes,
            scene,
            channels,
            blocks,
        })
    }

    fn agree_with(&self, there: &Self) -> Result<(), Error> {
        let apart = AGREED
            .iter()
            .find(|name| self.attributes.get(**name) != there.attributes.get(**name));
        let Some(name) = apart else {
            return Ok(());
        };
        let text = |store: &Self| match store.attributes.get(*name) {
            Some(Value::String(text)) => text.clone(),
            Some(value) => value.to_string(),
            None => "nothing".to_owned(),
        };
        let (there, here) = (text(there), text(self));
        let [there, here] = first_difference(&there, &here);
        Err(Error::AtOdds {
            path: self.path.clone(),
            name,
            there,
            here,
        })
    }

    /// Metadata and coordinates; the file that makes it a store comes last.
    fn write_metadata(&self) -> Result<(), Error> {
        let coordinates = metadata::coordinates(&self.scene.grid);
        let coordinates = coordinates.map_err(Error::at(&self.path, Error::Pack))?;
        let json = |value: &Value| value.to_string().into_bytes();
        for (array, values) in coordinates {
            let folder = self.path.join(&array.name);
            write(&folder.join(METADATA), &[json(&array.metadata)])?;
            let file = array
                .encode(values)
                .map_err(Error::at(&folder, Error::Pack))?;
            write(&folder.join(Array::file(&[], 1)), &[file])?;
        }
        for array in &self.arrays {
            let file = self.path.join(&array.name).join(METADATA);
            write(&file, &[json(&array.metadata)])?;
        }
        let coordinates = metadata::coordinates(&self.scene.grid);
        let coordinates = coordinates.map_err(Error::at(&self.path, Error::Pack))?;
        let axes = coordinates.iter().map(|(array, _)| array);
        let root = metadata::group(&self.attributes, axes.chain(&self.arrays));
        write(&self.path.join(METADATA), &[json(&root)])
    }

    /// One line for people.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.scene.title
    }

    /// The axes.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.scene.grid
    }

    /// What is stored of each cell.
    #[must_use]
    pub fn channels(&self) -> Channels {
        self.channels
    }

    /// What the store says of the whole, such as `scene` or `tolerances`.
    ///
    /// # Errors
    ///
    /// There is no such attribute.
    pub fn attribute(&self, name: &str) -> Result<Value, Error> {
        let value = self.attributes.get(name).cloned();
        value.ok_or_else(|| {
            Error::NotAStore(self.path.clone(), format!("there is no attribute `{name}`"))
        })
    }

    /// How many blocks the store of a sweep over `grid` has.
    #[must_use]
    pub fn blocks(grid: &Grid) -> usize {
        Blocks::of(grid).count()
    }

    /// How many blocks there are, done or not.
    #[must_use]
    pub fn block_count(&self) -> usize {
        self.blocks.count()
    }

    /// The whiskers of a block, by their indices in the sweep.
    #[must_use]
    pub fn whiskers(&self, block: usize) -> Range<usize> {
        self.blocks.whiskers(block)
    }

    /// Whether every file of a block is there.
    #[must_use]
    pub fn is_done(&self, block: usize) -> bool {
        let mut files = self.arrays.iter().map(|array| self.file(array, block));
        files.all(|file| file.is_file())
    }

    fn file(&self, array: &Array, block: usize) -> PathBuf {
        let place = self.blocks.place(block);
        let name = Array::file(&place, array.dimensions() - place.len());
        self.path.join(&array.name).join(name)
    }
}

/// Writes a file as a whole, piece by piece, into a folder that is made if need be. It is on the disk before others follow: after
/// a crash, what is there counts as done.
fn write(path: &Path, pieces: &[impl AsRef<[u8]>]) -> Result<(), Error> {
    let done = || -> io::Result<()> {
        path.parent().map_or(Ok(()), fs::create_dir_all)?;
        let mut output = Output::create(path)?;
        let mut pieces = pieces.iter();
        pieces.try_for_each(|piece| output.write_all(piece.as_ref()))?;
        output.finish_durably()
    };
    done().map_err(Error::at(path, Error::Write))
}

/// The first lines in which two texts differ.
fn first_difference(one: &str, other: &str) -> [String; 2] {
    let mut lines = [one.lines(), other.lines()];
    let mut number = 0;
    loop {
        number += 1;
        let [one, other] = lines.each_mut().map(Iterator::next);
        if one != other || one.is_none() {
            let shown = |line: Option<&str>| match (line, number) {
                (None, _) => "nothing more".to_owned(),
                (Some(line), 1) => line.to_owned(),
                (Some(line), _) => format!("`{line}` in line {number}"),
            };
            return [one, other].map(shown);
        }
    }
}
