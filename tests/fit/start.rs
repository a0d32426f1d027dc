//! Points that the scene's whisker does not reach, but the fitted one does.

use super::{DISTANCES_MM, cone, detachments};
use whiskmap::fit::{FitError, fit};
use whiskmap::measured::MeasuredAngle;
use whiskmap::scene::Parameter::{self, *};

/// The scene's whisker ends before the farthest points, on which the true one slips off and is pulled off.
#[test]
fn a_free_length_starts_where_all_points_are_in_reach() {
    let points = detachments(&cone(), MeasuredAngle::Push, &DISTANCES_MM);
    for (start, free) in [
        (vec![(LengthMm, 17.0)], vec![LengthMm]),
        (vec![(LengthMm, 14.0)], vec![LengthMm, ParabolaPerMm]),
        (vec![(ParabolaPerMm, 0.04)], vec![ParabolaPerMm]),
    ] {
        let short = cone().with_parameters(&start).unwrap();
        let found = fit(&short, &points, &free).unwrap();
        let moved = found.moved.unwrap();
        assert_eq!(moved.parameter, start[0].0);
        assert!(points.points.iter().any(|point| point.line == moved.line
            && point.distance_mm == moved.distance_mm
            && point.distance_mm > 12.0));
        for estimate in &found.estimates {
            let truth = estimate.parameter.value(&cone()).unwrap();
            // Measured: at most 6e-14.
            let off = estimate.value / truth - 1.0;
            assert!(off.abs() < 1e-9, "{start:?}: {estimate:?}");
        }
        assert_eq!(found.comparison.left_out().count(), 0);
    }
    let found = fit(&cone(), &points, &[LengthMm]).unwrap();
    assert_eq!(found.moved, None);
}

/// No radius changes the reach, and a length that is twice as large is an error of the points.
#[test]
fn points_that_no_start_reaches_are_refused() {
    let mut points = detachments(&cone(), MeasuredAngle::Push, &DISTANCES_MM);
    let short = cone().with_parameters(&[(LengthMm, 17.0)]).unwrap();
    let refused = |points: &_, free: &[Parameter]| match fit(&short, points, free) {
        Err(FitError::Points(why)) => why.to_string(),
        other => panic!("{other:?}"),
    };
    let why = refused(&points, &[TipRadiusUm, YoungsModulusGpa]);
    assert!(why.starts_with("points.csv:11: distance_mm = 17.5: must be between 0.017"), "{why}");
    points.points[11].distance_mm = 50.0;
    let why = refused(&points, &[LengthMm]);
    assert!(why.contains("distance_mm = "), "{why}");
}

#[test]
fn a_parameter_that_is_free_twice_counts_once() {
    let points = detachments(&cone(), MeasuredAngle::Push, &DISTANCES_MM);
    let once = fit(&cone(), &points, &[LengthMm, TipRadiusUm]);
    let twice = fit(&cone(), &points, &[LengthMm, TipRadiusUm, LengthMm]);
    assert_eq!(once, twice);
}
