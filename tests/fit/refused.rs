//! What a fit refuses.

use super::{DISTANCES_MM, cone, detachments};
use crate::shipped;
use whiskmap::fit::fit;
use whiskmap::measured::MeasuredAngle;
use whiskmap::scene::Parameter::{self, *};
use whiskmap::scene::Scene;

/// The message of a fit that is refused.
fn message(scene: &Scene, free: &[Parameter]) -> String {
    let points = detachments(&cone(), MeasuredAngle::Push, &DISTANCES_MM);
    fit(scene, &points, free).unwrap_err().to_string()
}

#[test]
fn parameters_that_cannot_be_free() {
    let cylinder = shipped::scene("cylinder");
    let said = message(&cylinder, &[TipRadiusUm, Friction]);
    assert!(said.starts_with(
        "friction: the scene has no contact.friction; give it a value to start from, or free some of length_mm, base_radius_um,"
    ), "{said}");
    assert_eq!(
        message(&cone(), &[TipRadiusUm, Taper]),
        "tip_radius_um and taper: both are whisker.tip_radius_um; one of them may be free"
    );
    assert_eq!(message(&cone(), &[]), "no parameter is free");
    let measured = shipped::scene("measured");
    let said = message(&measured, &[LengthMm]);
    assert!(
        said.starts_with("length_mm: the rest of the scene allows no values but 19.99"),
        "{said}"
    );
}

/// The stretch may be 1 to 1/taper, which is 1.000005 here: derivatives need no steps inside the range.
#[test]
fn a_narrow_range_ends_at_its_limit() {
    let sharp = cone().with(Parameter::TipRadiusUm, 1.5e-4).unwrap();
    let points = detachments(&cone(), MeasuredAngle::Push, &DISTANCES_MM);
    let [stretch] = fit(&sharp, &points, &[ArcStretch]).unwrap().estimates[..] else {
        panic!("one parameter is free");
    };
    assert!(stretch.is_at_limit && stretch.value == 1.0, "{stretch:?}");
    assert_eq!(stretch.standard_error, None);
}

#[test]
fn points_beyond_the_whisker() {
    let short = cone().with(Parameter::LengthMm, 19.0).unwrap();
    let said = message(&short, &[TipRadiusUm]);
    assert!(
        said.starts_with(
            "points.csv:12: distance_mm = 19.2: must be between 0.019 (length_mm / 1000) and 18."
        ),
        "{said}"
    );
}
