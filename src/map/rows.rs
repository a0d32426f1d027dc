//! Conversion of the cells of a row batch to panels: regimes, statuses and values.

use super::friction::{self, FrictionRow};
use super::panel::RowMut;
use super::{Panel, doubt};
use crate::classify::{Regime, RowBoundary, TIE};
use crate::engine::{Cell, CellRun, Cells, RowBatch, SideColumns, WhiskerSide};
use glam::DVec2;
use rayon::prelude::*;

/// Classifies the `cells` of a batch of whole rows and writes them into `panels`, which are `width` cells wide and begin with the row
/// `first_row` of their whiskers; each panel has `sides_per_panel` sides.
pub fn fill(
    batch: &RowBatch,
    cells: &Cells,
    sides_per_panel: usize,
    [width, first_row]: [usize; 2],
    panels: &mut [Panel],
) {
    let panels = panels.par_iter_mut().enumerate();
    panels.for_each(|(index, panel)| {
        // The columns of two sides may be in one row of a panel.
        for side in index * sides_per_panel..(index + 1) * sides_per_panel {
            let [from, to] =
                [side, side + 1].map(|side| batch.rows.partition_point(|row| row.side < side));
            let rows = &batch.rows[from..to];
            let Some(first) = rows.first() else { continue };
            let from = first.row - first_row;
            let into = panel.rows_mut(width, from..from + rows.len());
            let side = &batch.sides[side];
            let found = into.into_par_iter().zip(rows).map(|(into, row)| {
                let crossings = &side.sheet.crossings[row.row];
                let writer = RowWriter {
                    side,
                    row: row.row,
                    boundary: RowBoundary::new(side.sheet.touches(row.row), crossings),
                    into,
                    contacts: Vec::new(),
                    points: Vec::new(),
                    doubtful: Vec::new(),
                };
                writer.write(cells, row.first_cell)
            });
            let found: Vec<FrictionRow> = found.flatten_iter().collect();
            friction::replace(side, &found, [width, first_row], panel);
        }
    });
}

/// Writes one row of one whisker side.
struct RowWriter<'a> {
    side: &'a WhiskerSide,
    row: usize,
    boundary: RowBoundary,
    into: RowMut<'a>,
    /// Columns of the side whose cells are in contact with friction and reached by a push from first touch.
    contacts: Vec<usize>,
    /// Contact and load `(tau, load)` of the cells with a state, with their columns of the side; empty without the channel of strains.
    points: Vec<(usize, DVec2)>,
    /// Cells whose regime may be found by continuation, with their columns of the side.
    doubtful: Vec<(usize, Cell)>,
}

impl RowWriter<'_> {
    /// Writes the row whose cells begin at `first`; cells in doubt are solved once more. Returns the cells in contact if there is friction.
    fn write(mut self, cells: &Cells, first: usize) -> Option<FrictionRow> {
        let (side, row) = (self.side, self.row);
        let pushes = &side.columns.pushes;
        let is_reached = side.sheet.rows[row].is_reached();
        let touches = pushes
            .iter()
            .take_while(|push| **push == 0.0 && is_reached)
            .count();
        for index in 0..touches {
            let touch = side.first_touch(row, cells.steps[first + index]);
            self.write_run(index, touch.run());
        }
        let outcomes = &cells.outcome[first + touches..first + pushes.len()];
        let mut from = touches;
        for run in outcomes.chunk_by(PartialEq::eq) {
            let to = from + run.len();
            let length = match self.boundary.is_one_verdict(pushes[from], pushes[to - 1]) {
                true => run.len(),
                false => 1,
            };
            for index in (from..to).step_by(length) {
                self.write_run(index, cells.run(first + index..first + index + length));
            }
            from = to;
        }
        let doubtful = std::mem::take(&mut self.doubtful);
        if !doubtful.is_empty() {
            for (index, cell) in doubt::solve(side, row, &self.boundary, doubtful) {
                self.contacts.retain(|other| *other != index);
                self.points.retain(|(other, _)| *other != index);
                self.write_run(index, cell.run());
            }
            self.contacts.sort_unstable();
        }
        if !self.points.is_empty() {
            let points = self.points.iter().map(|(_, point)| *point);
            let strains = side.peak_strains(points);
            for ((index, _), strain) in self.points.iter().zip(strains) {
                let column = *index..index + 1;
                side.columns
                    .write(self.into.peak_strain, &column, |_| strain);
            }
        }
        // Without a push from first touch there is no history.
        let end_push = self.boundary.detachment().map(|span| span.to);
        let end_push = end_push.filter(|end| side.has_friction() && *end > TIE)?;
        Some(FrictionRow {
            row,
            end_push,
            contacts: self.contacts,
        })
    }

    /// Writes a run of cells with one verdict. Its first cell is in the column `from` of the side. Keeps the cells in doubt and, with friction,
    /// the cells in contact.
    fn write_run(&mut self, from: usize, cells: CellRun) {
        let columns: &SideColumns = &self.side.columns;
        let run = from..from + cells.steps.len();
        let pushes = &columns.pushes[run.clone()];
        let push = pushes[0];
        let span = self.boundary.span(push);
        let (regime, status) = self.boundary.classify(push, cells.outcome);
        let (place, into) = (columns.in_map(&run), &mut self.into);
        let clear = |row: &mut [f32]| {
            if let Some(values) = row.get_mut(place.clone()) {
                values.fill(f32::NAN);
            }
        };
        into.regime[place.clone()].fill(regime.code());
        into.status[place.clone()].fill(status.code());
        columns.write(into.newton_steps, &run, |i| cells.steps[i]);
        let is_unresolved = regime == Regime::Unresolved;
        let span = span.filter(|_| matches!(regime, Regime::Contact | Regime::Unreachable));
        match span.is_some() || is_unresolved {
            true => columns.write(into.residual, &run, |i| cells.residual[i]),
            false => clear(into.residual),
        }
        match span {
            Some(span) => {
                let margin = |i: usize| span.margin_deg(pushes[i]);
                columns.write(into.margin_deg, &run, margin);
                let derivatives = self.side.push_derivatives.get(self.row);
                for (parameter, by) in derivatives.into_iter().flatten() {
                    // Only a push from first touch ends at the row's detachment.
                    let by = if regime == Regime::Contact {
                        *by
                    } else {
                        f32::NAN
                    };
                    columns.write(into.push_derivatives[*parameter as usize], &run, |_| by);
                }
                for (channel, values) in into.state.iter_mut().zip(cells.values) {
                    columns.write(channel, &run, |i| values[i]);
                }
                if !into.peak_strain.is_empty() {
                    let points = run.clone().zip(cells.points);
                    self.points
                        .extend(points.map(|(index, point)| (index, *point)));
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
            let cells = run.clone().map(|index| (index, cells.get(index - from)));
            self.doubtful.extend(cells);
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
        let regimes = |cells: &Cells| {
            let mut panel = Panel::unwritten(cells.len(), Channels::STANDARD);
            fill(
                &batch,
                cells,
                1,
                [cells.len(), 0],
                std::slice::from_mut(&mut panel),
            );
            panel.regime
        };
        let mut cells = Cpu::default().solve(&batch);
        let sound = regimes(&cells);
        let [first, last] = [sound[0], sound[sound.len() - 1]];
        assert_eq!(
            [first, last],
            [Regime::Contact, Regime::SlipOff].map(Regime::code)
        );
        cells.outcome.fill(Outcome::Solved);
        assert_eq!(regimes(&cells), sound);
    }
}
