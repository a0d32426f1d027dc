//! The place of each value in an EXR map: parts, channels, tiles and blocks.

use super::zip::SampleLine;
use super::{Channels, STATE_CHANNELS};
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

/// Numbers of panels and of cells in a panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AtlasLayout {
    /// Number of panels along x, one per value of the first sweep axis.
    pub columns: usize,
    /// Number of panels along y, one per value of the second sweep axis.
    pub rows: usize,
    /// Number of cells along x in a panel, one per push angle.
    pub push_angles: usize,
    /// Number of cells along y in a panel, one per distance.
    pub distances: usize,
}

impl AtlasLayout {
    /// The layout of a sweep over at most two axes.
    #[must_use]
    pub fn of(grid: &Grid) -> Self {
        let [columns, rows] = grid
            .atlas()
            .map(|axis| axis.map_or(1, |own| own.values.len()));
        Self {
            columns,
            rows,
            push_angles: grid.push_angle_deg.len(),
            distances: grid.distance_mm.len(),
        }
    }

    /// Number of panels. Panel `row * columns + column` has value `column` of the first sweep axis and `row` of the second.
    #[must_use]
    pub const fn panels(&self) -> usize {
        self.columns * self.rows
    }

    /// Number of cells in a panel.
    #[must_use]
    pub const fn cells(&self) -> usize {
        self.push_angles * self.distances
    }

    /// Tiles, one per panel. A single panel has scan lines: their many blocks compress in parallel.
    fn blocks(&self) -> BlockDescription {
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
            1 => COMPRESSION.scan_lines_per_block(),
            _ => self.distances,
        }
    }

    /// Blocks of a panel in each part.
    pub(super) fn blocks_per_panel(&self) -> usize {
        self.distances.div_ceil(self.block_height())
    }

    /// Indices `(column, row)` of the tile of a `panel` in the atlas; `None` if there is only one panel.
    pub(super) fn tile(&self, panel: usize) -> Option<Vec2<usize>> {
        (self.panels() > 1).then_some(Vec2(panel % self.columns, panel / self.columns))
    }

    /// First row of cells of a block of a panel.
    pub(super) fn first_row(&self, block: usize) -> usize {
        block * self.block_height()
    }

    /// The samples of a block of a panel, line by line, in the order of the file, from all samples of each channel with its rounding.
    pub(super) fn lines<'a>(
        &self,
        block: usize,
        channels: &'a [SampleLine<'a>],
    ) -> impl Iterator<Item = SampleLine<'a>> + Clone {
        let line = self.push_angles * SAMPLE_BYTES;
        let first = self.first_row(block);
        let rows = first..(first + self.block_height()).min(self.distances);
        rows.flat_map(move |row| {
            let channels = channels.iter();
            channels.map(move |(samples, kept_bits)| (&samples[row * line..][..line], *kept_bits))
        })
    }

    /// Block `block` of panel `panel` in part `part`.
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

    /// One header per part, all with the same attributes: readers may take a part alone.
    pub(super) fn headers(
        &self,
        channels: Channels,
        attributes: &HashMap<Text, AttributeValue>,
    ) -> Headers {
        let size = Vec2(self.columns * self.push_angles, self.rows * self.distances);
        let described =
            parts(channels).into_iter().map(|(part, channels)| {
                let channels = channels.into_iter();
                let channels =
                    channels.map(|name| ChannelDescription::named(name, sample_type(name)));
                let mut header = Header::new(Text::from(part), size, channels.collect())
                    .with_encoding(COMPRESSION, self.blocks(), LineOrder::Increasing);
                header.own_attributes.other = attributes.clone();
                header
            });
        described.collect()
    }
}

/// Lossless.
const COMPRESSION: Compression = Compression::ZIP16;

/// Name and channels of each part of an EXR map with these `channels`, in the order of the file. The channels of a part are
/// sorted by name, as EXR demands.
pub(super) fn parts(channels: Channels) -> Vec<(&'static str, Vec<&'static str>)> {
    let part = |name: &&str| match *name {
        "regime" | "status" => "regime",
        state if STATE_CHANNELS.contains(&state) => "state",
        _ => "numerics",
    };
    let names: Vec<&'static str> = channels.names().collect();
    let parts = names.chunk_by(|one, next| part(one) == part(next));
    let sorted = parts.map(|own| {
        let mut own = own.to_vec();
        own.sort_unstable();
        (part(&own[0]), own)
    });
    sorted.collect()
}

/// Type of the samples of the channel `name`: `U32` for codes and counts, `F32` for all others.
pub(super) fn sample_type(name: &str) -> SampleType {
    match name {
        "regime" | "status" | "newton_steps" => SampleType::U32,
        _ => SampleType::F32,
    }
}

/// Bytes of one sample; every channel is 32 bits wide.
pub(super) const SAMPLE_BYTES: usize = 4;
