//! The columns of a map on one side of the pole.

use crate::rod::Side;
use glam::DVec2;
use std::ops::Range;

/// One column.
#[derive(Clone, Copy, Debug)]
pub struct Push {
    /// Index of the column.
    pub column: usize,
    /// Signed push angle, in radians.
    pub angle: f64,
    /// cos and sin of it.
    pub turn: DVec2,
}

/// Columns with growing magnitudes of their push angles.
#[derive(Clone, Debug)]
pub struct SideColumns {
    /// The side that they push to.
    pub side: Side,
    /// The columns.
    pub columns: Vec<Push>,
    /// Magnitudes of their push angles, in radians.
    pub magnitudes: Vec<f64>,
    /// Columns of the sides before.
    pub first: u32,
}

impl SideColumns {
    /// Those of `push_angle_deg`, which grow, that are on `side`; `first` is the number of columns on the sides before.
    pub fn new(push_angle_deg: &[f64], side: Side, first: u32) -> Self {
        let all = push_angle_deg.iter().enumerate();
        let ours = all.filter(|(_, push)| Side::of_push(**push) == side);
        let mut columns: Vec<Push> = ours
            .map(|(column, push)| {
                let angle = push.to_radians();
                Push {
                    column,
                    angle,
                    turn: DVec2::from_angle(angle),
                }
            })
            .collect();
        if side == Side::Cf {
            columns.reverse();
        }
        Self {
            side,
            magnitudes: columns.iter().map(|push| push.angle.abs()).collect(),
            columns,
            first,
        }
    }

    /// Writes the values of `cells` of a row, by growing push angle, into a row of a panel if it has columns.
    pub fn write(&self, row: &mut [f32], cells: &Range<usize>, value: impl Fn(usize) -> f32) {
        let Some(columns) = row.get_mut(self.span(cells.clone())) else {
            return;
        };
        match self.side {
            Side::Cb => columns
                .iter_mut()
                .enumerate()
                .for_each(|(i, cell)| *cell = value(i)),
            Side::Cf => columns
                .iter_mut()
                .rev()
                .enumerate()
                .for_each(|(i, cell)| *cell = value(i)),
        }
    }

    /// The columns of the panel that these `cells` of a row are in.
    pub fn span(&self, cells: Range<usize>) -> Range<usize> {
        match &self.columns[cells] {
            [] => 0..0,
            [only] => only.column..only.column + 1,
            [first, .., last] => first.column.min(last.column)..first.column.max(last.column) + 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_go_away_from_no_push() {
        let all = [-70.0, -1e-9, -0.0, 0.0, 30.0];
        let columns = |side| {
            let pushes = SideColumns::new(&all, side, 0);
            pushes
                .columns
                .iter()
                .map(|push| push.column)
                .collect::<Vec<_>>()
        };
        assert_eq!(columns(Side::Cf), [1, 0]);
        assert_eq!(columns(Side::Cb), [2, 3, 4]);
        let span = |side, cells| SideColumns::new(&all, side, 0).span(cells);
        assert_eq!(span(Side::Cf, 0..2), 0..2);
        assert_eq!(span(Side::Cf, 1..2), 0..1);
        assert_eq!(span(Side::Cb, 1..3), 3..5);
        let written = |side, cells| {
            let mut row = [0.0; 5];
            SideColumns::new(&all, side, 0).write(&mut row, &cells, |i| 1.0 + i as f32);
            row
        };
        assert_eq!(written(Side::Cf, 0..2), [2.0, 1.0, 0.0, 0.0, 0.0]);
        assert_eq!(written(Side::Cb, 1..3), [0.0, 0.0, 0.0, 1.0, 2.0]);
        SideColumns::new(&all, Side::Cb, 0).write(&mut [], &(0..1), |_| unreachable!());
        let Push { angle, turn, .. } = SideColumns::new(&all, Side::Cf, 0).columns[1];
        assert!(
            (turn.to_angle() - angle).abs() < 1e-15 && (angle + 1.2217304763960306).abs() < 1e-15
        );
    }
}
