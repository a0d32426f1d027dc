//! Frames of Blosc 1 as chunks: the bytes of the values are shuffled, then compressed.
//!
//! Every reader of Zarr decodes such frames, zarr-python by `numcodecs`. A frame (c-blosc, `README_CHUNK_FORMAT.rst`) begins with
//! 16 bytes: format version, codec version, flags, bytes of a value, and as little-endian `u32` the bytes of all values, of a
//! block and of the frame. Frames of this program have one block: its position and its size, as `u32`, and a stream of the codec. Where
//! that is not shorter than the values, the values follow the header as they are.

use super::planes::joined;
use miniz_oxide::deflate::compress_to_vec_zlib;
use miniz_oxide::inflate::decompress_slice_iter_to_slice;

/// Compression codec of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Codec {
    /// LZ4: four times as fast as zlib. Where the last bits of mantissas are noise, the result is within 3 % of the size by zlib.
    Lz4,
    /// Zlib, which also codes frequent bytes in fewer bits: rounded quantities and codes take less space.
    Zlib,
}

/// Level of both codecs. Zlib has levels from 1 (fastest) to 9; at 6 a store is 6 % smaller and takes four times as long.
pub(super) const LEVEL: u8 = 1;

/// Largest number of bytes by which a Blosc frame is longer than its values.
pub(super) const OVERHEAD: usize = 16;

/// Bytes before the stream of the codec: the header, position and size of the block.
const BEFORE_STREAM: usize = OVERHEAD + 8;

/// Versions of the frame and of the codec.
const VERSIONS: [u8; 2] = [2, 1];

/// Flag of values whose bytes are shuffled.
const SHUFFLED: u8 = 1;

/// Flag of values that follow the header as they are.
const COPIED: u8 = 2;

/// Flag of a block that is one stream.
const IN_ONE: u8 = 1 << 4;

impl Codec {
    const ALL: [Self; 2] = [Self::Lz4, Self::Zlib];

    /// Returns the name of the codec in the metadata of a store.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Lz4 => "lz4",
            Self::Zlib => "zlib",
        }
    }

    /// Returns the flags of the codec in the header of a frame.
    const fn flags(self) -> u8 {
        match self {
            Self::Lz4 => 1 << 5,
            Self::Zlib => 3 << 5,
        }
    }

    fn compress(self, bytes: &[u8]) -> Vec<u8> {
        match self {
            Self::Lz4 => lz4_flex::block::compress(bytes),
            Self::Zlib => compress_to_vec_zlib(bytes, LEVEL),
        }
    }

    /// Decompresses a `stream` into `bytes`; `None` if it has errors or another number of bytes.
    fn decompress(self, stream: &[u8], bytes: &mut [u8]) -> Option<()> {
        let found = match self {
            Self::Lz4 => lz4_flex::block::decompress_into(stream, bytes).ok(),
            Self::Zlib => {
                let stream = std::iter::once(stream);
                decompress_slice_iter_to_slice(bytes, stream, true, false).ok()
            }
        };
        (found == Some(bytes.len())).then_some(())
    }
}

/// The frame of values, each of `size` bytes, from their `planes`.
pub(super) fn pack(codec: Codec, planes: &[u8], size: usize) -> Vec<u8> {
    let stream = codec.compress(planes);
    let copied = OVERHEAD + planes.len();
    let is_copied = BEFORE_STREAM + stream.len() >= copied;
    let length = copied.min(BEFORE_STREAM + stream.len());
    let mut frame = header(codec, [planes.len(), size, length], is_copied).to_vec();
    frame.reserve(length - OVERHEAD);
    if is_copied {
        frame.resize(length, 0);
        joined(planes, size, &mut frame[OVERHEAD..]);
    } else {
        frame.extend((OVERHEAD as u32 + 4).to_le_bytes());
        frame.extend((stream.len() as u32).to_le_bytes());
        frame.extend(stream);
    }
    frame
}

/// Unpacks a Blosc `frame` of `count` values of `size` bytes, and appends them to `values`.
///
/// # Errors
/// The frame is not as [`pack`] writes it, or it has another number of values.
pub(super) fn unpack(
    frame: &[u8],
    [count, size]: [usize; 2],
    values: &mut Vec<u8>,
) -> Result<(), &'static str> {
    let length = count * size;
    let is_begun = |codec: &Codec, is_copied| {
        frame.starts_with(&header(*codec, [length, size, frame.len()], is_copied))
    };
    let is_copied = Codec::ALL.iter().any(|codec| is_begun(codec, true));
    if is_copied && frame.len() == OVERHEAD + length {
        values.extend(&frame[OVERHEAD..]);
        return Ok(());
    }
    let codec = Codec::ALL.iter().find(|codec| is_begun(codec, false));
    let stream = codec.zip(frame.get(BEFORE_STREAM..));
    let (codec, stream) = stream.ok_or("a chunk has no Blosc header of this program")?;
    let mut planes = vec![0; length];
    let decompressed = codec.decompress(stream, &mut planes);
    decompressed.ok_or("a chunk cannot be decompressed to its values")?;
    let first = values.len();
    values.resize(first + length, 0);
    joined(&planes, size, &mut values[first..]);
    Ok(())
}

/// The header of a frame from the numbers of bytes of all values, of one value, and of the frame.
fn header(codec: Codec, [values, size, length]: [usize; 3], is_copied: bool) -> [u8; OVERHEAD] {
    let shuffled = if size > 1 { SHUFFLED } else { 0 };
    let copied = if is_copied { COPIED } else { 0 };
    let mut header = [0; OVERHEAD];
    header[..2].copy_from_slice(&VERSIONS);
    header[2..4].copy_from_slice(&[codec.flags() | IN_ONE | shuffled | copied, size as u8]);
    let numbers = [values, values, length].map(|number| (number as u32).to_le_bytes());
    header[4..].copy_from_slice(numbers.as_flattened());
    header
}

#[cfg(test)]
mod tests {
    use super::super::planes::planes;
    use super::*;
    use crate::random::hash;

    /// `count` values of `size` bytes: smooth, or noise that cannot be packed.
    fn values(count: usize, size: usize, is_noise: bool) -> Vec<u8> {
        let value = |i: usize| {
            let smooth = (i as u32 / 7).to_be_bytes().map(|byte| byte ^ 0x5a);
            let value = if is_noise { (hash(i as u64) as u32).to_be_bytes() } else { smooth };
            value[..size].to_vec()
        };
        (0..count).flat_map(value).collect()
    }

    /// The bytes that c-blosc (`README_CHUNK_FORMAT.rst`) writes for 512 bytes of values in a frame of 300.
    #[test]
    fn headers_are_those_of_c_blosc() {
        for (codec, size, is_copied, flags) in [
            (Codec::Lz4, 4, false, 0x31),
            (Codec::Lz4, 8, true, 0x33),
            (Codec::Zlib, 1, false, 0x70),
        ] {
            let expected = [2, 1, flags, size, 0, 2, 0, 0, 0, 2, 0, 0, 44, 1, 0, 0];
            let sizes = [512, usize::from(size), 300];
            assert_eq!(header(codec, sizes, is_copied), expected);
        }
    }

    #[test]
    fn what_is_packed_comes_back_and_nothing_else_does() {
        let cases = [(1, 1, false), (900, 1, true), (900, 4, false), (900, 4, true)];
        let cases = Codec::ALL.into_iter().flat_map(|codec| cases.map(|case| (codec, case)));
        for (codec, (count, size, is_noise)) in cases {
            let values = values(count, size, is_noise);
            let planes = match size {
                1 => values.clone(),
                _ => planes(&values, None, None),
            };
            let frame = pack(codec, &planes, size);
            assert!(frame.len() <= values.len() + OVERHEAD);
            assert_eq!(frame.len() < values.len(), count > 1 && !is_noise);
            let mut found = Vec::new();
            assert_eq!(unpack(&frame, [count, size], &mut found), Ok(()));
            assert!(found == values);
            for damaged in [&frame[..frame.len() - 1], &[], &frame[1..]] {
                assert!(unpack(damaged, [count, size], &mut found).is_err());
            }
            assert!(unpack(&frame, [count + 1, size], &mut found).is_err());
            // A sound stream of fewer values.
            let stream = codec.compress(&planes[1..]);
            let numbers = [planes.len(), size, BEFORE_STREAM + stream.len()];
            let before = [OVERHEAD as u32 + 4, stream.len() as u32].map(u32::to_le_bytes);
            let short =
                [&header(codec, numbers, false)[..], before.as_flattened(), &stream].concat();
            assert!(unpack(&short, [count, size], &mut found).is_err());
        }
    }
}
