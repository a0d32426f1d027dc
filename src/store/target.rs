//! Targets of outputs: the path of an output is resolved, and the file there must be replaceable.

use super::file_id::folder_of;
use std::fs::{self, File, Metadata};
use std::io;
use std::path::{Path, PathBuf};

/// Target of an output: a regular file or a stream.
#[derive(Debug)]
pub(super) enum OutputTarget {
    /// A regular file, with the metadata of the file that it replaces, if there is one.
    Regular(PathBuf, Option<Metadata>),
    /// A device, a pipe or an open file of a process: bytes are appended to it.
    Stream(PathBuf),
}

/// Linux follows at most this many symbolic links in a row.
const MOST_LINKS: usize = 40;

impl OutputTarget {
    /// Follows the symbolic links of `path` and checks the file there.
    ///
    /// # Errors
    /// A link must not be followed, or `path` leads to a folder, or to a file without write permission.
    pub(super) fn of(path: &Path) -> io::Result<Self> {
        check_links(folder_of(path))?;
        let (given, mut path) = (path, path.to_owned());
        let mut links = 0;
        while let Ok(next) = fs::read_link(&path) {
            if is_descriptor(&path) {
                break;
            }
            links += 1;
            if links > MOST_LINKS {
                // Linux has a message of its own, and other systems may follow more links.
                fs::metadata(given)?;
                return Err(refused("more than 40 symbolic links lead to it"));
            }
            check_link(&path)?;
            path = folder_of(&path).join(next);
        }
        if is_descriptor(&path) {
            return fs::metadata(&path).map(|_| Self::Stream(path));
        }
        // Windows has no metadata of its null device.
        if cfg!(windows) && path.as_os_str().eq_ignore_ascii_case("NUL") {
            return Ok(Self::Stream(path));
        }
        match fs::metadata(&path) {
            Ok(about) if about.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
            Ok(about) if !about.is_file() => Ok(Self::Stream(path)),
            // An administrator can open a read-only file, so the mode decides.
            Ok(about) if about.permissions().readonly() => {
                Err(refused("the file there is read-only"))
            }
            Ok(about) => File::options()
                .write(true)
                .open(&path)
                .map(|_| Self::Regular(path, Some(about))),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Self::Regular(path, None)),
            Err(error) => Err(error),
        }
    }
}

/// Checks every symbolic link among the folders that `path` names.
///
/// # Errors
/// A link must not be followed: it belongs to another user, in a folder that others may write to.
pub fn check_links(path: &Path) -> io::Result<()> {
    let mut links = path.ancestors().filter(|folder| folder.is_symlink());
    links.try_for_each(check_link)
}

fn refused(why: &str) -> io::Error {
    io::Error::new(io::ErrorKind::PermissionDenied, why)
}

/// Returns true if `path` is an open file of a process, such as the target of `/dev/stdout`: the process that opened it would
/// not see a file that replaces it.
fn is_descriptor(path: &Path) -> bool {
    let folder = folder_of(path).canonicalize();
    folder.is_ok_and(|folder| {
        folder.ends_with("fd") && (folder.starts_with("/proc") || folder.starts_with("/dev"))
    })
}

/// Refuses a symbolic link that another user may have made. [`OutputTarget::of`] follows links itself, so `protected_symlinks` of Linux
/// has no effect on them. Its rule applies here in every folder that others may write to, sticky or not: the link must belong to
/// this user or to the folder's owner.
#[cfg(unix)]
fn check_link(link: &Path) -> io::Result<()> {
    use std::os::unix::fs::MetadataExt;
    let folder = fs::metadata(folder_of(link))?;
    let owner = fs::symlink_metadata(link)?.uid();
    let is_shared = folder.mode() & 0o022 != 0;
    if is_shared && owner != folder.uid() && owner != rustix::process::geteuid().as_raw() {
        let link = link.display();
        return Err(refused(&format!(
            "{link} is a symbolic link of user {owner} in a folder that others may write to"
        )));
    }
    Ok(())
}

#[cfg(not(unix))]
fn check_link(_: &Path) -> io::Result<()> {
    Ok(())
}

/// Gives `file` the owner, the group and the permissions of the file that it will replace. The set-user-ID and set-group-ID bits
/// are dropped, as by every write.
///
/// # Errors
/// This user may not give files that owner or group. Without them, other users could read or write the new file.
#[cfg(unix)]
pub(super) fn inherit(file: &File, replaced: &Metadata) -> io::Result<()> {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
    let own = file.metadata()?;
    let (user, group) = (replaced.uid(), replaced.gid());
    if (own.uid(), own.gid()) != (user, group) {
        let kept = fchown(file, Some(user), Some(group));
        kept.map_err(|_| {
            refused(&format!(
                "the file there belongs to user {user} and group {group}; this user cannot make such a file"
            ))
        })?;
    }
    file.set_permissions(fs::Permissions::from_mode(replaced.mode() & 0o777))
}

#[cfg(not(unix))]
pub(super) fn inherit(_: &File, _: &Metadata) -> io::Result<()> {
    Ok(())
}

#[cfg(all(test, unix))]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    /// A file never replaces the last link of a chain that is too long.
    #[test]
    fn as_many_links_are_followed_as_by_linux() {
        let folder = tempfile::tempdir().unwrap();
        let path = |links: usize| folder.path().join(links.to_string());
        for links in 1..=41 {
            symlink(path(links - 1), path(links)).unwrap();
        }
        let target = |links| match OutputTarget::of(&path(links)).unwrap() {
            OutputTarget::Regular(target, _) => target,
            OutputTarget::Stream(_) => PathBuf::new(),
        };
        assert_eq!([target(1), target(40)], [path(0), path(0)]);
        assert!(OutputTarget::of(&path(41)).is_err());
    }
}
