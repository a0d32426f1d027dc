//! Comparison of a channel of quantities: largest and median difference.

use super::CellPlace;
use crate::plan::Digits;
use crate::scene::Grid;

/// Comparison of a channel of quantities, or of `newton_steps`, of two maps. Differences are in the channel's unit.
#[derive(Clone, Debug, serde::Serialize)]
#[non_exhaustive]
pub struct QuantityComparison {
    /// Name of the compared channel.
    pub channel: &'static str,
    /// Number of cells with a value in both maps.
    pub cells: u64,
    /// Number of cells with a value in both maps whose two values are not equal.
    pub differing: u64,
    /// Number of cells with a value in only one of the maps: `[first, second]`.
    pub only_in: [u64; 2],
    /// Largest magnitude of a value of a compared cell, in either map, in the channel's unit.
    pub largest_value: f64,
    /// Median of the differences of all compared cells, in the channel's unit, to 0.2 % of itself; differences below 1e-38 count as 0.
    pub median: f64,
    /// Largest difference between the two maps, in the channel's unit, without rounding.
    pub largest: f64,
    /// Place of the cell with the largest difference, the first of equal ones; `None` if all values are equal.
    pub place: Option<CellPlace>,
    /// Largest part of a difference that the digits of the files do not explain, in the channel's unit. A value rounded to `n` bits of mantissa may
    /// differ by `2^-(n + 1)` of itself; with all bits, it is exact.
    pub beyond_rounding: f64,
    #[serde(skip)]
    rounding: [f64; 2],
    #[serde(skip)]
    at: usize,
    #[serde(skip)]
    counts: Vec<u64>,
}

/// Bits of an `f32` below the bits that number a bin of differences: a bin is 2^-8 of its values wide.
const BIN_SHIFT: u32 = 15;

impl QuantityComparison {
    /// Begins a comparison of the channel `name` of files with these digits.
    pub(super) fn new(channel: &'static str, digits: [Digits; 2]) -> Self {
        let of_file = |digits: Digits| {
            let bits = digits.mantissa_bits(channel);
            bits.map_or(0.0, |bits| (-f64::from(bits + 1)).exp2())
        };
        Self {
            channel,
            cells: 0,
            differing: 0,
            only_in: [0; 2],
            largest_value: 0.0,
            median: 0.0,
            largest: 0.0,
            place: None,
            beyond_rounding: 0.0,
            rounding: digits.map(of_file),
            at: 0,
            counts: vec![0; 1 << (u32::BITS - 1 - BIN_SHIFT)],
        }
    }

    /// Returns true if the channel is rounded in a file.
    #[must_use]
    pub fn is_rounded(&self) -> bool {
        self.rounding != [0.0; 2]
    }

    /// Returns a difference as a fraction of the channel's largest value; 0 without values.
    #[must_use]
    pub fn relative(&self, difference: f64) -> f64 {
        if difference == 0.0 { 0.0 } else { difference / self.largest_value }
    }

    /// Adds the values of a cell.
    pub(super) fn add(&mut self, cell: usize, values: [f64; 2]) {
        match values.map(|value| value.is_nan()) {
            [true, true] => {}
            [false, true] => self.only_in[0] += 1,
            [true, false] => self.only_in[1] += 1,
            [false, false] => self.add_both(cell, values),
        }
    }

    fn add_both(&mut self, cell: usize, [one, other]: [f64; 2]) {
        let difference = (one - other).abs();
        self.cells += 1;
        self.differing += u64::from(difference > 0.0);
        self.largest_value = self.largest_value.max(one.abs()).max(other.abs());
        self.counts[((difference as f32).to_bits() >> BIN_SHIFT) as usize] += 1;
        if difference > self.largest {
            (self.largest, self.at) = (difference, cell);
        }
        let [of_one, of_other] = self.rounding;
        let explained = of_one * one.abs() + of_other * other.abs();
        self.beyond_rounding = self.beyond_rounding.max(difference - explained);
    }

    /// Finds the median, and the place of the largest difference.
    pub(super) fn finish(mut self, grid: &Grid) -> Self {
        let (middle, mut below) = (self.cells.saturating_sub(1) / 2, 0);
        let bin = self.counts.iter().position(|count| {
            below += count;
            below > middle
        });
        self.median = bin.filter(|bin| *bin > 0).map_or(0.0, |bin| {
            let bits = ((bin as u32) << BIN_SHIFT) + (1 << (BIN_SHIFT - 1));
            f64::from(f32::from_bits(bits))
        });
        self.place = (self.largest > 0.0).then(|| CellPlace::of(grid, self.at));
        self
    }
}
