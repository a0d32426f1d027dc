//! Some rows, from an engine if there is one, beside references along each row; all other cells from the sheet's guesses by refinement.

use super::Face;
use super::audit::{self, Said, Sample};
use super::cells::{Settled, SettledRow, Source};
use super::pushes::Pushes;
use super::stages::{Stage, Stages};
use super::summary::Audit;
use crate::account::carried;
use crate::integrate::{CellDifference, Reference, on_gpu};
use crate::refine::{self, RowOfCells, Shot};
use crate::rod::Rod;
use crate::sheet::{Guess, Sheet};
use crate::shooting::batch::Method;
use rayon::prelude::*;
use std::ops::Range;

/// What an engine is asked about some rows.
#[derive(Default)]
pub struct Asked {
    /// The rods of the references.
    pub rods: Vec<Rod>,
    /// The references of all rows.
    pub references: Vec<Reference>,
    /// The references of each row, and the first of their cells.
    rows: Vec<(Range<usize>, usize)>,
}

impl Asked {
    /// About `rows`, pairs of a face and a row of its panel.
    pub fn new(method: Method, faces: &[Face], rows: &[(usize, usize)]) -> Self {
        match on_gpu(method.effects) {
            Ok(()) => Rows::new(method, faces, rows).ask(),
            Err(_) => Self::default(),
        }
    }
}

/// What an engine made of some rows.
#[derive(Default)]
pub struct Solved {
    /// What it was asked.
    pub asked: Asked,
    /// Its answers.
    pub differences: Vec<CellDifference>,
}

/// Settles the cells of `rows`, pairs of a face and a row of its panel, with what an engine made of them as long as that holds.
pub fn settle(
    method: Method,
    faces: &[Face],
    rows: &[(usize, usize)],
    solved: Solved,
    stages: &Stages,
) -> (Settled, Audit) {
    let rows = Rows::new(method, faces, rows);
    let (mut settled, mut audit) = rows.finish(solved, stages);
    if audit.differing > 0 {
        audit.turned_over = settled.solved();
        settled = rows.finish(Solved::default(), stages).0;
    }
    (settled, audit)
}

/// Some rows that are settled together.
struct Rows<'a> {
    method: Method,
    sheets: Vec<&'a Sheet>,
    places: Vec<Place<'a>>,
}

/// A row of a face.
struct Place<'a> {
    face: &'a Face<'a>,
    /// Of the face.
    index: usize,
    row: usize,
    /// Of the face's sheet among those of the strip.
    sheet: u32,
}

/// What is to be done for a row.
struct Work {
    sources: Vec<Source>,
    shots: Vec<Shot>,
    audits: Vec<Chosen>,
    /// Shots of cells that no engine was asked for.
    unasked: u64,
}

/// A cell of an engine that is computed once more.
struct Chosen {
    column: usize,
    reference: u32,
    cell: u32,
    /// Among the shots of its row.
    shot: usize,
}

impl<'a> Rows<'a> {
    fn new(method: Method, faces: &'a [Face<'a>], rows: &[(usize, usize)]) -> Self {
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
    fn ask(&self) -> Asked {
        let rows = self.places.iter().map(|place| RowOfCells {
            sheet: place.sheet,
            row: place.row,
            pushes: &place.face.pushes.magnitudes,
            first: place.face.pushes.first,
        });
        let rows: Vec<RowOfCells> = rows.collect();
        let mut asked = Asked {
            rods: self.sheets.iter().map(|sheet| sheet.rod.clone()).collect(),
            ..Asked::default()
        };
        let mut cells = 0;
        for row in refine::references(self.method, &self.sheets, &rows) {
            let from = asked.references.len();
            let of_row = row.iter().map(|reference| reference.cells.len());
            let of_row: usize = of_row.sum();
            asked.references.extend(row);
            asked.rows.push((from..asked.references.len(), cells));
            cells += of_row;
        }
        asked
    }

    /// Refines what an engine has left, and a sample of what it has not.
    fn finish(&self, solved: Solved, stages: &Stages) -> (Settled, Audit) {
        let work: Vec<Work> = stages.of(Stage::Guesses, || {
            let rows = self.places.par_iter().enumerate();
            let work = rows.map_init(carried(), |_, (i, place)| place.work(i, &solved));
            work.collect()
        });
        let refined = stages.of(Stage::Refinement, || {
            let shots: Vec<Shot> = work.iter().flat_map(|row| &row.shots).copied().collect();
            let starts: Vec<_> = shots.iter().map(|shot| (shot.tau, shot.load)).collect();
            refine::refine(self.method, &self.sheets, &shots, &starts)
        });
        let Solved { asked, differences } = solved;
        let mut audit = Audit::default();
        let mut rows = Vec::with_capacity(self.places.len());
        let (mut before, mut unasked) = (0, 0);
        for (i, (place, mut work)) in self.places.iter().zip(work).enumerate() {
            for chosen in &work.audits {
                let refined = &refined[before + chosen.shot];
                let push = place.face.pushes.columns[chosen.column].angle;
                let said = Said {
                    row: &asked.references[asked.rows[i].0.clone()],
                    reference: &asked.references[chosen.reference as usize],
                    difference: &differences[chosen.cell as usize],
                };
                let holds = audit::holds(&place.face.sheet, place.row, push, &said, refined);
                audit.cells += 1;
                audit.differing += u64::from(!holds);
            }
            for source in &mut work.sources {
                if let Source::Refined(index) = source {
                    *index += before as u32;
                }
            }
            before += work.shots.len();
            unasked += work.unasked;
            rows.push(SettledRow {
                face: place.index,
                row: place.row,
                sources: work.sources,
            });
        }
        let settled = Settled {
            rows,
            references: asked.references,
            differences,
            refined,
            unasked,
        };
        (settled, audit)
    }
}

impl Place<'_> {
    /// What is left to do for this row, the number `i` of its strip.
    fn work(&self, i: usize, solved: &Solved) -> Work {
        let pushes = self.face.pushes;
        let mut sources = vec![Source::Outside; pushes.columns.len()];
        let mut was_asked = vec![false; sources.len()];
        let mut chosen = Vec::new();
        if let Some((references, first)) = solved.asked.rows.get(i) {
            let mut cell = *first;
            let audit = Sample::new(&self.face.sheet, self.row, pushes.columns.len());
            for reference in references.clone() {
                let cells = &solved.asked.references[reference].cells;
                for column in cells.clone().map(|index| (index - pushes.first) as usize) {
                    let outcome = solved.differences[cell].outcome;
                    was_asked[column] = true;
                    if outcome.is_vouched_for() {
                        sources[column] = Source::Engine(reference as u32, cell as u32);
                        if audit.has(column) {
                            chosen.push((column, reference as u32, cell as u32));
                        }
                    }
                    cell += 1;
                }
            }
        }
        let is_left = |column: &usize| matches!(sources[*column], Source::Outside);
        let mut columns: Vec<usize> = (0..sources.len()).filter(is_left).collect();
        let left = columns.len();
        columns.extend(chosen.iter().map(|(column, ..)| *column));
        // Guesses are made by growing push angle.
        columns.sort_unstable();
        let guesses = self.shots(&columns);
        let mut shots = Vec::with_capacity(left);
        let (mut audits, mut unasked) = (Vec::new(), 0);
        let mut chosen = chosen.into_iter().peekable();
        for (column, shot) in columns.into_iter().zip(guesses) {
            let audited = chosen.next_if(|(own, ..)| *own == column);
            let Some(shot) = shot else { continue };
            match audited {
                Some((column, reference, cell)) => audits.push(Chosen {
                    column,
                    reference,
                    cell,
                    shot: shots.len(),
                }),
                None => {
                    sources[column] = Source::Refined(shots.len() as u32);
                    unasked += u64::from(!was_asked[column]);
                }
            }
            shots.push(shot);
        }
        Work {
            sources,
            shots,
            audits,
            unasked,
        }
    }

    /// The shots of the cells at `columns`, which grow.
    fn shots(&self, columns: &[usize]) -> Vec<Option<Shot>> {
        let Pushes {
            columns: pushes,
            magnitudes,
            ..
        } = self.face.pushes;
        let sheet = &self.face.sheet;
        let at_touch = sheet.rows[self.row].pole(0.0);
        let guesses = sheet.guesses(self.row, columns.iter().map(|column| magnitudes[*column]));
        let shot = |(guess, column): (Option<Guess>, &usize)| {
            guess.map(|Guess { tau, load }| Shot {
                rod: self.sheet,
                tau,
                load,
                pole: pushes[*column].turn.rotate(at_touch),
            })
        };
        guesses.into_iter().zip(columns).map(shot).collect()
    }
}
