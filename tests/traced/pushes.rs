//! Detachments of traced whiskers.

use super::{points, resting};
use crate::random_rods::Random;
use crate::shipped;
use whiskmap::Side;
use whiskmap::scene::{Curvature, EulerSpiral, Parameter, Scene, Whisker};
use whiskmap::trace::curve;
use whiskmap::traced::TracedShape;

const DISTANCES_MM: [f64; 6] = [3.0, 6.0, 9.0, 12.0, 15.0, 18.0];

fn cone() -> Scene {
    shipped::scene("cone")
}

/// The largest difference of the detachment angles of two whiskers, in degrees, over both sides and all distances.
fn apart(scene: &Scene, one: &Whisker, other: &Whisker) -> f64 {
    let mut worst = 0.0_f64;
    for side in Side::BOTH {
        let [one, other] =
            [one, other].map(|whisker| curve(whisker, &scene.pole, side, &DISTANCES_MM));
        for (one, other) in one.iter().zip(&other) {
            let [a, b] = [one, other].map(|end| end.push_angle_deg.unwrap());
            worst = worst.max((a - b).abs());
        }
    }
    worst
}

/// The whisker with its shape traced exactly at 100 points.
fn traced(whisker: &Whisker, degree: usize) -> Whisker {
    let points = points(&resting(whisker), whisker.length_mm, 100, 0.0, &mut Random::new(1));
    let shape = TracedShape::fit(points, Some(degree)).unwrap();
    Whisker {
        curvature: None,
        euler_spiral: None,
        traced: Some(shape.curvature),
        ..whisker.clone()
    }
}

/// A spiral has a curvature of degree 1: its traced shape detaches at the same angles. Measured: 1.4e-12 degrees.
#[test]
fn a_traced_spiral_detaches_as_the_spiral() {
    let scene = cone();
    let whisker = Whisker {
        curvature: None,
        euler_spiral: Some(EulerSpiral { per_mm: 0.05, per_mm2: -0.005 }),
        ..scene.whisker.clone()
    };
    for degree in [1, 4] {
        let apart = apart(&scene, &whisker, &traced(&whisker, degree));
        assert!(apart < 2e-11, "{degree}: {apart:e}");
    }
}

/// The curvature of a parabola is no polynomial: with the degrees 2, 4 and 6, detachment angles are off
/// by 0.034, 6.5e-4 and 1.3e-5 degrees, measured.
#[test]
fn a_traced_parabola_detaches_as_the_parabola() {
    let scene = cone();
    let whisker = Whisker {
        curvature: Some(Curvature { parabola_per_mm: 0.02, vertex_mm: 0.0 }),
        ..scene.whisker.clone()
    };
    let errors = [2, 4, 6].map(|degree| apart(&scene, &whisker, &traced(&whisker, degree)));
    assert!(errors[0] < 0.04 && errors[1] < 8e-4 && errors[2] < 1.6e-5, "{errors:?}");
}

/// A whisker twice as long, at a pole twice as thick and twice as far away, has the same angles: the shape is scaled with the length.
/// Measured: no difference.
#[test]
fn a_longer_whisker_has_the_same_shape() {
    let scene = shipped::scene("traced");
    let length_mm = scene.whisker.length_mm;
    let longer = scene
        .with_parameters(&[
            (Parameter::LengthMm, 2.0 * length_mm),
            (Parameter::PoleRadiusMm, 2.0 * scene.pole.radius_mm),
        ])
        .unwrap();
    assert_eq!(longer.whisker.traced, scene.whisker.traced);
    let twice = DISTANCES_MM.map(|distance_mm| 2.0 * distance_mm);
    for side in Side::BOTH {
        let ends = curve(&scene.whisker, &scene.pole, side, &DISTANCES_MM);
        let other = curve(&longer.whisker, &longer.pole, side, &twice);
        for (end, other) in ends.iter().zip(other) {
            let [a, b] = [end.push_angle_deg, other.push_angle_deg].map(Option::unwrap);
            assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
    }
}
