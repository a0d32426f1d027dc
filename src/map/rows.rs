//! Conversion of the cells of a row batch to panels: regimes, statuses and values.

use super::friction::{self, FrictionRow};
use super::panel::RowMut;
use super::{Panel, doubt};
use crate::classify::{PushSpan, Regime, RowBoundary, TIE};
use crate::engine::{BatchRow, Cells, RowBatch, RowCells, SideColumns, WhiskerSide};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

/// Classifies the `cells` of a batch of whole rows and writes them into `panels`, which are `width` cells wide and begin with the row
/// `first_row` of their whiskers; each panel has `sides_per_panel` sides. Cells at first touch and in doubt are replaced. If `cancel` is
/// true, the function soon returns, and `panels` are incomplete.
pub fn fill(
    batch: &RowBatch,
    cells: &mut Cells,
    sides_per_panel: usize,
    [width, first_row]: [usize; 2],
    panels: &mut [Panel],
    cancel: &AtomicBool,
) {
    let mut rows: Vec<(&BatchRow, RowCells)> =
        batch.rows.iter().zip(cells.rows_mut(batch)).collect();
    let panel_of = |row: &BatchRow| row.side / sides_per_panel;
    let first_panel = batch.rows.first().map_or(0, panel_of);
    let by_panel: Vec<_> = rows.chunk_by_mut(|(a, _), (b, _)| panel_of(a) == panel_of(b)).collect();
    let panels = panels[first_panel..].par_iter_mut().zip(by_panel);
    panels.for_each(|(panel, rows)| {
        // The columns of two sides may be in one row of a panel.
        for rows in rows.chunk_by_mut(|(a, _), (b, _)| a.side == b.side) {
            let first = rows[0].0;
            let from = first.row - first_row;
            let into = panel.rows_mut(width, from..from + rows.len());
            let side = &batch.sides[first.side];
            let rows = into.into_par_iter().zip(rows);
            let rows = rows.filter(|_| !cancel.load(Ordering::Relaxed));
            let found = rows.map(|(into, (row, cells))| {
                let crossings = &side.sheet.crossings[row.row];
                let writer = RowWriter {
                    side,
                    row: row.row,
                    boundary: RowBoundary::new(side.sheet.touches(row.row), crossings),
                    cells,
                    into,
                    contacts: Vec::new(),
                    strained: Vec::new(),
                    doubtful: Vec::new(),
                };
                writer.write()
            });
            let found: Vec<FrictionRow> = found.flatten_iter().collect();
            friction::replace(side, &found, [width, first_row], panel, cancel);
        }
    });
}

/// Writes one row of one whisker side.
struct RowWriter<'a, 'c> {
    side: &'a WhiskerSide,
    row: usize,
    boundary: RowBoundary,
    /// Cells of the row: `[column]`, of the side.
    cells: &'a mut RowCells<'c>,
    into: RowMut<'a>,
    /// Columns of the side whose cells are in contact with friction and reached by a push from first touch.
    contacts: Vec<usize>,
    /// Columns of the side whose cells have a state; empty without the channel of strains.
    strained: Vec<usize>,
    /// Columns of the side whose cells may get a regime by continuation.
    doubtful: Vec<usize>,
}

impl RowWriter<'_, '_> {
    /// Writes the row; cells in doubt are solved once more. Returns the cells in contact if there is friction.
    fn write(mut self) -> Option<FrictionRow> {
        let (side, row) = (self.side, self.row);
        let pushes = &side.columns.pushes;
        let is_reached = side.sheet.rows[row].is_reached();
        let touches = pushes.iter().take_while(|push| **push == 0.0 && is_reached).count();
        for column in 0..touches {
            let touch = side.first_touch(row, self.cells.steps[column]);
            self.cells.set(column, &touch);
            self.write_run(column..column + 1);
        }
        let mut from = touches;
        while from < pushes.len() {
            let outcomes = &self.cells.outcome[from..];
            let equal = outcomes.iter().take_while(|other| **other == outcomes[0]);
            let to = from + equal.count();
            if self.boundary.is_one_verdict(pushes[from], pushes[to - 1]) {
                self.write_run(from..to);
            } else {
                (from..to).for_each(|column| self.write_run(column..column + 1));
            }
            from = to;
        }
        let doubtful = std::mem::take(&mut self.doubtful);
        if !doubtful.is_empty() {
            doubt::solve(side, row, &self.boundary, &doubtful, self.cells);
            for column in doubtful {
                self.contacts.retain(|other| *other != column);
                self.strained.retain(|other| *other != column);
                self.write_run(column..column + 1);
            }
            self.contacts.sort_unstable();
        }
        if !self.strained.is_empty() {
            let points = self.strained.iter().map(|column| self.cells.points[*column]);
            for (column, strain) in self.strained.iter().zip(side.peak_strains(points)) {
                let run = *column..column + 1;
                side.columns.write(self.into.peak_strain, &run, |_| strain);
            }
        }
        // Without a push from first touch there is no history.
        let end_push = self.boundary.detachment().map(PushSpan::to);
        let end_push = end_push.filter(|end| side.has_friction() && *end > TIE)?;
        Some(FrictionRow { row, end_push, contacts: self.contacts })
    }

    /// Writes a run of cells with one outcome and one verdict, given by the columns of the side. Keeps the cells in doubt and, with friction, the
    /// cells in contact.
    fn write_run(&mut self, run: Range<usize>) {
        let (columns, cells): (&SideColumns, &RowCells) = (&self.side.columns, self.cells);
        let pushes = &columns.pushes[run.clone()];
        let push = pushes[0];
        let span = self.boundary.span(push);
        let (regime, status) = self.boundary.classify(push, cells.outcome[run.start]);
        let (place, into) = (columns.in_map(&run), &mut self.into);
        let clear = |row: &mut [f32]| {
            if let Some(values) = row.get_mut(place.clone()) {
                values.fill(f32::NAN);
            }
        };
        into.regime[place.clone()].fill(regime.code());
        into.status[place.clone()].fill(status.code());
        let steps = &cells.steps[run.clone()];
        columns.write(into.newton_steps, &run, |i| steps[i]);
        let is_unresolved = regime == Regime::Unresolved;
        let span = span.filter(|_| matches!(regime, Regime::Contact | Regime::Unreachable));
        match span.is_some() || is_unresolved {
            true => {
                let residuals = &cells.residual[run.clone()];
                columns.write(into.residual, &run, |i| residuals[i]);
            }
            false => clear(into.residual),
        }
        match span {
            Some(span) => {
                let margin = |i: usize| span.margin_deg(pushes[i]);
                columns.write(into.margin_deg, &run, margin);
                let derivatives = self.side.push_derivatives.get(self.row);
                for (parameter, by) in derivatives.into_iter().flatten() {
                    // Only a push from first touch ends at the row's detachment.
                    let by = if regime == Regime::Contact { *by } else { f32::NAN };
                    columns.write(into.push_derivatives[*parameter as usize], &run, |_| by);
                }
                for (channel, values) in into.state.iter_mut().zip(&cells.values) {
                    let values = values.get(run.clone()).unwrap_or_default();
                    columns.write(channel, &run, |i| values[i]);
                }
                if !into.peak_strain.is_empty() {
                    self.strained.extend(run.clone());
                }
            }
            None => {
                clear(into.margin_deg);
                clear(into.peak_strain);
                let on_demand = into.state.iter_mut().chain(&mut into.push_derivatives);
                on_demand.for_each(|channel| clear(channel));
            }
        }
        // A run of several cells does not begin at first touch.
        let is_touch = push <= TIE && self.boundary.detachment().is_some();
        if is_unresolved || is_touch && regime != Regime::Contact {
            self.doubtful.extend(run.clone());
        }
        if self.side.has_friction() && regime == Regime::Contact {
            self.contacts.extend(run);
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::classify::Outcome;
    use crate::engine::Cpu;
    use crate::plan::Channels;
    use crate::scene::Scene;
    use crate::sheet::Sheet;
    use std::sync::Arc;
    use whiskmap_mechanics::rod::Side;
    use whiskmap_mechanics::shooting::batch::Method;

    /// Cells with a state beyond the end of their row contradict it, although they follow cells in contact.
    #[test]
    fn a_state_beyond_the_end_is_no_contact() {
        let scene = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml").unwrap();
        let (method, swept) = (Method::fine(), scene.first_whisker());
        let push_angle_deg: Vec<f64> = (1..60).map(f64::from).collect();
        let columns = SideColumns::new(&push_angle_deg, Side::Cb);
        let sheet = Sheet::new(method, &swept.rod(Side::Cb), Side::Cb, &[0.7]);
        let side = WhiskerSide::new(Arc::new(columns), swept.whisker.units(), sheet);
        let batch = RowBatch::new(method, [side].into(), [(0, 0)]);
        let regimes = |cells: &mut Cells| {
            let mut panel = Panel::unwritten(cells.len(), Channels::STANDARD);
            let size = [cells.len(), 0];
            let panels = std::slice::from_mut(&mut panel);
            fill(&batch, cells, 1, size, panels, &AtomicBool::new(false));
            panel.regime
        };
        let mut cells = Cpu::default().solve(&batch);
        let sound = regimes(&mut cells);
        let [first, last] = [sound[0], sound[sound.len() - 1]];
        assert_eq!([first, last], [Regime::Contact, Regime::SlipOff].map(Regime::code));
        cells.outcome.fill(Outcome::Solved);
        assert_eq!(regimes(&mut cells), sound);
    }
}
