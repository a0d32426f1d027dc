//! Columns of a map on one side of the pole: its push angles.

use glam::DVec2;
use std::ops::Range;
use whiskmap_mechanics::rod::Side;

/// Column of a map: a push angle on one side.
#[derive(Clone, Copy, Debug)]
pub struct Column {
    /// Index of the column among all columns of the map.
    pub index: usize,
    /// Signed push angle of the column, in radians.
    pub push: f64,
    /// Cosine and sine `(cos, sin)` of the column's signed push angle.
    pub turn: DVec2,
}

/// Columns of a map on one side of the pole, by growing magnitude of the push angle.
#[derive(Clone, Debug)]
pub struct SideColumns {
    /// Side of the pole on which the columns lie.
    pub side: Side,
    /// Columns of the side by growing magnitude of the push angle: `[column]`.
    pub columns: Vec<Column>,
    /// Magnitudes of the push angles of the columns, in radians: `[column]`.
    pub magnitudes: Vec<f64>,
    /// Number of columns of the map on the sides before this one.
    pub first: u32,
}

impl SideColumns {
    /// Selects the columns of the growing `push_angle_deg` that are on `side`; `first` is the number of columns on the sides before.
    #[must_use]
    pub fn new(push_angle_deg: &[f64], side: Side, first: u32) -> Self {
        let all = push_angle_deg.iter().enumerate();
        let ours = all.filter(|(_, push)| Side::of_push(**push) == side);
        let column = |(index, push): (usize, &f64)| {
            let push = push.to_radians();
            Column {
                index,
                push,
                turn: DVec2::from_angle(push),
            }
        };
        let mut columns: Vec<Column> = ours.map(column).collect();
        if side == Side::Cf {
            columns.reverse();
        }
        Self {
            side,
            magnitudes: columns.iter().map(|column| column.push.abs()).collect(),
            columns,
            first,
        }
    }

    /// Returns the number of columns of the side.
    #[must_use]
    pub fn len(&self) -> usize {
        self.columns.len()
    }

    /// Returns true if no column of the map is on this side.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.columns.is_empty()
    }

    /// Writes `value(i)` of the `i`-th of `cells` of a side's row into a row of the map; nothing into an empty row.
    pub fn write<T>(&self, row: &mut [T], cells: &Range<usize>, value: impl Fn(usize) -> T) {
        let Some(columns) = row.get_mut(self.span(cells)) else {
            return;
        };
        let write = |(i, cell): (usize, &mut T)| *cell = value(i);
        match self.side {
            Side::Cb => columns.iter_mut().enumerate().for_each(write),
            Side::Cf => columns.iter_mut().rev().enumerate().for_each(write),
        }
    }

    /// Returns the columns of the map that `cells` of a row of this side occupy.
    #[must_use]
    pub fn span(&self, cells: &Range<usize>) -> Range<usize> {
        match &self.columns[cells.clone()] {
            [] => 0..0,
            [only] => only.index..only.index + 1,
            [first, .., last] => first.index.min(last.index)..first.index.max(last.index) + 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_grow_from_no_push() {
        let all = [-70.0, -1e-9, -0.0, 0.0, 30.0];
        let of = |side| SideColumns::new(&all, side, 0);
        let indices = |side| of(side).columns.iter().map(|c| c.index).collect::<Vec<_>>();
        assert_eq!(indices(Side::Cf), [1, 0]);
        assert_eq!(indices(Side::Cb), [2, 3, 4]);
        assert_eq!(of(Side::Cf).span(&(0..2)), 0..2);
        assert_eq!(of(Side::Cf).span(&(1..2)), 0..1);
        assert_eq!(of(Side::Cb).span(&(1..3)), 3..5);
        let written = |side, cells| {
            let mut row = [0; 5];
            of(side).write(&mut row, &cells, |i| 1 + i);
            row
        };
        assert_eq!(written(Side::Cf, 0..2), [2, 1, 0, 0, 0]);
        assert_eq!(written(Side::Cb, 1..3), [0, 0, 0, 1, 2]);
        of(Side::Cb).write(&mut [], &(0..1), |_| -> f32 { unreachable!() });
        let Column { push, turn, .. } = of(Side::Cf).columns[1];
        assert!((turn.to_angle() - push).abs() < 1e-15);
        assert!((push + 1.2217304763960306).abs() < 1e-15);
    }
}
