//! Outputs: files being written. No other module opens files for writing.

use super::temporary::{TemporaryFiles, TemporaryName, folder_of, sync_folder};
use crate::terminal::StandardOutput;
use std::fs::{self, File, Permissions};
use std::io::{self, Seek, SeekFrom, Write};
#[cfg(unix)]
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

/// Output: a file being written.
///
/// [`Output::finish`] makes or replaces a regular file as a whole. A replaced file keeps its permissions; its owner is the user of this
/// process. An output that is dropped before that leaves the file as it was. A device or a pipe is opened by `finish` and written to.
/// Symbolic links are followed, and stay.
#[derive(Debug)]
pub struct Output {
    path: PathBuf,
    bytes: OutputBytes,
    /// Absolute path of a regular file, behind all symbolic links, and its name until it is finished; `None` for another output.
    target: Option<(PathBuf, TemporaryName)>,
}

/// Place of the bytes of an output until it is finished.
#[derive(Debug)]
enum OutputBytes {
    /// Standard output has the bytes at once.
    Stdout(StandardOutput),
    /// A temporary file has the bytes. For a device or a pipe it has no name.
    File(File),
}

impl Output {
    /// Creates an output that writes to standard output at once; its path is `-`.
    #[must_use]
    pub fn stdout() -> Self {
        Self {
            path: PathBuf::from("-"),
            bytes: OutputBytes::Stdout(StandardOutput::open()),
            target: None,
        }
    }

    /// Creates an output for the file at `path`; until it is finished, its bytes are in one of the temporary `files`.
    ///
    /// # Errors
    /// `path` leads to a folder or to a read-only file, or its folder does not exist or is not writable.
    pub fn create(path: &Path, files: &TemporaryFiles) -> io::Result<Self> {
        let (file, target) = if is_device(path) {
            (tempfile::tempfile()?, None)
        } else {
            let replaced = permissions(path)?;
            let target = resolved(path)?;
            let (file, name) = files.file(folder_of(&target))?;
            replaced.map_or(Ok(()), |replaced| file.set_permissions(replaced))?;
            (file, Some((target, name)))
        };
        Ok(Self { path: path.to_owned(), bytes: OutputBytes::File(file), target })
    }

    /// Returns the path with which the output was created.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the absolute path of a regular file, behind all symbolic links; `None` for other outputs.
    #[must_use]
    pub fn target(&self) -> Option<&Path> {
        self.target.as_ref().map(|(target, _)| &**target)
    }

    /// Returns true if the output is standard output.
    #[must_use]
    pub fn is_stdout(&self) -> bool {
        matches!(self.bytes, OutputBytes::Stdout(_))
    }

    /// Finishes the output, and returns the path of a regular file; `None` for another output. The bytes of a regular file are on the disk
    /// before its name, and the name before this function returns. So a crash of the machine leaves the old file or the new one. The call
    /// takes 1 to 5 ms.
    ///
    /// # Errors
    /// The file cannot be brought to the disk or renamed, or the device takes no more.
    pub fn finish(self) -> io::Result<Option<PathBuf>> {
        let path = self.target().map(|_| self.path.clone());
        self.finish_open()?;
        Ok(path)
    }

    /// Finishes the output like [`Output::finish`], and returns the file with its bytes; `None` for standard output. That is still the file of
    /// this output when another one has got its name.
    ///
    /// # Errors
    /// An error of [`Output::finish`].
    pub(super) fn finish_open(self) -> io::Result<Option<File>> {
        let target = self.target().map(Path::to_owned);
        let file = self.persist(true)?;
        target.map_or(Ok(()), |target| sync_folder(folder_of(&target)))?;
        Ok(file)
    }

    /// Finishes the output like [`Output::finish_open`], but leaves the name of a regular file to a later [`sync_folder`]. Until then, a crash of
    /// the machine may leave the old file. Unless it `may_replace` a file, an existing one is an error, and one of several concurrent processes
    /// succeeds. This needs a file system with renames that replace nothing or, such as NFS, with hard links.
    ///
    /// # Errors
    /// [`AlreadyExists`](io::ErrorKind::AlreadyExists), or an error of [`Output::finish`].
    pub(super) fn persist(self, may_replace: bool) -> io::Result<Option<File>> {
        let mut file = match self.bytes {
            OutputBytes::Stdout(mut stdout) => return stdout.flush().map(|()| None),
            OutputBytes::File(file) => file,
        };
        if let Some((target, name)) = self.target {
            file.sync_all()?;
            name.replace(&file, &target, may_replace)?;
        } else {
            // What is open for appending is never shortened or overwritten, even where it is a file.
            let mut device = File::options().append(true).open(&self.path)?;
            file.rewind()?;
            io::copy(&mut file, &mut device)?;
        }
        Ok(Some(file))
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.bytes {
            OutputBytes::Stdout(stdout) => stdout.write(bytes),
            OutputBytes::File(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.bytes {
            OutputBytes::Stdout(stdout) => stdout.flush(),
            OutputBytes::File(file) => file.flush(),
        }
    }
}

impl Seek for Output {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        match &mut self.bytes {
            OutputBytes::Stdout(_) => Err(io::ErrorKind::NotSeekable.into()),
            OutputBytes::File(file) => file.seek(to),
        }
    }
}

/// Returns true if `path` leads to a device or a pipe.
fn is_device(path: &Path) -> bool {
    // Windows has no metadata of its null device.
    let is_null = cfg!(windows) && path.as_os_str().eq_ignore_ascii_case("NUL");
    is_null || fs::metadata(path).is_ok_and(|about| !about.is_file() && !about.is_dir())
}

/// Returns the permissions of the file at `path`, which an output replaces; `None` if there is no file.
fn permissions(path: &Path) -> io::Result<Option<Permissions>> {
    let about = match fs::metadata(path) {
        Err(why) if why.kind() == io::ErrorKind::NotFound => return Ok(None),
        about => about?,
    };
    if about.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    // An administrator can open a read-only file, so its mode decides.
    if about.permissions().readonly() {
        let why = "the file there is read-only";
        return Err(io::Error::new(io::ErrorKind::PermissionDenied, why));
    }
    File::options().write(true).open(path)?;
    let permissions = about.permissions();
    // Every write drops the set-user-ID and set-group-ID bits.
    #[cfg(unix)]
    let permissions = Permissions::from_mode(permissions.mode() & 0o777);
    Ok(Some(permissions))
}

/// Returns the absolute path behind all symbolic links. Its last parts need not exist, not even behind a link.
///
/// # Errors
/// The links are a circle, or a part is no folder or cannot be searched.
pub fn resolved(path: &Path) -> io::Result<PathBuf> {
    match path.canonicalize() {
        Err(why) if why.kind() == io::ErrorKind::NotFound => {
            match (path.read_link(), path.file_name()) {
                (Ok(target), _) => resolved(&folder_of(path).join(target)),
                (Err(_), Some(name)) => Ok(resolved(folder_of(path))?.join(name)),
                (Err(_), None) => Err(why),
            }
        }
        found => found,
    }
}
