//! Cells of random whiskers, as an engine gets them and as the refinement does.
#![allow(dead_code, reason = "each test program uses its own share")]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::random_rods::{Random, rod};
use rayon::prelude::*;
use std::sync::Arc;
use whiskmap::engine::{BasePoint, CellDifference, Engine, Question};
use whiskmap::refine::{Refined, RowOfCells, Shot, references, refine};
use whiskmap::rod::{Effects, Rod, Side};
use whiskmap::sheet::Sheet;
use whiskmap::shooting::batch::Method;

/// Rows of a whisker, and columns of each.
const ROWS: usize = 4;
const COLUMNS: usize = 64;

/// The largest push angle, in radians.
const LARGEST_PUSH: f64 = 1.8;

/// Rows of cells.
pub struct Cells {
    pub method: Method,
    pub sheets: Vec<Sheet>,
    pub rods: Vec<Rod>,
    /// Signed push angles of all columns, in radians.
    pub pushes: Vec<f64>,
    pub references: Vec<BasePoint>,
    /// Direction of the pole at first touch, for each reference.
    pub touches: Vec<f64>,
    /// What the refinement is asked for, cell by cell.
    pub shots: Vec<Shot>,
}

impl Cells {
    /// Of `count` random whiskers, which are `changed` first.
    pub fn random(
        effects: Effects,
        count: usize,
        seed: u64,
        changed: impl Fn(&mut Rod, &mut Random),
    ) -> Self {
        let mut random = Random(seed);
        let faces = (0..count).map(|_| {
            let mut rod = rod(effects, &mut random);
            changed(&mut rod, &mut random);
            let nearest = f64::max(0.15, 1.5 * rod.pole.abs());
            let distances = [(); ROWS].map(|()| random.between(nearest, 1.0));
            (rod, distances)
        });
        let faces: Vec<(Rod, [f64; ROWS])> = faces.collect();
        let method = Method::fine().with_effects(effects);
        let sheets = faces.par_iter().map(|(rod, distances)| {
            let side = Side::BOTH
                .into_iter()
                .find(|side| side.sign() == rod.pole.signum());
            Sheet::new(method, rod, side.unwrap(), distances)
        });
        Self::new(method, sheets.collect())
    }

    fn new(method: Method, sheets: Vec<Sheet>) -> Self {
        let part = |i: usize| i as f64 / (COLUMNS - 1) as f64;
        let magnitudes: Vec<f64> = (0..COLUMNS)
            .map(|i| LARGEST_PUSH * part(i).powi(2))
            .collect();
        let both = [Side::Cb, Side::Cf].map(|side| magnitudes.iter().map(move |m| side.sign() * m));
        let pushes: Vec<f64> = both.into_iter().flatten().collect();
        let first = |sheet: &Sheet| {
            if sheet.side == Side::Cb {
                0
            } else {
                COLUMNS as u32
            }
        };
        let rows = sheets.iter().enumerate().flat_map(|(index, sheet)| {
            let magnitudes = &magnitudes;
            (0..sheet.rows.len()).map(move |row| RowOfCells {
                sheet: index as u32,
                row,
                pushes: magnitudes,
                first: first(sheet),
            })
        });
        let rows: Vec<RowOfCells> = rows.collect();
        let kept: Vec<&Sheet> = sheets.iter().collect();
        let (mut of_rows, mut touches, mut shots) = (Vec::new(), Vec::new(), Vec::new());
        for (row, of_row) in rows.iter().zip(references(method, &kept, &rows)) {
            let sheet = &sheets[row.sheet as usize];
            let place = &sheet.rows[row.row];
            let guesses = sheet.guesses(row.row, magnitudes.iter().copied());
            for reference in of_row {
                shots.extend(reference.cells.clone().map(|index| {
                    let guess = guesses[(index - row.first) as usize].unwrap();
                    Shot {
                        rod: row.sheet,
                        tau: guess.tau,
                        load: guess.load,
                        pole: place.pole(pushes[index as usize]),
                    }
                }));
                touches.push(place.touch);
                of_rows.push(reference);
            }
        }
        Self {
            method,
            rods: sheets.iter().map(|sheet| sheet.rod.clone()).collect(),
            sheets,
            pushes,
            references: of_rows,
            touches,
            shots,
        }
    }

    /// What `engine` makes of them.
    pub fn solve(&self, engine: &mut dyn Engine) -> Vec<CellDifference> {
        engine
            .solve(self.question(engine, &self.references))
            .unwrap()
    }

    /// What `engine` is asked about some `references`.
    pub fn question(&self, engine: &dyn Engine, references: &[BasePoint]) -> Arc<Question> {
        Arc::new(Question::new(
            self.method.effects,
            engine.resolution(self.method.resolution),
            self.rods.clone(),
            self.pushes.as_slice().into(),
            references.to_vec(),
        ))
    }

    /// What the refinement makes of them.
    pub fn refined(&self) -> Vec<Refined> {
        let sheets: Vec<&Sheet> = self.sheets.iter().collect();
        let starts: Vec<_> = self
            .shots
            .iter()
            .map(|shot| (shot.tau, shot.load))
            .collect();
        refine(self.method, &sheets, &self.shots, &starts)
    }

    /// For each cell the index of its reference, and its push angle.
    pub fn places(&self) -> Vec<(usize, f64)> {
        let of_one = |(index, reference): (usize, &BasePoint)| {
            let pushes = &self.pushes[reference.cells.start as usize..reference.cells.end as usize];
            pushes
                .iter()
                .map(move |push| (index, *push))
                .collect::<Vec<_>>()
        };
        self.references
            .iter()
            .enumerate()
            .flat_map(of_one)
            .collect()
    }
}
