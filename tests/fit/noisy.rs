//! Points with normal errors, always the same: standard errors say how far off a fit is.

use super::{DISTANCES_MM, cone, detachments, free};
use whiskmap::fit::fit;
use whiskmap::measured::MeasuredAngle;
use whiskmap::random::RandomStream;
use whiskmap::scene::Parameter::{ParabolaPerMm, PoleRadiusMm, TipRadiusUm};

/// Number of 100 trials with every parameter within 3 standard errors, and the mean square of all errors over
/// standard errors.
fn trials(have_deviations: bool) -> (usize, f64) {
    let truth = [(TipRadiusUm, 2.5), (ParabolaPerMm, 0.018), (PoleRadiusMm, 0.4)];
    let start = cone();
    let exact =
        detachments(&start.with_parameters(&truth).unwrap(), MeasuredAngle::Push, &DISTANCES_MM);
    let (mut within, mut squares) = (0, 0.0);
    for seed in 0..100 {
        let mut random = RandomStream::of_state(seed);
        let mut points = exact.clone();
        points.have_deviations = have_deviations;
        for (i, point) in points.points.iter_mut().enumerate() {
            let sd_deg = if have_deviations { 0.2 + 0.05 * i as f64 } else { 0.7 };
            point.angle_deg += sd_deg * random.normal();
            if have_deviations {
                point.sd_deg = sd_deg;
            }
        }
        let found = fit(&start, &points, &free(&truth)).unwrap();
        let pulls = found.estimates.iter().zip(&truth).map(|(estimate, (_, value))| {
            (estimate.value - value) / estimate.standard_error.unwrap()
        });
        let pulls: Vec<f64> = pulls.collect();
        within += usize::from(pulls.iter().all(|pull| pull.abs() <= 3.0));
        squares += pulls.iter().map(|pull| pull * pull).sum::<f64>() / 300.0;
        assert_eq!(found.degrees_of_freedom, 24 - 3);
    }
    (within, squares)
}

#[test]
fn standard_errors_are_as_large_as_the_errors_of_fits() {
    for have_deviations in [true, false] {
        // Measured: 98 and 97, and mean squares of 0.98 and 1.07.
        let (within, squares) = trials(have_deviations);
        assert!(within >= 97, "{within}");
        // 1 if they are right; of so many numbers, 0.75 and 1.25 are three deviations off.
        assert!((0.75..1.25).contains(&squares), "{squares}");
    }
}
