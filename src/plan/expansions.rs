//! Cost of expansions against that of the cells they replace.

/// Cells whose refinement takes as long as a state of an expansion, with its trajectories, its share of the fit, and failed attempts. Measured
/// on `scenes/morphology.toml` on two shared cores of an AMD EPYC: 0.86 ms for a certified patch of 750 states, 0.48 us for a cell.
const CELLS_PER_STATE: usize = 3;

/// Cells whose refinement takes as long as the expansions of one row. Measured on the same sweep: about 4 us.
const CELLS_PER_ROW: usize = 8;

/// Number of states of a row that is expanded alone, with those that check it.
pub const STATES_OF_ROW: usize = 34;

/// Numbers of rows, and of states along each row, of most patches: `[rows, states]`.
pub const USUAL_PATCH: [usize; 2] = [24, 28];

/// Returns the number of cells whose refinement takes as long as some `states` and the expansions of `rows`.
#[must_use]
pub const fn expansion_cost(states: usize, rows: usize) -> usize {
    CELLS_PER_STATE * states + CELLS_PER_ROW * rows
}

/// Cells of one whisker side of a map beside the cost of its expansions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExpansionCount {
    /// Largest number of cells of a whisker side, with or without a state.
    pub cells: usize,
    /// Number of cells whose refinement takes as long as the cheapest expansions of the side's rows.
    pub cost: usize,
}

impl ExpansionCount {
    /// Counts for `rows` of at most `columns` cells on one side.
    #[must_use]
    pub fn new(rows: usize, columns: usize) -> Self {
        let [patch_rows, states] = USUAL_PATCH;
        let alone = rows * expansion_cost(STATES_OF_ROW, 1);
        let patch = expansion_cost(patch_rows * states, rows);
        Self {
            cells: rows * columns,
            cost: if rows > patch_rows {
                alone.min(patch)
            } else {
                alone
            },
        }
    }

    /// Returns true if expansions may take less time than the trajectories of all cells.
    #[must_use]
    pub const fn pays(&self) -> bool {
        self.cost < self.cells
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn expansions_pay_for_long_rows_or_many() {
        // A row of 110 cells costs as much as its expansions: 34 states of 3 cells, and 8.
        assert!(!ExpansionCount::new(4, 110).pays() && ExpansionCount::new(4, 111).pays());
        // A patch of 24 x 28 states costs 2016 cells, and 8 a row.
        let patch = ExpansionCount::new(96, 48);
        assert_eq!((patch.cells, patch.cost), (4608, 2784));
        assert!(patch.pays() && !ExpansionCount::new(96, 29).pays());
        // As many rows as a patch has give no patch.
        assert_eq!(ExpansionCount::new(24, 48).cost, 2640);
    }
}
