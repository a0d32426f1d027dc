//! Comparison of a channel of codes: `regime` or `status`.

use super::CellPlace;
use crate::scene::Grid;
use std::collections::BTreeMap;

/// Number of differing cells whose places are kept.
const PLACES: usize = 5;

/// Comparison of `regime` or `status` of two maps.
#[derive(Clone, Debug, serde::Serialize)]
#[non_exhaustive]
pub struct CodeComparison {
    /// Name of the compared channel of codes.
    pub channel: &'static str,
    /// Number of cells whose codes differ.
    pub differing: u64,
    /// Numbers of differing cells for each pair of codes, most cells first: `[pair]`.
    pub pairs: Vec<CodePair>,
    /// First differing cells in the order of the maps, at most five: `[cell]`.
    pub first: Vec<DifferentCodes>,
    #[serde(skip)]
    names: BTreeMap<u32, String>,
    #[serde(skip)]
    counts: BTreeMap<[u32; 2], u64>,
}

/// Pair of different codes, and the number of cells that have them.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct CodePair {
    /// Name of the code in each map: `[first, second]`.
    pub names: [String; 2],
    /// Number of cells with this pair of codes.
    pub cells: u64,
}

/// Cell whose codes differ.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct DifferentCodes {
    /// Name of the cell's code in each map: `[first, second]`.
    pub names: [String; 2],
    /// Place of the cell.
    pub place: CellPlace,
}

impl CodeComparison {
    pub(super) fn new(channel: &'static str, names: BTreeMap<u32, String>) -> Self {
        Self {
            channel,
            differing: 0,
            pairs: Vec::new(),
            first: Vec::new(),
            names,
            counts: BTreeMap::new(),
        }
    }

    pub(super) fn add(&mut self, grid: &Grid, cell: usize, codes: [f64; 2]) {
        if codes[0] == codes[1] {
            return;
        }
        let codes = codes.map(|code| code as u32);
        self.differing += 1;
        *self.counts.entry(codes).or_default() += 1;
        if self.first.len() < PLACES {
            self.first.push(DifferentCodes {
                names: self.named(codes),
                place: CellPlace::of(grid, cell),
            });
        }
    }

    fn named(&self, codes: [u32; 2]) -> [String; 2] {
        codes.map(|code| {
            let name = self.names.get(&code).cloned();
            name.unwrap_or_else(|| format!("code {code}"))
        })
    }

    /// Names and sorts the pairs.
    pub(super) fn finish(mut self) -> Self {
        let pairs = self
            .counts
            .iter()
            .map(|(codes, cells)| CodePair { names: self.named(*codes), cells: *cells });
        self.pairs = pairs.collect();
        self.pairs.sort_by_key(|pair| std::cmp::Reverse(pair.cells));
        self
    }
}
