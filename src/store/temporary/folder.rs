//! Temporary folders, which get their names when they are complete.

use super::file::folder_options;
use super::name::{RANDOM, prefix};
use super::{ListedPath, TemporaryFiles};
use crate::store::file_id::folder_of;
use crate::store::output::sync_folder;
use crate::store::target::check_links;
use std::fs::{self, File};
use std::io;
use std::path::Path;
use tempfile::TempDir;

/// Temporary folder that gets its name when it is complete. It is removed when it is dropped and when the process is interrupted. If
/// the process is killed, the next one on the same host removes it.
#[derive(Debug)]
pub struct TemporaryFolder {
    folder: TempDir,
    /// The folder, open and so locked while the process runs; `None` where folders cannot be opened.
    _lock: Option<File>,
    _listed: ListedPath,
}

impl TemporaryFolder {
    /// Creates an empty temporary folder beside `target`, and removes those of interrupted processes there.
    ///
    /// # Errors
    /// The folder of `target` does not exist, is not writable, or lies behind a link that must not be followed.
    pub fn create(target: &Path, files: &TemporaryFiles) -> io::Result<Self> {
        check_links(folder_of(target))?;
        files.prepare(folder_of(target))?;
        let prefix = prefix();
        let mut builder = tempfile::Builder::new();
        builder.prefix(&prefix).rand_bytes(RANDOM);
        // `tempfile` itself makes private folders.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
        let make = || builder.tempdir_in(folder_of(target));
        loop {
            let (folder, listed) = files.make(make, TempDir::path)?;
            // Without a lock, the folder of an interrupted process stays.
            let lock = folder_options().open(folder.path());
            if is_opened_elsewhere(&lock) {
                continue;
            }
            let lock = lock.ok();
            let _ = lock.as_ref().map(File::lock);
            // Before it was locked, another process may have removed it as a leftover.
            if !matches!(folder.path().try_exists(), Ok(false)) {
                return Ok(Self {
                    folder,
                    _lock: lock,
                    _listed: listed,
                });
            }
        }
    }

    /// Returns the path of the temporary folder until it is finished.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Gives the temporary folder the name `target`.
    ///
    /// # Errors
    /// A file, or a folder that is not empty, has the name.
    pub fn finish(self, target: &Path) -> io::Result<()> {
        if cfg!(windows) {
            // Windows replaces no folder, not even an empty one, and this removes no other.
            let _ = fs::remove_dir(target);
        }
        fs::rename(self.folder.path(), target)?;
        let _ = self.folder.keep();
        sync_folder(folder_of(target))
    }
}

/// Returns true if another process of Windows is about to remove the folder as a leftover, before it was open here.
fn is_opened_elsewhere(folder: &io::Result<File>) -> bool {
    const ERROR_SHARING_VIOLATION: i32 = 32;
    let code = folder.as_ref().err().and_then(io::Error::raw_os_error);
    cfg!(windows) && code == Some(ERROR_SHARING_VIOLATION)
}
