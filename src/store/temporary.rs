//! Temporary files and folders. They are removed when they are dropped and when the process is interrupted.
//!
//! A later process of the same user removes the files of an interrupted one, see [`Output::remove_leftovers`](super::Output).

use super::target::inherit;
#[cfg(feature = "zarr")]
use super::{file_id::folder_of, target::check_links};
use std::fs::{self, DirEntry, File, Metadata, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tempfile::NamedTempFile;
#[cfg(feature = "zarr")]
use tempfile::TempDir;

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

    /// Removes all temporary files and folders of a process that is about to end without unwinding. Threads that begin or finish a file
    /// after this wait forever.
    pub fn abandon(&self) {
        let list = self.list();
        for path in list.iter() {
            let _ = fs::remove_file(path);
            let _ = fs::remove_dir_all(path);
        }
        std::mem::forget(list);
    }

    /// Checks that files can be made in `folder`, and removes temporary files of interrupted processes there.
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

/// Temporary file that gets its name when it is complete.
#[derive(Debug)]
pub(super) struct TemporaryFile {
    file: NamedTempFile,
    _listed: ListedPath,
}

impl TemporaryFile {
    /// Creates a temporary file in `folder`, with owner and permissions of the file that it replaces.
    pub(super) fn create(
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

    pub(super) fn file(&mut self) -> &mut File {
        self.file.as_file_mut()
    }

    /// Gives the temporary file its name, and replaces the file that has it.
    pub(super) fn persist(self, name: &Path) -> io::Result<()> {
        self.file.persist(name)?;
        Ok(())
    }

    /// Gives the temporary file its name, unless a file has it: by a rename that replaces nothing or, on file systems without, such as
    /// NFS, by a hard link.
    #[cfg(feature = "zarr")]
    pub(super) fn persist_new(self, name: &Path) -> io::Result<()> {
        self.file.persist_noclobber(name)?;
        Ok(())
    }

    /// Removes the temporary files beside this one whose processes have ended. Files of other users stay.
    ///
    /// A process that has ended has lost its lock. Locks of other hosts may not be visible here, so their files must also
    /// be [`ABANDONED`] by the clock that dates them and this file.
    pub(super) fn remove_leftovers(&self) {
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
                let is_ours = about.is_file() && is_of_one_user(&about, &own);
                is_ours && (host == host_here || is_abandoned(&about))
            })
        };
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            if !is_gone(&entry) {
                continue;
            }
            // Kept open, and so locked, until it is removed.
            let file = not_following().open(entry.path());
            if file.as_ref().is_ok_and(|file| file.try_lock().is_ok()) {
                let _ = fs::remove_file(entry.path());
            }
        }
    }
}

/// Temporary folder that gets its name when it is complete. It is removed when it is dropped and when the process is interrupted. A
/// process that ends without unwinding leaves it.
#[cfg(feature = "zarr")]
#[derive(Debug)]
pub struct TemporaryFolder {
    folder: TempDir,
    _listed: ListedPath,
}

#[cfg(feature = "zarr")]
impl TemporaryFolder {
    /// Creates an empty temporary folder beside `target`.
    ///
    /// # Errors
    /// The folder of `target` does not exist, is not writable, or lies behind a link that must not be followed.
    pub fn create(target: &Path, files: &TemporaryFiles) -> io::Result<Self> {
        check_links(folder_of(target))?;
        let prefix = prefix();
        let mut builder = tempfile::Builder::new();
        builder.prefix(&prefix).rand_bytes(RANDOM);
        // `tempfile` itself makes private folders.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
        let make = || builder.tempdir_in(folder_of(target));
        let (folder, listed) = files.make(make, TempDir::path)?;
        Ok(Self {
            folder,
            _listed: listed,
        })
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
        fs::rename(self.folder.path(), target)?;
        let _ = self.folder.keep();
        Ok(())
    }
}

/// A file of another host counts as a leftover if nothing was written to it for so long.
const ABANDONED: Duration = Duration::from_secs(24 * 3600);

/// Options to open a leftover: whatever has taken its name since, no link is followed and no pipe waited for.
fn not_following() -> OpenOptions {
    let mut options = File::options();
    options.write(true);
    #[cfg(unix)]
    {
        use rustix::fs::OFlags;
        use std::os::unix::fs::OpenOptionsExt;
        options.custom_flags((OFlags::NOFOLLOW | OFlags::NONBLOCK).bits().cast_signed());
    }
    options
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

/// A temporary file's name is this, the host's name, [`DELIMITER`], and [`RANDOM`] letters and digits. It has the host's name
/// because the locks in a shared folder may be visible on one host only.
const PREFIX: &str = ".whiskmap-";

/// No host's name has this character.
const DELIMITER: char = '+';

/// Length of the random end of a name.
const RANDOM: usize = 12;

/// The name of a temporary file of this host, but for the random end.
fn prefix() -> String {
    format!("{PREFIX}{}{DELIMITER}", host())
}

/// Returns the host in the name of a temporary file; `None` for any other name.
pub(super) fn host_of(name: &str) -> Option<&str> {
    let (host, random) = name.strip_prefix(PREFIX)?.split_once(DELIMITER)?;
    let is_random = random.len() == RANDOM && random.chars().all(|c| c.is_ascii_alphanumeric());
    (is_random && host.chars().all(is_of_host)).then_some(host)
}

/// Returns true for the characters of a host's name.
fn is_of_host(c: char) -> bool {
    c.is_ascii_alphanumeric() || "-_.".contains(c)
}

/// Name of this host.
fn host() -> String {
    #[cfg(unix)]
    let host = rustix::system::uname()
        .nodename()
        .to_string_lossy()
        .into_owned();
    #[cfg(not(unix))]
    let host = std::env::var("COMPUTERNAME").unwrap_or_default();
    host.chars().filter(|c| is_of_host(*c)).take(64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_exact_names_have_a_host() {
        let named = |name: &str| host_of(name).map(str::to_owned);
        let host = |name: &str| Some(name.to_owned());
        assert_eq!(named(".whiskmap-node+aB3dE6gH9jK2"), host("node"));
        assert_eq!(
            named(".whiskmap-node-2.org+aB3dE6gH9jK2"),
            host("node-2.org")
        );
        for foreign in [
            ".whiskmap-node-notes.txt",
            ".whiskmap-node+notes.txt",
            ".whiskmap-node+aB3dE6gH9jK",
            ".whiskmap-node+aB3dE6gH9jK2x",
            ".whiskmap-node+aB3dE6gH9jK.",
            ".whiskmap-my node+aB3dE6gH9jK2",
            ".whiskmap-node+x+aB3dE6gH9jK2",
            "whiskmap-node+aB3dE6gH9jK2",
            ".whiskmap-",
        ] {
            assert_eq!(named(foreign), None, "{foreign}");
        }
    }

    #[test]
    fn a_new_file_has_an_exact_name() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let file = TemporaryFile::create(folder.path(), None, &TemporaryFiles::default())?;
        let name = file.file.path().file_name().and_then(|name| name.to_str());
        assert_eq!(name.and_then(host_of), Some(&*host()));
        Ok(())
    }
}
