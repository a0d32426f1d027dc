//! A folder that appears under its name when it is complete.

use super::file_id::folder_of;
use super::target::check_links;
use super::unfinished::{Listed, RANDOM, prefix};
use std::fs;
use std::io;
use std::path::Path;
use tempfile::TempDir;

/// A folder on its way to its name. It is removed when it is dropped, and when the process is interrupted; a killed process
/// leaves it.
#[derive(Debug)]
pub struct UnfinishedFolder {
    folder: TempDir,
    _listed: Listed,
}

impl UnfinishedFolder {
    /// An empty folder beside `target`.
    ///
    /// # Errors
    ///
    /// The folder of `target` does not exist, is not writable, or lies behind a link that must not be followed.
    pub fn create(target: &Path) -> io::Result<Self> {
        check_links(folder_of(target))?;
        let prefix = prefix();
        let mut builder = tempfile::Builder::new();
        builder.prefix(&prefix).rand_bytes(RANDOM);
        // `tempfile` itself makes private folders.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
        let make = || builder.tempdir_in(folder_of(target));
        let (folder, listed) = Listed::make(make, TempDir::path)?;
        Ok(Self {
            folder,
            _listed: listed,
        })
    }

    /// The path of the folder until it is finished.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Gives the folder its name.
    ///
    /// # Errors
    ///
    /// A file, or a folder that is not empty, has the name.
    pub fn finish(self, target: &Path) -> io::Result<()> {
        fs::rename(self.folder.path(), target)?;
        let _ = self.folder.keep();
        Ok(())
    }
}
