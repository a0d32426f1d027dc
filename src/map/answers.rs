//! From settled cells to the answers of a panel, in the units of the map.

use super::answer::{Answer, Readings, answer};
use super::cells::{Cell, Settled, SettledRow};
use super::channels::number;
use super::panel::RowMut;
use super::runs::{Run, Source};
use super::sliding::{self, FoundRow, FoundState};
use super::{Panel, WhiskerSide, doubt};
use crate::classify::{Regime, RowBoundary, Status};
use crate::scene::Swept;
use crate::shooting::Reader;
use rayon::prelude::*;

/// Judges the cells of `settled` and writes them into `panels`; face `i` belongs to panel `i / faces_per_panel`.
pub fn fill(
    width: usize,
    whiskers: &[Swept],
    faces: &[WhiskerSide],
    faces_per_panel: usize,
    settled: &Settled,
    panels: &mut [Panel],
) {
    let has_state = panels
        .iter()
        .any(|panel| panel.state.iter().any(|channel| !channel.is_empty()));
    panels
        .par_iter_mut()
        .enumerate()
        .for_each(|(index, panel)| {
            let units = whiskers[index].whisker.units();
            let faces_here = index * faces_per_panel..(index + 1) * faces_per_panel;
            // The columns of two faces may be in one row of a panel.
            for number in faces_here {
                let [from, to] = [number, number + 1]
                    .map(|face| settled.rows.partition_point(|row| row.face < face));
                let rows = &settled.rows[from..to];
                let Some(first) = rows.first() else { continue };
                let face = &faces[number];
                let into = panel.rows_mut(width, first.row..first.row + rows.len());
                let found = into.into_par_iter().zip(rows).map(|(into, row)| {
                    let reader = Reader::new(units, &face.sheet.rod);
                    let readings = has_state.then(|| Readings::new(reader, face, row.row));
                    let sheet = &face.sheet;
                    let crossings = &sheet.crossings[row.row];
                    let boundary = RowBoundary::new(sheet.touches(row.row), crossings);
                    let answers = RowAnswers {
                        settled,
                        face,
                        row,
                        boundary,
                        readings,
                        into,
                    };
                    answers.write()
                });
                let found: Vec<FoundRow> = found.flatten_iter().collect();
                sliding::mark(face, &found, width, &mut panel.status);
            }
        });
}

/// The answers of a row.
struct RowAnswers<'a> {
    settled: &'a Settled,
    face: &'a WhiskerSide<'a>,
    row: &'a SettledRow,
    boundary: RowBoundary,
    /// None where no channel of a state is wanted.
    readings: Option<Readings<'a>>,
    into: RowMut<'a>,
}

impl<'a> RowAnswers<'a> {
    /// Writes them; cells in doubt are settled once more. The states found are returned if there is friction, which may have dragged
    /// their contacts elsewhere.
    fn write(mut self) -> Option<FoundRow> {
        let (settled, face, row) = (self.settled, self.face, self.row);
        let mut states: Vec<FoundState> = Vec::new();
        let mut doubtful = Vec::new();
        // A cell that were forgotten would say so.
        let nothing = Answer::new(Regime::Unresolved, Status::NotConverged, 0);
        let columns = face.pushes.span(0..face.pushes.columns.len());
        self.into.fill_codes(columns, &nothing);
        for run in &row.runs {
            if self.write_alike(run).is_some() {
                continue;
            }
            for (index, cell) in run.cells.clone().zip(settled.cells(face, row.row, run)) {
                let answer = self.write_cell(&cell);
                states.extend(self.found(&cell, &answer));
                if self.is_in_doubt(&cell, &answer) {
                    doubtful.push(index);
                }
            }
        }
        if !doubtful.is_empty() {
            let runs = row.runs.iter();
            let cells = runs.flat_map(|run| settled.cells(face, row.row, run));
            let mut again: Vec<Cell> = cells.collect();
            let cells = again.iter_mut().enumerate();
            let cells = cells.filter(|(index, _)| doubtful.binary_search(index).is_ok());
            let cells = cells.map(|(_, cell)| cell);
            doubt::settle(&face.sheet, row.row, &self.boundary, cells);
            states.clear();
            for cell in &again {
                let answer = self.write_cell(cell);
                states.extend(self.found(cell, &answer));
            }
        }
        let row = row.row;
        (!states.is_empty()).then_some(FoundRow { row, states })
    }

    fn write_cell(&mut self, cell: &Cell<'a>) -> Answer {
        let readings = self.readings.as_mut();
        let answer = answer(cell, &self.face.sheet, &self.boundary, readings);
        self.into.write(cell.push.column, &answer);
        answer
    }

    /// Writes the answers of a `run` at once if they differ in nothing but numbers; otherwise, none.
    fn write_alike(&mut self, run: &Run) -> Option<()> {
        let all = self.face.pushes;
        let cells = run.cells.clone();
        let pushes = &all.columns[cells.clone()];
        let [from, to] = [pushes.first()?, pushes.last()?].map(|push| push.angle.abs());
        if !self.boundary.is_one_verdict(from, to) {
            return None;
        }
        let (status, steps) = match run.source {
            Source::Outside => (Status::Outside, 0),
            Source::Engine(..) if !self.has_friction() => (Status::Solved, 1),
            _ => return None,
        };
        let (regime, status) = self.boundary.judge(from, status);
        if regime == Regime::Unresolved {
            return None;
        }
        let answer = Answer::new(regime, status, steps);
        let columns = all.span(cells.clone());
        if let Source::Engine(reference, first) = run.source {
            self.into.fill_codes(columns, &answer);
            let span = self.boundary.span(from)?;
            let reference = &self.settled.question.references[reference as usize];
            let differences = &self.settled.differences[first as usize..][..pushes.len()];
            let into = &mut self.into;
            all.write(into.residual, &cells, |i| differences[i].residual);
            let margin = |i: usize| span.margin_deg(pushes[i].angle.abs());
            all.write(into.margin_deg, &cells, margin);
            let readings = self
                .readings
                .as_mut()
                .map(|all| all.of_reference(reference));
            if let Some([known, of_one]) = readings {
                for (i, channel) in into.state.iter_mut().enumerate() {
                    let (known, of_one) = (known[i], of_one[i]);
                    let value = |cell: usize| number(i, known, of_one, &differences[cell]) as f32;
                    all.write(channel, &cells, value);
                }
            }
        } else {
            self.into.fill(columns, &answer);
        }
        Some(())
    }

    fn has_friction(&self) -> bool {
        self.face.sheet.rod.friction != 0.0
    }

    fn is_in_doubt(&self, cell: &Cell, answer: &Answer) -> bool {
        let is_touch = cell.is_first_touch(&self.boundary);
        answer.regime == Regime::Unresolved || is_touch && answer.regime != Regime::Contact
    }

    /// The state of a cell, if there is one and friction may have dragged its contact elsewhere.
    fn found(&self, cell: &Cell, answer: &Answer) -> Option<FoundState> {
        let is_found = self.has_friction() && answer.status == Status::Solved;
        let point = answer.point.filter(|_| is_found)?;
        Some(FoundState {
            column: cell.push.column,
            regime: answer.regime,
            point,
            push: cell.push.angle.abs(),
        })
    }
}
