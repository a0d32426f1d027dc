//! Temporary files and folders: unfinished outputs, which are removed when they are dropped and when the process is interrupted.
//!
//! A process that is killed leaves its temporary files. Each file is locked while its process runs, so that a later process can remove
//! these leftovers. The locks in a shared folder may be visible on one host only, so names contain the host.

use std::fs::{self, File, Metadata};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
#[cfg(feature = "zarr")]
use tempfile::TempDir;
use tempfile::{Builder, TempPath};

/// A file of another host counts as a leftover if nothing was written to it for so long.
const ABANDONED: Duration = Duration::from_secs(24 * 3600);

/// The name of a temporary file is this, the name of the host, [`DELIMITER`], and [`RANDOM`] letters and digits.
const PREFIX: &str = ".whiskmap-";

/// No name of a host has this character.
const DELIMITER: char = '+';

/// Length of the random end of a name.
const RANDOM: usize = 12;

/// List of the temporary files and folders of a process, shared by its outputs and its signal handler.
#[derive(Clone, Debug, Default)]
pub struct TemporaryFiles(Arc<Mutex<Vec<PathBuf>>>);

impl TemporaryFiles {
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

    /// Creates a folder and those that hold it, if need be, with no interruption in between.
    ///
    /// # Errors
    /// An error of [`fs::create_dir_all`].
    pub fn create_folders(&self, path: &Path) -> io::Result<()> {
        let _list = self.list();
        fs::create_dir_all(path)
    }

    /// Checks that files can be made in `folder`, and removes leftovers there.
    ///
    /// # Errors
    /// The folder does not exist or is not writable.
    pub fn prepare(&self, folder: &Path) -> io::Result<()> {
        self.file(folder)?;
        Self::remove_leftovers(folder);
        Ok(())
    }

    /// Removes leftovers in `folder` that this user may write to: leftovers of this host at once, files of another host after a day. A
    /// folder of another host stays: it may be old, and files in it new.
    pub fn remove_leftovers(folder: &Path) {
        let host_here = host();
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let name = entry.file_name();
            let host = name.to_str().and_then(host_of);
            let Some((host, about)) = host.and_then(|host| Some((host, entry.metadata().ok()?)))
            else {
                continue;
            };
            let (is_here, is_folder) = (host == host_here, about.is_dir());
            let is_old = is_here || about.is_file() && is_abandoned(&about);
            // No folder is opened for writing, and NFS locks no file that is not. Without either, a pipe or a link is not opened.
            let mut options = File::options();
            options.read(is_folder).write(about.is_file());
            // The file stays locked until it is removed.
            if is_old
                && let Ok(file) = options.open(entry.path())
                && file.try_lock().is_ok()
            {
                let _ = match is_folder {
                    true => fs::remove_dir_all(entry.path()),
                    false => fs::remove_file(entry.path()),
                };
            }
        }
    }

    fn list(&self) -> MutexGuard<'_, Vec<PathBuf>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Creates an empty file in `folder`, with a temporary name.
    pub(super) fn file(&self, folder: &Path) -> io::Result<(File, TemporaryName)> {
        let mut options = File::options();
        options.read(true).write(true).create_new(true);
        // `tempfile` itself makes private files, and its errors name them.
        let make = |builder: &mut Builder| builder.make_in(folder, |path| options.open(path));
        let (file, listed) = self.make(make, |file| file.as_file().try_clone())?;
        let (file, path) = file.into_parts();
        let name = TemporaryName { path, _listed: listed };
        Ok((file, name))
    }

    /// Makes a file or a folder, opens, locks and lists it, with no interruption in between.
    fn make<T: AsRef<Path>>(
        &self,
        make: impl Fn(&mut Builder) -> io::Result<T>,
        open: impl Fn(&T) -> io::Result<File>,
    ) -> io::Result<(T, ListedPath)> {
        let prefix = format!("{PREFIX}{}{DELIMITER}", host());
        let mut builder = Builder::new();
        builder.prefix(&prefix).rand_bytes(RANDOM);
        let mut list = self.list();
        loop {
            let made = make(&mut builder)?;
            let path = made.as_ref().to_owned();
            // What cannot be locked, such as a folder of Windows, stays if the process is killed.
            let lock = open(&made).ok();
            let _ = lock.as_ref().map(File::lock);
            // Before it was locked, another process may have removed it as a leftover.
            if matches!(path.try_exists(), Ok(false)) {
                continue;
            }
            list.push(path.clone());
            let files = self.clone();
            let listed = ListedPath { path, files, _lock: lock };
            return Ok((made, listed));
        }
    }
}

/// A path in the list of [`TemporaryFiles`], until it is dropped.
#[derive(Debug)]
struct ListedPath {
    path: PathBuf,
    files: TemporaryFiles,
    _lock: Option<File>,
}

impl Drop for ListedPath {
    fn drop(&mut self) {
        self.files.list().retain(|path| *path != self.path);
    }
}

/// Name of an unfinished file, which is removed when it is dropped.
#[derive(Debug)]
pub(super) struct TemporaryName {
    path: TempPath,
    _listed: ListedPath,
}

impl TemporaryName {
    /// Gives the `file` of this name another `name`; without `may_replace`, no file may have it.
    pub fn replace(self, file: &File, name: &Path, may_replace: bool) -> io::Result<()> {
        if cfg!(windows) {
            // Nobody can read a locked file of Windows.
            let _ = file.unlock();
        }
        match may_replace {
            // On Windows, `tempfile` does not replace a file that is open.
            true => fs::rename(self.path, name),
            false => Ok(self.path.persist_noclobber(name)?),
        }
    }
}

/// Temporary folder that gets its name when it is complete.
#[cfg(feature = "zarr")]
#[derive(Debug)]
pub struct TemporaryFolder {
    folder: TempDir,
    _listed: ListedPath,
}

#[cfg(feature = "zarr")]
impl TemporaryFolder {
    /// Creates an empty temporary folder beside `target`, and removes leftovers there.
    ///
    /// # Errors
    /// The folder of `target` does not exist or is not writable.
    pub fn create(target: &Path, files: &TemporaryFiles) -> io::Result<Self> {
        let beside = folder_of(target);
        files.prepare(beside)?;
        let make = |builder: &mut Builder| {
            // `tempfile` itself makes private folders.
            #[cfg(unix)]
            builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
            builder.tempdir_in(beside)
        };
        let (folder, _listed) = files.make(make, |folder| File::open(folder))?;
        Ok(Self { folder, _listed })
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

/// Returns true if nothing was written to a file for so long that it counts as a leftover on every host.
fn is_abandoned(about: &Metadata) -> bool {
    let age = about.modified().ok().and_then(|then| then.elapsed().ok());
    age.is_some_and(|age| age > ABANDONED)
}

/// Returns the host in the name of a temporary file or folder; `None` for any other name.
pub(super) fn host_of(name: &str) -> Option<&str> {
    let (host, random) = name.strip_prefix(PREFIX)?.split_once(DELIMITER)?;
    let is_random = random.len() == RANDOM && random.chars().all(|c| c.is_ascii_alphanumeric());
    is_random.then_some(host)
}

/// Returns the name of this host.
fn host() -> String {
    #[cfg(unix)]
    let host = rustix::system::uname().nodename().to_string_lossy().into_owned();
    #[cfg(not(unix))]
    let host = std::env::var("COMPUTERNAME").unwrap_or_default();
    let is_plain = |c: &char| c.is_ascii_alphanumeric() || "-_.".contains(*c);
    host.chars().filter(is_plain).take(64).collect()
}

/// Returns the folder that holds `path`.
pub(super) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Brings the names in a folder to the disk. Only Unix opens folders, some users may not, and some network file systems bring no
/// folder to the disk: there, a crash of the machine can still take the new name back.
pub(super) fn sync_folder(folder: &Path) -> io::Result<()> {
    use io::ErrorKind::{InvalidInput, PermissionDenied, Unsupported};
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        Err(why) if matches!(why.kind(), PermissionDenied | InvalidInput | Unsupported) => Ok(()),
        synced => synced,
    }
}
