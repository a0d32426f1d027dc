//! Cost of nets against the cost of the cells they replace.

/// Cells whose refinement takes as long as a state of a net, with its share of the tensor and of the check. Measured on
/// `scenes/morphology.toml` on one thread of a Xeon (AVX-512): 0.40 us, and 0.57 us for a cell with its guess.
const CELLS_PER_STATE: usize = 1;

/// Cells whose refinement takes as long as the expansions of one row. Measured on the same whiskers: 3.2 us.
const CELLS_PER_ROW: usize = 6;

/// Cells whose refinement takes as long as the comparison of one known row with the net for guesses, which every sheet has.
const CELLS_PER_LINE: usize = 3;

/// Numbers of contacts, and of loads at each, of most nets: `[contacts, loads]`.
pub const USUAL_NET: [usize; 2] = [24, 22];

/// Returns the number of cells whose refinement takes as long as some `states` of a net and the expansions of `rows`.
#[must_use]
pub const fn net_cost(states: usize, rows: usize) -> usize {
    CELLS_PER_STATE * states + CELLS_PER_ROW * rows
}

/// Cells of one whisker side of a map beside the cost of its net.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExpansionCount {
    /// Largest number of cells of a whisker side, with or without a state.
    pub cells: usize,
    /// Number of cells whose refinement takes as long as the smallest net of the side's rows.
    pub cost: usize,
}

impl ExpansionCount {
    /// Counts for `rows` of at most `columns` cells on one side, of a map with or without numbers of states.
    #[must_use]
    pub const fn new(rows: usize, columns: usize, needs_states: bool) -> Self {
        let [contacts, loads] = USUAL_NET;
        Self {
            cells: rows * columns,
            cost: match needs_states {
                true => net_cost(contacts * loads, rows),
                false => CELLS_PER_LINE * rows,
            },
        }
    }

    /// Returns true if a net may take less time than the trajectories of all cells.
    #[must_use]
    pub const fn pays(&self) -> bool {
        self.cost < self.cells
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nets_pay_for_some_thousand_cells() {
        // 528 states cost 528 cells, and each row 6.
        let net = ExpansionCount::new(96, 48, true);
        assert_eq!((net.cells, net.cost), (4608, 1104));
        assert!(net.pays() && !ExpansionCount::new(96, 11, true).pays());
        assert!(
            ExpansionCount::new(1, 535, true).pays() && !ExpansionCount::new(1, 534, true).pays()
        );
    }
}
