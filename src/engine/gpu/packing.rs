//! Rows of batches as bytes for the shaders: push angles, and the expansions of rows around their ends.

use super::Precision;
use crate::engine::row::{FUNCTIONS, RowNumbers, functions};
use crate::engine::{RowBatch, RowExpansion};
use bytemuck::{Pod, Zeroable};
use std::ops::Range;
use whiskmap_mechanics::numerics::Real;
use whiskmap_mechanics::numerics::expansion::Chebyshev;
use whiskmap_mechanics::numerics::inverse::{TOGETHER, groups};

/// Number of shader invocations per workgroup; every device allows this many.
pub const WORKGROUP: u32 = 64;

/// Scalar type of the shaders: `f32` or `f64`.
pub trait Scalar: Real + Pod + Into<f64> + Send + Sync {}

impl<T: Real + Pod + Into<f64> + Send + Sync> Scalar for T {}

/// Returns `number` as the sum of two numbers `[high, low]`: rounded to the shaders' scalar, and the rounded remainder.
fn halves<T: Scalar>(number: f64) -> [T; 2] {
    let high = T::of(number);
    [high, T::of(number - high.into())]
}

/// Packs magnitudes of push angles, in radians, as bytes for the shaders. Each is two numbers of `precision`, `[high, low]` of [`halves`], which
/// together hold the angle.
pub fn pushes(precision: Precision, pushes: &[f64]) -> Vec<u8> {
    fn bytes<T: Scalar>(pushes: &[f64]) -> Vec<u8> {
        let pushes: Vec<[T; 2]> = pushes.iter().map(|push| halves(push.abs())).collect();
        bytemuck::cast_slice(&pushes).to_vec()
    }
    match precision {
        Precision::F32 => bytes::<f32>(pushes),
        Precision::F64 => bytes::<f64>(pushes),
    }
}

/// Numbers of a run of cells, in the layout of the shaders' `Row`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, packed)]
pub struct GpuRow<T> {
    /// Magnitude of the push angle at the end of the row as [`halves`], in radians.
    pub end: [T; 2],
    /// Argument of the expansions at the end.
    pub place: T,
    /// Distance of the pole, in whisker lengths.
    pub distance: T,
    /// Push angle left to the end as a parabola of the argument left to the end.
    pub slope: T,
    pub curvature: T,
    /// Bound on the residual of states of the row, in whisker lengths.
    pub residual: T,
    /// Contact coordinate `tau` at the end less `tau` at the tip.
    pub to_tip: T,
    /// Difference of `tau` within which a contact is at the tip, and the radius there, by which a residual is divided.
    pub tip_tie: T,
    pub tip_radius: T,
}

/// Run of cells: neighbouring cells of a row before its end.
#[derive(Clone, Debug, PartialEq)]
pub struct CellsOfRow {
    /// Index of the row in the batch.
    pub row: usize,
    /// Cells of the run among the cells of the batch.
    pub cells: Range<usize>,
}

/// Rows of a batch as bytes for the shaders.
#[derive(Debug, Default)]
pub struct Packed {
    /// Number of packed cells.
    pub cells: usize,
    /// Places of the packed cells among the cells of the batch, in their order: `[run]`.
    pub runs: Vec<CellsOfRow>,
    /// For each run, the indices of its first packed cell, of its first push angle, and of its first coefficients, and their number.
    pub heads: Vec<[u32; 4]>,
    /// Bytes of the numbers of each run: see `Row` in `shaders/cells.wgsl`.
    pub rows: Vec<u8>,
    /// Bytes of the coefficients of the runs: `[power][group][function]`, the values at the row's end first. Groups of four functions without one
    /// that is wanted are left out.
    pub terms: Vec<u8>,
}

impl Packed {
    /// Packs some `rows` of a batch for shaders of this precision.
    pub fn new(precision: Precision, batch: &RowBatch, rows: Range<usize>) -> Self {
        match precision {
            Precision::F32 => packed::<f32>(batch, rows),
            Precision::F64 => packed::<f64>(batch, rows),
        }
    }
}

/// Expansions of a row around its end, where the push angle may be flat: differences from the end keep their digits in `f32`.
struct AroundEnd {
    /// Numbers at the end.
    at_end: RowNumbers,
    /// Expansions of the differences from the end, over the difference of the argument.
    quotient: Chebyshev<FUNCTIONS>,
    /// The push angle that is left to the end is `slope left + curvature left^2` at the end and at first touch, where `left` is the argument
    /// that is left.
    slope: f64,
    curvature: f64,
}

impl AroundEnd {
    fn new(row: &RowExpansion) -> Self {
        let end = row.inverse.end;
        let (at_end, quotient) = row.inverse.functions.quotient(end);
        let ([slope, ..], [mean, ..]) = (quotient.at(end), quotient.at(0.0));
        Self {
            at_end,
            quotient,
            slope,
            curvature: (mean - slope) / end,
        }
    }
}

fn packed<T: Scalar>(batch: &RowBatch, rows: Range<usize>) -> Packed {
    let mut packed = Packed::default();
    let groups: Vec<usize> = groups(&functions(batch.channels)).collect();
    let width = TOGETHER * groups.len();
    let mut terms: Vec<T> = Vec::new();
    for index in rows {
        let row = &batch.rows[index];
        let Some(Some(expansion)) = batch.expansions.get(index) else {
            continue;
        };
        let side = &batch.sides[row.side];
        let first = terms.len() / width;
        let AroundEnd {
            at_end,
            quotient,
            slope,
            curvature,
        } = AroundEnd::new(expansion);
        for numbers in std::iter::once(&at_end).chain(&quotient.coefficients) {
            let wanted = groups
                .iter()
                .flat_map(|first| &numbers[*first..][..TOGETHER]);
            terms.extend(wanted.map(|number| T::of(*number)));
        }
        let [tip, tip_radius] = side.sheet.tip;
        let numbers = GpuRow {
            end: halves(at_end[0]),
            place: T::of(expansion.inverse.end),
            distance: T::of(side.sheet.rows[row.row].pole_distance),
            slope: T::of(slope),
            curvature: T::of(curvature),
            residual: T::of(expansion.residual),
            to_tip: T::of(at_end[1] - tip),
            tip_tie: T::of(side.sheet.tip_tie()),
            tip_radius: T::of(tip_radius),
        };
        let mut at = row.first;
        let before = row.before(expansion.end, &side.columns.magnitudes);
        for (range, cells) in row.cells.iter().zip(before) {
            // A submission has fewer cells and coefficients, and a row fewer columns, than `u32` can count.
            packed.heads.push([
                packed.cells as u32,
                side.columns.first + cells.start as u32,
                first as u32,
                (terms.len() / width - first) as u32,
            ]);
            packed.rows.extend_from_slice(bytemuck::bytes_of(&numbers));
            packed.runs.push(CellsOfRow {
                row: index,
                cells: at..at + cells.len(),
            });
            packed.cells += cells.len();
            at += range.len();
        }
    }
    packed.terms = bytemuck::cast_slice(&terms).to_vec();
    packed
}
