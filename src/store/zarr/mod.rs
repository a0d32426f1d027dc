//! The Zarr store: a folder that any number of processes fill, block by block.
//!
//! A block is some whiskers of the sweep: one file of each array, whole or not there. Which blocks there are depends on
//! the grid alone, and what is in a block on the scene alone, so it does not matter who computes it, when, or how often.
//!
//! Invariant: what has been computed is stored, fill values too, and the file of the regimes comes last.

mod array;
mod blocks;
mod chunk;
mod metadata;

use self::array::Array;
use self::blocks::Blocks;
use self::metadata::{AGREED, CELLS};
use super::effort::Effort;
use super::{Channels, Description, Error, Output, Packed, Panel, STATE_CHANNELS, Samples};
use crate::classify::Regime;
use crate::scene::{Grid, Scene};
use rayon::prelude::*;
use serde_json::{Map, Value};
use std::borrow::Cow;
use std::fs;
use std::io::{self, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A store on disk.
#[derive(Debug)]
pub struct ZarrStore {
    path: PathBuf,
    attributes: Map<String, Value>,
    scene: Scene,
    channels: Channels,
    blocks: Blocks,
    arrays: Vec<Array>,
    effort: Effort,
}

/// A panel on its way to a store: its chunks, array by array.
#[derive(Debug)]
pub struct PackedPanel(Vec<Vec<Vec<u8>>>);

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
            effort: Effort::default(),
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

    /// Packs a panel.
    ///
    /// # Errors
    ///
    /// The codecs refuse.
    pub fn pack(&self, panel: &Panel) -> Result<PackedPanel, Error> {
        let chunks = |array: &Array| {
            let chunks = || array.chunks(&values(&array.name, panel));
            let packed = self.effort.of(chunks);
            packed.map_err(Error::at(&self.path.join(&array.name), Error::Pack))
        };
        let arrays = self.arrays.par_iter().map(chunks);
        arrays.collect::<Result<_, _>>().map(PackedPanel)
    }

    /// Packs `panels` of `scene`, and tells what that takes.
    ///
    /// # Errors
    ///
    /// The codecs refuse.
    pub fn sample(scene: &Scene, channels: Channels, panels: &[Panel]) -> Result<Packed, Error> {
        let (nowhere, channels) = (Path::new(""), channels.with("regime"));
        let store = Self::new(nowhere, Map::new(), scene.clone(), channels)?;
        let packed = panels.iter().map(|panel| store.pack(panel));
        let packed: Vec<PackedPanel> = packed.collect::<Result<_, _>>()?;
        let chunks = packed.iter().flat_map(|panel| &panel.0).flatten();
        Ok(Packed {
            bytes: chunks.map(|chunk| chunk.len() as u64).sum(),
            time: store.packing(),
        })
    }

    /// CPU time spent on packing so far.
    #[must_use]
    pub fn packing(&self) -> Duration {
        self.effort.time()
    }

    /// Writes the panels of a block.
    ///
    /// # Errors
    ///
    /// The disk is full, or the folder is not writable.
    pub fn write(&self, block: usize, panels: &[PackedPanel]) -> Result<(), Error> {
        let put = |(index, array): (usize, &Array)| {
            let file = self.file(array, block);
            let room = self.blocks.slots();
            let missing = if panels.len() < room {
                array.empty(array.values() / room)
            } else {
                Ok(Vec::new())
            };
            let missing = missing.map_err(Error::at(&file, Error::Pack))?;
            let mut slots = vec![&missing; room];
            for (place, panel) in panels.iter().enumerate() {
                slots[self.blocks.slot(block, place)] = &panel.0[index];
            }
            let chunks = slots.into_iter().flatten().map(Vec::as_slice);
            write(&file, &chunk::file(chunks))
        };
        let last = self.arrays.len() - 1;
        let others = self.arrays[..last].par_iter().enumerate();
        others.try_for_each(put)?;
        put((last, &self.arrays[last]))
    }

    /// How many cells of a block there are of each regime.
    ///
    /// # Errors
    ///
    /// The block is not there, or damaged.
    pub fn regimes(&self, block: usize) -> Result<[u64; Regime::ALL.len()], Error> {
        let mut regimes = [0; Regime::ALL.len()];
        for array in self.arrays.iter().filter(|array| array.name == CELLS) {
            let values: Vec<u32> = bytemuck::pod_collect_to_vec(&self.read(array, block)?);
            for of_whisker in values.chunks(regimes.len()) {
                for (sum, cells) in regimes.iter_mut().zip(of_whisker) {
                    *sum += u64::from(*cells);
                }
            }
        }
        Ok(regimes)
    }

    /// Reads all of a block, and tells what is wrong with it.
    #[must_use]
    pub fn verify(&self, block: usize) -> Vec<Error> {
        let read = self.arrays.par_iter().map(|array| self.read(array, block));
        read.filter_map(Result::err).collect()
    }

    /// A channel of one whisker: `[distance][push angle]`.
    ///
    /// # Errors
    ///
    /// There is no such channel, or the whisker's block is missing or damaged.
    pub fn read_panel(&self, name: &str, whisker: usize) -> Result<Samples, Error> {
        let array = self
            .arrays
            .iter()
            .find(|array| array.name == name && name != CELLS);
        let array = array.ok_or_else(|| Error::UnknownChannel {
            path: self.path.clone(),
            name: name.to_owned(),
            known: self.channels.to_string(),
        })?;
        let (block, index) = self.blocks.find(whisker);
        let bytes = self.read(array, block)?;
        let (panel, room) = self.sizes(array);
        let first = self.blocks.slot(block, index) * room;
        let bytes = &bytes[first..first + panel];
        Ok(match array.kind {
            array::Kind::Code => Samples::U32(bytes.iter().map(|code| u32::from(*code)).collect()),
            array::Kind::Count => Samples::U32(bytemuck::pod_collect_to_vec(bytes)),
            _ => Samples::F32(bytemuck::pod_collect_to_vec(bytes)),
        })
    }

    fn file(&self, array: &Array, block: usize) -> PathBuf {
        let place = self.blocks.place(block);
        let name = Array::file(&place, array.dimensions() - place.len());
        self.path.join(&array.name).join(name)
    }

    fn read(&self, array: &Array, block: usize) -> Result<Vec<u8>, Error> {
        let file = self.file(array, block);
        let bytes = fs::read(&file).map_err(|why| match why.kind() {
            io::ErrorKind::NotFound => Error::NotComputed(file.clone()),
            _ => Error::Read(file.clone(), why),
        })?;
        let values = array
            .decode(bytes)
            .map_err(Error::at(&file, Error::Damaged))?;
        if values.len() == array.values() * array.kind.size() {
            Ok(values)
        } else {
            Err(Error::Damaged(file, "it has the wrong length".to_owned()))
        }
    }

    /// Bytes of a whisker's values in a block, and of the room there.
    fn sizes(&self, array: &Array) -> (usize, usize) {
        let room = array.values() / self.blocks.slots();
        let [distances, push_angles] = self.blocks.panel();
        let values = if array.name == CELLS {
            room
        } else {
            distances * push_angles
        };
        (values * array.kind.size(), room * array.kind.size())
    }
}

/// What a panel holds for an array, as bytes.
fn values<'a>(name: &str, panel: &'a Panel) -> Cow<'a, [u8]> {
    let codes = |codes: &[u32]| codes.iter().map(|code| *code as u8).collect();
    let state = STATE_CHANNELS.iter().position(|own| *own == name);
    match (name, state) {
        (_, Some(place)) => bytemuck::cast_slice(&panel.state[place]).into(),
        ("regime", _) => codes(&panel.regime),
        ("status", _) => codes(&panel.status),
        ("newton_steps", _) => bytemuck::cast_slice(&panel.newton_steps).into(),
        ("residual", _) => bytemuck::cast_slice(&panel.residual).into(),
        ("margin_deg", _) => bytemuck::cast_slice(&panel.margin_deg).into(),
        _ => {
            let count = |regime: Regime| {
                let codes = panel.regime.iter();
                codes.filter(|code| **code == regime.code()).count() as u32
            };
            bytemuck::pod_collect_to_vec(&Regime::ALL.map(count)).into()
        }
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
