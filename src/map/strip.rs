//! Some rows, from an engine if there is one, beside references along each row; all other cells from the sheet's guesses by refinement.

use super::WhiskerSide;
use super::audit::{self, Said};
use super::cells::{Settled, SettledRow};
use super::runs::Source;
use super::solved::{RowsAsked, Solved};
use super::stages::{Stage, StageTimes};
use super::summary::Audit;
use super::work::{Place, Work};
use crate::engine::{Question, on_gpu};
use crate::refine::{self, Refined, RowOfCells, Shot};
use crate::sheet::Sheet;
use crate::shooting::Resolution;
use crate::shooting::batch::Method;
use rayon::prelude::*;
use std::sync::Arc;

/// What there is to ask an engine about `rows`, pairs of a face and a row of its panel, at some of the signed `pushes` (radians), with
/// trajectories in the steps of `resolution`.
pub fn ask(
    method: Method,
    resolution: Resolution,
    pushes: &Arc<[f64]>,
    faces: &[WhiskerSide],
    rows: &[(usize, usize)],
) -> RowsAsked {
    match on_gpu(method.effects) {
        Ok(()) => Rows::new(method, faces, rows).ask(resolution, pushes),
        Err(_) => RowsAsked::default(),
    }
}

/// Settles the cells of `rows`, pairs of a face and a row of its panel, with what an engine made of them as long as that holds.
pub fn settle(
    method: Method,
    faces: &[WhiskerSide],
    rows: &[(usize, usize)],
    solved: Solved,
    times: &mut StageTimes,
) -> (Settled, Audit) {
    let rows = Rows::new(method, faces, rows);
    let (mut settled, mut audit) = rows.finish(solved, times);
    if audit.differing > 0 {
        audit.turned_over = settled.solved();
        settled = rows.finish(Solved::default(), times).0;
    }
    (settled, audit)
}

/// Some rows that are settled together.
struct Rows<'a> {
    method: Method,
    sheets: Vec<&'a Sheet>,
    places: Vec<Place<'a>>,
}

impl<'a> Rows<'a> {
    fn new(method: Method, faces: &'a [WhiskerSide<'a>], rows: &[(usize, usize)]) -> Self {
        let taking_part = |&i: &usize| rows.iter().any(|row| row.0 == i);
        let used: Vec<usize> = (0..faces.len()).filter(taking_part).collect();
        let place = |&(index, row): &(usize, usize)| Place {
            face: &faces[index],
            index,
            row,
            // Panels at once are few.
            sheet: used.binary_search(&index).unwrap_or_default() as u32,
        };
        Self {
            method,
            // `sheets[shot.rod]` is the sheet of a shot.
            sheets: used.iter().map(|&i| &faces[i].sheet).collect(),
            places: rows.iter().map(place).collect(),
        }
    }

    /// What there is to ask an engine.
    fn ask(&self, resolution: Resolution, pushes: &Arc<[f64]>) -> RowsAsked {
        let rows = self.places.iter().map(|place| RowOfCells {
            sheet: place.sheet,
            row: place.row,
            pushes: &place.face.pushes.magnitudes,
            first: place.face.pushes.first,
        });
        let rows: Vec<RowOfCells> = rows.collect();
        let found = refine::references(self.method, &self.sheets, &rows);
        let mut references = Vec::with_capacity(found.iter().map(Vec::len).sum());
        let mut rows = Vec::with_capacity(found.len());
        let mut cells = 0;
        for row in found {
            let from = references.len();
            let of_row = row.iter().map(|reference| reference.cells.len());
            let of_row: usize = of_row.sum();
            references.extend(row);
            rows.push((from..references.len(), cells));
            cells += of_row;
        }
        let rods = self.sheets.iter().map(|sheet| sheet.rod.clone()).collect();
        let (effects, pushes) = (self.method.effects, Arc::clone(pushes));
        let question = Question::new(effects, resolution, rods, pushes, references);
        let question = Arc::new(question);
        RowsAsked { question, rows }
    }

    /// Refines what an engine has left, and a sample of what it has not.
    fn finish(&self, solved: Solved, times: &mut StageTimes) -> (Settled, Audit) {
        let work: Vec<Work> = times.time(Stage::Guesses, || {
            let rows = self.places.par_iter().enumerate();
            let work = rows.map(|(i, place)| place.work(i, &solved));
            work.collect()
        });
        let refined = times.time(Stage::Refinement, || {
            let shots: Vec<Shot> = work.iter().flat_map(|row| &row.shots).copied().collect();
            let starts: Vec<_> = shots.iter().map(|shot| (shot.tau, shot.load)).collect();
            refine::refine(self.method, &self.sheets, &shots, &starts)
        });
        times.time(Stage::Classification, || {
            self.settled(solved, work, refined)
        })
    }

    /// Puts refined cells into their rows, and compares the audited ones.
    fn settled(&self, solved: Solved, work: Vec<Work>, refined: Vec<Refined>) -> (Settled, Audit) {
        let references = &solved.asked.question.references;
        let mut audit = Audit::default();
        let mut rows = Vec::with_capacity(self.places.len());
        let (mut before, mut unasked) = (0, 0);
        for (i, (place, mut work)) in self.places.iter().zip(work).enumerate() {
            for chosen in &work.audits {
                let refined = &refined[before + chosen.shot];
                let push = place.face.pushes.columns[chosen.cell].angle;
                let said = Said {
                    row: &references[solved.asked.rows[i].0.clone()],
                    reference: &references[chosen.reference as usize],
                    difference: &solved.differences[chosen.difference as usize],
                };
                let holds = audit::holds(&place.face.sheet, place.row, push, &said, refined);
                audit.cells += 1;
                audit.differing += u64::from(!holds);
            }
            for run in &mut work.runs {
                if let Source::Refined(first) = &mut run.source {
                    *first += before as u32;
                }
            }
            before += work.shots.len();
            unasked += work.unasked;
            rows.push(SettledRow {
                face: place.index,
                row: place.row,
                runs: work.runs,
            });
        }
        let settled = Settled {
            rows,
            question: solved.asked.question,
            differences: solved.differences,
            refined,
            unasked,
        };
        (settled, audit)
    }
}
