//! Errors of maps, stores and their files.

use std::io;
use std::path::{Path, PathBuf};

/// Error of a file that cannot be written or read. Every message is complete: there is no chain of sources to print.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StoreError {
    /// The file system refused to read the file at this path.
    #[error("cannot read {file}: {1}", file = .0.display())]
    Read(PathBuf, io::Error),
    /// The file system refused to write the file at this path.
    #[error("cannot write {file}: {1}", file = .0.display())]
    Write(PathBuf, io::Error),
    /// The map cannot be expressed as EXR, such as an atlas wider than 2^30 pixels.
    #[error("cannot write {file} as EXR: {1}", file = .0.display())]
    Encode(PathBuf, exr::error::Error),
    /// A sweep over more axes than an atlas has.
    #[error("cannot write {} as EXR: it has room for two sweep axes, the scene has {axes}", path.display())]
    TooManyAxes {
        /// Path of the map.
        path: PathBuf,
        /// Names of the sweep axes.
        axes: String,
    },
    /// The store exists already, and the run does not resume it.
    #[error("{folder} exists already; resume it with --resume, or remove it", folder = .0.display())]
    Exists(PathBuf),
    /// The store was created with other settings.
    #[error(
        "{} differs in `{name}`: {there} there, {here} here{reason}; use the settings with which it was created, or \
         give another --output", path.display(), reason = reason(name)
    )]
    AtOdds {
        /// Path of the store.
        path: PathBuf,
        /// Name of the attribute in which store and run differ.
        name: &'static str,
        /// Value of the differing attribute in the store.
        there: String,
        /// Value of the differing attribute in this run.
        here: String,
    },
    /// The folder has blocks of another store, whose metadata are missing or damaged.
    #[error(
        "{folder} has blocks of another scene, version, engine, arithmetic, accuracy, channels or digits; \
         remove it, or give another --output", folder = .0.display()
    )]
    OtherBlocks(PathBuf),
    /// The store is no longer at its path.
    #[error("{folder} was moved, removed or replaced during the run", folder = .0.display())]
    Displaced(PathBuf),
    /// The store was written by an incompatible version, which is named.
    #[error("{folder} was written by whiskmap {1}, and only that version can check and read it", folder = .0.display())]
    OtherVersion(PathBuf, String),
    /// The folder is a Zarr store of another program; the text names what is missing or different.
    #[error("{folder} is not a store of whiskmap: {1}", folder = .0.display())]
    NotAStore(PathBuf, String),
    /// There is no folder with metadata at its root, so it is not a Zarr store.
    #[error("{folder} is not a store: it has no zarr.json; give a folder that `map --format zarr` wrote", folder = .0.display())]
    NoStore(PathBuf),
    /// A file of a block of the store does not exist: it is not computed, or was removed.
    #[error("{file} is missing", file = .0.display())]
    NotComputed(PathBuf),
    /// The store has no values for some of the requested whiskers, because a run has not finished their block.
    #[error(
        "{folder} is not finished: some requested whiskers are not computed; `whiskmap status` lists the missing blocks, and \
         `whiskmap map --format zarr --resume` with the scene computes them", folder = .0.display()
    )]
    Unfinished(PathBuf),
    /// The path leads to a folder, a pipe or a device instead of a file.
    #[error("{file} is no regular file", file = .0.display())]
    NotAFile(PathBuf),
    /// The file does not begin like an EXR file.
    #[error("{file} is not an EXR file", file = .0.display())]
    NotExr(PathBuf),
    /// Another program wrote the EXR file; the text names what is missing or different.
    #[error("{file} is an EXR file, but not a map of whiskmap: {1}", file = .0.display())]
    NotAMap(PathBuf, String),
    /// The bytes of the file end too early or contradict each other; the text describes where, and how.
    #[error("{file} is damaged: {1}", file = .0.display())]
    Damaged(PathBuf, String),
    /// The file does not have the requested channel.
    #[error("{} has no channel `{name}`; it has {known}", path.display())]
    UnknownChannel {
        /// Path of the file without the channel.
        path: PathBuf,
        /// Name of the channel that the file does not have.
        name: String,
        /// Names of the channels that the file has, separated by commas.
        known: String,
    },
    /// The map does not have the requested attribute, whose name is given.
    #[error("there is no attribute `{0}`")]
    NoAttribute(String),
    /// The read of a computed map was cancelled.
    #[error("the computation was cancelled")]
    Cancelled,
    /// The map does not have the requested panel.
    #[error("there is no panel {index}; the map has {panels}")]
    NoSuchPanel {
        /// Index of the requested panel.
        index: usize,
        /// Number of panels of the map.
        panels: usize,
    },
    /// A channel of a panel does not have one value per cell.
    #[error("panel {index}: channel `{channel}` has {cells} cells instead of {expected}")]
    PanelSize {
        /// Index of the panel of wrong size.
        index: usize,
        /// Name of the channel of wrong size.
        channel: &'static str,
        /// Number of cells of the channel.
        cells: usize,
        /// Number of cells of a panel: distances times push angles.
        expected: usize,
    },
    /// A cell has a regime or a status without a name.
    #[error("panel {index}: channel `{channel}` holds the code {code}, which has no name")]
    UnknownCode {
        /// Index of the panel with the unknown code.
        index: usize,
        /// Name of the channel with the unknown code: `regime` or `status`.
        channel: &'static str,
        /// Code of a regime or a status that has no name.
        code: u32,
    },
    /// The map was finished before its last panel.
    #[error("the map was finished after {written} of {panels} panels")]
    Incomplete {
        /// Number of panels written.
        written: usize,
        /// Number of panels of the map.
        panels: usize,
    },
}

/// Explanation of an attribute in a message.
fn reason(name: &str) -> &'static str {
    if name == "arithmetic" {
        " (with and without fused multiply-add, processors round differently)"
    } else {
        ""
    }
}

impl StoreError {
    /// Returns a function that makes the error `kind` of the file at `path` from its cause.
    pub(super) fn at<C>(path: &Path, kind: fn(PathBuf, C) -> Self) -> impl Fn(C) -> Self {
        move |cause| kind(path.to_owned(), cause)
    }

    /// Returns true if the error is one of the input: a file that cannot be read or resumed.
    #[must_use]
    pub fn is_unreadable(&self) -> bool {
        matches!(
            self,
            Self::Read(..)
                | Self::NotAFile(_)
                | Self::NotExr(_)
                | Self::NotAMap(..)
                | Self::Damaged(..)
                | Self::Exists(_)
                | Self::AtOdds { .. }
                | Self::OtherBlocks(_)
                | Self::OtherVersion(..)
                | Self::NotAStore(..)
                | Self::NoStore(_)
                | Self::NotComputed(_)
                | Self::Unfinished(_)
        )
    }
}
