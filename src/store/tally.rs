//! How many cells there are of each regime and status.

use crate::classify::{Regime, Status};
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

/// Names of the regimes by code.
pub(super) fn regimes() -> BTreeMap<u32, &'static str> {
    Regime::ALL.map(|own| (own.code(), own.name())).into()
}

/// Names of the statuses by code.
pub(super) fn statuses() -> BTreeMap<u32, &'static str> {
    Status::ALL.map(|own| (own.code(), own.name())).into()
}

/// Counts the codes of one channel: the name and the cells of each.
#[derive(Clone, Debug)]
pub(super) struct Tally(BTreeMap<u32, (&'static str, u64)>);

impl Tally {
    /// A tally in which every count is `cells`.
    pub(super) fn new(names: BTreeMap<u32, &'static str>, cells: u64) -> Self {
        let named = names.into_iter();
        Self(named.map(|(code, name)| (code, (name, cells))).collect())
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
        let named = self.0.values();
        named
            .map(|&(name, cells)| (name.to_owned(), cells))
            .collect()
    }
}
