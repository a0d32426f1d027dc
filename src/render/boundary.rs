//! The detachment boundary, from the margins of the cells next to it.

use super::axis::Axis;
use crate::scene::Grid;
use crate::store::Samples;

/// A stretch of the boundary: two points (push angle in degrees, distance in mm).
pub(super) type Segment = [[f64; 2]; 2];

/// Neighbouring rows whose boundaries lie farther apart than this part of the axis are not connected.
const JUMP: f64 = 0.25;

/// The boundary on both sides, inside the axis. In each row and side, the cell with the smallest margin tells where
/// the whisker detaches: at its push angle and that margin farther from rest.
pub(super) fn segments(grid: &Grid, margin_deg: &Samples) -> Vec<Segment> {
    let [low, high] = Axis::new(&grid.push_angle_deg).range();
    let mut segments = Vec::new();
    for side in [-1.0, 1.0] {
        let rows: Vec<Option<[f64; 2]>> = (0..grid.distance_mm.len())
            .map(|row| {
                Some([
                    detachment(grid, margin_deg, row, side)?,
                    grid.distance_mm[row],
                ])
            })
            .collect();
        for pair in rows.windows(2) {
            if let [Some(from), Some(to)] = *pair
                && (from[0] - to[0]).abs() <= JUMP * (high - low)
            {
                segments.extend(clip([from, to], low, high));
            }
        }
    }
    segments
}

/// The push angle at which the whisker detaches in a row, for CF (`side` -1) or CB (1).
fn detachment(grid: &Grid, margin_deg: &Samples, row: usize, side: f64) -> Option<f64> {
    let angles = &grid.push_angle_deg;
    let cells = angles.iter().enumerate().filter_map(|(column, angle)| {
        let margin = margin_deg.value(row * angles.len() + column);
        let on_side = (*angle < 0.0) == (side < 0.0);
        (on_side && margin.is_finite()).then_some((margin, angle + side * margin))
    });
    cells
        .min_by(|(one, _), (other, _)| one.total_cmp(other))
        .map(|(_, angle)| angle)
}

/// The part of a segment between two push angles.
fn clip([from, to]: Segment, low: f64, high: f64) -> Option<Segment> {
    let run = to[0] - from[0];
    let at = |angle: f64| {
        let part = if run == 0.0 {
            0.0
        } else {
            (angle.clamp(low, high) - from[0]) / run
        };
        [angle.clamp(low, high), from[1] + part * (to[1] - from[1])]
    };
    let beyond =
        |limit: f64, sign: f64| sign * from[0] > sign * limit && sign * to[0] > sign * limit;
    if beyond(high, 1.0) || beyond(low, -1.0) {
        None
    } else if run == 0.0 {
        Some([from, to])
    } else {
        Some([at(from[0]), at(to[0])])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(push_angle_deg: &[f64], distances: usize) -> Grid {
        Grid {
            push_angle_deg: push_angle_deg.to_vec(),
            distance_mm: (0..distances).map(|row| row as f64).collect(),
            taper: None,
            curvature_per_mm: None,
        }
    }

    #[test]
    fn the_cell_nearest_detachment_tells_where_it_is() {
        let grid = grid(&[-20.0, -10.0, 0.0, 10.0], 2);
        let nan = f32::NAN;
        let margins = Samples::F32(vec![nan, 4.0, 14.5, 4.0, nan, 2.0, 12.0, nan]);
        assert_eq!(
            segments(&grid, &margins),
            [[[-14.0, 0.0], [-12.0, 1.0]], [[14.0, 0.0], [12.0, 1.0]]]
        );
    }

    #[test]
    fn the_boundary_breaks_at_jumps_and_gaps_and_ends_at_the_axis() {
        let grid = grid(&[0.0, 10.0], 6);
        let (nan, free) = (f32::NAN, f32::NAN);
        let margins = [5.0, 5.5, 14.0, free, 14.0, 16.0];
        let cells = margins.into_iter().flat_map(|margin| [margin, nan]);
        assert_eq!(
            segments(&grid, &Samples::F32(cells.collect())),
            [
                [[5.0, 0.0], [5.5, 1.0]],
                // From 14 at 4 mm to 16 at 5 mm, on an axis that ends at 15.
                [[14.0, 4.0], [15.0, 4.5]],
            ]
        );
    }
}
