//! Shards: the file of a block, with identity, chunks without gaps, index, and checksum of the index.
//!
//! The index has the position and the size of each chunk, as pairs of little-endian `u64`. Zarr readers find chunks by the index
//! and ignore the identity.

use super::blosc;
use super::identity::FileIdentity;
use std::borrow::Cow;
use std::io::{self, Read, Seek, SeekFrom};

/// Bytes of the identity.
const HEAD: u64 = size_of::<FileIdentity>() as u64;

/// Bytes of a CRC-32C, of the index or of a chunk.
const CHECKSUM: usize = 4;

/// Bytes of a chunk's entry in the index.
const ENTRY: usize = 16;

/// The most bytes by which packing makes a chunk larger.
const OVERHEAD: u64 = (blosc::OVERHEAD + CHECKSUM) as u64;

/// Returns the pieces of the file of a block with these chunks, in order.
pub(super) fn assemble<'a>(
    identity: FileIdentity,
    chunks: impl Iterator<Item = &'a [u8]> + Clone,
) -> Vec<Cow<'a, [u8]>> {
    let mut index = Vec::new();
    let mut position = HEAD;
    for chunk in chunks.clone() {
        let size = chunk.len() as u64;
        index.extend([position, size].map(u64::to_le_bytes).concat());
        position += size;
    }
    let checksum = crc32c::crc32c(&index);
    index.extend(checksum.to_le_bytes());
    let head = Cow::from(identity.to_vec());
    let chunks = chunks.map(Cow::from);
    [head].into_iter().chain(chunks).chain([index.into()]).collect()
}

/// Identity and sizes that a file of a block must have.
#[derive(Clone, Copy, Debug)]
pub(super) struct ExpectedFile {
    pub(super) identity: FileIdentity,
    /// Number of chunks that the file must have.
    pub(super) chunks: usize,
    /// Size in bytes of the values of a chunk of the file.
    pub(super) chunk_bytes: usize,
}

impl ExpectedFile {
    /// Returns the largest size in bytes that the file can have.
    pub(super) fn most_bytes(&self) -> u64 {
        let chunks = self.chunks as u64 * (self.chunk_bytes as u64 + OVERHEAD);
        HEAD + chunks + self.index_bytes() as u64
    }

    fn index_bytes(&self) -> usize {
        self.chunks * ENTRY + CHECKSUM
    }

    /// Returns the fault of identity, length or index of a block's file; `None` without one. Chunks are not read.
    pub(super) fn structure_fault(
        &self,
        file: &mut (impl Read + Seek),
    ) -> io::Result<Option<String>> {
        let length = file.seek(SeekFrom::End(0))?;
        let index_bytes = self.index_bytes();
        let Some(end) = length.checked_sub(index_bytes as u64).filter(|end| *end >= HEAD) else {
            return Ok(Some(format!("its {length} bytes are too few")));
        };
        if length > self.most_bytes() {
            return Ok(Some(format!("its {length} bytes are too many")));
        }
        let mut identity = FileIdentity::default();
        file.rewind()?;
        file.read_exact(&mut identity)?;
        let mut index = vec![0; index_bytes];
        file.seek(SeekFrom::Start(end))?;
        file.read_exact(&mut index)?;
        Ok(self.index_fault(identity, &index, end).map(str::to_owned))
    }

    fn index_fault(&self, identity: FileIdentity, index: &[u8], end: u64) -> Option<&'static str> {
        if !has_checksum(index) {
            return Some("the index does not have its checksum");
        }
        let (entries, _) = index.as_chunks::<ENTRY>();
        let mut position = HEAD;
        for entry in entries {
            let [begin, size] = numbers(entry);
            if begin != position || size > end - position {
                return Some("the index does not fit the file's length");
            }
            position += size;
        }
        if position != end {
            return Some("the index does not fit the file's length");
        }
        let why = "it belongs to another block, or to a store of another scene, version, engine, \
            arithmetic, accuracy, channels or digits";
        (identity != self.identity).then_some(why)
    }

    /// Returns the fault of the chunks of a whole block's file without a structure fault, by their checksums; `None` without one.
    pub(super) fn chunk_fault(&self, file: &[u8]) -> Option<String> {
        let damaged = self.chunks(file).position(|chunk| !has_checksum(chunk))?;
        Some(format!("chunk {damaged} does not have its checksum"))
    }

    /// Returns the chunks of a whole block's file without a fault, without their checksums.
    pub(super) fn frames<'a>(&self, file: &'a [u8]) -> impl Iterator<Item = &'a [u8]> {
        let chunks = self.chunks(file);
        chunks.map(|chunk| &chunk[..chunk.len().saturating_sub(CHECKSUM)])
    }

    /// The chunks of a whole file without a structure fault.
    fn chunks<'a>(&self, file: &'a [u8]) -> impl Iterator<Item = &'a [u8]> {
        let (entries, _) = file[file.len() - self.index_bytes()..].as_chunks::<ENTRY>();
        entries.iter().map(|entry| {
            let [begin, size] = numbers(entry).map(|number| number as usize);
            &file[begin..begin + size]
        })
    }
}

/// Returns true if the last bytes are the checksum of the bytes before them.
fn has_checksum(bytes: &[u8]) -> bool {
    bytes
        .split_last_chunk::<CHECKSUM>()
        .is_some_and(|(bytes, checksum)| crc32c::crc32c(bytes) == u32::from_le_bytes(*checksum))
}

/// Position and size of a chunk, from its entry in the index.
fn numbers(entry: &[u8; ENTRY]) -> [u64; 2] {
    let number = u128::from_le_bytes(*entry);
    [number as u64, (number >> 64) as u64]
}
