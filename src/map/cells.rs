//! The cells of a few rows: guesses from the sheet, shots by the engine, refinement.

use super::{Face, Summary, summary::Stage};
use crate::classify::Status;
use crate::integrate::{Fallback, Hit, Outcome, Shot};
use crate::model::Side;
use crate::model::batch::Method;
use crate::refine::{self, End, Refined, State};
use crate::scene::Scene;
use crate::sheet::{Guess, Sheet};
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
    let mut places: Vec<Place> = Vec::new();
    let mut shots: Vec<Shot> = Vec::new();
    // Only faces with a sheet take part; `sheets[shot.rod]` is the sheet of a shot.
    let used: Vec<usize> = (0..faces.len())
        .filter(|&i| faces[i].sheet.is_some() && strip.rows.iter().any(|(face, _)| *face == i))
        .collect();
    let sheets: Vec<&Sheet> = used
        .iter()
        .filter_map(|&i| faces[i].sheet.as_ref())
        .collect();
    summary.time(Stage::Guesses, || {
        let guessed: Vec<Vec<(Place, Option<Shot>)>> = strip
            .rows
            .par_iter()
            .map(|&(face, row)| {
                let rod = used.binary_search(&face).unwrap_or_default();
                guess_row(scene, &faces[face], face, row, rod)
            })
            .collect();
        for (place, shot) in guessed.into_iter().flatten() {
            let index = shot.is_some().then_some(shots.len());
            shots.extend(shot);
            places.push(Place {
                shot: index,
                ..place
            });
        }
    });
    let rods: Vec<_> = sheets.iter().map(|sheet| sheet.rod).collect();
    let hits = summary.time(Stage::Shooting, || {
        engine.shoot(method.effects, &rods, &shots)
    });
    let hits = hits.as_deref();
    summary.shots.all += shots.len() as u64;
    if engine.failure().is_some() {
        summary.shots.on_cpu_instead += shots.len() as u64;
    }
    let refined = summary.time(Stage::Refinement, || {
        // What an engine could not finish starts again from the lattice's guess.
        let hit = |i: usize| hits.map(|hits| hits[i]);
        let found = |i: usize| hit(i).filter(|hit| hit.outcome == Outcome::Converged);
        let start = |(i, shot): (usize, &Shot)| {
            found(i).map_or((shot.tau, shot.load), |hit| (hit.tau, hit.load))
        };
        let starts: Vec<(f64, f64)> = shots.iter().enumerate().map(start).collect();
        refine::refine(method, &sheets, &shots, &starts)
    });
    let unfinished = |hit: &&Hit| hit.outcome != Outcome::Converged;
    summary.shots.restarted += hits.unwrap_or_default().iter().filter(unfinished).count() as u64;
    let settled = |place: &Place| match place.shot {
        Some(i) => place.settled(hits.map_or(0, |hits| hits[i].steps), &refined[i]),
        None => place.without_state(),
    };
    places.par_iter().map(settled).collect()
}

/// A cell that is not settled yet, and which shot is for it.
#[derive(Clone, Copy)]
struct Place {
    face: usize,
    row: usize,
    column: usize,
    /// How the cell is settled if there is no shot for it.
    status: Status,
    shot: Option<usize>,
}

impl Place {
    fn without_state(&self) -> Cell {
        Cell {
            face: self.face,
            row: self.row,
            column: self.column,
            status: self.status,
            state: None,
            steps: 0,
        }
    }

    /// After `steps` of an engine.
    fn settled(&self, steps: u32, refined: &Refined) -> Cell {
        Cell {
            status: match refined.end {
                End::Solved => Status::Solved,
                End::BeyondTip => Status::BeyondTip,
                End::BeyondFold => Status::BeyondFold,
                End::NotConverged => Status::NotConverged,
            },
            state: Some(refined.state),
            steps: steps + refined.steps,
            ..self.without_state()
        }
    }
}

/// The cells of one row of one face, with the shots of those that may have a state.
fn guess_row(
    scene: &Scene,
    face: &Face,
    index: usize,
    row: usize,
    rod: usize,
) -> Vec<(Place, Option<Shot>)> {
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
            let place = Place {
                face: index,
                row,
                column,
                status,
                shot: None,
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
            (place, shot)
        })
        .collect()
}
