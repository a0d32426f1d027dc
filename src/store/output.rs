//! Where a file goes that is being written: the only opener of files for writing.

use super::unfinished::Unfinished;
use std::fs::{self, File};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// A file being written.
///
/// A regular file is replaced as a whole by [`Output::finish`]; dropped before that, it stays as it was. Whatever else has
/// the name, such as a device or a pipe, is opened by `finish` and written to. Symbolic links are followed, and stay.
#[derive(Debug)]
pub struct Output(Destination);

#[derive(Debug)]
enum Destination {
    Stdout(io::Stdout),
    Named {
        unfinished: Unfinished,
        target: PathBuf,
        is_regular: bool,
    },
}

/// More symbolic links in a row are a circle, here and in Linux.
const MOST_LINKS: usize = 40;

impl Output {
    /// Standard output, written as it comes.
    #[must_use]
    pub fn stdout() -> Self {
        Self(Destination::Stdout(io::stdout()))
    }

    /// What will be at `path` once it is finished; until then it is in a temporary file.
    ///
    /// # Errors
    ///
    /// `path` is a folder, or its folder does not exist or is not writable.
    pub fn create(path: &Path) -> io::Result<Self> {
        let (target, is_regular) = resolved(path)?;
        let folder = if is_regular {
            folder_of(&target).to_owned()
        } else {
            std::env::temp_dir()
        };
        Ok(Self(Destination::Named {
            unfinished: Unfinished::create(&folder)?,
            target,
            is_regular,
        }))
    }

    /// Whether a regular file is made, or replaced.
    #[must_use]
    pub fn is_regular(&self) -> bool {
        matches!(&self.0, Destination::Named { is_regular, .. } if *is_regular)
    }

    /// Finishes a regular file such that it is on the disk before it has its name, and its name when this returns, so that
    /// a crash of the machine spoils neither. It takes 1 to 5 ms.
    ///
    /// # Errors
    ///
    /// Those of [`Output::finish`].
    #[cfg(feature = "zarr")]
    pub(super) fn finish_durably(self) -> io::Result<()> {
        self.finish_synced(Self::finish)
    }

    /// Finishes a regular file like [`Output::finish_durably`], unless a file of its name is there: of several processes that
    /// do this at the same time one succeeds.
    ///
    /// # Errors
    ///
    /// [`AlreadyExists`](io::ErrorKind::AlreadyExists), or an error of [`Output::finish`].
    #[cfg(feature = "zarr")]
    pub(super) fn finish_new(self) -> io::Result<()> {
        self.finish_synced(|output| match output.0 {
            Destination::Named {
                unfinished,
                target,
                is_regular: true,
            } => unfinished.persist_new(&target),
            _ => Err(io::ErrorKind::AlreadyExists.into()),
        })
    }

    #[cfg(feature = "zarr")]
    fn finish_synced(mut self, finish: fn(Self) -> io::Result<()>) -> io::Result<()> {
        let folder = match &mut self.0 {
            Destination::Named {
                unfinished,
                target,
                is_regular: true,
            } => {
                unfinished.file().sync_all()?;
                Some(folder_of(target).to_owned())
            }
            _ => None,
        };
        finish(self)?;
        // Only Unix opens folders.
        match folder {
            Some(folder) if cfg!(unix) => File::open(folder)?.sync_all(),
            _ => Ok(()),
        }
    }

    /// Writes what is left and gives the file its name.
    ///
    /// # Errors
    ///
    /// The file cannot be renamed, or the device takes no more.
    pub fn finish(self) -> io::Result<()> {
        match self.0 {
            Destination::Stdout(mut stdout) => stdout.flush(),
            Destination::Named {
                unfinished,
                target,
                is_regular: true,
            } => unfinished.persist(&target),
            Destination::Named {
                mut unfinished,
                target,
                ..
            } => {
                // What is open for appending is never shortened or overwritten, even where it is a file.
                let mut device = File::options().append(true).open(target)?;
                let file = unfinished.file();
                file.rewind()?;
                io::copy(file, &mut device).map(drop)
            }
        }
    }
}

/// Equal outputs end in the same place.
impl PartialEq for Output {
    fn eq(&self, other: &Self) -> bool {
        let place = |output: &Self| match &output.0 {
            Destination::Stdout(_) => None,
            Destination::Named { target, .. } => Some((
                folder_of(target).canonicalize().ok(),
                target.file_name().map(ToOwned::to_owned),
            )),
        };
        place(self) == place(other)
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.0 {
            Destination::Stdout(stdout) => stdout.write(bytes),
            Destination::Named { unfinished, .. } => unfinished.file().write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.0 {
            Destination::Stdout(stdout) => stdout.flush(),
            Destination::Named { unfinished, .. } => unfinished.file().flush(),
        }
    }
}

impl Seek for Output {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        match &mut self.0 {
            Destination::Stdout(_) => Err(io::ErrorKind::NotSeekable.into()),
            Destination::Named { unfinished, .. } => unfinished.file().seek(to),
        }
    }
}

/// What `path` names behind its symbolic links, there or not, and whether it is, or will be, a regular file.
fn resolved(path: &Path) -> io::Result<(PathBuf, bool)> {
    let mut target = path.to_owned();
    for _ in 0..MOST_LINKS {
        if is_descriptor(&target) {
            return fs::metadata(&target).map(|_| (target, false));
        }
        match fs::read_link(&target) {
            Ok(next) => target = folder_of(&target).join(next),
            Err(_) => break,
        }
    }
    match fs::metadata(&target) {
        Ok(about) if about.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
        Ok(about) => Ok((target, about.is_file())),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok((target, true)),
        Err(error) => Err(error),
    }
}

/// Whether `path` is an open file of a process, such as what `/dev/stdout` points to: whoever opened it would miss what
/// replaces it.
fn is_descriptor(path: &Path) -> bool {
    let folder = folder_of(path).canonicalize();
    folder.is_ok_and(|folder| {
        folder.ends_with("fd") && (folder.starts_with("/proc") || folder.starts_with("/dev"))
    })
}

/// The folder that holds `path`.
pub(super) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}
