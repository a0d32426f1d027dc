//! The cells of a few rows: guesses from the sheet, shots by the engine, refinement.

use super::{Face, Summary, pushes::Push, summary::Stage};
use crate::classify::Status;
use crate::integrate::{Fallback, Hit, Outcome, Shot};
use crate::refine::{self, End, Refined, State};
use crate::sheet::{Guess, Sheet};
use crate::shooting::batch::Method;
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

/// The rows of a strip, settled.
pub struct Settled {
    /// The rows.
    pub rows: Vec<Row>,
    /// Steps of the engine, shot by shot, if it took some.
    hits: Option<Vec<Hit>>,
    /// What became of the shots.
    refined: Vec<Refined>,
}

/// A settled row of a face.
pub struct Row {
    /// Index of the face.
    pub face: usize,
    /// Row of the panel.
    pub row: usize,
    /// Which of its cells have a shot, by growing push angle.
    is_shot: Vec<bool>,
    /// Shots of the rows before.
    shots_before: usize,
}

/// A settled cell.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    /// Where it is.
    pub push: Push,
    /// How it was settled; the boundary has not been asked yet.
    pub status: Status,
    /// The last state computed.
    pub state: Option<State>,
    /// Newton steps, engine and refinement together.
    pub steps: u32,
}

impl Settled {
    /// The cells of `row`, which is one of `face`.
    pub fn cells<'a>(&'a self, face: &'a Face, row: &'a Row) -> impl Iterator<Item = Cell> + 'a {
        let mut shot = row.shots_before;
        let without_state = if face.sheet.is_some() {
            Status::Outside
        } else {
            Status::NoFold
        };
        let cells = face.pushes.columns.iter().zip(&row.is_shot);
        cells.map(move |(push, is_shot)| {
            if !is_shot {
                return Cell {
                    push: *push,
                    status: without_state,
                    state: None,
                    steps: 0,
                };
            }
            let refined = &self.refined[shot];
            let engine = self.hits.as_ref().map_or(0, |hits| hits[shot].steps);
            shot += 1;
            Cell {
                push: *push,
                status: match refined.end {
                    End::Solved => Status::Solved,
                    End::BeyondTip => Status::BeyondTip,
                    End::BeyondFold => Status::BeyondFold,
                    End::NotConverged => Status::NotConverged,
                },
                state: Some(refined.state),
                steps: engine + refined.steps,
            }
        })
    }
}

/// Settles the cells of `strip`.
pub fn settle(
    method: Method,
    faces: &[Face],
    strip: &Strip,
    engine: &mut Fallback<'_>,
    summary: &mut Summary,
) -> Settled {
    // Only faces with a sheet take part; `sheets[shot.rod]` is the sheet of a shot.
    let used: Vec<usize> = (0..faces.len())
        .filter(|&i| faces[i].sheet.is_some() && strip.rows.iter().any(|(face, _)| *face == i))
        .collect();
    let sheets: Vec<&Sheet> = used
        .iter()
        .filter_map(|&i| faces[i].sheet.as_ref())
        .collect();
    let mut rows: Vec<Row> = Vec::with_capacity(strip.rows.len());
    let mut shots: Vec<Shot> = Vec::new();
    summary.time(Stage::Guesses, || {
        let guessed: Vec<(Row, Vec<Shot>)> = strip
            .rows
            .par_iter()
            .map(|&(face, row)| {
                let rod = used.binary_search(&face).unwrap_or_default();
                guess_row(&faces[face], face, row, rod)
            })
            .collect();
        for (row, of_row) in guessed {
            rows.push(Row {
                shots_before: shots.len(),
                ..row
            });
            shots.extend_from_slice(&of_row);
        }
    });
    let rods: Vec<_> = sheets.iter().map(|sheet| sheet.rod.clone()).collect();
    let hits = summary.time(Stage::Shooting, || {
        engine.shoot(method.effects(), &rods, &shots)
    });
    summary.shots.all += shots.len() as u64;
    if engine.failure().is_some() {
        summary.shots.on_cpu_instead += shots.len() as u64;
    }
    let refined = summary.time(Stage::Refinement, || {
        // What an engine could not finish starts again from the lattice's guess.
        let hit = |i: usize| hits.as_ref().map(|hits| hits[i]);
        let found = |i: usize| hit(i).filter(|hit| hit.outcome == Outcome::Converged);
        let start = |(i, shot): (usize, &Shot)| {
            found(i).map_or((shot.tau, shot.load), |hit| (hit.tau, hit.load))
        };
        let starts: Vec<(f64, f64)> = shots.iter().enumerate().map(start).collect();
        refine::refine(method, &sheets, &shots, &starts)
    });
    let unfinished = |hit: &&Hit| hit.outcome != Outcome::Converged;
    let restarted = hits.iter().flatten().filter(unfinished).count();
    summary.shots.restarted += restarted as u64;
    Settled {
        rows,
        hits,
        refined,
    }
}

/// The shots of one row of a face.
fn guess_row(face: &Face, index: usize, row: usize, rod: usize) -> (Row, Vec<Shot>) {
    let columns = &face.pushes.columns;
    let mut is_shot = vec![false; columns.len()];
    let mut shots = Vec::with_capacity(columns.len());
    if let Some(sheet) = &face.sheet {
        let at_touch = sheet.rows[row].pole(0.0);
        let guesses = sheet.guesses(row, columns.iter().map(|push| push.angle.abs()));
        for ((is_shot, push), guess) in is_shot.iter_mut().zip(columns).zip(guesses) {
            let Some(Guess { tau, load }) = guess else {
                continue;
            };
            *is_shot = true;
            shots.push(Shot {
                #[allow(clippy::cast_possible_truncation, reason = "panels at once are few")]
                rod: rod as u32,
                tau,
                load,
                pole: push.turn.rotate(at_touch),
            });
        }
    }
    let row = Row {
        face: index,
        row,
        is_shot,
        shots_before: 0,
    };
    (row, shots)
}
