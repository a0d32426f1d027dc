//! Kinds of values of a Zarr array, and the encoding of its chunks, as metadata describe them.

use super::blosc::{self, Codec};
use crate::store::NOT_COMPUTED;
use serde_json::{Value, json};

/// Kind of the values of a Zarr array: their type and fill value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ValueKind {
    /// Codes as `u8`; the fill value is [`NOT_COMPUTED`].
    Code,
    /// Counts of cells or steps as `u32`.
    Count,
    /// Quantities of cells as `f32`.
    Quantity,
    /// Coordinates along an axis as `f64`.
    Coordinate,
    /// Names along an axis as texts in UTF-8.
    Name,
}

impl ValueKind {
    /// Returns the name of the data type of this kind in metadata.
    pub(super) const fn data_type(self) -> &'static str {
        match self {
            Self::Code => "uint8",
            Self::Count => "uint32",
            Self::Quantity => "float32",
            Self::Coordinate => "float64",
            Self::Name => "string",
        }
    }

    /// Returns the size in bytes of a value of this kind in blocks, which have no names.
    pub(super) const fn size(self) -> usize {
        match self {
            Self::Code | Self::Name => 1,
            Self::Count | Self::Quantity => 4,
            Self::Coordinate => 8,
        }
    }

    /// Returns the fill value, in the metadata and as bytes.
    pub(super) fn fill(self) -> (Value, Vec<u8>) {
        match self {
            Self::Code => (json!(NOT_COMPUTED), vec![NOT_COMPUTED]),
            Self::Count => (json!(0), vec![0; 4]),
            Self::Quantity => (json!("NaN"), f32::NAN.to_le_bytes().to_vec()),
            Self::Coordinate => (json!("NaN"), f64::NAN.to_le_bytes().to_vec()),
            Self::Name => (json!(""), Vec::new()),
        }
    }
}

/// Encoding of the chunks of an array.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ChunkEncoding {
    /// Values of a line of a chunk, if its lines are stored as columns.
    pub(super) width: Option<usize>,
    /// Number of mantissa bits to which values are rounded, unless all are stored.
    pub(super) kept_bits: Option<u32>,
}

impl ChunkEncoding {
    /// Returns the compression codec of values of a `kind`. The last bits of quantities are noise, which no codec makes smaller.
    pub(super) const fn codec(self, kind: ValueKind) -> Codec {
        match (kind, self.kept_bits) {
            (ValueKind::Quantity, None) => Codec::Lz4,
            _ => Codec::Zlib,
        }
    }
}

/// Returns the codec of values that are not packed.
pub(super) fn little_endian() -> Value {
    json!({ "name": "bytes", "configuration": { "endian": "little" } })
}

/// Returns the codecs of a chunk of this `shape`: lines to columns where they are turned, one block of Blosc, a checksum.
pub(super) fn chunk_codecs(kind: ValueKind, shape: &[usize], encoding: ChunkEncoding) -> Value {
    let size = kind.size();
    let blosc = json!({ "name": "blosc", "configuration": {
        "cname": encoding.codec(kind).name(),
        "clevel": blosc::LEVEL,
        "shuffle": if size > 1 { "shuffle" } else { "noshuffle" },
        "typesize": size,
        "blocksize": shape.iter().product::<usize>() * size,
    } });
    let codecs = [little_endian(), blosc, json!({ "name": "crc32c" })];
    let transpose = encoding.width.is_some().then(|| {
        let mut order: Vec<usize> = (0..shape.len()).collect();
        order[shape.len() - 2..].reverse();
        json!({ "name": "transpose", "configuration": { "order": order } })
    });
    transpose.into_iter().chain(codecs).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounded_quantities_and_codes_are_made_smaller() {
        let codec = |kind, kept_bits| {
            let width = None;
            ChunkEncoding { width, kept_bits }.codec(kind)
        };
        assert_eq!(codec(ValueKind::Quantity, None), Codec::Lz4);
        assert_eq!(codec(ValueKind::Quantity, Some(17)), Codec::Zlib);
        assert_eq!(codec(ValueKind::Code, None), Codec::Zlib);
    }
}
