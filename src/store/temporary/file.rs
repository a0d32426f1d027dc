//! Temporary files: locked while their process runs, and removed as leftovers after it was interrupted.

use super::name::{RANDOM, host, host_of, prefix};
use super::{ListedPath, TemporaryFiles};
use crate::store::target::inherit;
use std::fs::{self, DirEntry, File, Metadata, OpenOptions};
use std::io;
use std::path::Path;
use std::time::Duration;
use tempfile::NamedTempFile;

/// A file of another host counts as a leftover if nothing was written to it for so long.
const ABANDONED: Duration = Duration::from_secs(24 * 3600);

/// Temporary file that gets its name when it is complete.
#[derive(Debug)]
pub struct TemporaryFile {
    file: NamedTempFile,
    _listed: ListedPath,
}

impl TemporaryFile {
    /// Creates a temporary file in `folder`, with owner and permissions of the file that it replaces.
    pub fn create(
        folder: &Path,
        replaced: Option<&Metadata>,
        files: &TemporaryFiles,
    ) -> io::Result<Self> {
        let prefix = prefix();
        let mut options = File::options();
        options.read(true).write(true).create_new(true);
        loop {
            // `tempfile` itself makes private files, and its errors name them.
            let mut builder = tempfile::Builder::new();
            builder.prefix(&prefix).rand_bytes(RANDOM);
            let make = || builder.make_in(folder, |path| options.open(path));
            let (file, listed) = files.make(make, NamedTempFile::path)?;
            // Without locks, the file of an interrupted process stays.
            let _ = file.as_file().lock();
            // Before it was locked, another process may have removed it as a leftover.
            if matches!(file.path().try_exists(), Ok(false)) {
                continue;
            }
            if let Some(replaced) = replaced {
                inherit(file.as_file(), replaced)?;
            }
            return Ok(Self {
                file,
                _listed: listed,
            });
        }
    }

    pub fn file(&mut self) -> &mut File {
        self.file.as_file_mut()
    }

    /// Gives the temporary file its name, and replaces the file that has it, even one that is being read.
    pub fn persist(mut self, name: &Path) -> io::Result<()> {
        self.let_readers_in();
        // On Windows, the rename of `tempfile` does not replace an open file.
        fs::rename(self.file.path(), name)?;
        self.file.disable_cleanup(true);
        Ok(())
    }

    /// Gives the temporary file its name, unless a file has it: by a rename that replaces nothing or, on file systems without, such as
    /// NFS, by a hard link.
    #[cfg(feature = "zarr")]
    pub fn persist_new(self, name: &Path) -> io::Result<()> {
        self.let_readers_in();
        self.file.persist_noclobber(name)?;
        Ok(())
    }

    /// Unlocks the file on Windows, where nobody can read a locked file.
    fn let_readers_in(&self) {
        if cfg!(windows) {
            let _ = self.file.as_file().unlock();
        }
    }

    /// Removes the temporary files and folders beside this one whose processes have ended. Those of other users stay.
    ///
    /// A process that has ended has lost its lock. Locks of other hosts may not be visible here, so their files must also
    /// be [`ABANDONED`] by the clock that dates them and this file. Their folders stay: a folder may be old, and files in it new.
    pub fn remove_leftovers(&self) {
        let (Some(folder), Ok(own)) = (self.file.path().parent(), self.file.as_file().metadata())
        else {
            return;
        };
        let host_here = host();
        let is_abandoned = |about: &Metadata| {
            let age = own.modified().ok().zip(about.modified().ok());
            let age = age.and_then(|(now, then)| now.duration_since(then).ok());
            age.is_some_and(|age| age > ABANDONED)
        };
        let is_gone = |entry: &DirEntry| {
            let name = entry.file_name();
            let host = name.to_str().and_then(host_of);
            let about = host.zip(entry.metadata().ok());
            about.is_some_and(|(host, about)| {
                let is_here = host == host_here;
                let is_gone_by = match about.is_dir() {
                    true => is_here,
                    false => about.is_file() && (is_here || is_abandoned(&about)),
                };
                is_gone_by && is_of_one_user(&about, &own)
            })
        };
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            if !is_gone(&entry) {
                continue;
            }
            let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
            // Locked until it is removed, except on Windows, which removes no folder that nobody else may open.
            let Some(locked) = lock_leftover(&entry.path(), is_folder) else {
                continue;
            };
            if cfg!(windows) && is_folder {
                drop(locked);
            }
            let _ = match is_folder {
                true => fs::remove_dir_all(entry.path()),
                false => fs::remove_file(entry.path()),
            };
        }
    }
}

/// Returns options to open a folder.
pub fn folder_options() -> OpenOptions {
    let mut options = File::options();
    options.read(true);
    #[cfg(windows)]
    {
        use std::os::windows::fs::OpenOptionsExt;
        // Without this flag, Windows opens no folder.
        const FILE_FLAG_BACKUP_SEMANTICS: u32 = 0x0200_0000;
        options.custom_flags(FILE_FLAG_BACKUP_SEMANTICS);
    }
    options
}

/// Opens and locks a leftover; returns `None` while its process runs. Whatever has taken its name since, no link is followed and no
/// pipe waited for.
fn lock_leftover(path: &Path, is_folder: bool) -> Option<File> {
    let mut options = folder_options();
    // No folder is opened for writing, and NFS locks no file that is not.
    options.read(is_folder).write(!is_folder);
    #[cfg(unix)]
    {
        use rustix::fs::OFlags;
        use std::os::unix::fs::OpenOptionsExt;
        options.custom_flags((OFlags::NOFOLLOW | OFlags::NONBLOCK).bits().cast_signed());
    }
    #[cfg(windows)]
    if is_folder {
        use std::os::windows::fs::OpenOptionsExt;
        // Windows locks no folder, but one that is open elsewhere cannot be opened without sharing.
        return options.share_mode(0).open(path).ok();
    }
    let file = options.open(path).ok()?;
    file.try_lock().is_ok().then_some(file)
}

#[cfg(unix)]
fn is_of_one_user(one: &Metadata, other: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    one.uid() == other.uid()
}

#[cfg(not(unix))]
fn is_of_one_user(_: &Metadata, _: &Metadata) -> bool {
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_new_file_has_an_exact_name() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let file = TemporaryFile::create(folder.path(), None, &TemporaryFiles::default())?;
        let name = file.file.path().file_name().and_then(|name| name.to_str());
        assert_eq!(name.and_then(host_of), Some(&*host()));
        Ok(())
    }
}
