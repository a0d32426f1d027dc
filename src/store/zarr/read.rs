//! Reading of the files of a block.

use super::ZarrStore;
use super::array::ZarrArray;
use super::encoding::ValueKind;
use super::metadata::CELLS;
use super::shard::ExpectedFile;
use crate::classify::Regime;
use crate::input;
use crate::store::{ChannelValues, StoreError};
use std::fs::File;
use std::io::{self, Cursor, Read};
use std::ops::Range;
use std::path::Path;

impl ZarrStore {
    /// Reads the number of cells of each regime in a block, in the order of [`Regime::ALL`].
    ///
    /// # Errors
    /// The block is missing or damaged.
    pub fn regimes(&self, block: usize) -> Result<[u64; Regime::ALL.len()], StoreError> {
        let mut regimes = [0; Regime::ALL.len()];
        for array in self.arrays.iter().filter(|array| array.name == CELLS) {
            let values: Vec<u32> = bytemuck::pod_collect_to_vec(&self.read(array, block)?);
            for of_whisker in values.chunks(regimes.len()) {
                for (sum, cells) in regimes.iter_mut().zip(of_whisker) {
                    *sum += u64::from(*cells);
                }
            }
        }
        Ok(regimes)
    }

    /// Reads a channel of one whisker of the store: `[distance][push angle]`.
    ///
    /// # Errors
    /// There is no such channel, or the whisker's block is missing or damaged.
    pub fn read_panel(&self, name: &str, whisker: usize) -> Result<ChannelValues, StoreError> {
        self.read_panels(name, whisker..whisker + 1)
    }

    /// Reads a channel of consecutive whiskers of the store: `[whisker][distance][push angle]`. Each file of a block is read once.
    ///
    /// # Errors
    /// There is no such channel, or a block is missing or damaged.
    pub fn read_panels(
        &self,
        name: &str,
        whiskers: Range<usize>,
    ) -> Result<ChannelValues, StoreError> {
        let mut arrays = self.arrays.iter();
        let array = arrays.find(|array| array.name == name && name != CELLS).ok_or_else(|| {
            StoreError::UnknownChannel {
                path: self.path.clone(),
                name: name.to_owned(),
                known: self.channels.to_string(),
            }
        })?;
        let panel_bytes = self.blocks.panel.iter().product::<usize>() * array.kind.size();
        let mut bytes = Vec::with_capacity(whiskers.len() * panel_bytes);
        let mut next = whiskers.start;
        while next < whiskers.end {
            let (block, first) = self.blocks.find(next);
            let end = self.blocks.whiskers(block).end.min(whiskers.end);
            let file = self.file(array, block);
            let (expected, packed) = self.read_file(array, &file).map_err(|why| match why {
                _ if self.check_place().is_err() => StoreError::Displaced(self.path.clone()),
                StoreError::NotComputed(_) => StoreError::Unfinished(self.path.clone()),
                why => why,
            })?;
            let chunks = expected.chunks / self.blocks.slots();
            let frames: Vec<&[u8]> = expected.frames(&packed).collect();
            for index in first..first + (end - next) {
                let slot = self.blocks.slot(block, index) * chunks;
                let values = array
                    .unpack(frames[slot..slot + chunks].iter().copied())
                    .map_err(StoreError::at(&file, StoreError::Damaged))?;
                bytes.extend_from_slice(&values[..panel_bytes]);
            }
            next = end;
        }
        Ok(match array.kind {
            ValueKind::Code => ChannelValues::U32(bytes.into_iter().map(u32::from).collect()),
            ValueKind::Count => ChannelValues::U32(bytemuck::pod_collect_to_vec(&bytes)),
            _ => ChannelValues::F32(bytemuck::pod_collect_to_vec(&bytes)),
        })
    }

    /// Reads the values of the file of a block, as bytes.
    pub(super) fn read(&self, array: &ZarrArray, block: usize) -> Result<Vec<u8>, StoreError> {
        let path = self.file(array, block);
        let (expected, bytes) = self.read_file(array, &path)?;
        let values = array.unpack(expected.frames(&bytes));
        values.map_err(StoreError::at(&path, StoreError::Damaged))
    }

    /// Reads the file of a block and checks its structure and checksums.
    pub(super) fn read_file(
        &self,
        array: &ZarrArray,
        path: &Path,
    ) -> Result<(ExpectedFile, Vec<u8>), StoreError> {
        let file = open_regular(path)?;
        let expected = self.expected(array, path);
        let mut bytes = Vec::new();
        let read = file.take(expected.most_bytes() + 1).read_to_end(&mut bytes);
        read.map_err(StoreError::at(path, StoreError::Read))?;
        let fault = expected
            .structure_fault(&mut Cursor::new(&bytes))
            .map_err(StoreError::at(path, StoreError::Read))?;
        match fault.or_else(|| expected.chunk_fault(&bytes)) {
            Some(why) => Err(StoreError::Damaged(path.to_owned(), why)),
            None => Ok((expected, bytes)),
        }
    }

    /// Returns the identity and sizes that the file `path` of an array must have.
    pub(super) fn expected(&self, array: &ZarrArray, path: &Path) -> ExpectedFile {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        ExpectedFile {
            identity: self.identity.of_file(&array.name, &name),
            chunks: array.chunk_count(),
            chunk_bytes: array.chunk_bytes(),
        }
    }
}

/// Opens a regular file of a store.
pub(super) fn open_regular(path: &Path) -> Result<File, StoreError> {
    let failed = |why: io::Error| match why.kind() {
        io::ErrorKind::NotFound => StoreError::NotComputed(path.to_owned()),
        _ => StoreError::Read(path.to_owned(), why),
    };
    let file = input::open_regular(path).map_err(failed)?;
    file.ok_or_else(|| StoreError::NotAFile(path.to_owned()))
}
