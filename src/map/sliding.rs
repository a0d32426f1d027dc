//! Which states of a map slide as friction is computed for: the others have a status of their own.

use crate::classify::{ContactHistory, Regime, Sliding, Status};
use crate::engine::WhiskerSide;
use crate::sheet::{LevelCurve, rows_per_batch};
use glam::DVec2;
use rayon::prelude::*;

/// A state that was found.
pub struct FoundState {
    /// Column of the panel.
    pub column: usize,
    /// Whether a push from first touch leads there.
    pub regime: Regime,
    /// `(tau, load)`.
    pub point: DVec2,
    /// A magnitude, in radians.
    pub push: f64,
}

/// The states of a row.
pub struct FoundRow {
    pub row: usize,
    pub states: Vec<FoundState>,
}

impl FoundRow {
    /// Columns of the states that do not slide toward the tip, and what their statuses become. Where it is not known what a push makes of
    /// the contact, it counts as sticking.
    fn marks(&self, side: &WhiskerSide, dragged: Option<&ContactHistory>) -> Vec<(usize, Status)> {
        let (sheet, states) = (&side.sheet, &self.states);
        let is_led_to = |state: &&FoundState| state.regime == Regime::Contact;
        let led_to = states.iter().filter(is_led_to).map(|state| {
            let sliding = dragged.map(|dragged| dragged.sliding(state.push));
            (state.column, sliding.unwrap_or(Sliding::Sticks))
        });
        let apart: Vec<&FoundState> = states.iter().filter(|state| !is_led_to(state)).collect();
        let points: Vec<DVec2> = apart.iter().map(|state| state.point).collect();
        let slidings = Sliding::at(sheet.level(self.row).method, &sheet.rod, &points);
        let apart = apart.iter().zip(slidings);
        let apart = apart.filter_map(|(state, sliding)| Some((state.column, sliding?)));
        let marked = led_to
            .chain(apart)
            .filter_map(|(column, sliding)| match sliding {
                Sliding::Tip => None,
                Sliding::Base => Some((column, Status::TowardBase)),
                Sliding::Sticks => Some((column, Status::Sticking)),
            });
        marked.collect()
    }
}

/// Writes the statuses of the states of `rows` of `side` into those of a panel that is `width` cells wide.
pub fn mark(side: &WhiskerSide, rows: &[FoundRow], width: usize, status: &mut [u32]) {
    let marks = rows.par_chunks(rows_per_batch(rows.len())).map(|rows| {
        let levels: Vec<LevelCurve> = rows.iter().map(|row| side.sheet.level(row.row)).collect();
        let dragged = ContactHistory::of(&levels).into_iter();
        rows.iter().zip(dragged).flat_map(|(row, dragged)| {
            let marks = row.marks(side, dragged.as_ref()).into_iter();
            marks.map(|(column, status)| (row.row * width + column, status))
        })
    });
    let marks: Vec<(usize, Status)> = marks.flatten_iter().collect();
    for (cell, of_cell) in marks {
        status[cell] = of_cell.code();
    }
}
