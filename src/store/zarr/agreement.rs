//! Agreement of a store on disk with the settings of a run.

use super::check::BlockOwner;
use super::files::attributes;
use super::identity::AGREED;
use super::metadata::IDENTITY;
use super::{METADATA, ZarrStore};
use crate::store::StoreError;
use crate::store::temporary::host_of;
use serde_json::{Map, Value};
use std::path::Path;
use std::{fs, io};

impl ZarrStore {
    /// Checks that the store at the path, if any, has these settings. Its metadata may be damaged if its blocks belong to this store.
    pub(super) fn agree(&self) -> Result<(), StoreError> {
        match Self::open(&self.path) {
            Ok(_) if !self.may_exist => Err(StoreError::Exists(self.path.clone())),
            Ok(there) => {
                self.agree_with(&there)?;
                match self.owner() {
                    BlockOwner::Other => Err(StoreError::OtherBlocks(self.path.clone())),
                    BlockOwner::Nobody | BlockOwner::This => Ok(()),
                }
            }
            Err(why) if is_absent(&why) => {
                let (owner, is_empty) = (self.owner(), is_empty(&self.path));
                // Another process may have created it meanwhile: the root first.
                if Self::is_at(&self.path) {
                    return self.agree();
                }
                match owner {
                    BlockOwner::Other => Err(StoreError::OtherBlocks(self.path.clone())),
                    BlockOwner::Nobody if !is_empty => {
                        let why = format!("it has files, but no {METADATA}");
                        Err(StoreError::NotAStore(self.path.clone(), why))
                    }
                    BlockOwner::Nobody | BlockOwner::This => Ok(()),
                }
            }
            Err(StoreError::NotAStore(..) | StoreError::Damaged(..))
                if self.may_exist && self.owner() == BlockOwner::This =>
            {
                Ok(())
            }
            Err(why) => Err(why),
        }
    }

    fn agree_with(&self, there: &Self) -> Result<(), StoreError> {
        let apart = AGREED
            .iter()
            .find(|name| self.attributes.get(**name) != there.attributes.get(**name));
        let Some(name) = apart else {
            return Ok(());
        };
        let text = |store: &Self| match store.attributes.get(*name) {
            Some(Value::String(text)) => text.clone(),
            Some(value) => value.to_string(),
            None => "nothing".to_owned(),
        };
        let (there, here) = (text(there), text(self));
        let [there, here] = first_difference(&there, &here);
        Err(StoreError::AtOdds {
            path: self.path.clone(),
            name,
            there,
            here,
        })
    }

    /// Checks that the store at its path still has this identity.
    pub(super) fn check_place(&self) -> Result<(), StoreError> {
        let found = attributes(&self.path);
        let is_same =
            |found: &Map<String, Value>| found.get(IDENTITY) == self.attributes.get(IDENTITY);
        if found.is_ok_and(|found| is_same(&found)) {
            Ok(())
        } else {
            Err(StoreError::Displaced(self.path.clone()))
        }
    }
}

/// Returns true for the error of a path without a folder, or of a folder without metadata.
fn is_absent(why: &StoreError) -> bool {
    match why {
        StoreError::Read(_, why) => why.kind() == io::ErrorKind::NotFound,
        why => matches!(why, StoreError::NoStore(_)),
    }
}

/// Returns true if a folder is missing or has only temporary files.
fn is_empty(folder: &Path) -> bool {
    let names = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names = names.map(|entry| entry.file_name());
    names.all(|name| name.to_str().and_then(host_of).is_some())
}

/// The first lines in which two texts differ.
fn first_difference(one: &str, other: &str) -> [String; 2] {
    let mut lines = [one.lines(), other.lines()];
    let mut number = 0;
    loop {
        number += 1;
        let [one, other] = lines.each_mut().map(Iterator::next);
        if one.is_none() && other.is_none() {
            return ["line endings", "other line endings"].map(str::to_owned);
        }
        if one != other {
            let shown = |line: Option<&str>| match (line, number) {
                (None, _) => "nothing more".to_owned(),
                (Some(line), 1) => line.to_owned(),
                (Some(line), _) => format!("`{line}` in line {number}"),
            };
            return [one, other].map(shown);
        }
    }
}
