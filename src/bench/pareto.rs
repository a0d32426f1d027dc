//! Which rows are worth choosing.

use super::Measurement;

/// Marks the rows that no other row beats in both time and worst error of the angle.
pub fn mark(rows: &mut [Measurement]) {
    let places: Vec<[f64; 2]> = rows
        .iter()
        .map(|row| [row.us_per_state, row.errors.angle_deg.worst])
        .collect();
    for (row, here) in rows.iter_mut().zip(&places) {
        let beats = |other: &[f64; 2]| other[0] <= here[0] && other[1] <= here[1] && other != here;
        row.pareto = !places.iter().any(beats);
    }
}
