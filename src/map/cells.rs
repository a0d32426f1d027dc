//! The cells of a few rows: guesses from the sheet, shots by the engine, refinement.

use super::{Face, Summary, summary::Stage};
use crate::classify::Status;
use crate::integrate::{Fallback, Hit, Outcome, Shot};
use crate::model::Side;
use crate::model::batch::Method;
use crate::refine::{self, End, Refined, State};
use crate::scene::Scene;
use crate::sheet::{Guess, Sheet};
use crate::store::Shots;
use rayon::prelude::*;

/// Rows of some faces, settled together.
pub struct Strip {
    /// `(face, row)`.
    rows: Vec<(usize, usize)>,
}

impl Strip {
    /// Every row of every face, in pieces of `rows_at_once`.
    pub fn all(faces: usize, rows: usize, rows_at_once: usize) -> impl Iterator<Item = Self> {
        let all: Vec<(usize, usize)> = (0..faces)
            .flat_map(|face| (0..rows).map(move |row| (face, row)))
            .collect();
        let pieces: Vec<Self> = all
            .chunks(rows_at_once)
            .map(|piece| Self {
                rows: piece.to_vec(),
            })
            .collect();
        pieces.into_iter()
    }
}

/// A settled cell.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    /// Index of the face.
    pub face: usize,
    /// Row of the panel.
    pub row: usize,
    /// Column of the panel.
    pub column: usize,
    /// How it was settled; the boundary has not been asked yet.
    pub status: Status,
    /// The last state computed.
    pub state: Option<State>,
    /// Newton steps, engine and refinement together.
    pub steps: u32,
}

/// Settles the cells of `strip`.
pub fn settle(
    scene: &Scene,
    method: Method,
    faces: &[Face],
    strip: &Strip,
    engine: &mut Fallback<'_>,
    summary: &mut Summary,
) -> Vec<Cell> {
    let mut cells: Vec<Cell> = Vec::new();
    let mut shots: Vec<Shot> = Vec::new();
    let mut targets: Vec<usize> = Vec::new();
    // Only faces with a sheet take part; `sheets[shot.rod]` is the sheet of a shot.
    let used: Vec<usize> = (0..faces.len())
        .filter(|&i| faces[i].sheet.is_some() && strip.rows.iter().any(|(face, _)| *face == i))
        .collect();
    let sheets: Vec<&Sheet> = used
        .iter()
        .filter_map(|&i| faces[i].sheet.as_ref())
        .collect();
    summary.time(Stage::Guesses, || {
        let guessed: Vec<Vec<(Cell, Option<Shot>)>> = strip
            .rows
            .par_iter()
            .map(|&(face, row)| {
                let rod = used.binary_search(&face).unwrap_or_default();
                guess_row(scene, &faces[face], face, row, rod)
            })
            .collect();
        for (cell, shot) in guessed.into_iter().flatten() {
            if let Some(shot) = shot {
                targets.push(cells.len());
                shots.push(shot);
            }
            cells.push(cell);
        }
    });
    let rods: Vec<_> = sheets.iter().map(|sheet| sheet.rod).collect();
    let hits = summary.time(Stage::Shooting, || {
        engine.shoot(method.effects, &rods, &shots)
    });
    count(&hits, engine.failure().is_some(), &mut summary.shots);
    let refined = summary.time(Stage::Refinement, || {
        // What an engine could not finish starts again from the lattice's guess.
        let starts: Vec<(f64, f64)> = hits
            .iter()
            .zip(&shots)
            .map(|(hit, shot)| match hit.outcome {
                Outcome::Converged => (hit.tau, hit.load),
                Outcome::Stalled | Outcome::NotFinite => (shot.tau, shot.load),
            })
            .collect();
        refine::refine(method, &sheets, &shots, &starts)
    });
    for ((&target, hit), refined) in targets.iter().zip(&hits).zip(refined) {
        let Refined { state, steps, end } = refined;
        let cell = &mut cells[target];
        cell.steps = hit.steps + steps;
        cell.state = Some(state);
        cell.status = match end {
            End::Solved => Status::Solved,
            End::BeyondTip => Status::BeyondTip,
            End::BeyondFold => Status::BeyondFold,
            End::NotConverged => Status::NotConverged,
        };
    }
    cells
}

/// Adds the shots of one call to what is known of those before.
fn count(hits: &[Hit], on_cpu_instead: bool, shots: &mut Shots) {
    let restarted = hits.iter().filter(|hit| hit.outcome != Outcome::Converged);
    shots.all += hits.len() as u64;
    shots.restarted += restarted.count() as u64;
    if on_cpu_instead {
        shots.on_cpu_instead += hits.len() as u64;
    }
}

/// The cells of one row of one face, with the shots of those that may have a state.
fn guess_row(
    scene: &Scene,
    face: &Face,
    index: usize,
    row: usize,
    rod: usize,
) -> Vec<(Cell, Option<Shot>)> {
    let pushes = &scene.grid.push_angle_deg;
    let mut columns: Vec<usize> = (0..pushes.len())
        .filter(|&column| Side::of_push(pushes[column]) == face.side)
        .collect();
    if face.side == Side::Cf {
        columns.reverse();
    }
    let magnitude = |column: usize| pushes[column].abs().to_radians();
    let guesses = match &face.sheet {
        Some(sheet) => sheet.guesses(row, columns.iter().map(|&column| magnitude(column))),
        None => vec![None; columns.len()],
    };
    let status = if face.sheet.is_some() {
        Status::Outside
    } else {
        Status::NoFold
    };
    columns
        .into_iter()
        .zip(guesses)
        .map(|(column, guess)| {
            let cell = Cell {
                face: index,
                row,
                column,
                status,
                state: None,
                steps: 0,
            };
            let shot = guess
                .zip(face.sheet.as_ref())
                .map(|(Guess { tau, load }, sheet)| Shot {
                    #[allow(clippy::cast_possible_truncation, reason = "panels at once are few")]
                    rod: rod as u32,
                    tau,
                    load,
                    pole: sheet.rows[row].pole(face.side.sign() * magnitude(column)),
                });
            (cell, shot)
        })
        .collect()
}
