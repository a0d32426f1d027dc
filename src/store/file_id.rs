//! Identity of files: hard links, symbolic links and different spellings of a path name one file.

use std::fs;
use std::path::{Path, PathBuf};

/// Identity of standard output, or of a regular file or a folder, which need not exist yet.
///
/// Device and inode identify what exists on Unix. The canonical path identifies the rest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileId(Id);

#[derive(Clone, Debug, PartialEq, Eq)]
enum Id {
    Stdout,
    #[cfg(unix)]
    Inode {
        device: u64,
        inode: u64,
    },
    Path(PathBuf),
}

impl FileId {
    /// Identity of standard output.
    pub(super) const STDOUT: Self = Self(Id::Stdout);

    /// Identity of the file or folder at `path`, behind its symbolic links. A device or a pipe has none.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        let id = match fs::metadata(path) {
            Ok(about) if !about.is_file() && !about.is_dir() => return None,
            #[cfg(unix)]
            Ok(about) => {
                use std::os::unix::fs::MetadataExt;
                Id::Inode {
                    device: about.dev(),
                    inode: about.ino(),
                }
            }
            _ => Id::Path(resolved(path)?),
        };
        Some(Self(id))
    }

    /// Identity of the file at standard input, where a file is redirected to it.
    #[must_use]
    pub fn of_stdin() -> Option<Self> {
        let stdin = Path::new("/dev/stdin");
        stdin.exists().then(|| Self::of(stdin)).flatten()
    }

    /// Identities of the folders that hold `path`, from the innermost one on.
    #[must_use]
    pub fn of_folders(path: &Path) -> Vec<Self> {
        let path = resolved(path).unwrap_or_default();
        path.ancestors().skip(1).filter_map(Self::of).collect()
    }
}

/// The canonical path of something that need not exist: of its innermost part that does, with the rest as it is.
fn resolved(path: &Path) -> Option<PathBuf> {
    let path = std::path::absolute(path).ok()?;
    path.ancestors().find_map(|part| {
        let rest = path.strip_prefix(part).ok()?;
        Some(part.canonicalize().ok()?.join(rest))
    })
}

/// The folder that holds `path`.
pub(super) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}
