//! Reader of EXR maps, which reads one channel of a panel at a time.

use super::attributes::{self, DIGITS};
use super::layout::{self, AtlasLayout, SAMPLE_BYTES};
use super::{CellCounts, StoreError, header};
use crate::input::open_regular;
use crate::plan::Channels;
use crate::plan::Digits;
use crate::scene::Grid;
use exr::block::UncompressedBlock;
use exr::block::chunk::Chunk;
use exr::meta::attribute::SampleType;
use exr::meta::{MetaData, OffsetTables};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::{self, BufReader, Seek, SeekFrom};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Values of a channel: `[distance][push_angle]` of one panel, or of several panels one after the other.
#[derive(Clone, Debug, PartialEq)]
pub enum ChannelValues {
    /// Quantities of a channel in map units, `[cell]`; NaN where there is none.
    F32(Vec<f32>),
    /// Codes or counts of a channel, `[cell]`.
    U32(Vec<u32>),
}

impl ChannelValues {
    /// Returns the values of the channel `name` whose samples these `bytes` are.
    pub(super) fn of_bytes(name: &str, bytes: &[u8]) -> Self {
        match layout::sample_type(name) {
            SampleType::U32 => Self::U32(bytemuck::pod_collect_to_vec(bytes)),
            _ => Self::F32(bytemuck::pod_collect_to_vec(bytes)),
        }
    }

    /// Returns the channel's value of the cell with this index; a code or a count as a whole number.
    #[must_use]
    pub fn value(&self, cell: usize) -> f64 {
        match self {
            Self::F32(values) => f64::from(values[cell]),
            Self::U32(values) => f64::from(values[cell]),
        }
    }

    /// Returns all values of the channel in the order of the cells; a code or a count as a whole number.
    pub fn values(&self) -> impl Iterator<Item = f64> + '_ {
        let cells = match self {
            Self::F32(values) => values.len(),
            Self::U32(values) => values.len(),
        };
        (0..cells).map(|cell| self.value(cell))
    }
}

/// An EXR map on disk whose header is read and checked. It stays open: a file that replaces it meanwhile is not read.
#[derive(Debug)]
#[non_exhaustive]
pub struct StoredMap {
    /// Title of the scene of the stored map, one line.
    pub title: String,
    /// Axes of the stored map: push angles in degrees, distances in mm, and the sweep.
    pub grid: Grid,
    /// Numbers of panels and cells of the stored map.
    pub layout: AtlasLayout,
    /// Name of every code of the channel `regime`, by code.
    pub regime_names: BTreeMap<u32, String>,
    /// Name of every code of the channel `status`, by code.
    pub status_names: BTreeMap<u32, String>,
    /// Number of cells of each regime and status in the stored map.
    pub counts: CellCounts,
    path: PathBuf,
    file: Mutex<BufReader<File>>,
    meta: MetaData,
    /// Positions of the blocks of each part.
    offsets: OffsetTables,
    channels: Channels,
}

impl StoredMap {
    /// Opens an EXR map and reads its header.
    ///
    /// # Errors
    /// The file cannot be read, is not EXR, is not a map of this program, or is damaged.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let file = open_regular(path).map_err(StoreError::at(path, StoreError::Read))?;
        Self::of_file(path, file.ok_or_else(|| StoreError::NotAFile(path.to_owned()))?)
    }

    /// Reads the header of the EXR map that is open as `file`; messages call it `path`.
    pub(super) fn of_file(path: &Path, file: File) -> Result<Self, StoreError> {
        let mut file = BufReader::new(file);
        file.rewind().map_err(StoreError::at(path, StoreError::Read))?;
        let meta = header::read(path, &mut file)?;
        let foreign = StoreError::at(path, StoreError::NotAMap);
        let axes = header::parse(&meta, "axes").map_err(&foreign)?;
        let grid = attributes::decode_axes(axes)
            .map_err(|reason| foreign(format!("attribute `axes`: {reason}")))?;
        let layout = AtlasLayout::of(&grid);
        let channels = header::channels(&meta);
        header::check_layout(&meta, layout, channels).map_err(&foreign)?;
        Ok(Self {
            offsets: header::read_offsets(path, &mut file, &meta)?,
            title: header::parse(&meta, "title").map_err(&foreign)?,
            regime_names: header::parse(&meta, "regime_names").map_err(&foreign)?,
            status_names: header::parse(&meta, "status_names").map_err(&foreign)?,
            counts: header::parse(&meta, "counts").map_err(&foreign)?,
            layout,
            grid,
            path: path.to_owned(),
            file: Mutex::new(file),
            meta,
            channels,
        })
    }

    /// Returns the codes of `regime` or `status` that occur in the map, by the counts of the header.
    pub(super) fn codes(&self, channel: &str) -> BTreeSet<u32> {
        let (names, cells) = match channel {
            "regime" => (&self.regime_names, &self.counts.regimes),
            _ => (&self.status_names, &self.counts.statuses),
        };
        let occurs = |name: &String| cells.get(name).is_some_and(|cells| *cells > 0);
        let present = names.iter().filter(|(_, name)| occurs(name));
        present.map(|(code, _)| *code).collect()
    }

    /// Returns the attribute `name` of the map; texts such as `scene` and `adapter` are JSON strings.
    ///
    /// # Errors
    /// There is no such attribute, or it is not JSON.
    pub fn attribute(&self, name: &str) -> Result<serde_json::Value, StoreError> {
        header::parse(&self.meta, name).map_err(StoreError::at(&self.path, StoreError::NotAMap))
    }

    /// Returns the digits to which the channels of the map are rounded.
    ///
    /// # Errors
    /// The attribute is damaged.
    pub fn digits(&self) -> Result<Digits, StoreError> {
        let first = self.meta.headers.first();
        let mut names = first.into_iter().flat_map(|header| header.own_attributes.other.keys());
        if !names.any(|name| name.bytes() == DIGITS.as_bytes()) {
            return Ok(Digits::ALL);
        }
        let text: String = header::parse(&self.meta, DIGITS)
            .map_err(StoreError::at(&self.path, StoreError::NotAMap))?;
        text.parse().map_err(StoreError::at(&self.path, StoreError::NotAMap))
    }

    /// Returns the names of all channels of the map, part by part, `[channel]`.
    #[must_use]
    pub fn channels(&self) -> Vec<&'static str> {
        let parts = layout::parts(self.channels).into_iter();
        parts.flat_map(|(_, channels)| channels).collect()
    }

    /// Reads a channel of all panels of the map: `[second sweep axis][first sweep axis][distance][push angle]`, the last axis fastest.
    ///
    /// # Errors
    /// There is no such channel, or the file is damaged.
    pub fn read_channel(&self, name: &str) -> Result<ChannelValues, StoreError> {
        self.read_panels(name, 0..self.layout.panels())
    }

    /// Reads a channel of one panel of the map: `[distance][push angle]`. No other panel is read.
    ///
    /// # Errors
    /// There is no such channel or panel, or the file is damaged.
    pub fn read_panel(&self, name: &str, index: usize) -> Result<ChannelValues, StoreError> {
        self.read_panels(name, index..index + 1)
    }

    /// Reads a channel of consecutive panels of the map: `[panel][distance][push angle]`. No other panel is read.
    ///
    /// # Errors
    /// There is no such channel or panel, or the file is damaged.
    pub fn read_panels(
        &self,
        name: &str,
        panels: Range<usize>,
    ) -> Result<ChannelValues, StoreError> {
        let all = self.layout.panels();
        if let Some(index) = panels.clone().find(|index| *index >= all) {
            return Err(StoreError::NoSuchPanel { index, panels: all });
        }
        let (part, channel) = self.find(name)?;
        let mut bytes = Vec::new();
        for panel in panels {
            for block in 0..self.layout.blocks_per_panel() {
                self.read_block([part, panel, block], channel, &mut bytes).map_err(|cause| {
                    let place = format!("channel `{name}`, panel {panel}, block {block}");
                    StoreError::Damaged(self.path.clone(), format!("{place}: {cause}"))
                })?;
            }
        }
        Ok(ChannelValues::of_bytes(name, &bytes))
    }

    /// Part of a channel, and its index in the part.
    fn find(&self, name: &str) -> Result<(usize, usize), StoreError> {
        let parts = layout::parts(self.channels);
        let mut parts = parts.iter().map(|(_, channels)| channels).enumerate();
        let found = parts.find_map(|(part, channels)| {
            Some((part, channels.iter().position(|channel| *channel == name)?))
        });
        found.ok_or_else(|| StoreError::UnknownChannel {
            path: self.path.clone(),
            name: name.to_owned(),
            known: self.channels().join(", "),
        })
    }

    /// Appends the samples of one channel in one block to `bytes`.
    fn read_block(
        &self,
        [part, panel, block]: [usize; 3],
        channel: usize,
        bytes: &mut Vec<u8>,
    ) -> exr::error::Result<()> {
        let place = panel * self.layout.blocks_per_panel() + block;
        let chunk = {
            let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
            file.seek(SeekFrom::Start(self.offsets[part][place]))?;
            Chunk::read(&mut *file, &self.meta)?
        };
        let read = UncompressedBlock::decompress_chunk(chunk, &self.meta, false)?;
        if read.index != self.layout.block(part, panel, block) {
            return Err(io::Error::other("another block is in its place").into());
        }
        let line = self.layout.push_angles * SAMPLE_BYTES;
        let channels = self.meta.headers[part].channels.list.len();
        for row in read.data.chunks_exact(channels * line) {
            bytes.extend_from_slice(&row[channel * line..][..line]);
        }
        Ok(())
    }
}
