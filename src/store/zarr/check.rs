//! Checks of the blocks and metadata of a store, and removal of damaged blocks.

use super::ZarrStore;
use super::array::ZarrArray;
use super::identity::FileIdentity;
use super::metadata::CELLS;
use super::read::open_regular;
use crate::classify::Regime;
use crate::store::{NOT_COMPUTED, StoreError};
use rayon::prelude::*;
use std::collections::HashSet;
use std::fs;
use std::io::{self, Read};
use std::ops::Range;
use std::path::Path;

/// Depth of a check of a block's files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CheckDepth {
    /// Checks identity, length and index of each file.
    Structure,
    /// Checks the checksum of each chunk, too: files are read as a whole, at several GB/s.
    Checksums,
    /// Checks every value, too: files are decoded, and the counts of regimes are compared with the regimes.
    Values,
}

/// State of a block of a store on disk.
#[derive(Debug)]
#[non_exhaustive]
pub enum BlockState {
    /// A file of the block is missing: the block is not finished.
    Missing,
    /// All files of the block exist, and those with these errors are damaged.
    Damaged(Vec<StoreError>),
    /// The file system refused to read these files of the block: they may be undamaged.
    Unreadable(Vec<StoreError>),
    /// All files of the block exist, without a fault at this depth.
    Done,
}

impl ZarrStore {
    /// Checks the files of a block and returns its state.
    #[must_use]
    pub fn state(&self, block: usize, depth: CheckDepth) -> BlockState {
        match self.is_missing(block) {
            Ok(false) => {}
            Ok(true) => return BlockState::Missing,
            Err(fault) => return BlockState::Unreadable(vec![fault]),
        }
        let faults = self.arrays.par_iter();
        let faults = faults.filter_map(|array| self.check(array, block, depth).err());
        let mut faults: Vec<StoreError> = faults.collect();
        if faults.is_empty() && depth == CheckDepth::Values {
            faults.extend(self.check_counts(block).err());
        }
        if faults.is_empty() {
            BlockState::Done
        } else if faults
            .iter()
            .any(|fault| matches!(fault, StoreError::Read(..)))
        {
            BlockState::Unreadable(faults)
        } else {
            BlockState::Damaged(faults)
        }
    }

    /// Returns true if a file of the block does not exist.
    fn is_missing(&self, block: usize) -> Result<bool, StoreError> {
        // The file that is written last is looked for first.
        for array in self.arrays.iter().rev() {
            let file = self.file(array, block);
            let exists = file.try_exists();
            if !exists.map_err(StoreError::at(&file, StoreError::Read))? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Returns the indices in the sweep of the whiskers of each block that is not finished, `[block]`.
    ///
    /// # Errors
    /// The file system refuses to look for a file.
    pub fn missing(&self) -> Result<Vec<Range<usize>>, StoreError> {
        let mut missing = Vec::new();
        for block in 0..self.block_count() {
            if self.is_missing(block)? {
                missing.push(self.whiskers(block));
            }
        }
        Ok(missing)
    }

    fn check(&self, array: &ZarrArray, block: usize, depth: CheckDepth) -> Result<(), StoreError> {
        match depth {
            CheckDepth::Structure => self.check_structure(array, &self.file(array, block)),
            CheckDepth::Checksums => self.read_file(array, &self.file(array, block)).map(drop),
            CheckDepth::Values => self.read(array, block).map(drop),
        }
    }

    /// Checks identity, length and index of a file.
    fn check_structure(&self, array: &ZarrArray, file: &Path) -> Result<(), StoreError> {
        let mut opened = open_regular(file)?;
        let fault = self.expected(array, file).structure_fault(&mut opened);
        match fault.map_err(StoreError::at(file, StoreError::Read))? {
            Some(why) => Err(StoreError::Damaged(file.to_owned(), why)),
            None => Ok(()),
        }
    }

    /// Compares the counts of regimes with the regimes.
    fn check_counts(&self, block: usize) -> Result<(), StoreError> {
        let array = |name: &str| self.arrays.iter().find(|array| array.name == name);
        let (Some(counts), Some(regimes)) = (array(CELLS), array("regime")) else {
            return Ok(());
        };
        let counted: Vec<u32> = bytemuck::pod_collect_to_vec(&self.read(counts, block)?);
        let cells = self.read(regimes, block)?;
        let of_whisker = cells.chunks(cells.len() / self.blocks.slots());
        let found = of_whisker.flat_map(|cells| {
            Regime::ALL.map(|regime| {
                let code = regime.code();
                cells.iter().filter(|own| u32::from(**own) == code).count() as u32
            })
        });
        if !found.eq(counted) {
            let why = format!("its counts are not those of the array `{}`", regimes.name);
            return Err(StoreError::Damaged(self.file(counts, block), why));
        }
        let unknown = cells.iter().find(|code| {
            **code != NOT_COMPUTED
                && Regime::ALL
                    .iter()
                    .all(|own| own.code() != u32::from(**code))
        });
        unknown.map_or(Ok(()), |code| {
            let why = format!("the code {code} has no name");
            Err(StoreError::Damaged(self.file(regimes, block), why))
        })
    }

    /// Returns missing and damaged metadata and coordinates of the store, which [`ZarrStore::begin`] and [`ZarrStore::restore_metadata`]
    /// write again.
    ///
    /// # Errors
    /// The store is of another version, whose metadata may differ, or a file cannot be read.
    pub fn metadata_faults(&self) -> Result<Vec<StoreError>, StoreError> {
        let version = self.attribute("whiskmap_version")?;
        if version != env!("CARGO_PKG_VERSION") {
            return Err(StoreError::OtherVersion(
                self.path.clone(),
                version.to_string(),
            ));
        }
        let files = self.metadata_files();
        let faults = files.iter();
        let faults = faults.filter_map(|(path, bytes)| metadata_fault(path, bytes));
        Ok(faults.collect())
    }

    /// Removes the files of a block if it is still damaged, so that a run with `--resume` computes it again. Returns true if it
    /// was damaged.
    ///
    /// # Errors
    /// A file cannot be removed, or all blocks belong to another store: then the root is wrong, not the blocks.
    pub fn remove_damaged(&self, block: usize) -> Result<bool, StoreError> {
        if self.owner() == BlockOwner::Other {
            return Err(StoreError::OtherBlocks(self.path.clone()));
        }
        // A run may have computed it again meanwhile.
        let state = self.state(block, CheckDepth::Values);
        if !matches!(state, BlockState::Damaged(_)) {
            return Ok(false);
        }
        // Without the last file the block counts as missing, whether or not the others are removed.
        for array in self.arrays.iter().rev() {
            let file = self.file(array, block);
            match fs::remove_file(&file) {
                Err(why) if why.kind() != io::ErrorKind::NotFound => {
                    return Err(StoreError::Write(file, why));
                }
                _ => {}
            }
        }
        Ok(true)
    }

    /// Returns the owner of the blocks in the store's folder, by the first bytes of their files. A file of this store in the place of
    /// another one is damaged, but belongs to it.
    pub(super) fn owner(&self) -> BlockOwner {
        let mut found = HashSet::new();
        for array in &self.arrays {
            let folder = self.path.join(&array.name);
            for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
                let is_block = entry.file_name().to_string_lossy().starts_with("c.");
                let Some(identity) = is_block.then(|| identity_in(&entry.path())).flatten() else {
                    continue;
                };
                if identity == self.expected(array, &entry.path()).identity {
                    return BlockOwner::This;
                }
                found.insert(identity);
            }
        }
        let is_found = |array: &ZarrArray, block| {
            let expected = self.expected(array, &self.file(array, block));
            found.contains(&expected.identity)
        };
        let mut blocks = 0..self.block_count();
        if found.is_empty() {
            BlockOwner::Nobody
        } else if blocks.any(|block| self.arrays.iter().any(|array| is_found(array, block))) {
            BlockOwner::This
        } else {
            BlockOwner::Other
        }
    }
}

/// The identity at the beginning of a block's file, if it is long enough.
fn identity_in(file: &Path) -> Option<FileIdentity> {
    let mut identity = FileIdentity::default();
    let read = open_regular(file).ok()?.read_exact(&mut identity);
    read.ok().map(|()| identity)
}

/// The store to which the blocks in a folder belong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BlockOwner {
    /// The folder has no blocks.
    Nobody,
    /// At least one block of the folder belongs to this store.
    This,
    /// The folder has blocks, and none belongs to this store.
    Other,
}

/// Returns the fault of a metadata file that must have these `bytes`; `None` without one. A longer file is not read to its end.
pub(super) fn metadata_fault(path: &Path, bytes: &[u8]) -> Option<StoreError> {
    let mut found = Vec::new();
    let read = open_regular(path).and_then(|file| {
        let read = file.take(bytes.len() as u64 + 1).read_to_end(&mut found);
        read.map_err(StoreError::at(path, StoreError::Read))
    });
    match read {
        Ok(_) if found == bytes => None,
        Ok(_) => {
            let why = "it is not as the scene demands";
            Some(StoreError::Damaged(path.to_owned(), why.to_owned()))
        }
        Err(StoreError::NotComputed(_)) => Some(StoreError::Damaged(
            path.to_owned(),
            "it is missing".to_owned(),
        )),
        Err(why) => Some(why),
    }
}
