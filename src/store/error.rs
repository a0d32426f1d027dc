//! Errors of files.

use std::io;
use std::path::{Path, PathBuf};

/// A file that cannot be written or read. Every message is complete: there is no chain of sources to print.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StoreError {
    /// The file system refused to read.
    #[error("cannot read {file}: {1}", file = .0.display())]
    Read(PathBuf, io::Error),
    /// The file system refused to write.
    #[error("cannot write {file}: {1}", file = .0.display())]
    Write(PathBuf, io::Error),
    /// The map cannot be expressed as EXR, such as an atlas wider than 2^30 pixels.
    #[error("cannot write {file} as EXR: {1}", file = .0.display())]
    Encode(PathBuf, exr::error::Error),
    /// A sweep over more axes than an atlas has.
    #[error("cannot write {} as EXR: it has room for two sweep axes, the scene has {axes}", path.display())]
    TooManyAxes {
        /// The file.
        path: PathBuf,
        /// The axes, by name.
        axes: String,
    },
    /// A store that exists although the run does not resume it.
    #[error("{folder} exists already; resume it with --resume, or remove it", folder = .0.display())]
    Exists(PathBuf),
    /// A store that was created with other settings.
    #[error(
        "{} differs in `{name}`: {there} there, {here} here{reason}; use the settings with which it was created, or \
         give another --output", path.display(), reason = reason(name)
    )]
    AtOdds {
        /// The store.
        path: PathBuf,
        /// The attribute.
        name: &'static str,
        /// Value of the attribute in the store.
        there: String,
        /// Value of the attribute in this run.
        here: String,
    },
    /// A folder with blocks of another store, whose metadata are missing or damaged.
    #[error(
        "{folder} has blocks of another scene, version, engine, arithmetic, accuracy, channels or digits; \
         remove it, or give another --output", folder = .0.display()
    )]
    OtherBlocks(PathBuf),
    /// A store that is no longer at its path.
    #[error("{folder} was moved, removed or replaced during the run", folder = .0.display())]
    Displaced(PathBuf),
    /// A store of an incompatible version: the version.
    #[error("{folder} was written by whiskmap {1}, and only that version can check and read it", folder = .0.display())]
    OtherVersion(PathBuf, String),
    /// A Zarr folder of another program: what is missing or different.
    #[error("{folder} is not a store of whiskmap: {1}", folder = .0.display())]
    NotAStore(PathBuf, String),
    /// A file of a block that is not computed, or lost.
    #[error("{file} is missing: the store is not complete; compute the rest with `map --resume`", file = .0.display())]
    NotComputed(PathBuf),
    /// A folder, a pipe or a device.
    #[error("{file} is no regular file", file = .0.display())]
    NotAFile(PathBuf),
    /// A file that does not begin like an EXR file.
    #[error("{file} is not an EXR file", file = .0.display())]
    NotExr(PathBuf),
    /// An EXR file of another program: what is missing or different.
    #[error("{file} is an EXR file, but not a map of whiskmap: {1}", file = .0.display())]
    NotAMap(PathBuf, String),
    /// A file whose bytes end too early or contradict each other: where, and how.
    #[error("{file} is damaged: {1}", file = .0.display())]
    Damaged(PathBuf, String),
    /// A channel that the file does not have.
    #[error("{} has no channel `{name}`; it has {known}", path.display())]
    UnknownChannel {
        /// The file.
        path: PathBuf,
        /// The name.
        name: String,
        /// The names of its channels, separated by commas.
        known: String,
    },
    /// A panel that the map does not have.
    #[error("there is no panel {index}; the map has {panels}")]
    NoSuchPanel {
        /// The index.
        index: usize,
        /// The number of panels.
        panels: usize,
    },
    /// A channel of a panel does not have one value per cell.
    #[error("panel {index}: channel `{channel}` has {cells} cells instead of {expected}")]
    PanelSize {
        /// The panel.
        index: usize,
        /// The channel.
        channel: &'static str,
        /// Number of cells of the channel.
        cells: usize,
        /// Distances times push angles.
        expected: usize,
    },
    /// A regime or status that has no name.
    #[error("panel {index}: channel `{channel}` holds the code {code}, which has no name")]
    UnknownCode {
        /// The panel.
        index: usize,
        /// `regime` or `status`.
        channel: &'static str,
        /// The code.
        code: u32,
    },
    /// The map was finished before its last panel.
    #[error("the map was finished after {written} of {panels} panels")]
    Incomplete {
        /// Panels written.
        written: usize,
        /// Panels due.
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
    /// Makes the error `kind` of the file at `path` from its cause.
    pub(super) fn at<C>(path: &Path, kind: fn(PathBuf, C) -> Self) -> impl Fn(C) -> Self {
        move |cause| kind(path.to_owned(), cause)
    }

    /// Returns true if a file cannot be read or resumed, which is an error of the input.
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
                | Self::NotComputed(_)
        )
    }
}
