//! Layout of an EXR map: the position of each value in parts, channels, tiles and blocks.

use super::zip::SampleLine;
use crate::plan::{BLOCK_ROWS, Channels, STATE_CHANNELS};
use crate::scene::Grid;
use exr::block::BlockIndex;
use exr::math::{RoundingMode, Vec2};
use exr::meta::attribute::{
    AttributeValue, ChannelDescription, LevelMode, LineOrder, SampleType, Text, TileDescription,
};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, Headers};
use exr::prelude::Compression;
use std::collections::HashMap;

/// Layout of an atlas: numbers of panels, and of cells in a panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AtlasLayout {
    /// Number of panels of the atlas along x, one for each value of the first sweep axis.
    pub columns: usize,
    /// Number of panels of the atlas along y, one for each value of the second sweep axis.
    pub rows: usize,
    /// Number of cells along x in a panel, one for each push angle.
    pub push_angles: usize,
    /// Number of cells along y in a panel, one for each distance.
    pub distances: usize,
}

impl AtlasLayout {
    /// Returns the atlas layout of a sweep over at most two axes.
    #[must_use]
    pub fn of(grid: &Grid) -> Self {
        let [columns, rows] = grid.atlas().map(|axis| axis.map_or(1, |axis| axis.values.len()));
        Self {
            columns,
            rows,
            push_angles: grid.push_angle_deg.len(),
            distances: grid.distance_mm.len(),
        }
    }

    /// Returns the number of panels of the atlas. Panel `row * columns + column` has value `column` of the first sweep axis and `row` of
    /// the second.
    #[must_use]
    pub const fn panels(&self) -> usize {
        self.columns * self.rows
    }

    /// Returns the number of cells in a panel of the atlas.
    #[must_use]
    pub const fn cells(&self) -> usize {
        self.push_angles * self.distances
    }

    /// Tiles, one per panel. A single panel has scan lines: their many blocks compress in parallel.
    fn description(&self) -> BlockDescription {
        if self.panels() == 1 {
            return BlockDescription::ScanLines;
        }
        BlockDescription::Tiles(TileDescription {
            tile_size: Vec2(self.push_angles, self.distances),
            level_mode: LevelMode::Singular,
            rounding_mode: RoundingMode::Down,
        })
    }

    /// Rows of cells in a block; the last block of a panel may have fewer.
    fn block_height(&self) -> usize {
        match self.panels() {
            1 => BLOCK_ROWS,
            _ => self.distances,
        }
    }

    /// Returns the number of blocks of a panel in each part of an EXR map.
    pub(super) fn blocks_per_panel(&self) -> usize {
        self.distances.div_ceil(self.block_height())
    }

    /// Returns the number of blocks in each part for this number of `cells` of a panel.
    pub(super) fn blocks(&self, cells: usize) -> usize {
        cells.div_ceil(self.block_height() * self.push_angles)
    }

    /// Number of cells that a panel must have whose first `begun` blocks came before: all that are left, or `cells` if they are whole
    /// blocks of a single panel.
    pub(super) fn expected_cells(&self, begun: usize, cells: usize) -> usize {
        let block = self.block_height() * self.push_angles;
        let left = self.cells() - begun * block;
        match cells > 0 && cells < left && cells.is_multiple_of(block) {
            true => cells,
            false => left,
        }
    }

    /// Indices `(column, row)` of the tile of a `panel` in the atlas; `None` if there is only one panel.
    pub(super) fn tile(&self, panel: usize) -> Option<Vec2<usize>> {
        (self.panels() > 1).then_some(Vec2(panel % self.columns, panel / self.columns))
    }

    /// Returns the first row of cells of a block of a panel.
    pub(super) fn first_row(&self, block: usize) -> usize {
        block * self.block_height()
    }

    /// Returns the samples of a block of a panel, or of some of its rows, from all samples of each channel with its rounding. The samples
    /// are in the order of the file, line by line.
    pub(super) fn lines<'a>(
        &self,
        block: usize,
        channels: &'a [SampleLine<'a>],
    ) -> impl Iterator<Item = SampleLine<'a>> + Clone {
        let line = self.push_angles * SAMPLE_BYTES;
        let first = self.first_row(block);
        let all = channels.first().map_or(0, |(samples, _)| samples.len() / line);
        let rows = first..(first + self.block_height()).min(all);
        rows.flat_map(move |row| {
            let channels = channels.iter();
            channels.map(move |(samples, kept_bits)| (&samples[row * line..][..line], *kept_bits))
        })
    }

    /// Returns the index of block `block` of panel `panel` in part `part` of an EXR map.
    pub(super) fn block(&self, part: usize, panel: usize, block: usize) -> BlockIndex {
        let first_row = self.first_row(block);
        let rows = self.block_height().min(self.distances - first_row);
        let corner = Vec2(
            panel % self.columns * self.push_angles,
            panel / self.columns * self.distances + first_row,
        );
        BlockIndex {
            layer: part,
            pixel_position: corner,
            pixel_size: Vec2(self.push_angles, rows),
            level: Vec2(0, 0),
        }
    }

    /// Returns one header for each part of an EXR map, all with the same attributes: readers may take a part alone.
    pub(super) fn headers(
        &self,
        channels: Channels,
        attributes: &HashMap<Text, AttributeValue>,
    ) -> Headers {
        let size = Vec2(self.columns * self.push_angles, self.rows * self.distances);
        let described =
            parts(channels).into_iter().map(|(part, channels)| {
                let channels = channels
                    .into_iter()
                    .map(|name| ChannelDescription::named(name, sample_type(name)));
                let mut header = Header::new(Text::from(part), size, channels.collect())
                    .with_encoding(COMPRESSION, self.description(), LineOrder::Increasing);
                header.own_attributes.other = attributes.clone();
                header
            });
        described.collect()
    }
}

/// Lossless.
const COMPRESSION: Compression = Compression::ZIP16;

/// Returns name and channels of each part of an EXR map with these `channels`, in the order of the file. The channels of a part are
/// sorted by name, as EXR demands.
pub(super) fn parts(channels: Channels) -> Vec<(&'static str, Vec<&'static str>)> {
    let part = |name: &&str| match *name {
        "regime" | "status" => "regime",
        state if STATE_CHANNELS.contains(&state) => "state",
        _ => "numerics",
    };
    let names: Vec<&'static str> = channels.names().collect();
    let parts = names.chunk_by(|one, next| part(one) == part(next));
    let sorted = parts.map(|names| {
        let mut names = names.to_vec();
        names.sort_unstable();
        (part(&names[0]), names)
    });
    sorted.collect()
}

/// Returns the type of the samples of the channel `name`: `U32` for codes and counts, `F32` for all others.
pub(super) fn sample_type(name: &str) -> SampleType {
    match name {
        "regime" | "status" | "newton_steps" => SampleType::U32,
        _ => SampleType::F32,
    }
}

/// Size of one sample of an EXR map in bytes; every channel is 32 bits wide.
pub(super) const SAMPLE_BYTES: usize = 4;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_of_rows_are_whole_blocks() {
        assert_eq!(COMPRESSION.scan_lines_per_block(), BLOCK_ROWS);
    }
}
