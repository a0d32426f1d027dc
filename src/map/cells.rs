//! The cells of a few rows, stage by stage: guesses from the sheet, shots by an engine if there is one, refinement.

use super::{Face, Stage, Summary, pushes::Push};
use crate::classify::{RowBoundary, Status, TIE};
use crate::integrate::{Fallback, Hit, Outcome, Shot};
use crate::refine::{self, ContactState, End, Refined};
use crate::rod::Rod;
use crate::sheet::{Guess, Sheet};
use crate::shooting::batch::Method;
use rayon::prelude::*;

/// Some rows, settled.
pub struct Settled {
    /// The rows.
    pub rows: Vec<SettledRow>,
    /// What the engine made of the shots, if one was asked.
    hits: Option<Vec<Hit>>,
    /// What the refinement made of them.
    refined: Vec<Refined>,
}

/// A settled row of a face.
pub struct SettledRow {
    /// Index of the face.
    pub face: usize,
    /// Row of the panel.
    pub row: usize,
    /// Which of its cells have a shot, by growing push angle.
    has_shot: Vec<bool>,
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
    pub state: Option<ContactState>,
    /// Newton steps, engine and refinement together.
    pub steps: u32,
}

impl Cell {
    /// Whether its push is none, on a row that ends one from first touch.
    pub fn is_first_touch(&self, boundary: &RowBoundary) -> bool {
        self.push.angle.abs() <= TIE && boundary.detachment().is_some()
    }
}

impl Settled {
    /// The cells of `row`, which is one of `face`.
    pub fn cells<'a>(
        &'a self,
        face: &'a Face,
        row: &'a SettledRow,
    ) -> impl Iterator<Item = Cell> + 'a {
        let mut shot = row.shots_before;
        let cells = face.pushes.columns.iter().zip(&row.has_shot);
        cells.map(move |(push, has_shot)| {
            if !has_shot {
                return Cell {
                    push: *push,
                    status: Status::Outside,
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

/// Settles the cells of `rows`, pairs of a face and a row of its panel.
pub fn settle(
    method: Method,
    faces: &[Face],
    rows: &[(usize, usize)],
    engine: &mut Fallback<'_>,
    summary: &mut Summary,
) -> Settled {
    // `sheets[shot.rod]` is the sheet of a shot.
    let taking_part = |&i: &usize| rows.iter().any(|row| row.0 == i);
    let used: Vec<usize> = (0..faces.len()).filter(taking_part).collect();
    let sheets: Vec<&Sheet> = used.iter().map(|&i| &faces[i].sheet).collect();
    let rods: Vec<Rod> = sheets.iter().map(|sheet| sheet.rod.clone()).collect();

    let (rows, shots) = summary.time(Stage::Guesses, || {
        let guess = |&(face, row): &(usize, usize)| {
            let rod = used.binary_search(&face).unwrap_or_default();
            guess_row(&faces[face], row, rod)
        };
        let guessed: Vec<Vec<Option<Shot>>> = rows.par_iter().map(guess).collect();
        let mut shots: Vec<Shot> = Vec::new();
        let settled = rows.iter().zip(guessed).map(|(&(face, row), guesses)| {
            let shots_before = shots.len();
            shots.extend(guesses.iter().flatten());
            SettledRow {
                face,
                row,
                has_shot: guesses.iter().map(Option::is_some).collect(),
                shots_before,
            }
        });
        (settled.collect(), shots)
    });
    let hits = summary.time(Stage::Shooting, || {
        engine.shoot(method.effects, &rods, &shots)
    });
    let refined = summary.time(Stage::Refinement, || {
        // What an engine could not finish starts again from the lattice's guess.
        let start = |(i, shot): (usize, &Shot)| match &hits {
            Some(hits) if hits[i].outcome == Outcome::Converged => (hits[i].tau, hits[i].load),
            _ => (shot.tau, shot.load),
        };
        let starts: Vec<(f64, f64)> = shots.iter().enumerate().map(start).collect();
        refine::refine(method, &sheets, &shots, &starts)
    });

    let count = shots.len() as u64;
    summary.shots.all += count;
    summary.shots.on_cpu_instead += engine.failure.as_ref().map_or(0, |_| count);
    let unfinished = |hit: &&Hit| hit.outcome != Outcome::Converged;
    summary.shots.restarted += hits.iter().flatten().filter(unfinished).count() as u64;
    Settled {
        rows,
        hits,
        refined,
    }
}

/// The shots of the cells of one row of a face.
fn guess_row(face: &Face, row: usize, rod: usize) -> Vec<Option<Shot>> {
    let columns = &face.pushes.columns;
    let sheet = &face.sheet;
    let at_touch = sheet.rows[row].pole(0.0);
    let guesses = sheet.guesses(row, columns.iter().map(|push| push.angle.abs()));
    let shot = |(guess, push): (Option<Guess>, &Push)| {
        guess.map(|Guess { tau, load }| Shot {
            // Panels at once are few.
            rod: rod as u32,
            tau,
            load,
            pole: push.turn.rotate(at_touch),
        })
    };
    guesses.into_iter().zip(columns).map(shot).collect()
}
