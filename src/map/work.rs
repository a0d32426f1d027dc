//! What is left to do for a row once an engine has answered: the cells that it has left, and the sample of the audit.

use super::WhiskerSide;
use super::audit::Sample;
use super::columns::SideColumns;
use super::runs::{self, Run, Source};
use super::solved::Solved;
use crate::engine::CellDifference;
use crate::refine::Shot;
use crate::sheet::Guess;
use std::ops::Range;

/// A row of a face.
pub struct Place<'a> {
    pub face: &'a WhiskerSide<'a>,
    /// Of the face.
    pub index: usize,
    pub row: usize,
    /// Of the face's sheet among those of the strip.
    pub sheet: u32,
}

/// What is to be done for a row.
#[derive(Default)]
pub struct Work {
    /// All its cells; those refined are numbered by the row's own shots.
    pub runs: Vec<Run>,
    pub shots: Vec<Shot>,
    pub audits: Vec<Chosen>,
    /// Shots of cells that no engine was asked for.
    pub unasked: u64,
}

/// A cell of an engine that is computed once more.
pub struct Chosen {
    pub cell: usize,
    pub reference: u32,
    pub difference: u32,
    /// Among the shots of its row.
    pub shot: usize,
}

/// What an engine has said of a row.
#[derive(Default)]
struct Heard {
    /// The cells that it was asked for.
    asked: Range<usize>,
    /// Those that it vouches for.
    runs: Vec<Run>,
}

impl Place<'_> {
    /// Of this row, the number `i` of its strip.
    fn heard(&self, i: usize, solved: &Solved) -> Heard {
        let Some((references, first)) = solved.asked.rows.get(i) else {
            return Heard::default();
        };
        let own_first = self.face.pushes.first;
        let mut heard = Heard::default();
        let mut first = *first;
        for index in references.clone() {
            // The cells of a row's references follow each other.
            let cells = &solved.asked.question.references[index].cells;
            let [from, to] = [cells.start, cells.end].map(|cell| (cell - own_first) as usize);
            heard.asked = match heard.asked.is_empty() {
                true => from..to,
                false => heard.asked.start..to,
            };
            let answers = &solved.differences[first..first + to - from];
            let is_vouched_for = |cell: &CellDifference| cell.outcome.is_vouched_for();
            let mut before = 0;
            for run in answers.chunk_by(|a, b| is_vouched_for(a) == is_vouched_for(b)) {
                if is_vouched_for(&run[0]) {
                    heard.runs.push(Run {
                        cells: from + before..from + before + run.len(),
                        source: Source::Engine(index as u32, (first + before) as u32),
                    });
                }
                before += run.len();
            }
            first += answers.len();
        }
        heard
    }

    /// What is left to do for this row, the number `i` of its strip.
    pub fn work(&self, i: usize, solved: &Solved) -> Work {
        let count = self.face.pushes.columns.len();
        let Heard {
            asked,
            runs: vouched,
        } = self.heard(i, solved);
        // Guesses are made by growing push angle.
        let mut wanted: Vec<(usize, Source)> = Vec::new();
        let sample = Sample::new(&self.face.sheet, self.row, count);
        let mut from = 0;
        for run in &vouched {
            wanted.extend((from..run.cells.start).map(|cell| (cell, Source::Outside)));
            let audited = sample.of(run.cells.clone());
            let source = |cell: usize| run.source.after((cell - run.cells.start) as u32);
            wanted.extend(audited.map(|cell| (cell, source(cell))));
            from = run.cells.end;
        }
        wanted.extend((from..count).map(|cell| (cell, Source::Outside)));
        let mut work = Work::default();
        let shots = self.shots(wanted.iter().map(|(cell, _)| *cell));
        for ((cell, source), shot) in wanted.into_iter().zip(shots) {
            let index = work.shots.len();
            work.shots.extend(shot);
            match (source, shot) {
                (Source::Engine(reference, difference), Some(_)) => work.audits.push(Chosen {
                    cell,
                    reference,
                    difference,
                    shot: index,
                }),
                (Source::Engine(..), None) => {}
                (_, Some(_)) => {
                    runs::push(&mut work.runs, cell, Source::Refined(index as u32));
                    work.unasked += u64::from(!asked.contains(&cell));
                }
                (_, None) => runs::push(&mut work.runs, cell, Source::Outside),
            }
        }
        work.runs.extend(vouched);
        work.runs.sort_unstable_by_key(|run| run.cells.start);
        work
    }

    /// The shots of `cells`, which grow.
    fn shots(&self, cells: impl Iterator<Item = usize> + Clone) -> Vec<Option<Shot>> {
        let SideColumns {
            columns,
            magnitudes,
            ..
        } = self.face.pushes;
        let sheet = &self.face.sheet;
        let at_touch = sheet.rows[self.row].pole(0.0);
        let guesses = sheet.guesses(self.row, cells.clone().map(|cell| magnitudes[cell]));
        let shot = |(guess, cell): (Option<Guess>, usize)| {
            guess.map(|Guess { tau, load }| Shot {
                rod: self.sheet,
                tau,
                load,
                pole: columns[cell].turn.rotate(at_touch),
            })
        };
        guesses.into_iter().zip(cells).map(shot).collect()
    }
}
