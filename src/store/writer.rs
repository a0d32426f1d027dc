//! Writer of EXR maps, which writes some panels at a time.

use super::attributes::{self, MapDescription, attribute};
use super::chunk::{chunk, samples};
use super::layout::{self, AtlasLayout, SAMPLE_BYTES};
use super::{CellCounts, Output, StoreError, StoredMap, header, zip};
use crate::map::{Audit, EngineCells, Panel};
use crate::plan::{Channels, Digits, Plan};
use crate::scene::Grid;
use exr::meta::Headers;
use exr::meta::header::Header;
use rayon::prelude::*;
use std::io::{self, BufWriter, IntoInnerError, Seek, SeekFrom, Write};
use std::path::PathBuf;

/// Bytes of a place in the file.
const OFFSET_BYTES: u64 = 8;

/// Writer of an EXR map, which appears at its path with [`MapWriter::finish`].
#[derive(Debug)]
pub struct MapWriter {
    path: PathBuf,
    file: BufWriter<Output>,
    /// Position of the next block.
    position: u64,
    layout: AtlasLayout,
    channels: Channels,
    digits: Digits,
    headers: Headers,
    /// Position of each part's table of block positions. Tables are written with their blocks: the tables of a large sweep would not fit in
    /// memory.
    tables: Vec<u64>,
    /// Panels written so far.
    written: usize,
    /// Packed blocks of a panel that came in part: `[part][block]`. In the file, the blocks of a part follow one another.
    packed: Vec<Vec<Vec<u8>>>,
    counts: CellCounts,
}

impl MapWriter {
    /// Begins to write an EXR map into `output`.
    ///
    /// # Errors
    /// The disk is full, or the map is too large for EXR or has more than two sweep axes.
    pub fn create(output: Output, about: &MapDescription<'_>) -> Result<Self, StoreError> {
        let path = output.path().to_owned();
        let grid = &about.scene.grid;
        if grid.sweep.len() > 2 {
            return Err(StoreError::TooManyAxes { path, axes: grid.sweep_names() });
        }
        let layout = AtlasLayout::of(grid);
        let mut attributes = attributes::encode(about);
        attributes.extend([attribute("counts", &" ".repeat(attributes::counts_width()))]);
        let headers = layout.headers(about.channels, &attributes);
        if headers.iter().any(|header| header.chunk_count > i32::MAX as usize) {
            let why = exr::error::Error::Invalid("it has more than 2^31 blocks".into());
            return Err(StoreError::Encode(path, why));
        }

        let preamble =
            header::encode(&headers).map_err(StoreError::at(&path, StoreError::Encode))?;
        let mut position = preamble.len() as u64;
        let table = |header: &Header| {
            let table = position;
            position += OFFSET_BYTES * header.chunk_count as u64;
            table
        };
        let tables = headers.iter().map(table).collect();
        let mut writer = Self {
            path,
            file: BufWriter::new(output),
            position,
            layout,
            channels: about.channels,
            packed: vec![Vec::new(); headers.len()],
            digits: about.digits,
            headers,
            tables,
            written: 0,
            counts: CellCounts::default(),
        };
        writer.write_at(0, &[preamble])?;
        Ok(writer)
    }

    /// Compresses the next panels in parallel and appends them, in the order of the sweep. The only panel of a map may come in bands of
    /// rows, each as a panel of [`BLOCK_ROWS`](crate::plan::BLOCK_ROWS) rows or a multiple of it, except for the last one.
    ///
    /// # Errors
    /// A panel is one too many, has the wrong size or a code without a name, or the disk is full.
    pub fn write_panels(&mut self, panels: &[Panel]) -> Result<(), StoreError> {
        let (first, all) = (self.written, self.layout.panels());
        if first + panels.len() > all {
            return Err(StoreError::NoSuchPanel { index: all, panels: all });
        }
        for (index, panel) in (first..).zip(panels) {
            self.check_sizes(index, panel)?;
        }
        let mut counts = self.counts.clone();
        for (index, panel) in (first..).zip(panels) {
            counts.add(index, panel)?;
        }
        self.counts = counts;

        let parts = layout::parts(self.channels);
        let begun = self.packed[0].len();
        let tasks: Vec<[usize; 3]> = (0..panels.len())
            .flat_map(|panel| {
                let blocks = self.layout.blocks(panels[panel].regime.len());
                let of_part = move |part| (0..blocks).map(move |block| [panel, part, block]);
                (0..parts.len()).flat_map(of_part)
            })
            .collect();
        let chunks: Vec<Vec<u8>> = tasks
            .par_iter()
            .map(|&[panel, part, block]| {
                let samples = samples(&panels[panel], &parts[part].1, self.digits);
                let lines = self.layout.lines(block, &samples);
                let place = [first + panel, part, begun + block];
                chunk(&self.layout, parts.len(), place, zip::pack(lines))
            })
            .collect::<exr::error::Result<_>>()
            .map_err(StoreError::at(&self.path, StoreError::Encode))?;
        let blocks = self.layout.blocks_per_panel();
        let mut chunks = chunks.into_iter();
        let mut ready: Vec<Vec<u8>> = Vec::new();
        let mut offsets = vec![Vec::new(); self.tables.len()];
        let mut position = self.position;
        for of_panel in tasks.chunk_by(|a, b| a[0] == b[0]) {
            for ([_, part, _], chunk) in of_panel.iter().zip(&mut chunks) {
                self.packed[*part].push(chunk);
            }
            if self.packed[0].len() == blocks {
                for (packed, offsets) in self.packed.iter_mut().zip(&mut offsets) {
                    for chunk in packed.drain(..) {
                        offsets.extend(position.to_le_bytes());
                        position += chunk.len() as u64;
                        ready.push(chunk);
                    }
                }
                self.written += 1;
            }
        }
        self.write_at(self.position, &ready)?;
        self.position = position;
        for (part, offsets) in offsets.into_iter().enumerate() {
            let before = OFFSET_BYTES * (first * blocks) as u64;
            self.write_at(self.tables[part] + before, &[offsets])?;
        }
        Ok(())
    }

    /// Packs `panels` of a run of `plan` over this `grid`, and returns their size in bytes without headers.
    #[must_use]
    pub fn sample(grid: &Grid, plan: &Plan, panels: &[Panel]) -> u64 {
        let layout = AtlasLayout::of(grid);
        let packed = panels.par_iter().map(|panel| {
            let bytes = layout::parts(plan.channels).into_iter().map(|(_, part)| {
                let samples = samples(panel, &part, plan.digits);
                let blocks = 0..layout.blocks_per_panel();
                let pack = |block| zip::pack(layout.lines(block, &samples)).len() as u64;
                blocks.map(pack).sum::<u64>()
            });
            bytes.sum::<u64>()
        });
        packed.sum()
    }

    /// Writes counts and checksum into the header and gives the EXR map its name. Returns the map, open for reading: whatever replaces it
    /// meanwhile is not read.
    ///
    /// # Errors
    /// A panel is missing, or the file cannot be written or renamed; then no map appears.
    pub fn finish(
        mut self,
        engine_cells: EngineCells,
        audit: Audit,
    ) -> Result<StoredMap, StoreError> {
        if self.written != self.layout.panels() {
            return Err(StoreError::Incomplete {
                written: self.written,
                panels: self.layout.panels(),
            });
        }
        self.counts.engine_cells = engine_cells;
        self.counts.audit = audit;
        let text = attributes::encode_counts(&self.counts);
        for header in &mut self.headers {
            let attributes = &mut header.own_attributes.other;
            attributes.extend([attribute("counts", &text)]);
        }
        // `create` has reserved the room of the counts.
        let mut preamble = header::encode(&self.headers)
            .map_err(StoreError::at(&self.path, StoreError::Encode))?;
        header::seal(&mut preamble);
        self.write_at(0, &[preamble])?;
        let Self { path, file, .. } = self;
        let file = file
            .into_inner()
            .map_err(IntoInnerError::into_error)
            .and_then(Output::finish_open)
            .and_then(|file| file.ok_or(io::ErrorKind::NotSeekable.into()))
            .map_err(StoreError::at(&path, StoreError::Write))?;
        StoredMap::of_file(&path, file)
    }

    /// Writes `pieces` one after another.
    fn write_at(&mut self, position: u64, pieces: &[Vec<u8>]) -> Result<(), StoreError> {
        let mut pieces = pieces.iter();
        self.file
            .seek(SeekFrom::Start(position))
            .and_then(|_| pieces.try_for_each(|piece| self.file.write_all(piece)))
            .map_err(StoreError::at(&self.path, StoreError::Write))
    }

    fn check_sizes(&self, index: usize, panel: &Panel) -> Result<(), StoreError> {
        let begun = self.packed[0].len();
        let expected = self.layout.expected_cells(begun, panel.regime.len());
        for channel in self.channels.names() {
            let cells = panel.bytes(channel).len() / SAMPLE_BYTES;
            if cells != expected {
                return Err(StoreError::PanelSize { index, channel, cells, expected });
            }
        }
        Ok(())
    }
}
