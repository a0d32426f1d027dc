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

/// Counts the codes of one channel.
#[derive(Clone, Debug)]
pub(super) struct Tally {
    codes: Vec<u32>,
    names: Vec<String>,
    cells: Vec<u64>,
}

impl Tally {
    /// A tally in which every count is `cells`.
    pub(super) fn new<'a>(names: impl IntoIterator<Item = (u32, &'a str)>, cells: u64) -> Self {
        let (codes, names): (Vec<_>, Vec<_>) = names
            .into_iter()
            .map(|(code, name)| (code, name.to_owned()))
            .unzip();
        let cells = vec![cells; codes.len()];
        Self {
            codes,
            names,
            cells,
        }
    }

    /// Counts `codes`; returns the first one that has no name.
    pub(super) fn add(&mut self, codes: &[u32]) -> Result<(), u32> {
        for code in codes {
            let place = self.codes.iter().position(|known| known == code);
            self.cells[place.ok_or(*code)?] += 1;
        }
        Ok(())
    }

    /// Cells by name.
    pub(super) fn by_name(&self) -> BTreeMap<String, u64> {
        let cells = self.cells.iter().copied();
        self.names.iter().cloned().zip(cells).collect()
    }

    /// Names by code.
    pub(super) fn names(&self) -> BTreeMap<u32, &str> {
        let names = self.names.iter().map(String::as_str);
        self.codes.iter().copied().zip(names).collect()
    }
}
