//! From settled cells to the panel of a whisker, in the units of the map.

use super::{Face, cells::Cell, doubt};
use crate::classify::{Regime, RowBoundary, Status};
use crate::model::{Reader, Reading, Units};
use crate::scene::{Scene, Whisker};
use crate::sheet::Sheet;
use crate::store::{Panel, STATE_CHANNELS};
use rayon::prelude::*;

/// A panel without answers.
pub fn blank(scene: &Scene) -> Panel {
    let cells = scene.grid.push_angle_deg.len() * scene.grid.distance_mm.len();
    Panel {
        regime: vec![Regime::Unresolved.code(); cells],
        status: vec![Status::NotConverged.code(); cells],
        state: std::array::from_fn(|_| vec![f32::NAN; cells]),
        residual: vec![f32::NAN; cells],
        margin_deg: vec![f32::NAN; cells],
        newton_steps: vec![0; cells],
    }
}

/// Judges `cells` and writes them into `panels`; face `i` belongs to panel `i / faces_per_panel`.
pub fn fill(
    scene: &Scene,
    whiskers: &[Whisker],
    faces: &[Face],
    faces_per_panel: usize,
    cells: &[Cell],
    panels: &mut [Panel],
) {
    let width = scene.grid.push_angle_deg.len();
    let answers: Vec<Answer> = cells
        .par_chunk_by(|a, b| (a.face, a.row) == (b.face, b.row))
        .flat_map_iter(|row| {
            let face = &faces[row[0].face];
            let units = Units::new(&whiskers[row[0].face / faces_per_panel]);
            let reader = face.sheet.as_ref().map(|sheet| units.reader(&sheet.rod));
            let boundary = face.sheet.as_ref().map(|sheet| {
                RowBoundary::new(sheet.touches(row[0].row), &sheet.crossings[row[0].row])
            });
            let push = |cell: &Cell| scene.grid.push_angle_deg[cell.column];
            let answer = |cell: &Cell| {
                let sheet = face.sheet.as_ref();
                answer(cell, push(cell), sheet, boundary.as_ref(), reader.as_ref())
            };
            let mut answers: Vec<Answer> = row.iter().map(answer).collect();
            let in_doubt = |answer: &Answer| answer.regime == Regime::Unresolved;
            if let (Some(sheet), Some(boundary)) = (&face.sheet, &boundary)
                && answers.iter().any(in_doubt)
            {
                let mut again = row.to_vec();
                let doubtful = again.iter_mut().zip(&answers);
                let doubtful = doubtful.filter(|(_, answer)| in_doubt(answer));
                let doubtful = doubtful.map(|(cell, _)| {
                    let push = push(cell).to_radians();
                    (cell, push)
                });
                doubt::settle(sheet, row[0].row, boundary, doubtful);
                answers = again.iter().map(answer).collect();
            }
            answers
        })
        .collect();
    for (cell, answer) in cells.iter().zip(&answers) {
        let panel = &mut panels[cell.face / faces_per_panel];
        let at = cell.row * width + cell.column;
        panel.regime[at] = answer.regime.code();
        panel.status[at] = answer.status.code();
        panel.newton_steps[at] = cell.steps;
        panel.residual[at] = answer.residual;
        panel.margin_deg[at] = answer.margin_deg;
        for (channel, value) in panel.state.iter_mut().zip(answer.state) {
            channel[at] = value;
        }
    }
}

/// What a panel holds of one cell.
struct Answer {
    regime: Regime,
    status: Status,
    state: [f32; STATE_CHANNELS.len()],
    residual: f32,
    margin_deg: f32,
}

fn answer(
    cell: &Cell,
    push_deg: f64,
    sheet: Option<&Sheet>,
    boundary: Option<&RowBoundary>,
    reader: Option<&Reader>,
) -> Answer {
    let push = push_deg.to_radians();
    let at_tip = sheet
        .zip(cell.state)
        .is_some_and(|(sheet, state)| state.is_at_tip(sheet));
    let (regime, status) = match boundary {
        // At the tip both verdicts are right; the boundary's is taken.
        Some(boundary)
            if at_tip && cell.status == Status::Solved && boundary.span(push.abs()).is_none() =>
        {
            boundary.judge(push.abs(), Status::BeyondTip)
        }
        Some(boundary) => boundary.judge(push.abs(), cell.status),
        None => (Regime::Unresolved, Status::NoFold),
    };
    let mut answer = Answer {
        regime,
        status,
        state: [f32::NAN; STATE_CHANNELS.len()],
        residual: f32::NAN,
        margin_deg: f32::NAN,
    };
    if let (Regime::Unresolved, Some(state)) = (regime, &cell.state) {
        answer.residual = narrow(state.residual);
    }
    let in_contact = matches!(regime, Regime::Contact | Regime::Unreachable);
    if let (true, Some(sheet), Some(reader), Some(state)) = (in_contact, sheet, reader, &cell.state)
    {
        let touch = sheet.rows[cell.row].touch;
        answer.state = channels(&reader.read(state.tau, &state.full, touch, push)).map(narrow);
        answer.residual = narrow(state.residual);
        let span = boundary.and_then(|boundary| boundary.span(push.abs()));
        answer.margin_deg = span.map_or(f32::NAN, |span| {
            narrow((span.to - push.abs()).max(0.0).to_degrees())
        });
    }
    answer
}

#[allow(clippy::cast_possible_truncation, reason = "maps are stored in f32")]
fn narrow(x: f64) -> f32 {
    x as f32
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
