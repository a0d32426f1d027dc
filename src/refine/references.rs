//! References of rows: exact states along a row, so near to each other that between them the row is a polynomial.
//!
//! The way along a row is measured by `load tau^2`, which at the fold is much the same for all contacts. They lie near Chebyshev's nodes
//! of it, from first touch to where the row leaves the sheet. Every number that is smooth along the row is known between them by
//! the polynomial through all of them, expanded around the nearest one.

use super::Shot;
use super::exact::{Exact, exact};
use crate::engine::{BasePoint, MOST_TRAJECTORY_STEPS, RowTerms};
use crate::numerics::taylor::around_nodes;
use crate::numerics::{WIDTH, nearest_turn};
use crate::rod::Rest;
use crate::sheet::{Guess, Sheet};
use crate::shooting::batch::Method;
use rayon::prelude::*;
use std::f64::consts::PI;
use std::ops::Range;

/// References of a row: as many as polynomials are expanded around side by side.
pub const NODES: usize = WIDTH;

/// The cells of a row that ask for references.
#[derive(Clone, Copy, Debug)]
pub struct RowOfCells<'a> {
    /// Which of the sheets.
    pub sheet: u32,
    /// Which of its rows.
    pub row: usize,
    /// Push angles, growing magnitudes in radians.
    pub pushes: &'a [f64],
    /// The index of the first of them among those of the call.
    pub first: u32,
}

/// The references of every row, as far as its cells from first touch on go; none where the sheet is walked, where the row does not
/// begin at first touch, where a trajectory takes more than [`MOST_TRAJECTORY_STEPS`], and where there are too few cells to be worth it.
#[must_use]
pub fn references(method: Method, sheets: &[&Sheet], rows: &[RowOfCells]) -> Vec<Vec<BasePoint>> {
    let shots = |row: &RowOfCells| node_shots(sheets[row.sheet as usize], row);
    let shots = rows.par_iter().map(|row| shots(row));
    let shots: Vec<Option<Vec<Shot>>> = shots.collect();
    let flat: Vec<Shot> = shots.iter().flatten().flatten().copied().collect();
    let found = exact(method, sheets, &flat);
    let mut after = 0;
    let nodes: Vec<Range<usize>> = shots
        .iter()
        .map(|shots| {
            let count = shots.as_ref().map_or(0, Vec::len);
            after += count;
            after - count..after
        })
        .collect();
    rows.par_iter()
        .zip(nodes)
        .map(|(row, nodes)| {
            let found: Option<Vec<Exact>> = found[nodes].iter().copied().collect();
            let sheet = sheets[row.sheet as usize];
            let is_short = |at: &Exact| {
                let steps = method.resolution.steps(&sheet.rod, at.tau, at.load);
                steps <= MOST_TRAJECTORY_STEPS
            };
            let found = found.filter(|found| !found.is_empty() && found.iter().all(is_short));
            let expanded = found.and_then(|found| expand(sheet, row, &found));
            expanded.unwrap_or_default()
        })
        .collect()
}

/// The push angle at which a row that begins at first touch leaves the sheet, and the signed way there.
fn end(sheet: &Sheet, row: usize) -> Option<(f64, f64)> {
    let [crossing] = &sheet.crossings[row][..] else {
        return None;
    };
    let is_simple = sheet.touches(row) && crossing.is_sound() && !crossing.is_at_touch();
    is_simple.then(|| (crossing.push, way(crossing.tau, crossing.load)))
}

fn way(tau: f64, load: f64) -> f64 {
    load * tau * tau
}

/// The shots of the nodes of a row, from the lattice's guesses.
fn node_shots(sheet: &Sheet, row: &RowOfCells) -> Option<Vec<Shot>> {
    let (last, whole) = end(sheet, row.row)?;
    if row.pushes.len() <= NODES || sheet.is_walked() {
        return None;
    }
    let points = sheet.points(row.row).into_iter();
    let part = |(push, at): (f64, Guess)| [push, way(at.tau, at.load) / whole];
    let mut points: Vec<[f64; 2]> = points.map(part).collect();
    points.retain(|[push, part]| *push < last && *part < 1.0);
    points.push([last, 1.0]);
    let mut pushes = Vec::with_capacity(NODES);
    for m in 0..NODES {
        let part = (1.0 - libm::cos(PI * (m as f64 + 0.5) / NODES as f64)) / 2.0;
        let after = points.partition_point(|point| point[1] < part).max(1);
        let [from, to] = [points.get(after - 1)?, points.get(after)?];
        let between = (part - from[1]) / (to[1] - from[1]);
        pushes.push(between.mul_add(to[0] - from[0], from[0]));
    }
    let guesses = sheet.guesses(row.row, pushes.iter().copied());
    let sign = sheet.side.sign();
    let shot = |(guess, push): (Option<Guess>, &f64)| {
        guess.map(|guess| Shot {
            rod: row.sheet,
            tau: guess.tau,
            load: guess.load,
            pole: sheet.rows[row.row].pole(sign * push),
        })
    };
    guesses.into_iter().zip(&pushes).map(shot).collect()
}

/// References at the states of a row, and the cells of each; `None` where the way does not grow with the push angle.
fn expand(sheet: &Sheet, row: &RowOfCells, found: &[Exact]) -> Option<Vec<BasePoint>> {
    let (last, whole) = end(sheet, row.row)?;
    let sign = sheet.side.sign();
    let touch = sheet.rows[row.row].touch;
    let rest = Rest::new(&sheet.rod);
    let mut ways = [0.0; NODES];
    let mut numbers = [RowTerms::default(); NODES];
    let mut before = (0.0, 0.0);
    for (m, Exact { tau, load, state }) in found.iter().enumerate() {
        ways[m] = way(*tau, *load) / whole;
        let full = &state.full;
        let push = nearest_turn(full.map.pole.to_angle() - touch, before.0);
        let resting = rest.point_at_distance(full.position.length()).to_angle();
        let resting = nearest_turn(resting, before.1);
        before = (push, resting);
        let (by_tau, by_load) = (full.map.by_tau, full.map.by_load);
        numbers[m] = [
            push, *tau, resting, by_tau.x, by_tau.y, by_load.x, by_load.y,
        ];
    }
    if !ways.windows(2).all(|pair| pair[0] < pair[1]) {
        return None;
    }
    let expanded = around_nodes(&ways, &numbers);
    let mut references = Vec::with_capacity(NODES);
    let mut from = 0;
    for (m, row_here) in expanded.into_iter().enumerate() {
        let [push, ..] = numbers[m];
        let until = match ways.get(m + 1) {
            Some(next) => {
                let half = 0.5 * (next - ways[m]);
                let ahead = row_here
                    .iter()
                    .rev()
                    .fold(0.0, |sum, term| sum * half + term[0]);
                (sign * ahead).min(last)
            }
            None => last,
        };
        let to = from + row.pushes[from..].partition_point(|push| *push < until);
        if to > from {
            let Exact { tau, load, state } = found[m];
            references.push(BasePoint {
                rod: row.sheet,
                tau,
                load,
                push,
                state,
                per_way: whole / (tau * tau),
                row: row_here,
                cells: row.first + from as u32..row.first + to as u32,
            });
        }
        from = to;
    }
    Some(references)
}
