//! Comparison with closed forms.

use super::{POINT, whisker};
use whiskmap::Side;
use whiskmap::paper::elastica::{elastica, fold};
use whiskmap::paper::{CheckVerdict, checks};
use whiskmap::trace::{Branch, DetachmentKind, curve};

/// Ten turning angles of the straight cylinder at a point contact, up to the fold at 119 degrees, and the fold. [`checks`] has the digits of
/// the fold.
#[test]
fn the_straight_cylinder_is_the_elastica() {
    let cylinder = whisker(30.0, 0.0);
    for side in Side::BOTH {
        let branch = Branch::new(&cylinder, &POINT, side, 8.0).unwrap();
        for degrees in [1.0, 12.0, 24.0, 36.0, 48.0, 60.0, 75.0, 90.0, 105.0, 115.0] {
            let exact = elastica(f64::to_radians(degrees));
            let state = branch.state(side.sign() * exact.push, true).unwrap();
            let arc = state.point.x / 0.4;
            let load = state.point.y.abs() * 0.16;
            assert!((arc - exact.arc_over_distance).abs() < 1e-10, "{degrees}: {arc}");
            assert!((load / exact.load - 1.0).abs() < 1e-10, "{degrees}: {load}");
            let turned = branch.read(&state).contact_angle_deg;
            assert!((turned.abs() - degrees).abs() < 1e-10, "{degrees}: {turned}");
        }
        for end in curve(&cylinder, &POINT, side, &[2.0, 8.0, 11.0]) {
            assert_eq!(end.kind, DetachmentKind::SlipOff);
            let push = end.push_angle_deg.unwrap() * side.sign();
            assert!((push - fold().push.to_degrees()).abs() < 1e-10, "{push}");
        }
    }
}

/// Values of an independent evaluation, to 9 digits.
#[test]
fn an_elastica_that_turns_by_60_degrees() {
    let state = elastica(60_f64.to_radians());
    for (value, known) in [
        (state.push.to_degrees(), 39.751_229_68),
        (state.arc_over_distance, 1.051_451_76),
        (state.load, 1.967_754_50),
    ] {
        assert!((value - known).abs() < 5e-9, "{state:?}");
    }
}

/// The lemniscate constant is `int_0^1 du/sqrt(1 - u^4)`. At a right angle the contact is at 2 along and at `across` across the axis
/// of the base, in units of `1/sqrt(2f)`.
#[test]
fn the_lemniscate_constant() {
    let state = elastica(std::f64::consts::FRAC_PI_2);
    let distance = (2.0 * state.load).sqrt();
    let (arc, across) = (state.arc_over_distance * distance, (2.0 * state.load - 4.0).sqrt());
    assert!((0.5 * arc - 1.311_028_777_146_06).abs() < 1e-14, "{arc}");
    // Legendre's relation: the product of both lemniscatic integrals is pi/4.
    let product = 0.25 * arc * across;
    assert!((product - std::f64::consts::FRAC_PI_4).abs() < 1e-14, "{across}");
}

/// `M = 3 E I theta (L - a)/(a L)` is the limit of small angles. The difference decreases with the square of the angle.
#[test]
fn a_straight_cone_tends_to_its_small_load_formula() {
    for (tip, a) in [(0.0, 5.0), (0.0, 15.0), (1.5, 15.0), (20.0, 10.0), (30.0, 10.0)] {
        let cone = whisker(tip, 0.0);
        let branch = Branch::new(&cone, &POINT, Side::Cb, a).unwrap();
        let part = a * (1.0 - tip / 30.0) / 20.0;
        let stiffness = cone.units().moment_nnm * 20.0;
        let miss = |push: f64| {
            let moment = branch.read(&branch.state(push, true).unwrap()).base_moment_nnm;
            (moment / (3.0 * stiffness * push * (1.0 - part) / a) - 1.0).abs()
        };
        let (coarse, fine) = (miss(1e-2), miss(1e-3));
        assert!(coarse < 1e-2, "tip {tip} at {a}: {coarse:e}");
        let ratio = coarse / fine;
        assert!((90.0..110.0).contains(&ratio), "tip {tip} at {a}: {coarse:e} {fine:e}");
    }
}

/// The checks of `whiskmap verify`, with the points of the independent solver.
#[test]
fn every_independently_verified_value_is_reproduced() {
    let checks = checks();
    assert!(checks.len() > 30);
    for check in checks {
        let expected = if check.is_disputed { CheckVerdict::Differs } else { CheckVerdict::Pass };
        assert_eq!(check.verdict(), expected, "{check:?}");
        let spoilt = whiskmap::paper::Check { computed: f64::NAN, ..check };
        assert_eq!(spoilt.verdict(), CheckVerdict::Fail, "{spoilt:?}");
    }
}
