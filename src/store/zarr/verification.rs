//! Verification of a store: it belongs to the settings of a run, and its files are sound.
//!
//! The identity of a store is a hash of everything that its bytes depend on. Each file of a block begins with a hash of the store's
//! identity and its own place. So one check finds a damaged file and a file of another store or place. A check has two depths
//! ([`CheckDepth`]): the structure of files, or all of their values.

use super::array::ZarrArray;
use super::files::{attributes, metadata_fault};
use super::identity::{AGREED, FileIdentity, IDENTITY};
use super::metadata::CELLS;
use super::read::open_regular;
use super::{METADATA, ZarrStore};
use crate::classify::Regime;
use crate::store::temporary::host_of;
use crate::store::{NOT_COMPUTED, StoreError};
use rayon::prelude::*;
use serde_json::{Map, Value};
use std::collections::HashSet;
use std::fs;
use std::io::{self, Read};
use std::ops::Range;
use std::path::Path;

/// Depth of a check of a block's files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CheckDepth {
    /// Checks identity, length and index of each file, without reading its chunks.
    Structure,
    /// Checks every value, too: checksums, decoded values, and the counts of regimes, which are compared with the regimes.
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

/// Settings of a run, and the store on disk.
impl ZarrStore {
    /// Checks that the store at the path, if any, has these settings. Its metadata may be damaged if its blocks belong to this store.
    pub(super) fn agree(&self) -> Result<(), StoreError> {
        match Self::open(&self.path) {
            Ok(_) if !self.may_exist => Err(StoreError::Exists(self.path.clone())),
            Ok(there) => {
                self.agree_with(&there)?;
                self.has_blocks().map(drop)
            }
            Err(why) if is_absent(&why) => {
                let (has_blocks, is_empty) = (self.has_blocks(), is_empty(&self.path));
                // Another process may have created the store in the meantime: the root first.
                if Self::is_at(&self.path) {
                    return self.agree();
                }
                if has_blocks? || is_empty {
                    return Ok(());
                }
                let why = format!("it has files, but no {METADATA}");
                Err(StoreError::NotAStore(self.path.clone(), why))
            }
            Err(StoreError::NotAStore(..) | StoreError::Damaged(..))
                if self.may_exist && matches!(self.has_blocks(), Ok(true)) =>
            {
                Ok(())
            }
            Err(why) => Err(why),
        }
    }

    fn agree_with(&self, there: &Self) -> Result<(), StoreError> {
        let apart =
            AGREED.iter().find(|name| self.attributes.get(**name) != there.attributes.get(**name));
        let Some(name) = apart else {
            return Ok(());
        };
        let text = |store: &Self| match store.attributes.get(*name) {
            Some(Value::String(text)) => text.clone(),
            Some(value) => value.to_string(),
            None => "nothing".to_owned(),
        };
        let (there, here) = (text(there), text(self));
        let [there, here] = first_difference(&there, &here);
        Err(StoreError::AtOdds { path: self.path.clone(), name, there, here })
    }

    /// Checks that the store at its path still has this identity.
    pub(super) fn check_place(&self) -> Result<(), StoreError> {
        let found = attributes(&self.path);
        let is_same =
            |found: &Map<String, Value>| found.get(IDENTITY) == self.attributes.get(IDENTITY);
        if found.is_ok_and(|found| is_same(&found)) {
            Ok(())
        } else {
            Err(StoreError::Displaced(self.path.clone()))
        }
    }

    /// Returns true if a block in the store's folder belongs to this store, by the first bytes of its files. Returns false if the folder
    /// has no blocks. A file of this store in the place of another file is damaged, but belongs to the store.
    ///
    /// # Errors
    /// The folder has blocks, and none belongs to this store.
    fn has_blocks(&self) -> Result<bool, StoreError> {
        let mut found = HashSet::new();
        for array in &self.arrays {
            let folder = self.path.join(&array.name);
            for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
                let is_block = entry.file_name().to_string_lossy().starts_with("c.");
                let Some(identity) = is_block.then(|| identity_in(&entry.path())).flatten() else {
                    continue;
                };
                if identity == self.expected(array, &entry.path()).identity {
                    return Ok(true);
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
            Ok(false)
        } else if blocks.any(|block| self.arrays.iter().any(|array| is_found(array, block))) {
            Ok(true)
        } else {
            Err(StoreError::OtherBlocks(self.path.clone()))
        }
    }
}

/// Returns true for the error of a path without a folder, or of a folder without metadata.
fn is_absent(why: &StoreError) -> bool {
    match why {
        StoreError::Read(_, why) => why.kind() == io::ErrorKind::NotFound,
        why => matches!(why, StoreError::NoStore(_)),
    }
}

/// Returns true if a folder is missing or has only temporary files.
fn is_empty(folder: &Path) -> bool {
    let names = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names = names.map(|entry| entry.file_name());
    names.all(|name| name.to_str().and_then(host_of).is_some())
}

/// The first lines in which two texts differ.
fn first_difference(one: &str, other: &str) -> [String; 2] {
    let mut lines = [one.lines(), other.lines()];
    let mut number = 0;
    loop {
        number += 1;
        let [one, other] = lines.each_mut().map(Iterator::next);
        if one.is_none() && other.is_none() {
            return ["line endings", "other line endings"].map(str::to_owned);
        }
        if one != other {
            let shown = |line: Option<&str>| match (line, number) {
                (None, _) => "nothing more".to_owned(),
                (Some(line), 1) => line.to_owned(),
                (Some(line), _) => format!("`{line}` in line {number}"),
            };
            return [one, other].map(shown);
        }
    }
}

/// The identity at the beginning of a block's file, if it is long enough.
fn identity_in(file: &Path) -> Option<FileIdentity> {
    let mut identity = FileIdentity::default();
    let read = open_regular(file).ok()?.read_exact(&mut identity);
    read.ok().map(|()| identity)
}

/// Files of the store on disk.
impl ZarrStore {
    /// Checks the files of a block and returns its state.
    #[must_use]
    pub fn state(&self, block: usize, depth: CheckDepth) -> BlockState {
        match self.is_missing(block) {
            Ok(false) => {}
            Ok(true) => return BlockState::Missing,
            Err(fault) => return BlockState::Unreadable(vec![fault]),
        }
        let arrays = self.arrays.par_iter();
        let found = arrays.filter_map(|array| self.check(array, block, depth).err());
        let mut faults: Vec<StoreError> = found.collect();
        if faults.is_empty() && depth == CheckDepth::Values {
            faults.extend(self.check_counts(block).err());
        }
        if faults.is_empty() {
            BlockState::Done
        } else if faults.iter().any(|fault| matches!(fault, StoreError::Read(..))) {
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

    /// Checks the file of an array of a block.
    fn check(&self, array: &ZarrArray, block: usize, depth: CheckDepth) -> Result<(), StoreError> {
        if depth == CheckDepth::Values {
            return self.read(array, block).map(drop);
        }
        let file = self.file(array, block);
        let mut opened = open_regular(&file)?;
        let fault = self.expected(array, &file).structure_fault(&mut opened);
        match fault.map_err(StoreError::at(&file, StoreError::Read))? {
            Some(why) => Err(StoreError::Damaged(file, why)),
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
                cells.iter().filter(|cell| u32::from(**cell) == code).count() as u32
            })
        });
        if !found.eq(counted) {
            let why = format!("its counts are not those of the array `{}`", regimes.name);
            return Err(StoreError::Damaged(self.file(counts, block), why));
        }
        let unknown = cells.iter().find(|code| {
            **code != NOT_COMPUTED
                && Regime::ALL.iter().all(|regime| regime.code() != u32::from(**code))
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
            return Err(StoreError::OtherVersion(self.path.clone(), version.to_string()));
        }
        let files = self.metadata_files();
        let faults = files.iter().filter_map(|(path, bytes)| metadata_fault(path, bytes));
        Ok(faults.collect())
    }

    /// Removes the files of a block if it is still damaged, so that a run with `--resume` computes it again. Returns true if it
    /// was damaged.
    ///
    /// # Errors
    /// A file cannot be removed, or all blocks belong to another store: then the root is wrong, not the blocks.
    pub fn remove_damaged(&self, block: usize) -> Result<bool, StoreError> {
        self.has_blocks()?;
        // A run may have computed the block again in the meantime.
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
}
