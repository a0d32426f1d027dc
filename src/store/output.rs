//! Outputs: files being written. No other module opens files for writing.

use super::file_id::{FileId, folder_of};
use super::target::OutputTarget;
use super::temporary::{TemporaryFile, TemporaryFiles};
use std::fs::File;
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Output: a file being written.
///
/// [`Output::finish`] replaces a regular file as a whole and keeps its owner, group and permissions. An output that is dropped
/// before that leaves the file as it was. A device or a pipe is opened by `finish` and written to. Symbolic links are followed,
/// and stay; a link of another user in a folder that others may write to is refused.
#[derive(Debug)]
pub struct Output(Destination);

#[derive(Debug)]
enum Destination {
    Stdout,
    Regular {
        file: TemporaryFile,
        target: PathBuf,
    },
    /// The bytes are kept in a file without a name until the stream is opened.
    Stream {
        kept: File,
        target: PathBuf,
    },
}

impl Output {
    /// Creates an output that writes to standard output at once.
    #[must_use]
    pub fn stdout() -> Self {
        Self(Destination::Stdout)
    }

    /// Creates an output for the file at `path`; until it is finished, its bytes are in one of the temporary `files`.
    ///
    /// # Errors
    /// `path` leads to a folder, to a read-only file, or to a file whose owner cannot be kept. Or it leads through a link that must not
    /// be followed, or its folder does not exist or is not writable.
    pub fn create(path: &Path, files: &TemporaryFiles) -> io::Result<Self> {
        Ok(Self(match OutputTarget::of(path)? {
            OutputTarget::Regular(target, replaced) => Destination::Regular {
                file: TemporaryFile::create(folder_of(&target), replaced.as_ref(), files)?,
                target,
            },
            OutputTarget::Stream(target) => Destination::Stream {
                kept: tempfile::tempfile()?,
                target,
            },
        }))
    }

    /// Removes the temporary files that interrupted processes of the same user left in the folder of a regular file: at once on the
    /// same host, after a day on another one.
    pub fn remove_leftovers(&self) {
        if let Destination::Regular { file, .. } = &self.0 {
            file.remove_leftovers();
        }
    }

    /// Returns true if the output makes or replaces a regular file.
    #[must_use]
    pub fn is_regular(&self) -> bool {
        matches!(self.0, Destination::Regular { .. })
    }

    /// Returns the path of the output's regular file behind all symbolic links; `None` for other outputs.
    #[must_use]
    pub fn target(&self) -> Option<&Path> {
        match &self.0 {
            Destination::Regular { target, .. } => Some(target),
            _ => None,
        }
    }

    /// Returns the identity of the output, equal for two outputs that are one file; `None` for devices and pipes.
    #[must_use]
    pub fn id(&self) -> Option<FileId> {
        match &self.0 {
            Destination::Stdout => Some(FileId::of_stdout()),
            Destination::Regular { target, .. } => FileId::of(target),
            Destination::Stream { .. } => None,
        }
    }

    /// Finishes a regular file such that its bytes are on the disk before its name, and its name before this returns. A crash of the
    /// machine damages neither. It takes 1 to 5 ms.
    ///
    /// # Errors
    /// An error of [`Output::finish`].
    #[cfg(feature = "zarr")]
    pub(super) fn finish_durably(self) -> io::Result<()> {
        self.finish_synced(Self::finish)
    }

    /// Finishes a regular file like [`Output::finish_durably`], unless a file of its name is there: of several processes that
    /// do this at the same time one succeeds.
    ///
    /// # Errors
    /// [`AlreadyExists`](io::ErrorKind::AlreadyExists), or an error of [`Output::finish`].
    #[cfg(feature = "zarr")]
    pub(super) fn finish_new(self) -> io::Result<()> {
        self.finish_synced(|output| match output.0 {
            Destination::Regular { file, target } => file.persist_new(&target),
            _ => Err(io::ErrorKind::AlreadyExists.into()),
        })
    }

    #[cfg(feature = "zarr")]
    fn finish_synced(mut self, finish: fn(Self) -> io::Result<()>) -> io::Result<()> {
        let folder = self.target().map(|target| folder_of(target).to_owned());
        if let (Some(file), true) = (self.file(), folder.is_some()) {
            file.sync_all()?;
        }
        finish(self)?;
        // Only Unix opens folders.
        match folder {
            Some(folder) if cfg!(unix) => File::open(folder)?.sync_all(),
            _ => Ok(()),
        }
    }

    /// The file that has the bytes until the output is finished; `None` for standard output.
    fn file(&mut self) -> Option<&mut File> {
        match &mut self.0 {
            Destination::Stdout => None,
            Destination::Regular { file, .. } => Some(file.file()),
            Destination::Stream { kept, .. } => Some(kept),
        }
    }

    /// Flushes the output and gives the file its name.
    ///
    /// # Errors
    /// The file cannot be renamed, or the device takes no more.
    pub fn finish(self) -> io::Result<()> {
        match self.0 {
            Destination::Stdout => io::stdout().flush(),
            Destination::Regular { file, target } => file.persist(&target),
            Destination::Stream { mut kept, target } => {
                // What is open for appending is never shortened or overwritten, even where it is a file.
                let mut stream = File::options().append(true).open(target)?;
                kept.rewind()?;
                io::copy(&mut kept, &mut stream).map(drop)
            }
        }
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self.file() {
            Some(file) => file.write(bytes),
            None => io::stdout().write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self.file() {
            Some(file) => file.flush(),
            None => io::stdout().flush(),
        }
    }
}

impl Seek for Output {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let file = self.file();
        file.map_or(Err(io::ErrorKind::NotSeekable.into()), |file| file.seek(to))
    }
}
