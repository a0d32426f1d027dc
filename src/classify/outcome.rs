//! Outcomes of cells, before they are classified.

/// Outcome of a cell: what Newton's method or an engine reports. A cell without a solution is data, not an error.
///
/// A map stores no outcome but the [`Status`](super::Status) that follows from it and the boundary of the row. Some outcomes only lead to a
/// fallback to the CPU, and some statuses are of friction, boundaries and tables, which solvers do not know.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Outcome {
    /// The cell is solved, with a bound on the residual.
    Solved,
    /// The cell is solved, with the contact at the tip up to the residual.
    AtTip,
    /// The cell has no solution: the contact lies beyond the tip.
    BeyondTip,
    /// The cell has no solution: the push angle lies beyond the fold.
    BeyondFold,
    /// The cell has no solution: the sheet has no guess there.
    OffSheet,
    /// The solver found neither a solution of the cell nor a proof that there is none.
    NotConverged,
    /// The cell is not certified: a number is not finite, or nothing was written.
    NotFinite,
    /// The cell is not certified: it lies next to the tip, or to the end of a known row.
    NearEdge,
    /// The cell is not certified: the bound on the residual is too large.
    Missed,
    /// The cell is not computed: its row has no expansions, or ends before it.
    NoRow,
}

impl Outcome {
    /// Returns true if the cell is solved.
    #[must_use]
    pub const fn is_solved(self) -> bool {
        matches!(self, Self::Solved | Self::AtTip)
    }
}
