//! Metadata and coordinates of a store, which follow from the scene and the settings.

use super::array::ZarrArray;
use super::check::{BlockOwner, metadata_fault};
use super::identity::AGREED;
use super::metadata::{self, IDENTITY};
use super::read::open_regular;
use super::{METADATA, ZarrStore};
use crate::store::temporary::host_of;
use crate::store::{Output, StoreError, TemporaryFiles, check_links};
use serde_json::{Map, Value};
use std::fs;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

/// Most bytes of a metadata file: a scene of 1 MiB with its radii, in JSON, needs less.
const MOST_METADATA: u64 = 16 << 20;

impl ZarrStore {
    /// Creates the store, or joins the one that is there, restores metadata that are missing or damaged, and removes temporary
    /// files of interrupted processes. Returns the damaged files that it has replaced.
    ///
    /// If several processes create a store at the same time, one creates it, and the others join it.
    ///
    /// # Errors
    /// The existing store was created with other settings or must not exist, or one of its folders cannot be written.
    pub fn begin(&self, temporary: &TemporaryFiles) -> Result<Vec<PathBuf>, StoreError> {
        let made = check_links(&self.path).and_then(|()| fs::create_dir_all(&self.path));
        made.map_err(StoreError::at(&self.path, StoreError::Write))?;
        let root = self.path.join(METADATA);
        let created = finish(&root, &[self.root()], temporary, Output::finish_new);
        match created {
            Err(why) if why.kind() == io::ErrorKind::AlreadyExists => self.agree()?,
            created => created.map_err(StoreError::at(&root, StoreError::Write))?,
        }
        for array in &self.arrays {
            let folder = self.path.join(&array.name);
            let made = check_links(&folder).and_then(|()| fs::create_dir_all(&folder));
            made.map_err(StoreError::at(&folder, StoreError::Write))?;
        }
        let restored = self.restore_metadata(temporary)?;
        let folders = self.arrays.iter().map(|array| self.path.join(&array.name));
        for folder in folders.chain([self.path.clone()]) {
            temporary
                .prepare(&folder)
                .map_err(StoreError::at(&folder, StoreError::Write))?;
        }
        Ok(restored)
    }

    /// Writes missing and damaged metadata and coordinates of the store again. Returns the paths of the files that were damaged, `[file]`.
    ///
    /// # Errors
    /// A file cannot be read or written.
    pub fn restore_metadata(&self, temporary: &TemporaryFiles) -> Result<Vec<PathBuf>, StoreError> {
        let (mut damaged, mut failures) = (Vec::new(), Vec::new());
        for (path, bytes) in self.metadata_files() {
            let restored = match metadata_fault(&path, &bytes) {
                None => continue,
                Some(StoreError::Damaged(..)) => restore(&path, &bytes, temporary),
                Some(why) => Err(why),
            };
            match restored {
                Ok(true) => damaged.push(path),
                Ok(false) => {}
                Err(why) => failures.push(why),
            }
        }
        failures.into_iter().next().map_or(Ok(damaged), Err)
    }

    /// Returns every file of metadata and coordinates of the store with its bytes; the root's is the last.
    pub(super) fn metadata_files(&self) -> Vec<(PathBuf, Vec<u8>)> {
        let mut files = Vec::new();
        for (array, values) in self.constants() {
            let folder = self.path.join(&array.name);
            files.push((folder.join(METADATA), json(&array.metadata)));
            files.push((folder.join(ZarrArray::file(&[], array.dimensions)), values));
        }
        for array in &self.arrays {
            let file = self.path.join(&array.name).join(METADATA);
            files.push((file, json(&array.metadata)));
        }
        files.push((self.path.join(METADATA), self.root()));
        files
    }

    /// The bytes of the root's metadata.
    fn root(&self) -> Vec<u8> {
        let constants = self.constants();
        let constants = constants.iter().map(|(array, _)| array);
        json(&metadata::group(
            &self.attributes,
            constants.chain(&self.arrays),
        ))
    }

    fn constants(&self) -> Vec<(ZarrArray, Vec<u8>)> {
        metadata::constants(&self.scene.grid, self.digits)
    }

    /// Checks that the store at the path, if any, has these settings. Its metadata may be damaged if its blocks belong to this store.
    pub(super) fn agree(&self) -> Result<(), StoreError> {
        match Self::open(&self.path) {
            Ok(_) if !self.may_exist => Err(StoreError::Exists(self.path.clone())),
            Ok(there) => {
                self.agree_with(&there)?;
                match self.owner() {
                    BlockOwner::Other => Err(StoreError::OtherBlocks(self.path.clone())),
                    BlockOwner::Nobody | BlockOwner::This => Ok(()),
                }
            }
            Err(why) if is_absent(&why) => {
                let (owner, is_empty) = (self.owner(), is_empty(&self.path));
                // Another process may have created it meanwhile: the root first.
                if Self::is_at(&self.path) {
                    return self.agree();
                }
                match owner {
                    BlockOwner::Other => Err(StoreError::OtherBlocks(self.path.clone())),
                    BlockOwner::Nobody if !is_empty => {
                        let why = format!("it has files, but no {METADATA}");
                        Err(StoreError::NotAStore(self.path.clone(), why))
                    }
                    BlockOwner::Nobody | BlockOwner::This => Ok(()),
                }
            }
            Err(StoreError::NotAStore(..) | StoreError::Damaged(..))
                if self.may_exist && self.owner() == BlockOwner::This =>
            {
                Ok(())
            }
            Err(why) => Err(why),
        }
    }

    fn agree_with(&self, there: &Self) -> Result<(), StoreError> {
        let apart = AGREED
            .iter()
            .find(|name| self.attributes.get(**name) != there.attributes.get(**name));
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
        Err(StoreError::AtOdds {
            path: self.path.clone(),
            name,
            there,
            here,
        })
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
}

/// Returns true for the error of a path without a folder, or of a folder without metadata.
fn is_absent(why: &StoreError) -> bool {
    match why {
        StoreError::Read(_, why) => why.kind() == io::ErrorKind::NotFound,
        why => matches!(why, StoreError::NoStore(_)),
    }
}

/// Reads the attributes of the store at `path` from its root.
pub(super) fn attributes(path: &Path) -> Result<Map<String, Value>, StoreError> {
    let file = path.join(METADATA);
    let foreign =
        |why: &dyn std::fmt::Display| StoreError::NotAStore(path.to_owned(), why.to_string());
    let mut text = Vec::new();
    fs::metadata(path).map_err(StoreError::at(path, StoreError::Read))?;
    let source = open_regular(&file).map_err(|why| match why {
        StoreError::NotComputed(_) => StoreError::NoStore(path.to_owned()),
        why => why,
    })?;
    let read = source.take(MOST_METADATA + 1).read_to_end(&mut text);
    if read.map_err(StoreError::at(&file, StoreError::Read))? as u64 > MOST_METADATA {
        return Err(foreign(&format!("{METADATA} is longer than 16 MiB")));
    }
    let root = serde_json::from_slice(&text);
    let mut root: Value = root.map_err(|why| foreign(&format!("{METADATA}: {why}")))?;
    match root.get_mut("attributes").map(Value::take) {
        Some(Value::Object(attributes)) => Ok(attributes),
        _ => Err(foreign(&"it has no attributes")),
    }
}

/// Returns true if a folder is missing or has only temporary files.
fn is_empty(folder: &Path) -> bool {
    let names = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names = names.map(|entry| entry.file_name());
    names.all(|name| name.to_str().and_then(host_of).is_some())
}

/// Writes a metadata file again. Returns true if it existed.
fn restore(path: &Path, bytes: &[u8], temporary: &TemporaryFiles) -> Result<bool, StoreError> {
    let was_there = path.exists();
    let folder = path.parent().map_or(Ok(()), fs::create_dir_all);
    folder.map_err(StoreError::at(path, StoreError::Write))?;
    write(path, &[bytes], temporary)?;
    Ok(was_there)
}

fn json(value: &Value) -> Vec<u8> {
    value.to_string().into_bytes()
}

/// Writes a file as a whole, piece by piece, into an existing folder. It is on the disk before this returns, because a run that resumes
/// after a crash takes existing files for finished ones.
pub(super) fn write(
    path: &Path,
    pieces: &[impl AsRef<[u8]>],
    temporary: &TemporaryFiles,
) -> Result<(), StoreError> {
    let written = finish(path, pieces, temporary, Output::finish_durably);
    written.map_err(StoreError::at(path, StoreError::Write))
}

fn finish(
    path: &Path,
    pieces: &[impl AsRef<[u8]>],
    temporary: &TemporaryFiles,
    finish: fn(Output) -> io::Result<()>,
) -> io::Result<()> {
    let mut output = Output::create(path, temporary)?;
    if !output.is_regular() {
        return Err(io::Error::other("it is no regular file"));
    }
    let mut pieces = pieces.iter();
    pieces.try_for_each(|piece| output.write_all(piece.as_ref()))?;
    finish(output)
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
