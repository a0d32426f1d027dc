//! Temporary files, which nobody should ever find: they vanish when dropped, when the process is interrupted, and, after it
//! was killed, when the next one writes into their folder: one of the same host at once, one of another after a day.

use std::fs::{self, DirEntry, File, Metadata};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tempfile::NamedTempFile;

/// A temporary file on its way to its name.
#[derive(Debug)]
pub(super) struct Unfinished {
    file: NamedTempFile,
    _listed: Listed,
}

/// The temporary files of this process.
static LIST: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn list() -> MutexGuard<'static, Vec<PathBuf>> {
    LIST.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A place in the list.
#[derive(Debug)]
struct Listed(PathBuf);

impl Drop for Listed {
    fn drop(&mut self) {
        list().retain(|path| *path != self.0);
    }
}

/// Removes all temporary files of this process, for one that is about to end without unwinding. Threads that begin or
/// finish a file after this wait forever.
pub fn abandon() {
    let list = list();
    for path in list.iter() {
        let _ = fs::remove_file(path);
        let _ = fs::remove_dir_all(path);
    }
    std::mem::forget(list);
}

impl Unfinished {
    /// A new file in `folder`, from which those that killed runs have left are removed.
    pub(super) fn create(folder: &Path) -> io::Result<Self> {
        let prefix = prefix();
        let mut options = File::options();
        options.read(true).write(true).create_new(true);
        loop {
            let mut list = list();
            // `tempfile` itself makes private files, and its errors name them.
            let file = tempfile::Builder::new()
                .prefix(&prefix)
                .make_in(folder, |path| options.open(path))?;
            list.push(file.path().to_owned());
            drop(list);
            let listed = Listed(file.path().to_owned());
            // Without locks, a killed run's file stays.
            let _ = file.as_file().lock();
            // Before it was locked, another process may have taken it for a leftover.
            if !matches!(file.path().try_exists(), Ok(false)) {
                sweep(folder, &prefix, file.as_file());
                return Ok(Self {
                    file,
                    _listed: listed,
                });
            }
        }
    }

    pub(super) fn file(&mut self) -> &mut File {
        self.file.as_file_mut()
    }

    /// Gives the file its name, in place of what has it.
    pub(super) fn persist(self, name: &Path) -> io::Result<()> {
        self.file.persist(name)?;
        Ok(())
    }

    /// Gives the file its name, unless a file has it: by a rename that replaces nothing or, on file systems without, such as
    /// NFS, by a hard link.
    #[cfg(feature = "zarr")]
    pub(super) fn persist_new(self, name: &Path) -> io::Result<()> {
        self.file.persist_noclobber(name)?;
        Ok(())
    }
}

/// A file of another host to which nothing was written for so long is taken for a leftover.
const ABANDONED: Duration = Duration::from_secs(24 * 3600);

/// Removes the files in `folder` whose process is gone. One of this host has lost its lock then. Locks of other hosts may not be
/// seen here, so their files must be old, too: older than `own`, which is new, by the clock that dates both.
fn sweep(folder: &Path, prefix: &str, own: &File) {
    let modified = |about: io::Result<Metadata>| about.and_then(|about| about.modified()).ok();
    let now = modified(own.metadata());
    let is_abandoned = |entry: &DirEntry| {
        let age = now.zip(modified(entry.metadata()));
        let age = age.and_then(|(now, then)| now.duration_since(then).ok());
        age.is_some_and(|age| age > ABANDONED)
    };
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let begins = |with: &str| name.to_str().is_some_and(|name| name.starts_with(with));
        let is_gone = begins(prefix) || begins(PREFIX) && is_abandoned(&entry);
        if !is_gone || !entry.file_type().is_ok_and(|kind| kind.is_file()) {
            continue;
        }
        // Kept open, and so locked, until it is removed.
        let file = File::options().write(true).open(entry.path());
        if file.as_ref().is_ok_and(|file| file.try_lock().is_ok()) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// How the names of all hosts begin.
const PREFIX: &str = ".whiskmap-";

/// How the names of this host begin. They name the host, because there are shared folders whose locks only one host sees.
fn prefix() -> String {
    #[cfg(unix)]
    let host = rustix::system::uname()
        .nodename()
        .to_string_lossy()
        .into_owned();
    #[cfg(not(unix))]
    let host = std::env::var("COMPUTERNAME").unwrap_or_default();
    let plain = |c: &char| c.is_ascii_alphanumeric() || "-_.".contains(*c);
    let host: String = host.chars().filter(plain).take(64).collect();
    format!("{PREFIX}{host}-")
}

/// A folder on its way to its name. It is removed when it is dropped, and when the process is interrupted.
#[cfg(feature = "zarr")]
#[derive(Debug)]
pub struct UnfinishedFolder {
    folder: tempfile::TempDir,
    _listed: Listed,
}

#[cfg(feature = "zarr")]
impl UnfinishedFolder {
    /// An empty folder beside `target`.
    ///
    /// # Errors
    ///
    /// The folder of `target` does not exist or is not writable.
    pub fn create(target: &Path) -> io::Result<Self> {
        let mut list = list();
        let prefix = prefix();
        let mut builder = tempfile::Builder::new();
        builder.prefix(&prefix);
        // `tempfile` itself makes private folders.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
        let folder = builder.tempdir_in(super::output::folder_of(target))?;
        list.push(folder.path().to_owned());
        drop(list);
        Ok(Self {
            _listed: Listed(folder.path().to_owned()),
            folder,
        })
    }

    /// Where the folder is until it is finished.
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
