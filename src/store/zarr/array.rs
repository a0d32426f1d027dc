//! One array of a store: its metadata as Zarr has them, and its blocks from values to bytes and back.

use super::blocks::Blocks;
use super::chunk::{self, Chunk};
use super::kind::{Kind, options};
use serde_json::{Map, Value, json};
use std::num::NonZeroU64;
use std::sync::Arc;
use zarrs::array::codec::api::ArrayToBytesCodecTraits;
use zarrs::array::{ArrayBytes, ArrayMetadata};

/// An array of a store.
#[derive(Debug)]
pub(super) struct Array {
    pub(super) name: String,
    pub(super) kind: Kind,
    /// The metadata as they are written.
    pub(super) metadata: Value,
    array: zarrs::array::Array<()>,
    /// The shape of a block's file.
    shape: Vec<NonZeroU64>,
    /// How a chunk of a block's file is packed.
    chunk: Chunk,
}

impl Array {
    /// Values for each cell, `[sweep axes.., distance, push angle]`, in blocks.
    pub(super) fn of_cells(
        name: &str,
        kind: Kind,
        blocks: &Blocks,
        dimensions: &[&str],
        about: Value,
    ) -> Result<Self, String> {
        let [chunk, filled] = blocks.distances();
        let [distances, push_angles] = blocks.panel();
        let sizes = [[distances, filled, chunk], [push_angles; 3]];
        let width = chunk::is_turned(name, kind).then_some(push_angles);
        Self::in_blocks(name, kind, blocks, (&sizes, width), dimensions, about)
    }

    /// `count` values for each whisker, in blocks.
    pub(super) fn of_whiskers(
        name: &str,
        kind: Kind,
        blocks: &Blocks,
        count: usize,
        dimensions: &[&str],
        about: Value,
    ) -> Result<Self, String> {
        let sizes = (&[[count; 3]][..], None);
        Self::in_blocks(name, kind, blocks, sizes, dimensions, about)
    }

    /// An array whose last dimensions have these `sizes`: in all, in a block's file, in a chunk, whose lines are turned into columns
    /// where they have a `width`.
    fn in_blocks(
        name: &str,
        kind: Kind,
        blocks: &Blocks,
        (sizes, width): (&[[usize; 3]], Option<usize>),
        dimensions: &[&str],
        about: Value,
    ) -> Result<Self, String> {
        let [axes, block] = blocks.sweep();
        let sweep = axes.iter().zip(block).map(|(all, block)| [*all, *block, 1]);
        let sizes: Vec<[usize; 3]> = sweep.chain(sizes.iter().copied()).collect();
        let [all, file, chunk] =
            [0, 1, 2].map(|which| -> Vec<usize> { sizes.iter().map(|size| size[which]).collect() });
        let packed = Chunk::new(kind, chunk.iter().product(), width)?;
        let codecs = json!([{ "name": "sharding_indexed", "configuration": {
            "chunk_shape": chunk,
            "codecs": packed.codecs(chunk.len()),
            "index_codecs": [
                { "name": "bytes", "configuration": { "endian": "little" } },
                { "name": "crc32c" },
            ],
            "index_location": "end",
        } }]);
        Self::new(
            name,
            kind,
            [&all, &file],
            dimensions,
            (about, codecs),
            packed,
        )
    }

    /// The values along an axis.
    pub(super) fn of_axis(
        name: &str,
        kind: Kind,
        count: usize,
        about: Value,
    ) -> Result<Self, String> {
        let plain = json!([{ "name": "bytes", "configuration": { "endian": "little" } }]);
        let chunk = Chunk::new(kind, count, None)?;
        Self::new(name, kind, [&[count]; 2], &[name], (about, plain), chunk)
    }

    fn new(
        name: &str,
        kind: Kind,
        [all, file]: [&[usize]; 2],
        dimensions: &[&str],
        (about, codecs): (Value, Value),
        chunk: Chunk,
    ) -> Result<Self, String> {
        let metadata = json!({
            "zarr_format": 3,
            "node_type": "array",
            "shape": all,
            "data_type": kind.name(),
            "chunk_grid": { "name": "regular", "configuration": { "chunk_shape": file } },
            "chunk_key_encoding": { "name": "default", "configuration": { "separator": "." } },
            "fill_value": kind.fill(),
            "codecs": codecs,
            "attributes": about,
            "dimension_names": dimensions,
        });
        let parsed: ArrayMetadata =
            serde_json::from_value(metadata.clone()).map_err(|why| why.to_string())?;
        let path = format!("/{name}");
        let array = zarrs::array::Array::new_with_metadata(Arc::new(()), &path, parsed)
            .map_err(|why| why.to_string())?;
        let shape = file.iter().filter_map(|&size| NonZeroU64::new(size as u64));
        Ok(Self {
            name: name.to_owned(),
            kind,
            shape: shape.collect(),
            metadata,
            array,
            chunk,
        })
    }

    /// The name of a block's file in the folder of the array.
    pub(super) fn file(place: &[usize], dimensions: usize) -> String {
        let inside = std::iter::repeat_n(&0, dimensions);
        let indices = place.iter().chain(inside).map(usize::to_string);
        std::iter::once("c".to_owned())
            .chain(indices)
            .collect::<Vec<_>>()
            .join(".")
    }

    /// How many dimensions there are.
    pub(super) fn dimensions(&self) -> usize {
        self.shape.len()
    }

    /// Values of a block's file.
    pub(super) fn values(&self) -> usize {
        let sizes = self.shape.iter().map(|size| size.get() as usize);
        sizes.product()
    }

    /// Chunks of a block's file.
    pub(super) fn chunk_count(&self) -> usize {
        self.values() * self.kind.size() / self.chunk.bytes()
    }

    /// Bytes of a chunk's values.
    pub(super) const fn chunk_bytes(&self) -> usize {
        self.chunk.bytes()
    }

    /// The chunks of a whisker with these values, as bytes.
    pub(super) fn chunks(&self, values: &[u8]) -> Result<Vec<Vec<u8>>, String> {
        self.chunk.pack_all(values)
    }

    /// The chunks of a whisker that there is not, with room for `values` of them.
    pub(super) fn empty(&self, values: usize) -> Result<Vec<Vec<u8>>, String> {
        self.chunk.pack_all(&self.kind.fill_bytes().repeat(values))
    }

    /// The file with these values, as bytes.
    pub(super) fn encode(&self, values: Vec<u8>) -> Result<Vec<u8>, String> {
        let array = &self.array;
        let (kind, fill) = (array.data_type(), array.fill_value());
        let values = ArrayBytes::new_flen(values);
        let encoded = array
            .codecs()
            .encode(values, &self.shape, kind, fill, &options());
        encoded
            .map(std::borrow::Cow::into_owned)
            .map_err(|why| why.to_string())
    }

    /// The values of a block's file, as bytes.
    pub(super) fn decode(&self, file: Vec<u8>) -> Result<Vec<u8>, String> {
        let array = &self.array;
        let (kind, fill) = (array.data_type(), array.fill_value());
        let decoded = array
            .codecs()
            .decode(file.into(), &self.shape, kind, fill, &options())
            .map_err(|why| why.to_string())?;
        let values = decoded.into_fixed().map_err(|why| why.to_string())?;
        Ok(values.into_owned())
    }
}

/// Attributes by which xarray knows what an array holds.
pub(super) fn about(units: Option<&str>, long_name: &str) -> Map<String, Value> {
    let mut about = Map::new();
    if let Some(units) = units {
        about.insert("units".to_owned(), json!(units));
    }
    about.insert("long_name".to_owned(), json!(long_name));
    about
}
