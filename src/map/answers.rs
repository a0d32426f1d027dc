//! From settled cells to the answers of a panel, in the units of the map.

use super::cells::{Cell, Settled};
use super::{Face, Panel, STATE_CHANNELS, doubt};
use crate::classify::{Regime, RowBoundary, Sliding, Status};
use crate::scene::Swept;
use crate::sheet::Sheet;
use crate::shooting::{Reader, Reading};
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
    let answers: Vec<Vec<Answer>> = settled
        .rows
        .par_iter()
        .map(|row| {
            let face = &faces[row.face];
            let units = whiskers[row.face / faces_per_panel].whisker.units();
            let reader = Reader::new(units, &face.sheet.rod);
            let reader = has_state.then_some(&reader);
            let mut answers = answers(reader, face, row.row, || settled.cells(face, row));
            mark_toward_base(face, row.row, &mut answers);
            answers
        })
        .collect();
    for (row, answers) in settled.rows.iter().zip(&answers) {
        let panel = &mut panels[row.face / faces_per_panel];
        for (push, answer) in faces[row.face].pushes.columns.iter().zip(answers) {
            let at = row.row * width + push.column;
            panel.regime[at] = answer.regime.code();
            panel.status[at] = answer.status.code();
            panel.newton_steps[at] = answer.steps;
            panel.residual[at] = answer.residual;
            panel.margin_deg[at] = answer.margin_deg;
            for (channel, value) in panel.state.iter_mut().zip(answer.state) {
                if let Some(cell) = channel.get_mut(at) {
                    *cell = value;
                }
            }
        }
    }
}

/// The answers for the `cells` of `row`, with states if there is a `reader` of them, which are settled once more where they are in doubt.
fn answers<C: Iterator<Item = Cell>>(
    reader: Option<&Reader>,
    face: &Face,
    row: usize,
    cells: impl Fn() -> C,
) -> Vec<Answer> {
    let sheet = &face.sheet;
    let boundary = RowBoundary::new(sheet.touches(row), &sheet.crossings[row]);
    let answer = |cell: &Cell| answer(cell, sheet, row, &boundary, reader);
    let answers: Vec<Answer> = cells().map(|cell| answer(&cell)).collect();
    let in_doubt = |(cell, answer): (Cell, &Answer)| {
        let is_touch = cell.is_first_touch(&boundary);
        answer.regime == Regime::Unresolved || is_touch && answer.regime != Regime::Contact
    };
    if !cells().zip(&answers).any(in_doubt) {
        return answers;
    }
    let mut again: Vec<Cell> = cells().collect();
    let doubtful = again.iter_mut().zip(&answers);
    let doubtful = doubtful.filter(|(cell, answer)| in_doubt((**cell, answer)));
    doubt::settle(sheet, row, &boundary, doubtful.map(|(cell, _)| cell));
    again.iter().map(answer).collect()
}

/// Tells those of the states found for `row` whose contact slides toward the base, against the friction assumed.
fn mark_toward_base(face: &Face, row: usize, answers: &mut [Answer]) {
    let sheet = &face.sheet;
    if sheet.rod.friction == 0.0 {
        return;
    }
    let solved = answers
        .iter_mut()
        .filter(|answer| answer.status == Status::Solved);
    let (mut solved, points): (Vec<_>, Vec<_>) = solved
        .filter_map(|answer| answer.point.map(|point| (answer, point)))
        .unzip();
    let sliding = Sliding::at(sheet.level(row).method, &sheet.rod, &points);
    for (answer, sliding) in solved.iter_mut().zip(sliding) {
        if sliding == Some(Sliding::Base) {
            answer.status = Status::TowardBase;
        }
    }
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

fn answer(
    cell: &Cell,
    sheet: &Sheet,
    row: usize,
    boundary: &RowBoundary,
    reader: Option<&Reader>,
) -> Answer {
    let push = cell.push.angle;
    let span = boundary.span(push.abs());
    let at_tip = cell.state.is_some_and(|state| state.is_at_tip(sheet));
    // At the tip both verdicts are right; the boundary's is taken.
    let status = if at_tip && cell.status == Status::Solved && span.is_none() {
        Status::BeyondTip
    } else {
        cell.status
    };
    let (regime, status) = boundary.judge(push.abs(), status);
    let mut answer = Answer::new(regime, status, cell.steps);
    let Some(state) = &cell.state else {
        return answer;
    };
    if matches!(regime, Regime::Contact | Regime::Unreachable) {
        answer.point = Some(DVec2::new(state.tau, state.load));
        let touch = sheet.rows[row].touch;
        if let Some(reader) = reader {
            let reading = reader.read(state.tau, &state.full, touch, push);
            answer.state = channels(&reading).map(|value| value as f32);
        }
        answer.residual = state.residual as f32;
        answer.margin_deg = span.map_or(f32::NAN, |span| {
            (span.to - push.abs()).max(0.0).to_degrees() as f32
        });
    } else if regime == Regime::Unresolved {
        answer.residual = state.residual as f32;
    }
    answer
}

/// The channels of [`STATE_CHANNELS`].
fn channels(reading: &Reading) -> [f64; STATE_CHANNELS.len()] {
    [
        reading.arc_length_mm,
        reading.contact_angle_deg,
        reading.force_un,
        reading.base_force_un.x,
        reading.base_force_un.y,
        reading.base_moment_nnm,
        reading.push_chord_deg,
        reading.contact_distance_mm,
        reading.energy_nj,
    ]
}
