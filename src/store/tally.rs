//! How many cells there are of each regime and status.

use crate::map::Shots;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The attribute `counts`: what a whole map holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Counts {
    /// Cells of each regime, by name.
    pub regimes: BTreeMap<String, u64>,
    /// Cells of each status, by name.
    pub statuses: BTreeMap<String, u64>,
    /// The greatest residual, relative to the whisker's length; `None` where no cell is in contact.
    pub worst_residual: Option<f64>,
    /// What the engine did for them.
    pub shots: Shots,
}

/// Counts the codes of one channel: the name and the cells of each.
#[derive(Clone, Debug)]
pub(super) struct Tally(BTreeMap<u32, (String, u64)>);

impl Tally {
    /// A tally in which every count is `cells`.
    pub(super) fn new<'a>(names: impl IntoIterator<Item = (u32, &'a str)>, cells: u64) -> Self {
        let named = |(code, name): (u32, &str)| (code, (name.to_owned(), cells));
        Self(names.into_iter().map(named).collect())
    }

    /// Counts `codes`; returns the first one that has no name.
    pub(super) fn add(&mut self, codes: &[u32]) -> Result<(), u32> {
        for code in codes {
            self.0.get_mut(code).ok_or(*code)?.1 += 1;
        }
        Ok(())
    }

    /// Cells by name.
    pub(super) fn by_name(&self) -> BTreeMap<String, u64> {
        self.0.values().cloned().collect()
    }

    /// Names by code.
    pub(super) fn names(&self) -> BTreeMap<u32, &str> {
        let named = self.0.iter();
        named.map(|(code, (name, _))| (*code, &**name)).collect()
    }
}
