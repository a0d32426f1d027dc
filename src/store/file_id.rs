//! Identity of files: hard links, symbolic links and different spellings of a path name one file.

use std::fs::{self, File};
use std::path::{Path, PathBuf};

/// Identity of standard output, or of a regular file or a folder, which need not exist yet.
///
/// Device and inode identify what exists on Unix. The canonical path identifies the rest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileId(FileKey);

#[derive(Clone, Debug, PartialEq, Eq)]
enum FileKey {
    Stdout,
    #[cfg(unix)]
    Inode {
        device: u64,
        inode: u64,
    },
    Path(PathBuf),
}

impl FileId {
    /// Returns the identity of the file or folder at `path`, behind its symbolic links; `None` for a device or a pipe.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        let id = match fs::metadata(path) {
            Ok(about) if !about.is_file() && !about.is_dir() => return None,
            #[cfg(unix)]
            Ok(about) => inode(&about),
            _ => FileKey::Path(resolved(path)?),
        };
        Some(Self(id))
    }

    /// Returns false if two paths with equal identities lead to two files after all: while another process replaces files, the
    /// inode of a removed file may be that of the next new one. Both files are held open to be compared. `-` is a standard stream.
    #[must_use]
    pub fn is_confirmed(one: &Path, other: &Path) -> bool {
        if [one, other].contains(&Path::new("-")) {
            return true;
        }
        let open = |path| File::open(path).and_then(|file| Ok((file.metadata()?, file)));
        match (open(one), open(other)) {
            #[cfg(unix)]
            (Ok((one, _one)), Ok((other, _other))) => inode(&one) == inode(&other),
            _ => true,
        }
    }

    /// Returns the identity of the file at standard input; `None` unless a file is redirected to it, and on Windows.
    #[must_use]
    pub fn of_stdin() -> Option<Self> {
        let stdin = Path::new("/dev/stdin");
        let has_name = cfg!(unix) && stdin.exists();
        has_name.then(|| Self::of(stdin)).flatten()
    }

    /// Returns the identity of standard output: of the file that it is redirected to, if there is one. On Windows no redirection is known.
    pub(super) fn of_stdout() -> Self {
        let redirected = cfg!(unix).then(|| Self::of(Path::new("/dev/stdout")));
        redirected.flatten().unwrap_or(Self(FileKey::Stdout))
    }

    /// Returns the identities of the folders that hold `path`, from the innermost one on: `[folder]`.
    #[must_use]
    pub fn of_folders(path: &Path) -> Vec<Self> {
        let path = resolved(path).unwrap_or_default();
        path.ancestors().skip(1).filter_map(Self::of).collect()
    }
}

#[cfg(unix)]
fn inode(about: &fs::Metadata) -> FileKey {
    use std::os::unix::fs::MetadataExt;
    FileKey::Inode {
        device: about.dev(),
        inode: about.ino(),
    }
}

/// The canonical path of something that need not exist: of its innermost part that does, with the rest as it is. Where names that differ
/// in case are usually one file, the rest is in lower case.
fn resolved(path: &Path) -> Option<PathBuf> {
    let path = std::path::absolute(path).ok()?;
    path.ancestors().find_map(|part| {
        let rest = path.strip_prefix(part).ok()?;
        let rest = match cfg!(any(windows, target_vendor = "apple")) {
            true => rest.as_os_str().to_ascii_lowercase().into(),
            false => rest.to_owned(),
        };
        Some(part.canonicalize().ok()?.join(rest))
    })
}

/// Returns the folder that holds `path`.
pub(super) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

#[cfg(all(test, unix))]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    #[test]
    fn only_two_names_of_one_file_are_confirmed() {
        let folder = tempfile::tempdir().unwrap();
        let [one, hard, other] = ["one", "hard", "other"].map(|name| folder.path().join(name));
        fs::write(&one, "").unwrap();
        fs::hard_link(&one, &hard).unwrap();
        assert!(FileId::is_confirmed(&one, &hard));
        // A file that cannot be opened cannot be compared.
        assert!(FileId::is_confirmed(&one, &other));
        fs::write(&other, "").unwrap();
        assert!(!FileId::is_confirmed(&one, &other));
    }
}
