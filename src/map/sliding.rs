//! Statuses of states whose contact does not slide toward the tip, as the computed friction assumes.

use crate::classify::{ContactHistory, Regime, Sliding, Status};
use crate::engine::WhiskerSide;
use crate::sheet::{LevelCurve, rows_per_batch};
use glam::DVec2;
use rayon::prelude::*;

/// State of a row whose sliding is to be determined.
pub struct FoundState {
    /// Index of the state's column in the panel.
    pub column: usize,
    /// Regime of the state: contact if a push from first touch reaches it.
    pub regime: Regime,
    /// Contact coordinate and signed load of the state, `(tau, load)` with `load = f/rho^2`, dimensionless.
    pub point: DVec2,
    /// Magnitude of the state's push angle, in radians.
    pub push: f64,
}

/// States of a row whose sliding is to be determined.
pub struct FoundRow {
    pub row: usize,
    pub states: Vec<FoundState>,
}

impl FoundRow {
    /// Columns and statuses of the states that do not slide toward the tip. A contact with an unknown history counts as sticking.
    fn marks(&self, side: &WhiskerSide, history: Option<&ContactHistory>) -> Vec<(usize, Status)> {
        let (sheet, states) = (&side.sheet, &self.states);
        let is_reached = |state: &&FoundState| state.regime == Regime::Contact;
        let reached = states.iter().filter(is_reached).map(|state| {
            let sliding = history.map(|history| history.sliding(state.push));
            (state.column, sliding.unwrap_or(Sliding::Sticks))
        });
        let apart: Vec<&FoundState> = states.iter().filter(|state| !is_reached(state)).collect();
        let points: Vec<DVec2> = apart.iter().map(|state| state.point).collect();
        let slidings = Sliding::at(sheet.level(self.row).method, &sheet.rod, &points);
        let apart = apart.iter().zip(slidings);
        let apart = apart.filter_map(|(state, sliding)| Some((state.column, sliding?)));
        let marked = reached
            .chain(apart)
            .filter_map(|(column, sliding)| match sliding {
                Sliding::Tip => None,
                Sliding::Base => Some((column, Status::TowardBase)),
                Sliding::Sticks => Some((column, Status::Sticking)),
            });
        marked.collect()
    }
}

/// Writes the statuses of the states of `rows` of `side` into the `status` of a panel that is `width` cells wide and begins with the row
/// `first_row`.
pub fn mark(
    side: &WhiskerSide,
    rows: &[FoundRow],
    [width, first_row]: [usize; 2],
    status: &mut [u32],
) {
    let marks = rows.par_chunks(rows_per_batch(rows.len())).map(|rows| {
        let levels: Vec<LevelCurve> = rows.iter().map(|row| side.sheet.level(row.row)).collect();
        let histories = ContactHistory::of(&levels).into_iter();
        rows.iter().zip(histories).flat_map(|(row, history)| {
            let marks = row.marks(side, history.as_ref()).into_iter();
            marks.map(|(column, status)| ((row.row - first_row) * width + column, status))
        })
    });
    let marks: Vec<(usize, Status)> = marks.flatten_iter().collect();
    for (cell, of_cell) in marks {
        status[cell] = of_cell.code();
    }
}
