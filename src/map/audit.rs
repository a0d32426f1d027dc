//! Looking over an engine's shoulder: a sample of its cells, computed once more in `f64`.

use super::channels::{Numbers, channels, of_cell, of_reference};
use crate::integrate::{CellDifference, Outcome, Reference};
use crate::refine::{End, Refined};
use crate::rod::Units;
use crate::sheet::Sheet;
use crate::shooting::Reader;

/// One cell in so many is in the sample.
const ONE_IN: u64 = 256;

/// The fewest cells of a whisker's side in it, as far as there are any.
const AT_LEAST: u64 = 64;

/// By how much a number may differ, in parts of its size and of one: a whisker's length, a radian, a force of `E I_base/L_w^2`.
const TOLERANCE: f64 = 3e-6;

/// Which cells of a row are in the sample: the same ones in every run.
pub struct Sample {
    seed: u64,
    threshold: u64,
}

impl Sample {
    /// Of `row` of `sheet`.
    pub fn new(sheet: &Sheet, row: usize, columns: usize) -> Self {
        let cells = (sheet.rows.len() * columns) as u64;
        let one_in = (cells / AT_LEAST).clamp(1, ONE_IN);
        Self {
            seed: sheet.rows[row].touch.to_bits() ^ sheet.rod.taper.to_bits().rotate_left(32),
            threshold: u64::MAX / one_in,
        }
    }

    /// Whether the cell in `column` is in it.
    pub fn has(&self, column: usize) -> bool {
        mixed(self.seed ^ (column as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15)) <= self.threshold
    }
}

/// A random-looking number for each number: the last steps of the generator splitmix64 (G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014).
fn mixed(z: u64) -> u64 {
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Whether what an engine says of a cell of `row` at the signed `push` is what the refinement says; where that has no answer, nothing
/// is known against it.
pub fn holds(
    sheet: &Sheet,
    row: usize,
    push: f64,
    (reference, difference): (&Reference, &CellDifference),
    refined: &Refined,
) -> bool {
    match (difference.outcome, refined.end) {
        (_, End::NotConverged) => true,
        (Outcome::BeyondTip, end) => end == End::BeyondTip,
        (_, End::Solved) => {
            let units = Units {
                length_mm: 1.0,
                force_un: 1.0,
                moment_nnm: 1.0,
            };
            let reader = Reader::new(units, &sheet.rod);
            let touch = sheet.rows[row].touch;
            let of_one = channels(&reader.of_one(sheet.side.sign()));
            let reference = of_reference(&reader, reference, touch);
            let ours = channels(&reader.read(refined.state.tau, &refined.state.full, touch, push));
            let theirs = of_cell(&reference, &of_one, difference);
            let larger: Numbers = std::array::from_fn(|i| ours[i].abs().max(reference[i].abs()));
            let [arc, angle, force, .., chord, distance, _] = larger;
            // Components of the force, moment and energy go with the force, near the base in front of a small arm.
            let moment = force * arc;
            let sizes = [
                arc, angle, force, force, force, moment, chord, distance, moment,
            ];
            let differences = ours.iter().zip(theirs).map(|(ours, theirs)| ours - theirs);
            let allowed = sizes.iter().zip(of_one).map(|(size, one)| one.abs() + size);
            let mut pairs = differences.zip(allowed);
            pairs.all(|(difference, allowed)| difference.abs() <= TOLERANCE * allowed)
        }
        _ => false,
    }
}
