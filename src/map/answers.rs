//! From settled cells to the answers of a panel, in the units of the map.

use super::cells::{Cell, Settled, State};
use super::channels::{Numbers, channels, of_cell, of_reference};
use super::panel::RowMut;
use super::sliding::{self, FoundRow, FoundState};
use super::{Face, Panel, STATE_CHANNELS, doubt};
use crate::account::carried;
use crate::classify::{Regime, RowBoundary, Status};
use crate::integrate::Reference;
use crate::scene::Swept;
use crate::sheet::Sheet;
use crate::shooting::Reader;
use glam::DVec2;
use rayon::prelude::*;

/// Judges the cells of `settled` and writes them into `panels`; face `i` belongs to panel `i / faces_per_panel`.
pub fn fill(
    width: usize,
    whiskers: &[Swept],
    faces: &[Face],
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
        .for_each_init(carried(), |_, (index, panel)| {
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
                let found = into
                    .into_par_iter()
                    .zip(rows)
                    .map_init(carried(), |_, (into, row)| {
                        let reader = Reader::new(units, &face.sheet.rod);
                        let readings = has_state.then(|| Readings::new(reader, face, row.row));
                        write_row(readings, face, row.row, || settled.cells(face, row), into)
                    });
                let found: Vec<FoundRow> = found.flatten_iter().collect();
                sliding::mark(face, &found, width, &mut panel.status);
            }
        });
}

/// What turns the states of a row into numbers of the map.
struct Readings<'a> {
    reader: Reader,
    /// What a difference of one is.
    of_one: Numbers,
    touch: f64,
    /// The reference that was read last.
    reference: Option<(&'a Reference, Numbers)>,
}

impl<'a> Readings<'a> {
    fn new(reader: Reader, face: &Face, row: usize) -> Self {
        Self {
            of_one: channels(&reader.of_one(face.sheet.side.sign())),
            touch: face.sheet.rows[row].touch,
            reader,
            reference: None,
        }
    }

    /// The channels of a cell in contact.
    fn read(&mut self, cell: &Cell<'a>) -> Option<Numbers> {
        match cell.state {
            State::Unknown => None,
            State::Refined(state) => {
                let reading = self
                    .reader
                    .read(state.tau, &state.full, self.touch, cell.push.angle);
                Some(channels(&reading))
            }
            State::Different(reference, difference) => {
                let known = self
                    .reference
                    .filter(|(known, _)| std::ptr::eq(*known, reference));
                let (_, numbers) = known.unwrap_or_else(|| {
                    (reference, of_reference(&self.reader, reference, self.touch))
                });
                self.reference = Some((reference, numbers));
                Some(of_cell(&numbers, &self.of_one, difference))
            }
        }
    }
}

/// Writes the answers for the `cells` of `row`, with states if there are `readings` of them; cells in doubt are settled once more. The
/// states found are returned if there is friction, which may have dragged their contacts elsewhere.
fn write_row<'a, C: Iterator<Item = Cell<'a>>>(
    mut readings: Option<Readings<'a>>,
    face: &Face,
    row: usize,
    cells: impl Fn() -> C,
    mut into: RowMut,
) -> Option<FoundRow> {
    let sheet = &face.sheet;
    let boundary = RowBoundary::new(sheet.touches(row), &sheet.crossings[row]);
    let mut write = |cell: &Cell<'a>| {
        let answer = answer(cell, sheet, &boundary, readings.as_mut());
        answer.write(&mut into, cell.push.column);
        answer
    };
    let in_doubt = |cell: &Cell, answer: &Answer| {
        let is_touch = cell.is_first_touch(&boundary);
        answer.regime == Regime::Unresolved || is_touch && answer.regime != Regime::Contact
    };
    let has_friction = sheet.rod.friction != 0.0;
    let state = |cell: &Cell, answer: &Answer| {
        let is_found = has_friction && answer.status == Status::Solved;
        let point = answer.point.filter(|_| is_found)?;
        Some(FoundState {
            column: cell.push.column,
            regime: answer.regime,
            point,
            push: cell.push.angle.abs(),
        })
    };
    let mut states: Vec<FoundState> = Vec::new();
    let mut doubtful = Vec::new();
    for (index, cell) in cells().enumerate() {
        let answer = write(&cell);
        states.extend(state(&cell, &answer));
        if in_doubt(&cell, &answer) {
            doubtful.push(index);
        }
    }
    if !doubtful.is_empty() {
        let mut again: Vec<Cell> = cells().collect();
        let cells = again.iter_mut().enumerate();
        let cells = cells.filter(|(index, _)| doubtful.binary_search(index).is_ok());
        doubt::settle(sheet, row, &boundary, cells.map(|(_, cell)| cell));
        let again = again.iter();
        states = again.filter_map(|cell| state(cell, &write(cell))).collect();
    }
    let found = FoundRow { row, states };
    (!found.states.is_empty()).then_some(found)
}

/// What a panel holds of one cell, and where on the sheet its state is.
struct Answer {
    regime: Regime,
    status: Status,
    /// `(tau, load)`.
    point: Option<DVec2>,
    state: [f32; STATE_CHANNELS.len()],
    residual: f32,
    margin_deg: f32,
    steps: u32,
}

impl Answer {
    /// Into a column of a row of a panel.
    fn write(&self, row: &mut RowMut, column: usize) {
        row.regime[column] = self.regime.code();
        row.status[column] = self.status.code();
        row.newton_steps[column] = self.steps;
        row.residual[column] = self.residual;
        row.margin_deg[column] = self.margin_deg;
        for (channel, value) in row.state.iter_mut().zip(self.state) {
            if let Some(cell) = channel.get_mut(column) {
                *cell = value;
            }
        }
    }

    /// Without a state.
    const fn new(regime: Regime, status: Status, steps: u32) -> Self {
        Self {
            regime,
            status,
            point: None,
            state: [f32::NAN; STATE_CHANNELS.len()],
            residual: f32::NAN,
            margin_deg: f32::NAN,
            steps,
        }
    }
}

fn answer<'a>(
    cell: &Cell<'a>,
    sheet: &Sheet,
    boundary: &RowBoundary,
    readings: Option<&mut Readings<'a>>,
) -> Answer {
    let push = cell.push.angle;
    let span = boundary.span(push.abs());
    // At the tip both verdicts are right; the boundary's is taken.
    let status = match cell.state {
        State::Refined(state)
            if cell.status == Status::Solved && span.is_none() && state.is_at_tip(sheet) =>
        {
            Status::BeyondTip
        }
        _ => cell.status,
    };
    let (regime, status) = boundary.judge(push.abs(), status);
    let mut answer = Answer::new(regime, status, cell.steps);
    let residual = match cell.state {
        State::Unknown => return answer,
        State::Refined(state) => {
            answer.point = Some(DVec2::new(state.tau, state.load));
            state.residual as f32
        }
        State::Different(reference, difference) => {
            let rod = &sheet.rod;
            let point = || DVec2::from(difference.point(rod, reference));
            // Only friction asks for it.
            answer.point = (rod.friction != 0.0).then(point);
            difference.residual
        }
    };
    if matches!(regime, Regime::Contact | Regime::Unreachable) {
        if let Some(numbers) = readings.and_then(|readings| readings.read(cell)) {
            answer.state = numbers.map(|value| value as f32);
        }
        answer.residual = residual;
        answer.margin_deg = span.map_or(f32::NAN, |span| {
            (span.to - push.abs()).max(0.0).to_degrees() as f32
        });
    } else if regime == Regime::Unresolved {
        answer.residual = residual;
    }
    answer
}
