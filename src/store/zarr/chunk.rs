//! A chunk of a block's file: what is packed as a whole.

use super::kind::{Kind, options};
use serde_json::{Value, json};
use std::borrow::Cow;
use std::num::NonZeroU64;
use std::sync::Arc;
use zarrs::array::codec::api::ArrayToBytesCodecTraits;
use zarrs::array::{ArrayBytes, ArrayMetadata};

/// How chunks are packed.
#[derive(Debug)]
pub(super) struct Chunk {
    kind: Kind,
    /// Values of a chunk.
    values: usize,
    /// Values of a line, if lines are turned into columns first.
    width: Option<usize>,
    /// A chunk alone.
    array: zarrs::array::Array<()>,
}

/// Whether neighbours in a chunk are those at the next distance, instead of the next push angle. Quantities get smaller by 8 %
/// so; but the margin of a line is that of another one, shifted.
pub(super) fn is_turned(name: &str, kind: Kind) -> bool {
    kind == Kind::Quantity && name != "margin_deg"
}

impl Chunk {
    /// Chunks of so many `values`, the lines of which are turned into columns where they have a `width`.
    pub(super) fn new(kind: Kind, values: usize, width: Option<usize>) -> Result<Self, String> {
        let metadata = json!({
            "zarr_format": 3,
            "node_type": "array",
            "shape": [values],
            "data_type": kind.name(),
            "chunk_grid": { "name": "regular", "configuration": { "chunk_shape": [values] } },
            "chunk_key_encoding": { "name": "default" },
            "fill_value": kind.fill(),
            "codecs": packed(kind, values),
        });
        let parsed: ArrayMetadata =
            serde_json::from_value(metadata).map_err(|why| why.to_string())?;
        let array = zarrs::array::Array::new_with_metadata(Arc::new(()), "/chunk", parsed)
            .map_err(|why| why.to_string())?;
        Ok(Self {
            kind,
            values,
            width,
            array,
        })
    }

    /// Bytes of a chunk's values.
    pub(super) const fn bytes(&self) -> usize {
        self.values * self.kind.size()
    }

    /// The codecs as the metadata of an array with so many `dimensions` have them.
    pub(super) fn codecs(&self, dimensions: usize) -> Value {
        let mut codecs = packed(self.kind, self.values);
        if let (Some(_), Value::Array(list)) = (self.width, &mut codecs) {
            let mut order: Vec<usize> = (0..dimensions).collect();
            order.swap(dimensions - 2, dimensions - 1);
            let turned = json!({ "name": "transpose", "configuration": { "order": order } });
            list.insert(0, turned);
        }
        codecs
    }

    /// Packs `values`, given as bytes, chunk by chunk; the last chunk is filled up.
    pub(super) fn pack_all(&self, values: &[u8]) -> Result<Vec<Vec<u8>>, String> {
        let size = self.bytes();
        let chunks = values.chunks(size).map(|chunk| {
            let missing = (size - chunk.len()) / self.kind.size();
            if missing == 0 {
                return self.pack(chunk.into());
            }
            let fill = self.kind.fill_bytes().repeat(missing);
            self.pack([chunk, &fill].concat().into())
        });
        chunks.collect()
    }

    fn pack(&self, chunk: Cow<[u8]>) -> Result<Vec<u8>, String> {
        let chunk = match self.width {
            Some(width) => turned(&chunk, width).into(),
            None => chunk,
        };
        let array = &self.array;
        let (kind, fill) = (array.data_type(), array.fill_value());
        let shape: Vec<NonZeroU64> = NonZeroU64::new(self.values as u64).into_iter().collect();
        let packed =
            array
                .codecs()
                .encode(ArrayBytes::new_flen(chunk), &shape, kind, fill, &options());
        packed.map(Cow::into_owned).map_err(|why| why.to_string())
    }
}

/// Blosc's level: zstd 3. Above it hardly anything gets smaller.
const LEVEL: u8 = 2;

/// A chunk is one block of Blosc, with a checksum: in blocks of 32 KB, which Blosc would choose itself, less repeats.
fn packed(kind: Kind, values: usize) -> Value {
    json!([
        { "name": "bytes", "configuration": { "endian": "little" } },
        { "name": "blosc", "configuration": {
            "cname": "zstd",
            "clevel": LEVEL,
            "shuffle": if kind.size() > 1 { "shuffle" } else { "noshuffle" },
            "typesize": kind.size(),
            "blocksize": values * kind.size(),
        } },
        { "name": "crc32c" },
    ])
}

/// Columns that are turned together: those of a cache line.
const TOGETHER: usize = 16;

/// Lines of `width` values of 4 bytes, turned into columns.
fn turned(lines: &[u8], width: usize) -> Vec<u8> {
    let (from, _) = lines.as_chunks::<4>();
    let mut turned = vec![0; lines.len()];
    let (to, _) = turned.as_chunks_mut::<4>();
    let height = from.len() / width;
    for first in (0..width).step_by(TOGETHER) {
        for (y, line) in from.chunks_exact(width).enumerate() {
            let columns = line.iter().enumerate().skip(first).take(TOGETHER);
            for (x, value) in columns {
                to[x * height + y] = *value;
            }
        }
    }
    turned
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    fn unpacked(chunk: &Chunk, bytes: Vec<u8>) -> Vec<f32> {
        let array = &chunk.array;
        let (kind, fill) = (array.data_type(), array.fill_value());
        let shape: Vec<_> = NonZeroU64::new(chunk.values as u64).into_iter().collect();
        let decoded = array
            .codecs()
            .decode(bytes.into(), &shape, kind, fill, &options());
        let values = decoded.unwrap().into_fixed().unwrap();
        bytemuck::pod_collect_to_vec(&values)
    }

    /// Two lines a chunk.
    #[test]
    fn lines_are_turned_and_the_last_chunk_is_filled_up() {
        let values: Vec<f32> = (0..51).map(|i| i as f32).collect();
        let chunk = Chunk::new(Kind::Quantity, 34, Some(17)).unwrap();
        let packed = chunk.pack_all(bytemuck::cast_slice(&values)).unwrap();
        let found: Vec<Vec<f32>> = packed
            .into_iter()
            .map(|bytes| unpacked(&chunk, bytes))
            .collect();
        assert_eq!(found.len(), 2);
        for x in 0..17 {
            assert_eq!(found[0][2 * x..][..2], [values[x], values[17 + x]]);
            assert_eq!(found[1][2 * x], values[34 + x]);
            assert!(found[1][2 * x + 1].is_nan());
        }
    }
}
