//! The columns of a map on one side of the pole.

use crate::rod::Side;
use glam::DVec2;

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
pub struct Pushes {
    /// The side that they push to.
    pub side: Side,
    /// The columns.
    pub columns: Vec<Push>,
    /// Magnitudes of their push angles, in radians.
    pub magnitudes: Vec<f64>,
    /// Columns of the sides before.
    pub first: u32,
}

impl Pushes {
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
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_go_away_from_no_push() {
        let all = [-70.0, -1e-9, -0.0, 0.0, 30.0];
        let columns = |side| {
            let pushes = Pushes::new(&all, side, 0);
            pushes
                .columns
                .iter()
                .map(|push| push.column)
                .collect::<Vec<_>>()
        };
        assert_eq!(columns(Side::Cf), [1, 0]);
        assert_eq!(columns(Side::Cb), [2, 3, 4]);
        let Push { angle, turn, .. } = Pushes::new(&all, Side::Cf, 0).columns[1];
        assert!(
            (turn.to_angle() - angle).abs() < 1e-15 && (angle + 1.2217304763960306).abs() < 1e-15
        );
    }
}
