//! Runs of cells: neighbours in a row whose answers come from one place.

use std::ops::Range;

/// Where the answers of a run come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Nowhere: the sheet has nothing there.
    Outside,
    /// Refined cells, from this one on.
    Refined(u32),
    /// An engine's cells beside a reference, from the cell with the second index on.
    Engine(u32, u32),
}

impl Source {
    /// That of the cell so many further on.
    pub const fn after(self, count: u32) -> Self {
        match self {
            Self::Outside => self,
            Self::Refined(first) => Self::Refined(first + count),
            Self::Engine(reference, first) => Self::Engine(reference, first + count),
        }
    }
}

/// Neighbouring cells.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Run {
    /// Their indices among the cells of the row, by growing push angle.
    pub cells: Range<usize>,
    /// The source of the first one; the others follow it there, too.
    pub source: Source,
}

impl Run {
    /// Every cell, and its source.
    pub fn each(&self) -> impl Iterator<Item = (usize, Source)> + use<> {
        let Self { cells, source } = self.clone();
        cells.zip(0..).map(move |(cell, i)| (cell, source.after(i)))
    }
}

/// Adds a cell, which comes after all others, to the last of the `runs` if it goes on there.
pub fn push(runs: &mut Vec<Run>, cell: usize, source: Source) {
    if let Some(last) = runs.last_mut()
        && last.cells.end == cell
        && last.source.after(last.cells.len() as u32) == source
    {
        last.cells.end += 1;
    } else {
        let cells = cell..cell + 1;
        runs.push(Run { cells, source });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_come_back_one_by_one() {
        use Source::{Engine, Outside, Refined};
        let cells = [
            (0, Refined(7)),
            (1, Refined(8)),
            (2, Refined(10)),
            (4, Refined(11)),
            (5, Outside),
            (6, Outside),
            (7, Engine(3, 5)),
            (8, Engine(3, 6)),
            (9, Engine(4, 7)),
        ];
        let mut runs = Vec::new();
        for (cell, source) in cells {
            push(&mut runs, cell, source);
        }
        let each: Vec<_> = runs.iter().flat_map(Run::each).collect();
        assert_eq!(each, cells);
        let lengths: Vec<usize> = runs.iter().map(|run| run.cells.len()).collect();
        assert_eq!(lengths, [2, 1, 1, 2, 2, 1]);
    }
}
