//! Chunks of EXR maps: a block of one part of a panel with its place in the map.

use super::layout::AtlasLayout;
use super::zip::SampleLine;
use crate::map::Panel;
use crate::plan::Digits;
use exr::block::chunk::{
    Chunk, CompressedBlock, CompressedScanLineBlock, CompressedTileBlock, TileCoordinates,
};
use exr::math::Vec2;

/// Returns the bytes of a block of a map with this number of `parts`, from its compressed samples. The place of the block is `[panel, part,
/// block]`.
pub(super) fn chunk(
    layout: &AtlasLayout,
    parts: usize,
    [panel, part, block]: [usize; 3],
    compressed_pixels_le: Vec<u8>,
) -> exr::error::Result<Vec<u8>> {
    let compressed_block = match layout.tile(panel) {
        Some(tile) => CompressedBlock::Tile(CompressedTileBlock {
            coordinates: TileCoordinates { tile_index: tile, level_index: Vec2(0, 0) },
            compressed_pixels_le,
        }),
        None => CompressedBlock::ScanLine(CompressedScanLineBlock {
            // At most 2^30, which the header has been checked for.
            y_coordinate: layout.first_row(block) as i32,
            compressed_pixels_le,
        }),
    };
    let chunk = Chunk { layer_index: part, compressed_block };
    let mut bytes = Vec::new();
    chunk.write(&mut bytes, parts)?;
    Ok(bytes)
}

/// Returns the samples of some channels of a panel, as bytes, with their rounding.
pub(super) fn samples<'a>(
    panel: &'a Panel,
    channels: &[&str],
    digits: Digits,
) -> Vec<SampleLine<'a>> {
    let channels = channels.iter();
    channels.map(|name| (panel.bytes(name), digits.mantissa_bits(name))).collect()
}
