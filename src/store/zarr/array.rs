//! Arrays of a Zarr store: metadata, and conversion of chunks between values and bytes.

use super::blocks::Blocks;
use super::blosc;
use super::encoding::{ChunkEncoding, ValueKind, chunk_codecs, little_endian};
use super::planes::{planes, turned};
use serde_json::{Value, json};

/// Array of a Zarr store. Each of its blocks is a file of equal chunks.
#[derive(Debug)]
pub(super) struct ZarrArray {
    pub(super) name: String,
    pub(super) kind: ValueKind,
    /// Metadata of the Zarr array, as they are written.
    pub(super) metadata: Value,
    /// Number of dimensions of the Zarr array, sweep axes included.
    pub(super) dimensions: usize,
    /// Number of values in the file of a block of the Zarr array.
    pub(super) values: usize,
    /// Values of a chunk.
    chunk_values: usize,
    encoding: ChunkEncoding,
}

impl ZarrArray {
    /// Creates a Zarr array in blocks. Its first dimensions are the sweep axes. Its last dimensions have these `sizes`: in all, in a
    /// block's file, and in a chunk.
    pub(super) fn in_blocks(
        name: &str,
        kind: ValueKind,
        blocks: &Blocks,
        (sizes, encoding): (&[[usize; 3]], ChunkEncoding),
        dimensions: &[&str],
        about: Value,
    ) -> Self {
        let sweep = blocks.axes.iter().zip(&blocks.shape);
        let sweep = sweep.map(|(all, block)| [*all, *block, 1]);
        let sizes: Vec<[usize; 3]> = sweep.chain(sizes.iter().copied()).collect();
        let [all, file, chunk] =
            [0, 1, 2].map(|which| -> Vec<usize> { sizes.iter().map(|size| size[which]).collect() });
        let codecs = json!([{ "name": "sharding_indexed", "configuration": {
            "chunk_shape": chunk,
            "codecs": chunk_codecs(kind, &chunk, encoding),
            "index_codecs": [little_endian(), { "name": "crc32c" }],
            "index_location": "end",
        } }]);
        let array = Self::new(name, kind, [&all, &file], dimensions, (about, codecs));
        Self { chunk_values: chunk.iter().product(), encoding, ..array }
    }

    /// The values along an axis, in one chunk that is not packed.
    pub(super) fn of_axis(name: &str, kind: ValueKind, count: usize, about: Value) -> Self {
        let codec = match kind {
            ValueKind::Name => json!({ "name": "vlen-utf8" }),
            _ => little_endian(),
        };
        let about = (about, json!([codec]));
        Self::new(name, kind, [&[count]; 2], &[name], about)
    }

    /// One value without axes, which is not packed.
    pub(super) fn scalar(name: &str, kind: ValueKind, about: Value) -> Self {
        let about = (about, json!([little_endian()]));
        Self::new(name, kind, [&[]; 2], &[], about)
    }

    fn new(
        name: &str,
        kind: ValueKind,
        [all, file]: [&[usize]; 2],
        dimensions: &[&str],
        (about, codecs): (Value, Value),
    ) -> Self {
        let metadata = json!({
            "zarr_format": 3,
            "node_type": "array",
            "shape": all,
            "data_type": kind.data_type(),
            "chunk_grid": { "name": "regular", "configuration": { "chunk_shape": file } },
            "chunk_key_encoding": { "name": "default", "configuration": { "separator": "." } },
            "fill_value": kind.fill().0,
            "codecs": codecs,
            "attributes": about,
            "dimension_names": dimensions,
        });
        let values = file.iter().product();
        Self {
            name: name.to_owned(),
            kind,
            metadata,
            dimensions: file.len(),
            values,
            chunk_values: values,
            encoding: ChunkEncoding::default(),
        }
    }

    /// Returns the name of the file of a block of the Zarr array, in the folder of the array.
    pub(super) fn file(place: &[usize], dimensions: usize) -> String {
        let inside = std::iter::repeat_n(&0, dimensions);
        let indices = place.iter().chain(inside).map(usize::to_string);
        let parts: Vec<String> = std::iter::once("c".to_owned()).chain(indices).collect();
        parts.join(".")
    }

    /// Returns the number of chunks in the file of a block.
    pub(super) const fn chunk_count(&self) -> usize {
        self.values / self.chunk_values
    }

    /// Returns the size of the values of a chunk in bytes.
    pub(super) const fn chunk_bytes(&self) -> usize {
        self.chunk_values * self.kind.size()
    }

    /// Packs the `values` of a whisker, given as bytes, into chunks, `[chunk][byte]`; the last chunk is filled up.
    pub(super) fn pack(&self, values: &[u8]) -> Vec<Vec<u8>> {
        let size = self.chunk_bytes();
        let chunks = values.chunks(size).map(|chunk| {
            let missing = (size - chunk.len()) / self.kind.size();
            if missing == 0 {
                return self.pack_chunk(chunk);
            }
            let fill = self.kind.fill().1.repeat(missing);
            self.pack_chunk(&[chunk, &fill].concat())
        });
        chunks.collect()
    }

    /// Packs the chunks, `[chunk][byte]`, of a whisker that does not exist, in a block with space for `whiskers`.
    pub(super) fn pack_fill(&self, whiskers: usize) -> Vec<Vec<u8>> {
        let chunks = self.chunk_count() / whiskers;
        vec![self.pack_chunk(&self.kind.fill().1.repeat(self.chunk_values)); chunks]
    }

    /// A frame of Blosc and its checksum.
    fn pack_chunk(&self, values: &[u8]) -> Vec<u8> {
        let size = self.kind.size();
        let ChunkEncoding { width, kept_bits } = self.encoding;
        let codec = self.encoding.codec(self.kind);
        let mut chunk = if size == 1 {
            blosc::pack(codec, values, size)
        } else {
            blosc::pack(codec, &planes(values, width, kept_bits), size)
        };
        chunk.extend(crc32c::crc32c(&chunk).to_le_bytes());
        chunk
    }

    /// Returns the values of frames of Blosc, as bytes.
    ///
    /// # Errors
    /// A frame is not as [`pack`](Self::pack) writes it.
    pub(super) fn unpack<'a>(
        &self,
        frames: impl Iterator<Item = &'a [u8]>,
    ) -> Result<Vec<u8>, String> {
        let mut values = Vec::with_capacity(frames.size_hint().0 * self.chunk_bytes());
        for frame in frames {
            let first = values.len();
            blosc::unpack(frame, [self.chunk_values, self.kind.size()], &mut values)?;
            if let Some(width) = self.encoding.width {
                let lines = turned(&values[first..], self.chunk_values / width);
                values[first..].copy_from_slice(&lines);
            }
        }
        Ok(values)
    }
}

/// The attributes of an array by which xarray labels its values: unit and name.
pub(super) fn about(units: Option<&str>, long_name: &str) -> Value {
    let mut about = json!({});
    if let Some(units) = units {
        about["units"] = json!(units);
    }
    about["long_name"] = json!(long_name);
    about
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two lines a chunk.
    #[test]
    fn lines_are_turned_and_the_last_chunk_is_filled_up() {
        let values: Vec<f32> = (0..51).map(|i| i as f32).collect();
        let axis = ZarrArray::of_axis("force_un", ValueKind::Quantity, 34, json!({}));
        let width = Some(17);
        let encoding = ChunkEncoding { width, ..ChunkEncoding::default() };
        let array = ZarrArray { encoding, ..axis };
        let packed = array.pack(bytemuck::cast_slice(&values));
        let frames = || packed.iter().map(|chunk| &chunk[..chunk.len() - 4]);
        let numbers = |bytes: Result<Vec<u8>, String>| -> Vec<f32> {
            bytemuck::pod_collect_to_vec(&bytes.unwrap_or_default())
        };
        let found = numbers(array.unpack(frames()));
        assert_eq!(found[..51], values);
        assert!(found.len() == 68 && found[51..].iter().all(|value| value.is_nan()));
        let columns = ZarrArray { encoding: ChunkEncoding::default(), ..array };
        let columns = numbers(columns.unpack(frames()));
        assert_eq!(columns[..4], [0.0, 17.0, 1.0, 18.0]);
    }
}
