//! The files that the text of a scene may name.

use std::fs;
use std::path::{Path, PathBuf};

/// Which files the text of a scene may name.
#[derive(Clone, Copy, Debug)]
pub(super) enum NamedFiles<'a> {
    /// Regular files, relative to this folder.
    In(&'a Path),
    /// None: checking the text opens no path.
    Forbidden,
}

impl NamedFiles<'_> {
    /// The path of the file `name`, if the text may name it.
    pub fn path_of(self, name: &str) -> Option<PathBuf> {
        match self {
            Self::In(folder) => Some(folder.join(name)),
            Self::Forbidden => None,
        }
    }

    /// The path of the regular file `name`.
    ///
    /// # Errors
    /// What is wrong with it, without its name.
    pub fn find(self, name: &str) -> Result<PathBuf, String> {
        let Some(path) = self.path_of(name) else {
            return Err("must be a list of rows: only a scene file may name a CSV file".to_owned());
        };
        // A pipe without a writer would never open.
        match fs::metadata(&path) {
            Ok(about) if !about.is_file() => Err("must name a regular file".to_owned()),
            _ => Ok(path),
        }
    }
}
