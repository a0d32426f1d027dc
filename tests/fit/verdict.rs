//! What is not a fit, and what stays one.

use super::{DISTANCES_MM, cone, detachments};
use whiskmap::fit::{Fit, LikelyCause, fit};
use whiskmap::measured::{MeasuredAngle, MeasuredPoint, MeasuredPoints};
use whiskmap::random::RandomStream;
use whiskmap::scene::Parameter::{ParabolaPerMm, TipRadiusUm};

/// The detachments of another cone, each changed by `change`, and fitted.
fn changed(have_deviations: bool, change: impl Fn(&mut MeasuredPoint)) -> Fit {
    let truth = [(TipRadiusUm, 2.5), (ParabolaPerMm, 0.018)];
    let truth = cone().with_parameters(&truth).unwrap();
    let mut points = detachments(&truth, MeasuredAngle::Push, &DISTANCES_MM);
    points.have_deviations = have_deviations;
    points.points.iter_mut().for_each(change);
    fit(&cone(), &points, &[TipRadiusUm, ParabolaPerMm]).unwrap()
}

#[test]
fn wrong_units_are_not_a_fit() {
    let radians = changed(true, |point| {
        point.angle_deg = point.angle_deg.to_radians();
        point.sd_deg = 0.01;
    });
    let centimetres = changed(false, |point| point.distance_mm /= 10.0);
    for (found, cause, has_chi_square) in
        [(radians, LikelyCause::Radians, true), (centimetres, LikelyCause::Centimetres, false)]
    {
        let why = found.not_a_fit.as_ref().unwrap();
        assert_eq!(why.cause, Some(cause), "{why}");
        assert_eq!(why.reduced_chi_square.is_some(), has_chi_square);
        let mut errors = found.estimates.iter().map(|estimate| estimate.standard_error);
        assert!(errors.all(|error| error.is_none()));
        assert_eq!(found.correlation, [[None; 2]; 2]);
    }
    let turned = changed(false, |point| point.angle_deg = -point.angle_deg);
    let why = turned.not_a_fit.unwrap();
    assert_eq!((why.cause, why.largest_rms_deg), (None, 5.0));
    let said = why.to_string();
    assert!(
        said.starts_with("not a fit: RMS ") && said.ends_with(" deg, must be at most 5 deg"),
        "{said}"
    );
}

/// Errors of 3 degrees, deviations that are ten times too small, and points of low precision that are far off.
#[test]
fn noisy_points_stay_a_fit() {
    for (noise_deg, sd_deg, is_explained) in
        [(3.0, 3.0, true), (1.0, 0.1, false), (12.0, 12.0, true)]
    {
        let random = std::cell::RefCell::new(RandomStream::of_state(7));
        let found = changed(true, |point| {
            point.angle_deg += noise_deg * random.borrow_mut().normal();
            point.sd_deg = sd_deg;
        });
        assert_eq!(found.not_a_fit, None, "{noise_deg}");
        assert_eq!(found.is_explained(), is_explained, "{noise_deg}");
        assert!(found.estimates[0].standard_error.is_some());
    }
}

/// The scene's kind of whisker explains the angles, but not the deviations.
#[test]
fn absurd_deviations_are_not_a_fit() {
    for (sd_deg, cause) in
        [(3.0_f64.to_radians(), Some(LikelyCause::RadianDeviations)), (0.001, None)]
    {
        let random = std::cell::RefCell::new(RandomStream::of_state(7));
        let found = changed(true, |point| {
            point.angle_deg += 3.0 * random.borrow_mut().normal();
            point.sd_deg = sd_deg;
        });
        let why = found.not_a_fit.unwrap();
        assert_eq!(why.cause, cause, "{why}");
        assert!(why.rms_deg < why.largest_rms_deg, "{why}");
        assert!(why.reduced_chi_square.unwrap() > 400.0, "{why}");
        assert!(!why.to_string().contains("at most"), "{why}");
        assert_eq!(found.estimates[0].standard_error, None);
    }
}

/// Their range is that of their errors; a third of it does not bound the fit.
#[test]
fn repeated_measurements_at_one_distance_stay_a_fit() {
    let text = "side,distance_mm,push_angle_deg\ncb,15,18\ncb,15,20.5\ncb,15,16\n";
    let points = MeasuredPoints::parse(text, "points.csv").unwrap();
    let found = fit(&cone(), &points, &[TipRadiusUm]).unwrap();
    assert_eq!(found.not_a_fit, None);
    assert!(found.estimates[0].standard_error.is_some());
}
