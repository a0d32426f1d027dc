//! The detachment boundary of a stored map, from the margins of the cells next to it.

use crate::scene::Grid;
use crate::store::ChannelValues;
use whiskmap_plot::CellAxis;

/// Boundaries of neighbouring rows are not connected if they lie farther apart than this fraction of the axis.
const JUMP: f64 = 0.25;

/// Returns the detachment boundary on both sides of the whisker, inside the axis: lines through points `[push angle (deg), distance
/// (mm)]`, `[line][point]`. In each row and side, the whisker detaches at the push angle of the cell with the smallest margin, plus that
/// margin away from 0. There is no line across a single push angle.
pub fn stretches(grid: &Grid, margin_deg: &ChannelValues) -> Vec<Vec<[f64; 2]>> {
    if grid.push_angle_deg.len() < 2 {
        return Vec::new();
    }
    let [low, high] = CellAxis::new("", &grid.push_angle_deg).range();
    let mut stretches: Vec<Vec<[f64; 2]>> = Vec::new();
    for side in [-1.0, 1.0] {
        let rows = grid.distance_mm.iter().enumerate();
        let rows: Vec<Option<[f64; 2]>> = rows
            .map(|(row, distance)| Some([detachment(grid, margin_deg, row, side)?, *distance]))
            .collect();
        for pair in rows.windows(2) {
            if let [Some(from), Some(to)] = *pair
                && (from[0] - to[0]).abs() <= JUMP * (high - low)
                && let Some([from, to]) = clip([from, to], low, high)
            {
                match stretches.last_mut() {
                    Some(stretch) if stretch.last() == Some(&from) => stretch.push(to),
                    _ => stretches.push(vec![from, to]),
                }
            }
        }
    }
    stretches
}

/// The push angle in degrees at which the whisker detaches in a row, CF for `side` -1 and CB for 1.
fn detachment(grid: &Grid, margin_deg: &ChannelValues, row: usize, side: f64) -> Option<f64> {
    let angles = &grid.push_angle_deg;
    let cells = angles.iter().enumerate().filter_map(|(column, angle)| {
        let margin = margin_deg.value(row * angles.len() + column);
        let on_side = (*angle < 0.0) == (side < 0.0);
        (on_side && margin.is_finite()).then_some((margin, angle + side * margin))
    });
    cells.min_by(|(one, _), (other, _)| one.total_cmp(other)).map(|(_, angle)| angle)
}

/// The part of a segment between the push angles `low` and `high`.
fn clip([from, to]: [[f64; 2]; 2], low: f64, high: f64) -> Option<[[f64; 2]; 2]> {
    let inside = |[angle, _]: [f64; 2]| (low..=high).contains(&angle);
    let at = |end: [f64; 2]| {
        if inside(end) {
            return end;
        }
        let angle = end[0].clamp(low, high);
        let part = (angle - from[0]) / (to[0] - from[0]);
        [angle, from[1] + part * (to[1] - from[1])]
    };
    let beyond = |limit: f64, sign: f64| [from, to].iter().all(|end| sign * end[0] > sign * limit);
    (!beyond(high, 1.0) && !beyond(low, -1.0)).then(|| [at(from), at(to)])
}
