//! A scene small enough to be computed only to see how long it takes.

use crate::scene::Scene;

/// Push angles, and distances, of the sample: 16384 cells per whisker. Twelve estimates of shipped scenes were 0.9 to 1.9
/// times what their runs took right after, on two cores busy with other work. Estimates of the cone repeated in one
/// process differed by a factor of 1.25; with 32 lines, of 2.6.
pub const SAMPLE_LINES: usize = 128;

/// Values of a sweep's axis in the sample: four whiskers where there are two axes.
const MOST_VALUES: usize = 2;

/// `scene` with every axis thinned out, its range kept, and at most `lines` push angles and distances.
#[must_use]
pub fn sample(scene: &Scene, lines: usize) -> Scene {
    let mut sample = scene.clone();
    let grid = &mut sample.grid;
    thin(&mut grid.push_angle_deg, lines);
    thin(&mut grid.distance_mm, lines);
    let axes = [&mut grid.taper, &mut grid.curvature_per_mm];
    for values in axes.into_iter().flatten() {
        thin(values, MOST_VALUES);
    }
    sample
}

/// Keeps the middles of at most `most` equal parts.
fn thin(values: &mut Vec<f64>, most: usize) {
    let (all, kept) = (values.len(), values.len().min(most));
    *values = (0..kept)
        .map(|i| values[(2 * i + 1) * all / (2 * kept)])
        .collect();
}

#[cfg(test)]
mod tests {
    use super::thin;

    #[test]
    fn few_values_stay_and_many_are_represented() {
        let thinned = |count: u32, most| {
            let mut values: Vec<f64> = (0..count).map(f64::from).collect();
            thin(&mut values, most);
            values
        };
        assert_eq!(thinned(3, 4), [0.0, 1.0, 2.0]);
        assert_eq!(thinned(16, 2), [4.0, 12.0]);
        assert_eq!(thinned(7, 2), [1.0, 5.0]);
    }
}
