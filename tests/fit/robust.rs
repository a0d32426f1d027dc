//! Losses that outliers hardly change, and pulls of points.

use super::{DISTANCES_MM, cone, detachments, free};
use std::sync::atomic::AtomicBool;
use whiskmap::fit::{Fit, FitLoss, fit, fit_until};
use whiskmap::measured::{MeasuredAngle, MeasuredPoints};
use whiskmap::random::RandomStream;
use whiskmap::scene::Parameter::{self, ParabolaPerMm, TipRadiusUm};

const TRUTH: [(Parameter, f64); 2] = [(TipRadiusUm, 2.5), (ParabolaPerMm, 0.018)];

/// Detachments of the truth with normal errors of this standard deviation, which the points give.
fn noisy(sd_deg: f64, seed: u64) -> MeasuredPoints {
    let truth = cone().with_parameters(&TRUTH).unwrap();
    let mut points = detachments(&truth, MeasuredAngle::Push, &DISTANCES_MM);
    points.have_deviations = true;
    let mut random = RandomStream::of_state(seed);
    for point in &mut points.points {
        point.angle_deg += sd_deg * random.normal();
        point.sd_deg = sd_deg;
    }
    points
}

fn fitted(points: &MeasuredPoints, loss: FitLoss) -> Fit {
    let never = AtomicBool::new(false);
    fit_until(&cone(), points, &free(&TRUTH), loss, &never).unwrap()
}

/// Errors of the estimates over their standard errors, `[parameter]`.
fn errors(fit: &Fit) -> Vec<f64> {
    let pairs = fit.estimates.iter().zip(TRUTH);
    pairs
        .map(|(estimate, (_, truth))| (estimate.value - truth) / estimate.standard_error.unwrap())
        .collect()
}

/// Three rows of 24 that are 40 standard deviations off are named, and do not move the estimates by more than 3 standard errors.
#[test]
fn outliers_are_named_and_hardly_pull() {
    let mut points = noisy(0.3, 7);
    let rows = [3, 11, 17];
    for row in rows {
        points.points[row].angle_deg += 12.0;
    }
    let squares = fitted(&points, FitLoss::Squares);
    assert!(squares.warnings(&points).iter().all(|point| !point.contains("outlier")));
    for loss in [FitLoss::SoftL1, FitLoss::Huber] {
        let found = fitted(&points, loss);
        assert!(
            errors(&found).iter().all(|error| error.abs() < 3.0),
            "{loss:?}: {:?}",
            errors(&found)
        );
        let off = |fit: &Fit| (fit.estimates[0].value - TRUTH[0].1).abs();
        assert!(off(&found) < 0.2 * off(&squares), "{loss:?}: {} {}", off(&found), off(&squares));
        let warnings = found.warnings(&points);
        assert_eq!(warnings.len(), 3, "{warnings:?}");
        for (row, warning) in rows.iter().zip(&warnings) {
            let said = format!("points.csv:{}: outlier: residual ", row + 2);
            assert!(warning.starts_with(&said) && warning.contains("weight 0.0"), "{warning}");
        }
        // Without standard deviations, the median of the residuals is the scale of outliers.
        let mut bare = points.clone();
        bare.have_deviations = false;
        bare.points.iter_mut().for_each(|point| point.sd_deg = 1.0);
        assert_eq!(fitted(&bare, loss).warnings(&bare).len(), 3);
    }
}

/// The standard errors of robust fits are as large as their errors, with every tenth point 10 standard deviations off.
#[test]
fn standard_errors_of_robust_fits_are_as_large_as_their_errors() {
    for loss in [FitLoss::SoftL1, FitLoss::Huber] {
        let mut squares = 0.0;
        for seed in 0..100 {
            let mut points = noisy(0.3, seed);
            for (i, point) in points.points.iter_mut().enumerate().filter(|(i, _)| i % 10 == 4) {
                point.angle_deg += if i == 14 { -3.0 } else { 3.0 };
            }
            let found = fitted(&points, loss);
            squares += errors(&found).iter().map(|error| error * error).sum::<f64>() / 200.0;
        }
        // 1 if they are right; of so many numbers, 0.7 and 1.3 are three deviations off.
        assert!((0.7..1.3).contains(&squares), "{loss:?}: {squares}");
    }
}

/// The pull of a row is the change of the estimate in a fit without it, to first order.
#[test]
fn a_pull_is_the_change_without_the_row() {
    let points = noisy(0.05, 3);
    for loss in FitLoss::ALL {
        let whole = fitted(&points, loss);
        assert_eq!(whole.pulls.len(), points.points.len());
        assert!(
            whole.pulls.is_sorted_by(|a, b| a.standard_errors.abs() >= b.standard_errors.abs())
        );
        let strongest = whole.pulls[0];
        let mut without = points.clone();
        without.points.retain(|point| point.line != strongest.line);
        let other = fitted(&without, loss);
        let place =
            whole.estimates.iter().position(|estimate| estimate.parameter == strongest.parameter);
        let place = place.unwrap();
        let [before, after] = [&whole, &other].map(|fit| fit.estimates[place].value);
        let moved = (after - before) / whole.estimates[place].standard_error.unwrap();
        let ratio = strongest.standard_errors / moved;
        // Measured: 1.00 for squares. Of the losses, the mean curvature takes the place of each point's own.
        let most = if loss == FitLoss::Squares { 0.02 } else { 0.5 };
        assert!((ratio - 1.0).abs() < most, "{loss:?}: {strongest:?} {moved}");
    }
    let exact = detachments(&cone(), MeasuredAngle::Push, &DISTANCES_MM);
    assert_eq!(fit(&cone(), &exact, &free(&TRUTH)).unwrap().loss, FitLoss::Squares);
}
