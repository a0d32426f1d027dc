//! The Zarr store: a folder that any number of processes fill, block by block.
//!
//! A block is some whiskers of the sweep: one file of each array, whole or not there. Which blocks there are depends on
//! the grid alone, and what is in a block on the scene alone, so it does not matter who computes it, when, or how often.
//!
//! Invariant: what has been computed is stored, fill values too, and the file of the regimes comes last.

mod array;
mod blocks;
mod metadata;

use self::array::Array;
use self::blocks::Blocks;
use self::metadata::{AGREED, CELLS};
use super::{Channels, Description, Error, Output, Panel, STATE_CHANNELS, Samples};
use crate::classify::Regime;
use crate::scene::{Grid, Scene};
use rayon::prelude::*;
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
    /// Begins the store at `path`, or joins the one that is there if it `may_exist`. The regimes are always stored.
    ///
    /// # Errors
    ///
    /// The store was begun with another scene, version, engine, accuracy or choice of channels; it is there although it
    /// must not be; or one of its folders cannot be written.
    pub fn begin(
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
        } else {
            own.write_metadata()?;
        }
        let folders = own.arrays.iter().map(|array| path.join(&array.name));
        for folder in folders.chain([path.to_owned()]) {
            // Whoever begins a file removes what killed runs have left beside it.
            Output::create(&folder.join(METADATA)).map_err(Error::at(&folder, Error::Write))?;
        }
        Ok(own)
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
            write(&folder.join(METADATA), &json(&array.metadata))?;
            let file = array
                .encode(values)
                .map_err(Error::at(&folder, Error::Pack))?;
            write(&folder.join(Array::file(&[], 1)), &file)?;
        }
        for array in &self.arrays {
            let file = self.path.join(&array.name).join(METADATA);
            write(&file, &json(&array.metadata))?;
        }
        let coordinates = metadata::coordinates(&self.scene.grid);
        let coordinates = coordinates.map_err(Error::at(&self.path, Error::Pack))?;
        let axes = coordinates.iter().map(|(array, _)| array);
        let root = metadata::group(&self.attributes, axes.chain(&self.arrays));
        write(&self.path.join(METADATA), &json(&root))
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

    /// Writes the panels of a block.
    ///
    /// # Errors
    ///
    /// The disk is full, or the folder is not writable.
    pub fn write(&self, block: usize, panels: &[Panel]) -> Result<(), Error> {
        let (last, others) = self.arrays.split_last().unzip();
        let others = others.unwrap_or_default();
        let put = |array: &Array| {
            let file = self.file(array, block);
            let values = self.gathered(array, block, panels);
            let bytes = array
                .encode(values)
                .map_err(Error::at(&file, Error::Pack))?;
            write(&file, &bytes)
        };
        others.par_iter().try_for_each(put)?;
        last.map_or(Ok(()), put)
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

    /// The values of a block's file, from the panels of its whiskers.
    fn gathered(&self, array: &Array, block: usize, panels: &[Panel]) -> Vec<u8> {
        let mut bytes = array.kind.fill_bytes().repeat(array.values());
        let (_, room) = self.sizes(array);
        for (index, panel) in panels.iter().enumerate() {
            let first = self.blocks.slot(block, index) * room;
            let values = values(&array.name, panel);
            bytes[first..first + values.len()].copy_from_slice(&values);
        }
        bytes
    }
}

/// What a panel holds for an array, as bytes.
fn values(name: &str, panel: &Panel) -> Vec<u8> {
    let codes = |codes: &[u32]| codes.iter().map(|code| *code as u8).collect();
    let state = STATE_CHANNELS.iter().position(|own| *own == name);
    match (name, state) {
        (_, Some(place)) => bytemuck::cast_slice(&panel.state[place]).to_vec(),
        ("regime", _) => codes(&panel.regime),
        ("status", _) => codes(&panel.status),
        ("newton_steps", _) => bytemuck::cast_slice(&panel.newton_steps).to_vec(),
        ("residual", _) => bytemuck::cast_slice(&panel.residual).to_vec(),
        ("margin_deg", _) => bytemuck::cast_slice(&panel.margin_deg).to_vec(),
        _ => {
            let count = |regime: Regime| {
                let codes = panel.regime.iter();
                codes.filter(|code| **code == regime.code()).count() as u32
            };
            bytemuck::cast_slice(&Regime::ALL.map(count)).to_vec()
        }
    }
}

/// Writes a file as a whole, into a folder that is made if need be. It is on the disk before others follow: after a crash, what
/// is there counts as done.
fn write(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let done = || -> io::Result<()> {
        path.parent().map_or(Ok(()), fs::create_dir_all)?;
        let mut output = Output::create(path)?;
        output.write_all(bytes)?;
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
