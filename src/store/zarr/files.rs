//! Metadata and coordinates of a store, which follow from the scene and the settings.

use super::array::ZarrArray;
use super::metadata;
use super::read::open_regular;
use super::{METADATA, ZarrStore};
use crate::store::temporary::sync_folder;
use crate::store::{Output, StoreError, TemporaryFiles};
use serde_json::{Map, Value};
use std::fs;
use std::io::{self, Read, Write};
use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::thread::{self, ScopedJoinHandle};

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
        let made = temporary.create_folders(&self.path);
        made.map_err(StoreError::at(&self.path, StoreError::Write))?;
        let root = self.path.join(METADATA);
        let created = create(&root, &[self.root()], temporary, false);
        match created.and_then(|()| sync_folder(&self.path)) {
            Err(why) if why.kind() == io::ErrorKind::AlreadyExists => self.agree()?,
            created => created.map_err(StoreError::at(&root, StoreError::Write))?,
        }
        for array in &self.arrays {
            let folder = self.path.join(&array.name);
            let made = temporary.create_folders(&folder);
            made.map_err(StoreError::at(&folder, StoreError::Write))?;
        }
        let restored = self.restore_metadata(temporary)?;
        let folders = self.arrays.iter().map(|array| self.path.join(&array.name));
        for folder in folders.chain([self.path.clone()]) {
            temporary.prepare(&folder).map_err(StoreError::at(&folder, StoreError::Write))?;
        }
        Ok(restored)
    }

    /// Writes missing and damaged metadata and coordinates of the store again. Returns the paths of the files that were damaged, `[file]`.
    ///
    /// # Errors
    /// A file cannot be read or written.
    pub fn restore_metadata(&self, temporary: &TemporaryFiles) -> Result<Vec<PathBuf>, StoreError> {
        let files = self.metadata_files();
        let restored = on_threads(&files, |(path, bytes)| match metadata_fault(path, bytes) {
            None => Ok(None),
            Some(StoreError::Damaged(..)) => {
                let was_there = restore(path, bytes, temporary)?;
                Ok(was_there.then(|| path.clone()))
            }
            Some(why) => Err(why),
        });
        restored.into_iter().filter_map(Result::transpose).collect()
    }

    /// Brings the names of all files of the store to the disk. Before that, a crash of the machine may take the last blocks back: they are
    /// missing then, not damaged. One call for all blocks takes the place of one for each file, of 1 to 5 ms.
    ///
    /// # Errors
    /// A folder cannot be brought to the disk.
    pub fn sync(&self) -> Result<(), StoreError> {
        let arrays = self.constants().into_iter().map(|(array, _)| array.name);
        let arrays = arrays.chain(self.arrays.iter().map(|array| array.name.clone()));
        let folders = arrays.map(|name| self.path.join(name));
        for folder in folders.chain([self.path.clone()]) {
            sync_folder(&folder).map_err(StoreError::at(&folder, StoreError::Write))?;
        }
        Ok(())
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
        json(&metadata::group(&self.attributes, constants.chain(&self.arrays)))
    }

    fn constants(&self) -> Vec<(ZarrArray, Vec<u8>)> {
        metadata::constants(&self.scene.grid, self.digits)
    }
}

/// Reads the attributes of the store at `path` from its root.
pub(super) fn attributes(path: &Path) -> Result<Map<String, Value>, StoreError> {
    let file = path.join(METADATA);
    let foreign =
        |why: &dyn std::fmt::Display| StoreError::NotAStore(path.to_owned(), why.to_string());
    let mut text = Vec::new();
    let found = fs::metadata(path).map_err(StoreError::at(path, StoreError::Read))?;
    if !found.is_dir() {
        return Err(StoreError::NoStore(path.to_owned()));
    }
    let source = open_regular(&file).map_err(|why| match why {
        StoreError::NotComputed(_) => StoreError::NoStore(path.to_owned()),
        why => why,
    })?;
    let read = source.take(MOST_METADATA + 1).read_to_end(&mut text);
    if read.map_err(StoreError::at(&file, StoreError::Read))? as u64 > MOST_METADATA {
        return Err(foreign(&format!("{METADATA} is longer than 16 MiB")));
    }
    let mut root: Value =
        serde_json::from_slice(&text).map_err(|why| foreign(&format!("{METADATA}: {why}")))?;
    match root.get_mut("attributes").map(Value::take) {
        Some(Value::Object(attributes)) => Ok(attributes),
        _ => Err(foreign(&"it has no attributes")),
    }
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
        Err(StoreError::NotComputed(_)) => {
            Some(StoreError::Damaged(path.to_owned(), "it is missing".to_owned()))
        }
        Err(why) => Some(why),
    }
}

/// Writes a metadata file again. Returns true if it existed.
fn restore(path: &Path, bytes: &[u8], temporary: &TemporaryFiles) -> Result<bool, StoreError> {
    let was_there = path.exists();
    let folder = path.parent().map_or(Ok(()), |folder| temporary.create_folders(folder));
    folder.map_err(StoreError::at(path, StoreError::Write))?;
    write(path, &[bytes], temporary)?;
    Ok(was_there)
}

fn json(value: &Value) -> Vec<u8> {
    value.to_string().into_bytes()
}

/// Calls `write` for each file on a thread of its own, because it waits for the disk, and returns the results. Without more threads it calls
/// `write` on this one.
pub(super) fn on_threads<T: Sync, R: Send>(files: &[T], write: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let write = &write;
    thread::scope(|scope| {
        let begun = files.iter().map(|file| {
            let thread = thread::Builder::new().spawn_scoped(scope, move || write(file));
            thread.map_err(|_| write(file))
        });
        let begun: Vec<Result<ScopedJoinHandle<'_, R>, R>> = begun.collect();
        let ended = begun.into_iter().map(|begun| match begun {
            Ok(thread) => thread.join().unwrap_or_else(|panic| resume_unwind(panic)),
            Err(written) => written,
        });
        ended.collect()
    })
}

/// Writes a file as a whole, piece by piece, into an existing folder. [`ZarrStore::sync`] brings its name to the disk.
pub(super) fn write(
    path: &Path,
    pieces: &[impl AsRef<[u8]>],
    temporary: &TemporaryFiles,
) -> Result<(), StoreError> {
    let written = create(path, pieces, temporary, true);
    written.map_err(StoreError::at(path, StoreError::Write))
}

/// Writes a file as [`write`] does; unless it `may_replace` one, no file may be there.
fn create(
    path: &Path,
    pieces: &[impl AsRef<[u8]>],
    temporary: &TemporaryFiles,
    may_replace: bool,
) -> io::Result<()> {
    let mut output = Output::create(path, temporary)?;
    if output.target().is_none() {
        return Err(io::Error::other("it is no regular file"));
    }
    let mut pieces = pieces.iter();
    pieces.try_for_each(|piece| output.write_all(piece.as_ref()))?;
    output.persist(may_replace).map(drop)
}
