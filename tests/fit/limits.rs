//! Parameters that points do not determine, limits of the scene, and points without a prediction.

use super::{DISTANCES_MM, cone, detachments};
use whiskmap::fit::{Fit, FitError, fit};
use whiskmap::measured::{MeasuredAngle, MeasuredPoints};
use whiskmap::random::RandomStream;
use whiskmap::scene::Parameter::{self, *};
use whiskmap::scene::Scene;

/// Which parameters have a standard error.
fn determined(fit: &Fit) -> Vec<Parameter> {
    let known = fit.estimates.iter().filter(|estimate| estimate.standard_error.is_some());
    known.map(|estimate| estimate.parameter).collect()
}

#[test]
fn no_detachment_depends_on_the_modulus() {
    let points = detachments(&cone(), MeasuredAngle::Push, &DISTANCES_MM);
    let found = fit(&cone(), &points, &[YoungsModulusGpa]).unwrap();
    assert_eq!(determined(&found), []);
    assert_eq!((found.estimates[0].value, found.degrees_of_freedom), (3.0, 24));
    let truth = cone().with_parameters(&[(TipRadiusUm, 2.0)]).unwrap();
    let points = detachments(&truth, MeasuredAngle::Push, &DISTANCES_MM);
    let found = fit(&cone(), &points, &[YoungsModulusGpa, TipRadiusUm]).unwrap();
    assert_eq!(determined(&found), [TipRadiusUm]);
    assert_eq!(found.correlation, [[None, None], [None, Some(1.0)]]);
    assert!((found.estimates[1].value - 2.0).abs() < 1e-8);
}

/// Only the ratio of the radii counts. Slip-offs of a cone, all before its tip, do not even tell where it ends.
#[test]
fn what_counts_only_together_is_not_determined() {
    let truth = cone().with_parameters(&[(TipRadiusUm, 2.0), (ParabolaPerMm, 0.018)]);
    let points = detachments(&truth.unwrap(), MeasuredAngle::Push, &DISTANCES_MM);
    let found = fit(&cone(), &points, &[BaseRadiusUm, ParabolaPerMm, TipRadiusUm]).unwrap();
    assert_eq!(determined(&found), [ParabolaPerMm]);
    assert_eq!(found.degrees_of_freedom, 22);
    let whisker = found.scene.first_whisker().whisker;
    let ratio = whisker.tip_radius_um / whisker.base_radius_um;
    assert!((ratio * 15.0 - 1.0).abs() < 1e-8, "{ratio}");
    assert!((found.estimates[1].value - 0.018).abs() < 1e-9);

    let found = fit(&cone(), &points, &[BaseRadiusUm, ParabolaPerMm, Taper]).unwrap();
    assert_eq!(determined(&found), [ParabolaPerMm, Taper]);
    assert_eq!((found.estimates[0].value, found.degrees_of_freedom), (30.0, 22));

    let slips = MeasuredPoints {
        points: points.points.iter().copied().filter(|point| point.distance_mm < 16.5).collect(),
        ..points
    };
    let found = fit(&cone(), &slips, &[LengthMm, ParabolaPerMm, TipRadiusUm]).unwrap();
    assert_eq!(determined(&found), [ParabolaPerMm]);
}

#[test]
fn an_error_beyond_the_range_is_none() {
    let rough = cone().with_parameters(&[(Friction, 0.2)]).unwrap();
    let mut points = detachments(&rough, MeasuredAngle::Push, &DISTANCES_MM);
    points.have_deviations = true;
    for (sd_deg, known) in [(1.0, vec![Friction]), (1e3, vec![])] {
        points.points.iter_mut().for_each(|point| point.sd_deg = sd_deg);
        let found = fit(&cone(), &points, &[Friction]).unwrap();
        assert_eq!(determined(&found), known);
    }
}

#[test]
fn as_many_points_as_parameters_have_no_error_of_their_own() {
    let mut points = detachments(&cone(), MeasuredAngle::Push, &[12.0]);
    let free = [TipRadiusUm, ParabolaPerMm];
    let found = fit(&cone(), &points, &free).unwrap();
    assert_eq!((determined(&found), found.degrees_of_freedom), (vec![], 0));
    points.have_deviations = true;
    assert_eq!(determined(&fit(&cone(), &points, &free).unwrap()), free);
    points.points.pop();
    let few = FitError::TooFew { origin: "points.csv".to_owned(), free: 2, used: 1 };
    assert_eq!(fit(&cone(), &points, &free), Err(few));
}

/// The limits, 0 and 30, are met from inside, and held by errors that pull beyond them.
#[test]
fn parameters_stay_within_the_scene() {
    let start = cone().with_parameters(&[(Friction, 0.3)]).unwrap();
    let mut points = detachments(&cone(), MeasuredAngle::Push, &DISTANCES_MM);
    let found = fit(&start, &points, &[Friction, TipRadiusUm]).unwrap();
    assert!(found.estimates[0].value.abs() < 1e-8 && (found.estimates[1].value - 1.5).abs() < 1e-8);

    // Less friction than none would fit better: then the others fit as if it were not free.
    for point in &mut points.points {
        point.angle_deg *= 0.98;
    }
    for from in [0.0, 0.3] {
        let start = cone().with_parameters(&[(Friction, from)]).unwrap();
        let found = fit(&start, &points, &[Friction, TipRadiusUm, ParabolaPerMm]).unwrap();
        let alone = fit(&cone(), &points, &[TipRadiusUm, ParabolaPerMm]).unwrap();
        assert_eq!((found.estimates[0].value, found.estimates[0].is_at_limit), (0.0, true));
        assert!((found.chi_square / alone.chi_square - 1.0).abs() < 1e-9);
        // A parameter at its limit is held, so that the others are as certain as without it.
        assert_eq!(found.estimates[0].standard_error, None);
        assert_eq!(found.degrees_of_freedom, alone.degrees_of_freedom);
        for (one, other) in found.estimates[1..].iter().zip(&alone.estimates) {
            let errors = [one, other].map(|estimate| estimate.standard_error.unwrap());
            // Measured: 2e-6.
            assert!((errors[0] / errors[1] - 1.0).abs() < 1e-4, "{errors:?}");
            assert!((one.value / other.value - 1.0).abs() < 1e-5, "{one:?} {other:?}");
            assert!(!one.is_at_limit);
        }
    }
}

/// A start at a limit is left.
#[test]
fn a_cylinder_becomes_a_cone_and_a_cone_a_cylinder() {
    let cylinder = cone().with_parameters(&[(TipRadiusUm, 30.0)]).unwrap();
    for (start, truth, tip_um) in [(&cylinder, &cone(), 1.5), (&cone(), &cylinder, 30.0)] {
        let points = detachments(truth, MeasuredAngle::Push, &DISTANCES_MM);
        let found = fit(start, &points, &[TipRadiusUm]).unwrap();
        assert!((found.estimates[0].value - tip_um).abs() < 1e-7, "{found:?}");
    }
}

/// Shorter whiskers do not reach the last point: such steps are taken back.
#[test]
fn the_whisker_keeps_reaching_its_points() {
    let truth = cone().with_parameters(&[(LengthMm, 21.0)]).unwrap();
    let start = cone().with_parameters(&[(LengthMm, 26.0)]).unwrap();
    let distances = [10.0, 14.0, 19.0, 20.0, 20.6];
    let mut random = RandomStream::of_state(1);
    let mut points = detachments(&truth, MeasuredAngle::Push, &distances);
    for point in &mut points.points {
        point.angle_deg += 0.01 * random.normal();
    }
    let found = fit(&start, &points, &[LengthMm]).unwrap();
    assert!((found.estimates[0].value - 21.0).abs() < 0.01, "{found:?}");
}

/// Beyond a hinge nothing slips off.
#[test]
fn points_that_never_detach_are_left_out() {
    let hinged = "title = 'A hinge'\n[whisker]\nlength_mm = 20\nyoungs_modulus_gpa = 3\n\
                  profile.rows = [[0, 30], [2, 7.5], [3, 30], [20, 30]]\n\
                  [grid]\npush_angle_deg = [5, 10]\ndistance_mm = [8, 19]\n";
    let scene = Scene::parse(hinged, "hinged.toml").unwrap();
    let text = "side,distance_mm,push_angle_deg\ncb,19,13\ncb,8,40\n";
    let points = MeasuredPoints::parse(text, "points.csv").unwrap();
    let found = fit(&scene, &points, &[YoungsModulusGpa]).unwrap();
    let left_out: Vec<usize> = found.comparison.left_out().map(|row| row.line).collect();
    assert_eq!((left_out, found.comparison.count()), (vec![3], 1));
    assert_eq!(found.degrees_of_freedom, 1);
}

/// A whisker with measured radii and detachments, of which the last ones may be pull-offs.
fn measured(extension: f64, points: &str) -> (Scene, MeasuredPoints) {
    let text = format!(
        r#"title = "measured"
        [whisker]
        length_mm = 23.5
        youngs_modulus_gpa = 3.2
        profile = {{ tip_extension_mm = {extension}, rows = [[0, 61.2], [3.5, 55.8], [7, 46.1], [10.5, 39.9], [14, 31.4], [17.5, 24.7], [21, 13.9], [23.5, 8.1]] }}
        curvature = {{ parabola_per_mm = 0.01 }}
        [pole]
        radius_mm = 0.25
        [grid]
        push_angle_deg = [10]
        distance_mm = [10]
        "#
    );
    let scene = Scene::parse(&text, "measured").unwrap();
    let header = "side,distance_mm,push_angle_deg,kind,sd_deg\n";
    let points = MeasuredPoints::parse(&format!("{header}{points}"), "points").unwrap();
    (scene, points)
}

const SLIPS: &str = "cf,8,-63.6,slip-off,1.2\ncf,11,-56.9,slip-off,1.2\ncf,14,-45.2,slip-off,1\ncf,17,-38.3,slip-off,1\n\
                     cb,11,44.3,slip-off,1.2\ncb,14,36.0,slip-off,1\ncb,20,15.6,slip-off,0.8\ncb,22,10.9,slip-off,0.8\n";

/// No slip-off depends on where the tip is: the extension keeps its start value, and is not determined.
#[test]
fn an_extension_without_pull_offs_stays() {
    for start in [0.3, 1.0, 2.0] {
        let (scene, points) = measured(start, SLIPS);
        let found = fit(&scene, &points, &[ParabolaPerMm, TipExtensionMm]).unwrap();
        let [_, extension] = found.estimates[..] else {
            panic!("{found:?}");
        };
        assert_eq!(determined(&found), [ParabolaPerMm], "{start}");
        assert_eq!((extension.value, extension.is_at_limit), (start, false));
    }
}

/// From some starts, a search ends at the sharpest tip, where pull-offs are slip-offs. Further starts find the better minimum.
#[test]
fn a_local_minimum_at_a_limit_is_left() {
    let pulls = format!("{SLIPS}cb,24,5.1,pull-off,0.5\ncb,24.3,4.2,pull-off,0.5\n");
    let mut values = Vec::new();
    for start in [1.5, 2.0, 2.5] {
        let (scene, points) = measured(start, &pulls);
        let found = fit(&scene, &points, &[ParabolaPerMm, TipExtensionMm]).unwrap();
        assert_eq!(determined(&found), [ParabolaPerMm, TipExtensionMm], "{start}");
        assert_eq!(found.comparison.of_another_kind(), 0, "{start}");
        values.push(found.estimates[1].value);
    }
    assert!(values.iter().all(|value| (value / values[0] - 1.0).abs() < 1e-6), "{values:?}");
}

/// A fit takes differences where the push of a point ends at first touch, because such a point has no derivative.
#[test]
fn a_point_at_first_touch_does_not_end_a_fit() {
    let straight = cone().with_parameters(&[(ParabolaPerMm, 0.0), (PoleRadiusMm, 0.0)]);
    let straight = straight.unwrap();
    let truth = straight.with(TipRadiusUm, 2.0).unwrap();
    let mut points = detachments(&truth, MeasuredAngle::Push, &DISTANCES_MM);
    let at_reach = "side,distance_mm,push_angle_deg\ncb,20,0\n";
    points.points.extend(MeasuredPoints::parse(at_reach, "reach").unwrap().points);
    let found = fit(&straight, &points, &[TipRadiusUm]).unwrap();
    assert!((found.estimates[0].value - 2.0).abs() < 1e-6, "{:?}", found.estimates);
}
