//! Which states of a map slide as friction is computed for: the others have a status of their own.

use super::Face;
use crate::classify::{BaseLimit, Regime, Sliding, SlidingState, Status};
use crate::sheet::LevelCurve;
use glam::DVec2;
use rayon::prelude::*;

/// Rows whose limits are found together.
const TOGETHER: usize = 32;

/// A state that was found: its column, regime, `(tau, load)`, and signed push angle in radians.
pub type FoundState = (usize, Regime, DVec2, f64);

/// The states of a row of which some do not slide toward the tip, from first touch on.
pub struct Dragged {
    row: usize,
    level: LevelCurve,
    /// The columns of all but first touch.
    columns: Vec<usize>,
    /// First touch, and those that a push from there leads to.
    states: Vec<SlidingState>,
    /// Columns of other states that slide toward the base.
    apart: Vec<usize>,
}

impl Dragged {
    /// Of a `row` of `face` with the states `found`, by growing push; `None` where all of them slide toward the tip.
    pub fn new(face: &Face, row: usize, found: &[FoundState]) -> Option<Self> {
        let level = face.sheet.level(row);
        let touch = [(level.touch_point(), 0.0)];
        let points = found.iter().map(|(.., point, push)| (*point, *push));
        let points: Vec<(DVec2, f64)> = touch.into_iter().chain(points).collect();
        let mut all = SlidingState::at(&level, &points).into_iter();
        let mut dragged = Self {
            row,
            level,
            columns: Vec::new(),
            states: all.next().into_iter().collect(),
            apart: Vec::new(),
        };
        for ((column, regime, ..), state) in found.iter().zip(all) {
            if *regime == Regime::Contact {
                dragged.columns.push(*column);
                dragged.states.push(state);
            } else if state.toward == Some(Sliding::Base) {
                dragged.apart.push(*column);
            }
        }
        let states = dragged.states.iter();
        let mut base = states.filter(|state| state.toward == Some(Sliding::Base));
        (base.next().is_some() || !dragged.apart.is_empty()).then_some(dragged)
    }

    /// Columns and what their statuses become, with the row's limit toward the base; where that was lost, every state counts as sticking
    /// that is not known to slide toward the base.
    fn marks(&self, limit: Option<&BaseLimit>) -> Vec<(usize, Status)> {
        let slidings: Vec<Sliding> = match limit {
            Some(limit) => limit.slidings(&self.states),
            None => {
                let base = |state: &SlidingState| state.toward == Some(Sliding::Base);
                let of = |state| {
                    if base(state) {
                        Sliding::Base
                    } else {
                        Sliding::Sticks
                    }
                };
                self.states.iter().map(of).collect()
            }
        };
        let along = self.columns.iter().zip(&slidings[1..]);
        let marked = along.filter_map(|(column, sliding)| match sliding {
            Sliding::Tip => None,
            Sliding::Base => Some((*column, Status::TowardBase)),
            Sliding::Sticks => Some((*column, Status::Sticking)),
        });
        let apart = self
            .apart
            .iter()
            .map(|column| (*column, Status::TowardBase));
        marked.chain(apart).collect()
    }
}

/// Writes the statuses of `rows` into those of a panel that is so many cells wide.
pub fn mark(rows: &[Dragged], width: usize, status: &mut [u32]) {
    let marks = rows.par_chunks(TOGETHER).map(|rows| {
        let levels: Vec<LevelCurve> = rows.iter().map(|row| row.level.clone()).collect();
        let limits = BaseLimit::of(&levels);
        let marks = rows.iter().zip(limits);
        let marks = marks.flat_map(|(row, limit)| {
            let marks = row.marks(limit.as_ref()).into_iter();
            marks.map(|(column, status)| (row.row * width + column, status))
        });
        let marks: Vec<(usize, Status)> = marks.collect();
        marks
    });
    let marks: Vec<Vec<(usize, Status)>> = marks.collect();
    for (cell, of_cell) in marks.into_iter().flatten() {
        status[cell] = of_cell.code();
    }
}
