//! Columns of a map on one side of the pole: its push angles.

use glam::DVec2;
use std::ops::Range;
use whiskmap_mechanics::rod::Side;

/// Columns of a map on one side of the pole, by growing push angle.
#[derive(Clone, Debug)]
pub struct SideColumns {
    /// Side of the pole on which the columns lie.
    pub side: Side,
    /// Magnitude of each column's push angle, in radians, growing: `[column]`.
    pub pushes: Vec<f64>,
    /// Cosine and sine `(cos, sin)` of each column's signed push angle: `[column]`.
    pub turns: Vec<DVec2>,
    /// Columns of the map on this side. On CF they are in the opposite order.
    in_map: Range<usize>,
}

impl SideColumns {
    /// Selects the columns of the growing `push_angle_deg` that are on `side`.
    #[must_use]
    pub fn new(push_angle_deg: &[f64], side: Side) -> Self {
        let first_cb = push_angle_deg.partition_point(|push| Side::of_push(*push) == Side::Cf);
        let in_map = match side {
            Side::Cf => 0..first_cb,
            Side::Cb => first_cb..push_angle_deg.len(),
        };
        let mut signed_pushes: Vec<f64> =
            push_angle_deg[in_map.clone()].iter().map(|push| push.to_radians()).collect();
        if side == Side::Cf {
            signed_pushes.reverse();
        }
        Self {
            side,
            pushes: signed_pushes.iter().map(|push| push.abs()).collect(),
            turns: signed_pushes.into_iter().map(DVec2::from_angle).collect(),
            in_map,
        }
    }

    /// Returns the number of columns of the side.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.pushes.len()
    }

    /// Returns true if no column of the map is on this side.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.pushes.is_empty()
    }

    /// Returns the signed push angle of a column of this side, in radians.
    #[must_use]
    pub fn signed_push(&self, column: usize) -> f64 {
        self.side.sign() * self.pushes[column]
    }

    /// Writes `value(i)` of the `i`-th of the `columns` of this side into a row of the map; nothing into an empty row.
    pub fn write<T>(&self, row: &mut [T], columns: &Range<usize>, value: impl Fn(usize) -> T) {
        let Some(cells) = row.get_mut(self.in_map(columns)) else {
            return;
        };
        let write = |(i, cell): (usize, &mut T)| *cell = value(i);
        match self.side {
            Side::Cb => cells.iter_mut().enumerate().for_each(write),
            Side::Cf => cells.iter_mut().rev().enumerate().for_each(write),
        }
    }

    /// Returns the columns of the map that are the `columns` of this side.
    #[must_use]
    pub const fn in_map(&self, columns: &Range<usize>) -> Range<usize> {
        match self.side {
            Side::Cb => self.in_map.start + columns.start..self.in_map.start + columns.end,
            Side::Cf => self.in_map.end - columns.end..self.in_map.end - columns.start,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_grow_from_no_push() {
        let all = [-70.0, -1e-9, -0.0, 0.0, 30.0];
        let of = |side| SideColumns::new(&all, side);
        assert_eq!([Side::Cf, Side::Cb].map(|side| of(side).len()), [2, 3]);
        assert_eq!(of(Side::Cf).in_map(&(0..2)), 0..2);
        assert_eq!(of(Side::Cf).in_map(&(1..2)), 0..1);
        assert_eq!(of(Side::Cb).in_map(&(1..3)), 3..5);
        let written = |side, columns| {
            let mut row = [0; 5];
            of(side).write(&mut row, &columns, |i| 1 + i);
            row
        };
        assert_eq!(written(Side::Cf, 0..2), [2, 1, 0, 0, 0]);
        assert_eq!(written(Side::Cb, 1..3), [0, 0, 0, 1, 2]);
        of(Side::Cb).write(&mut [], &(0..1), |_| -> f32 { unreachable!() });
        let columns = of(Side::Cf);
        assert!((columns.pushes[1] - 1.2217304763960306).abs() < 1e-15);
        let signed_push = columns.signed_push(1);
        assert_eq!(signed_push, -columns.pushes[1]);
        assert!((columns.turns[1].to_angle() - signed_push).abs() < 1e-15);
    }
}
