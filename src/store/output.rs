//! Outputs: files being written. No other module opens files for writing.

use super::file_id::{FileId, folder_of};
use super::target::OutputTarget;
use super::temporary::{TemporaryFile, TemporaryFiles};
use crate::terminal::StandardOutput;
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
    Stdout(StandardOutput),
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
        Self(Destination::Stdout(StandardOutput::open()))
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
            Destination::Stdout(_) => Some(FileId::of_stdout()),
            Destination::Regular { target, .. } => FileId::of(target),
            Destination::Stream { .. } => None,
        }
    }

    /// Finishes a regular file like [`Output::finish`], unless a file of its name is there: of several processes that
    /// do this at the same time one succeeds.
    ///
    /// # Errors
    /// [`AlreadyExists`](io::ErrorKind::AlreadyExists), or an error of [`Output::finish`].
    #[cfg(feature = "zarr")]
    pub(super) fn finish_new(self) -> io::Result<()> {
        match self.0 {
            Destination::Regular { file, target } => {
                named(file, &target, TemporaryFile::persist_new)
            }
            _ => Err(io::ErrorKind::AlreadyExists.into()),
        }
    }

    /// Finishes the output like [`Output::finish`], and returns its file. That is still the file of this output when another one has
    /// got its name.
    ///
    /// # Errors
    /// An error of [`Output::finish`], or the output is standard output.
    pub(super) fn finish_open(mut self) -> io::Result<File> {
        let file = self.file().map(|file| file.try_clone());
        let file = file.ok_or(io::ErrorKind::NotSeekable)??;
        self.finish()?;
        Ok(file)
    }

    /// The file that has the bytes until the output is finished; `None` for standard output.
    fn file(&mut self) -> Option<&mut File> {
        match &mut self.0 {
            Destination::Stdout(_) => None,
            Destination::Regular { file, .. } => Some(file.file()),
            Destination::Stream { kept, .. } => Some(kept),
        }
    }

    /// Finishes the output. The bytes of a regular file are on the disk before its name, and its name before this returns: a crash of the
    /// machine leaves the old file or the new one. It takes 1 to 5 ms.
    ///
    /// # Errors
    /// The file cannot be brought to the disk or renamed, or the device takes no more.
    pub fn finish(self) -> io::Result<()> {
        match self.0 {
            Destination::Stdout(mut stdout) => stdout.flush(),
            Destination::Regular { file, target } => named(file, &target, TemporaryFile::persist),
            Destination::Stream { mut kept, target } => {
                // What is open for appending is never shortened or overwritten, even where it is a file.
                let mut stream = File::options().append(true).open(target)?;
                kept.rewind()?;
                io::copy(&mut kept, &mut stream).map(drop)
            }
        }
    }
}

/// Gives a file its name by `rename`, between its bytes and the entry of its folder on the disk.
fn named(
    mut file: TemporaryFile,
    target: &Path,
    rename: fn(TemporaryFile, &Path) -> io::Result<()>,
) -> io::Result<()> {
    file.file().sync_all()?;
    rename(file, target)?;
    sync_folder(folder_of(target))
}

/// Brings the names in a folder to the disk. Only Unix opens folders, some users may not, and some network file systems bring no
/// folder to the disk: there, a crash of the machine can still take the new name back.
pub(super) fn sync_folder(folder: &Path) -> io::Result<()> {
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        Err(why)
            if matches!(
                why.kind(),
                io::ErrorKind::PermissionDenied
                    | io::ErrorKind::InvalidInput
                    | io::ErrorKind::Unsupported
            ) =>
        {
            Ok(())
        }
        synced => synced,
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.0 {
            Destination::Stdout(stdout) => stdout.write(bytes),
            Destination::Regular { file, .. } => file.file().write(bytes),
            Destination::Stream { kept, .. } => kept.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.0 {
            Destination::Stdout(stdout) => stdout.flush(),
            Destination::Regular { file, .. } => file.file().flush(),
            Destination::Stream { kept, .. } => kept.flush(),
        }
    }
}

impl Seek for Output {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let file = self.file();
        file.map_or(Err(io::ErrorKind::NotSeekable.into()), |file| file.seek(to))
    }
}
