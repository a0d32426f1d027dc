//! Kinds of values in a store, and how all of them are coded.

use serde_json::{Value, json};
use zarrs::array::CodecOptions;

/// Kinds of values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Codes, whose fill value is [`NOT_COMPUTED`].
    Code,
    /// Counts.
    Count,
    /// Quantities.
    Quantity,
    /// Coordinates.
    Coordinate,
}

/// The code of what has not been computed yet.
pub(super) const NOT_COMPUTED: u8 = 254;

impl Kind {
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Code => "uint8",
            Self::Count => "uint32",
            Self::Quantity => "float32",
            Self::Coordinate => "float64",
        }
    }

    /// Bytes of a value.
    pub(super) const fn size(self) -> usize {
        match self {
            Self::Code => 1,
            Self::Count | Self::Quantity => 4,
            Self::Coordinate => 8,
        }
    }

    pub(super) fn fill(self) -> Value {
        match self {
            Self::Code => json!(NOT_COMPUTED),
            Self::Count => json!(0),
            Self::Quantity | Self::Coordinate => json!("NaN"),
        }
    }

    /// The bytes of a value that there is not.
    pub(super) fn fill_bytes(self) -> Vec<u8> {
        match self {
            Self::Code => vec![NOT_COMPUTED],
            Self::Count => vec![0; 4],
            Self::Quantity => f32::NAN.to_ne_bytes().to_vec(),
            Self::Coordinate => f64::NAN.to_ne_bytes().to_vec(),
        }
    }
}

/// Chunks of nothing but fill values are stored, too: what is there has been computed. One thread packs a file, because
/// several would put its chunks in any order.
pub(super) fn options() -> CodecOptions {
    CodecOptions::default()
        .with_store_empty_chunks(true)
        .with_concurrent_target(1)
}
