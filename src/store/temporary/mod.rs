//! Temporary files and folders. They are removed when they are dropped and when the process is interrupted.
//!
//! A later process of the same user removes those of an interrupted one, see [`Output::remove_leftovers`](super::Output).

mod file;
#[cfg(feature = "zarr")]
mod folder;
mod name;

pub(super) use file::TemporaryFile;
#[cfg(feature = "zarr")]
pub use folder::TemporaryFolder;
#[cfg(feature = "zarr")]
pub(super) use name::host_of;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// List of the temporary files and folders of a process, shared by its outputs and its signal handler.
#[derive(Clone, Debug, Default)]
pub struct TemporaryFiles(Arc<Mutex<Vec<PathBuf>>>);

impl TemporaryFiles {
    fn list(&self) -> MutexGuard<'_, Vec<PathBuf>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Makes a file or a folder and lists it, with no interruption in between.
    fn make<T>(
        &self,
        make: impl FnOnce() -> io::Result<T>,
        path: impl FnOnce(&T) -> &Path,
    ) -> io::Result<(T, ListedPath)> {
        let mut list = self.list();
        let made = make()?;
        let path = path(&made).to_owned();
        list.push(path.clone());
        let listed = ListedPath {
            path,
            files: self.clone(),
        };
        Ok((made, listed))
    }

    /// Creates a folder and those that hold it, if need be, with no interruption in between.
    ///
    /// # Errors
    /// An error of [`fs::create_dir_all`].
    pub fn create_folders(&self, path: &Path) -> io::Result<()> {
        let _list = self.list();
        fs::create_dir_all(path)
    }

    /// Removes all temporary files and folders of a process that is about to end without unwinding. Threads that create a file or a folder
    /// or finish a file after this wait forever.
    pub fn abandon(&self) {
        let list = self.list();
        // The files in a folder are listed after it. Without them, no thread can add an entry to it.
        for path in list.iter().rev() {
            let _ = fs::remove_file(path);
            let _ = fs::remove_dir_all(path);
        }
        std::mem::forget(list);
    }

    /// Checks that files can be made in `folder`, and removes temporary files and folders of interrupted processes there.
    ///
    /// # Errors
    /// The folder does not exist or is not writable.
    pub fn prepare(&self, folder: &Path) -> io::Result<()> {
        let file = TemporaryFile::create(folder, None, self)?;
        file.remove_leftovers();
        Ok(())
    }
}

/// A path in the list of [`TemporaryFiles`], until it is dropped.
#[derive(Debug)]
struct ListedPath {
    path: PathBuf,
    files: TemporaryFiles,
}

impl Drop for ListedPath {
    fn drop(&mut self) {
        self.files.list().retain(|path| *path != self.path);
    }
}
