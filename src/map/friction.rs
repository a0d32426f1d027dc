//! States with friction that the engines do not compute: contacts that slide toward the base or stick. Engines compute all states with
//! the friction of a contact that slides toward the tip.

use super::Panel;
use crate::classify::{Regime, Status};
use crate::engine::{Values, WhiskerSide};
use crate::friction::{ContactHistory, ContactPhase, ContactQuery, FrictionState, Sliding, states};
use crate::sheet::{LevelCurve, rows_per_batch};
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

/// Row of a whisker side with friction, and its cells in contact.
pub struct FrictionRow {
    /// Index of the row in the sheet.
    pub row: usize,
    /// Push angle at which a push from first touch detaches, a magnitude in radians.
    pub end_push: f64,
    /// Columns of the side whose cells are in contact and reached by a push from first touch: `[cell]`.
    pub contacts: Vec<usize>,
}

/// Cell whose contact does not slide toward the tip, so that its friction differs.
struct FrictionCell {
    /// Index of the cell in the panel.
    cell: usize,
    /// Sliding direction of the contact; `None` if it is not found.
    sliding: Option<Sliding>,
    /// State of the cell and its channel values `[channel]`; `None` at first touch, where friction changes nothing, and if no state is
    /// found.
    state: Option<(FrictionState, Values)>,
    /// Largest bending strain of the state; NaN without a state, and if it is not computed.
    strain: f32,
}

/// Replaces the states of `rows` of `side` that do not slide toward the tip, in a `panel` that is `width` cells wide and begins with the
/// row `first_row`. Without a known history a cell keeps its regime, which follows from the contact that slides toward the tip, but has no
/// state. Cells beyond a detachment to which the contact does not slide are marked. If `cancel` is true, the function soon returns, and the `panel` is
/// incomplete.
pub fn replace(
    side: &WhiskerSide,
    rows: &[FrictionRow],
    [width, first_row]: [usize; 2],
    panel: &mut Panel,
    cancel: &AtomicBool,
) {
    let has_strain = !panel.peak_strain.is_empty();
    let batches = rows.par_chunks(rows_per_batch(rows.len()));
    let batches = batches.filter(|_| !cancel.load(Ordering::Relaxed));
    let found = batches.map(|rows| {
        let levels = rows.iter().map(|row| side.sheet.fine_level(row.row));
        let levels: Vec<LevelCurve> = levels.collect();
        let histories = ContactHistory::of(&levels);
        let mut cells = cells(side, rows, &histories, [width, first_row]);
        if has_strain {
            add_strains(side, &mut cells);
        }
        let ends = rows.iter().zip(histories).filter(|(row, history)| {
            let sliding = history.as_ref().and_then(|history| history.sliding_at_end(row.end_push));
            sliding.is_some_and(|sliding| sliding != Sliding::Tip)
        });
        let ends: Vec<usize> = ends.map(|(row, _)| row.row - first_row).collect();
        (cells, ends)
    });
    for (cells, endless) in found.collect::<Vec<_>>() {
        for cell in &cells {
            write(cell, panel);
        }
        for row in endless {
            for column in side.columns.in_map(&(0..side.columns.len())) {
                mark_end(row * width + column, panel);
            }
        }
    }
}

/// The cells of `rows` that do not slide toward the tip, with their states.
fn cells(
    side: &WhiskerSide,
    rows: &[FrictionRow],
    histories: &[Option<ContactHistory>],
    [width, first_row]: [usize; 2],
) -> Vec<FrictionCell> {
    let columns = &side.columns;
    let mut unsolved = Vec::new();
    let mut queries = Vec::new();
    let mut wanted = Vec::new();
    for (row, history) in rows.iter().zip(histories) {
        for &column in &row.contacts {
            let push = columns.pushes[column];
            let cell = (row.row - first_row) * width + columns.in_map(&(column..column + 1)).start;
            let phase = history.as_ref().map(|history| history.phase(push));
            let sliding = phase.map(ContactPhase::sliding);
            if let (Some(history), Some(phase)) = (history, phase)
                && push > 0.0
            {
                if sliding != Some(Sliding::Tip) {
                    wanted.push((row.row, columns.signed_push(column), cell));
                    queries.push(ContactQuery { history, push, phase });
                }
            } else if sliding != Some(Sliding::Tip) {
                unsolved.push(FrictionCell { cell, sliding, state: None, strain: f32::NAN });
            }
        }
    }
    let solved = wanted.into_iter().zip(states(&queries));
    let solved = solved.map(|((row, signed_push, cell), state)| {
        let values = |state| (state, side.values_with_friction(row, signed_push, &state));
        let state = state.map(values);
        FrictionCell {
            cell,
            sliding: state.as_ref().map(|(state, _)| state.sliding),
            state,
            strain: f32::NAN,
        }
    });
    unsolved.into_iter().chain(solved).collect()
}

/// Adds the largest bending strains of the states of `cells`.
fn add_strains(side: &WhiskerSide, cells: &mut [FrictionCell]) {
    let states = cells.iter().filter_map(|cell| Some(&cell.state.as_ref()?.0));
    let strains = side.peak_strains_with_friction(&states.collect::<Vec<_>>());
    let solved = cells.iter_mut().filter(|cell| cell.state.is_some());
    for (cell, strain) in solved.zip(strains) {
        cell.strain = strain;
    }
}

/// Writes a cell into the `panel`.
fn write(found: &FrictionCell, panel: &mut Panel) {
    let cell = found.cell;
    let status = match found.sliding {
        Some(Sliding::Tip) => Status::Solved,
        Some(Sliding::Base) => Status::TowardBase,
        Some(Sliding::Sticks) => Status::Sticking,
        None => Status::NoState,
    };
    panel.status[cell] = status.code();
    let Some((state, values)) = &found.state else {
        if status == Status::NoState {
            clear(cell, panel);
        }
        return;
    };
    panel.newton_steps[cell] += state.steps;
    panel.residual[cell] = state.residual as f32;
    for (channel, value) in panel.state.iter_mut().zip(values) {
        if let Some(number) = channel.get_mut(cell) {
            *number = *value as f32;
        }
    }
    if let Some(strain) = panel.peak_strain.get_mut(cell) {
        *strain = found.strain;
    }
}

/// Removes the state of a cell from the `panel`.
fn clear(cell: usize, panel: &mut Panel) {
    panel.residual[cell] = f32::NAN;
    for channel in panel.state.iter_mut().chain([&mut panel.peak_strain]) {
        if let Some(number) = channel.get_mut(cell) {
            *number = f32::NAN;
        }
    }
}

/// Marks a cell of the `panel` beyond the end of the push: the contact does not slide toward the tip there, as the end assumes.
fn mark_end(cell: usize, panel: &mut Panel) {
    let ended = [Regime::SlipOff, Regime::PullOff].map(Regime::code);
    if ended.contains(&panel.regime[cell]) {
        panel.status[cell] = Status::AssumedEnd.code();
    }
}
