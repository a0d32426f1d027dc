//! Looking over an engine's shoulder: a sample of its cells, computed once more in `f64`.

use super::channels::{Numbers, channels, of_cell, of_reference};
use crate::engine::{BasePoint, CellDifference};
use crate::refine::{End, Refined};
use crate::rod::Units;
use crate::sheet::Sheet;
use crate::shooting::Reader;
use std::ops::Range;

/// One cell in so many is in the sample.
const ONE_IN: u64 = 256;

/// About the fewest cells of a whisker's side in it, as far as there are any.
const AT_LEAST: u64 = 64;

/// By how much a number may differ, in parts of the largest along the row, or of a radian.
const TOLERANCE: f64 = 3e-6;

/// Engines vouch for no larger miss of a pole, in whisker lengths.
const LARGEST_MISS: f64 = 1e-7;

/// Which cells of a row are in the sample: the same ones in every run, one of each so many.
pub struct Sample {
    seed: u64,
    one_in: u64,
}

impl Sample {
    /// Of `row` of `sheet`.
    pub fn new(sheet: &Sheet, row: usize, columns: usize) -> Self {
        let cells = (sheet.rows.len() * columns) as u64;
        let distance = sheet.rows[row].pole_distance;
        let of_whisker = [
            sheet.rod.taper,
            sheet.rod.bend,
            sheet.rod.pole,
            sheet.side.sign(),
        ];
        let numbers = of_whisker
            .map(f64::to_bits)
            .into_iter()
            .chain([distance.to_bits(), row as u64]);
        Self {
            seed: numbers.fold(0, |seed, number| mixed(seed ^ mixed(number))),
            one_in: (cells / AT_LEAST).clamp(1, ONE_IN),
        }
    }

    /// Those of `cells` that are in it.
    pub fn of(&self, cells: Range<usize>) -> impl Iterator<Item = usize> + use<> {
        let Self { seed, one_in } = *self;
        let all = cells.start as u64..cells.end as u64;
        let parts = all.start / one_in..all.end.div_ceil(one_in);
        let chosen = parts.map(move |part| part * one_in + mixed(seed ^ mixed(part)) % one_in);
        let chosen = chosen.filter(move |cell| all.contains(cell));
        chosen.map(|cell| cell as usize)
    }
}

/// A random-looking number for each number: the generator splitmix64 (G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014).
fn mixed(z: u64) -> u64 {
    let z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// What an engine says of a cell: a difference from one of the references of its row.
pub struct Said<'a> {
    /// The references of the row.
    pub row: &'a [BasePoint],
    /// That of the cell.
    pub reference: &'a BasePoint,
    /// The difference.
    pub difference: &'a CellDifference,
}

/// How many times as much as by the push alone a miss of the pole may show: next to the tip of a cone numbers change faster with its
/// distance. Measured 1.5 on 2,000 random whiskers.
const BY_DISTANCE: f64 = 4.0;

/// Whether what is `said` of a solved cell of `row` at the signed `push` is what the refinement says; where that has no answer, nothing is
/// known against it. A miss of the pole is allowed to show: next to the tip of a cone the contact angle changes up to 200 times as
/// much as the push.
pub fn holds(sheet: &Sheet, row: usize, push: f64, said: &Said, refined: &Refined) -> bool {
    match refined.end {
        End::NotConverged => return true,
        End::Solved => {}
        End::BeyondTip | End::BeyondFold => return false,
    }
    let units = Units {
        length_mm: 1.0,
        force_un: 1.0,
        moment_nnm: 1.0,
    };
    let reader = Reader::new(units, &sheet.rod);
    let touch = sheet.rows[row].touch;
    let of_one = channels(&reader.of_one(sheet.side.sign()));
    let ours = channels(&reader.read(refined.state.tau, &refined.state.full, touch, push));
    let reference = of_reference(&reader, said.reference, touch);
    let theirs = of_cell(&reference, &of_one, said.difference);
    let of_row = said.row.iter().map(|own| of_reference(&reader, own, touch));
    let sizes = sizes(of_row.chain([ours]), &of_one);
    let miss = f64::from(said.difference.residual).min(LARGEST_MISS);
    let miss_angle = miss / sheet.rows[row].pole_distance;
    let part_of_turn = (miss_angle / (push - said.reference.push).abs()).min(1.0);
    (0..ours.len()).all(|i| {
        let by_miss = BY_DISTANCE * part_of_turn * (ours[i] - reference[i]).abs();
        (ours[i] - theirs[i]).abs() <= TOLERANCE * sizes[i] + by_miss
    })
}

/// How large the numbers of a row are: components of the force go with the whole, moment and energy with the force and its lever, angles
/// with a radian.
fn sizes(row: impl Iterator<Item = Numbers>, of_one: &Numbers) -> Numbers {
    let of_state = |[arc, _, force, .., distance, _]: Numbers| [arc, force, distance, force * arc];
    let [arc, force, distance, moment] = row.map(of_state).fold([0.0; 4], |largest, own| {
        std::array::from_fn(|i| f64::max(largest[i], own[i].abs()))
    });
    let [_, radian, ..] = *of_one;
    [
        arc, radian, force, force, force, moment, radian, distance, moment,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One cell of each part of a row, whatever ranges are asked for; in other rows others.
    #[test]
    fn a_sample_has_a_cell_of_each_part() {
        for one_in in [1, 2, 7, 256] {
            let sample = |seed| Sample { seed, one_in };
            let all: Vec<usize> = sample(3).of(0..1792).collect();
            let parts: Vec<u64> = all.iter().map(|cell| *cell as u64 / one_in).collect();
            assert_eq!(parts, (0..1792 / one_in).collect::<Vec<_>>());
            for step in [1, 5, 100, 257] {
                let ranges = (0..1792)
                    .step_by(step)
                    .map(|from| from..1792.min(from + step));
                let joined: Vec<usize> = ranges.flat_map(|range| sample(3).of(range)).collect();
                assert_eq!(joined, all);
            }
            assert_eq!(sample(3).of(9..9).count(), 0);
            assert_eq!(sample(4).of(0..1792).eq(all), one_in == 1);
        }
    }

    /// Of rows that are shorter than a part, as many cells in all.
    #[test]
    fn short_rows_are_sampled_as_often() {
        let rows = (0..4096).map(|row| Sample {
            seed: mixed(row),
            one_in: 256,
        });
        let count = rows.map(|row| row.of(0..16).count()).sum::<usize>();
        // 256 of 65,536 cells, give or take four standard deviations.
        assert!((192..=320).contains(&count), "{count}");
    }
}
