//! Outputs: files being written. No other module opens files for writing.

use super::temporary::{TemporaryFile, TemporaryFiles, folder_of, sync_folder};
use crate::terminal::StandardOutput;
use std::fs::{self, File, Metadata};
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
    place: OutputPlace,
}

/// Place of the bytes of an output until it is finished.
#[derive(Debug)]
enum OutputPlace {
    /// Bytes are written at once.
    Stdout(StandardOutput),
    /// The target is behind all symbolic links.
    Regular {
        file: TemporaryFile,
        target: PathBuf,
    },
    /// A file without a name keeps the bytes until the device or the pipe is opened.
    Device(File),
}

/// Time at which the name of a finished file is brought to the disk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum NameSync {
    Now,
    #[cfg(feature = "zarr")]
    Later,
}

impl Output {
    /// Creates an output that writes to standard output at once; its path is `-`.
    #[must_use]
    pub fn stdout() -> Self {
        Self {
            path: PathBuf::from("-"),
            place: OutputPlace::Stdout(StandardOutput::open()),
        }
    }

    /// Creates an output for the file at `path`; until it is finished, its bytes are in one of the temporary `files`.
    ///
    /// # Errors
    /// `path` leads to a folder or to a read-only file, or its folder does not exist or is not writable.
    pub fn create(path: &Path, files: &TemporaryFiles) -> io::Result<Self> {
        let place = if is_device(path) {
            OutputPlace::Device(tempfile::tempfile()?)
        } else {
            let replaced = replaced(path)?;
            let target = resolved(path)?;
            let mut file = TemporaryFile::create(folder_of(&target), files)?;
            if let Some(replaced) = replaced {
                let permissions = replaced.permissions();
                // Every write drops the set-user-ID and set-group-ID bits.
                #[cfg(unix)]
                let permissions = fs::Permissions::from_mode(permissions.mode() & 0o777);
                file.file().set_permissions(permissions)?;
            }
            OutputPlace::Regular { file, target }
        };
        let path = path.to_owned();
        Ok(Self { path, place })
    }

    /// Returns the path with which the output was created.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the absolute path of a regular file, behind all symbolic links; `None` for other outputs.
    #[must_use]
    pub fn target(&self) -> Option<&Path> {
        match &self.place {
            OutputPlace::Regular { target, .. } => Some(target),
            _ => None,
        }
    }

    /// Returns true if the output is standard output.
    #[must_use]
    pub fn is_stdout(&self) -> bool {
        matches!(self.place, OutputPlace::Stdout(_))
    }

    /// Finishes the output. The bytes of a regular file are on the disk before its name, and the name before this function returns. So a
    /// crash of the machine leaves the old file or the new one. The call takes 1 to 5 ms.
    ///
    /// # Errors
    /// The file cannot be brought to the disk or renamed, or the device takes no more.
    pub fn finish(self) -> io::Result<()> {
        self.complete(true, NameSync::Now).map(drop)
    }

    /// Finishes a regular file like [`Output::finish`], unless a file of its name is there: of several processes that
    /// do this at the same time one succeeds.
    ///
    /// # Errors
    /// [`AlreadyExists`](io::ErrorKind::AlreadyExists), or an error of [`Output::finish`].
    #[cfg(feature = "zarr")]
    pub(super) fn finish_new(self) -> io::Result<()> {
        self.complete(false, NameSync::Now).map(drop)
    }

    /// Finishes the output like [`Output::finish`], but leaves the name of a regular file to a later [`sync_folder`]. Until then, a crash of the
    /// machine may leave the old file.
    ///
    /// # Errors
    /// An error of [`Output::finish`].
    #[cfg(feature = "zarr")]
    pub(super) fn finish_before_sync(self) -> io::Result<()> {
        self.complete(true, NameSync::Later).map(drop)
    }

    /// Finishes the output like [`Output::finish`], and returns its file. That is still the file of this output when another one has
    /// got its name.
    ///
    /// # Errors
    /// An error of [`Output::finish`], or the output is standard output.
    pub(super) fn finish_open(self) -> io::Result<File> {
        self.complete(true, NameSync::Now)?
            .ok_or(io::ErrorKind::NotSeekable.into())
    }

    /// Finishes the output, and returns the file that has its bytes; `None` for standard output.
    fn complete(self, may_replace: bool, sync: NameSync) -> io::Result<Option<File>> {
        match self.place {
            OutputPlace::Stdout(mut stdout) => stdout.flush().map(|()| None),
            OutputPlace::Regular { file, target } => {
                let file = file.persist(&target, may_replace)?;
                if sync == NameSync::Now {
                    sync_folder(folder_of(&target))?;
                }
                Ok(Some(file))
            }
            OutputPlace::Device(mut kept) => {
                // What is open for appending is never shortened or overwritten, even where it is a file.
                let mut device = File::options().append(true).open(&self.path)?;
                kept.rewind()?;
                io::copy(&mut kept, &mut device)?;
                Ok(Some(kept))
            }
        }
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.place {
            OutputPlace::Stdout(stdout) => stdout.write(bytes),
            OutputPlace::Regular { file, .. } => file.file().write(bytes),
            OutputPlace::Device(kept) => kept.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.place {
            OutputPlace::Stdout(stdout) => stdout.flush(),
            // A file has no buffer.
            _ => Ok(()),
        }
    }
}

impl Seek for Output {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        match &mut self.place {
            OutputPlace::Stdout(_) => Err(io::ErrorKind::NotSeekable.into()),
            OutputPlace::Regular { file, .. } => file.file().seek(to),
            OutputPlace::Device(kept) => kept.seek(to),
        }
    }
}

/// Returns true if `path` leads to a device or a pipe.
fn is_device(path: &Path) -> bool {
    // Windows has no metadata of its null device.
    let is_null = cfg!(windows) && path.as_os_str().eq_ignore_ascii_case("NUL");
    is_null || fs::metadata(path).is_ok_and(|about| !about.is_file() && !about.is_dir())
}

/// Returns the metadata of the file at `path`, which an output replaces; `None` if there is no file.
fn replaced(path: &Path) -> io::Result<Option<Metadata>> {
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
    Ok(Some(about))
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
