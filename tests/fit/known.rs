//! Points without errors: the parameters that they were made with.

use super::{DISTANCES_MM, cone, detachments, free};
use crate::shipped;
use whiskmap::fit::fit;
use whiskmap::measured::MeasuredAngle;
use whiskmap::scene::Parameter::{self, *};
use whiskmap::scene::Scene;

/// Fits `start` to the detachments of the same scene with these values, which must come back.
fn comes_back(start: &Scene, angle: MeasuredAngle, truth: &[(Parameter, f64)]) {
    let scene = start.with_parameters(truth).unwrap();
    let points = detachments(&scene, angle, &DISTANCES_MM);
    let found = fit(start, &points, &free(truth)).unwrap();
    for (estimate, (parameter, value)) in found.estimates.iter().zip(truth) {
        let off = estimate.value / value - 1.0;
        // Measured: at most 2e-12.
        assert!(off.abs() < 1e-10, "{parameter:?} of {truth:?}: {off:e}");
        assert_eq!(estimate.value, parameter.value(&found.scene).unwrap());
        assert!(estimate.standard_error.is_some(), "{parameter:?} of {truth:?}");
    }
    assert!(found.comparison.rms_deg().unwrap() < 1e-8);
    assert_eq!(found.comparison.of_another_kind(), 0);
}

/// Parameters that detachments determine together. The length is known from pull-offs alone, of which there are none at the
/// start.
const ALL: [(Parameter, f64); 7] = [
    (TipRadiusUm, 5.0),
    (ParabolaPerMm, 0.018),
    (VertexMm, 2.0),
    (PoleRadiusMm, 0.4),
    (LengthMm, 20.4),
    (ModulusTipToBase, 1.3),
    (Friction, 0.2),
];

#[test]
fn each_parameter_alone() {
    let others = [(BaseRadiusUm, 40.0), (Taper, 0.8), (ArcStretch, 1.04)];
    for truth in ALL.into_iter().chain(others) {
        comes_back(&cone(), MeasuredAngle::Push, &[truth]);
    }
}

#[test]
fn several_at_once() {
    for truth in [&ALL[..2], &ALL[..3], &ALL[..4], &ALL[3..], &ALL] {
        comes_back(&cone(), MeasuredAngle::Push, truth);
    }
    // Tip, gradient and stretch are two ratios along the whisker.
    let stretched = [ALL[1], ALL[3], (ArcStretch, 1.04), (ModulusTipToBase, 1.3)];
    comes_back(&cone(), MeasuredAngle::Push, &stretched);
}

/// In a follicle, detachments depend on the size of a cone, also where the taper is free.
#[test]
fn the_size_of_a_cone_in_a_follicle() {
    let text = include_str!("../../scenes/cone.toml");
    let follicle = "[whisker.follicle]\nstiffness_nnm_per_rad = 2000\n";
    let scene = Scene::parse(&format!("{text}{follicle}"), "cone.toml").unwrap();
    for truth in [
        &[(BaseRadiusUm, 33.0), (Taper, 0.9)][..],
        &[(Taper, 0.85), (ParabolaPerMm, 0.018), (BaseRadiusUm, 28.0)],
        &[(BaseRadiusUm, 33.0), (TipRadiusUm, 3.0)],
    ] {
        comes_back(&scene, MeasuredAngle::Push, truth);
    }
}

#[test]
fn chord_angles_do_as_well() {
    comes_back(&cone(), MeasuredAngle::Chord, &ALL[..4]);
}

#[test]
fn from_far_away() {
    let truth = [(TipRadiusUm, 15.0), (ParabolaPerMm, 0.005)];
    comes_back(&cone(), MeasuredAngle::Push, &truth);
    let truth = [(TipRadiusUm, 0.1), (ParabolaPerMm, 0.001), (PoleRadiusMm, 1.5)];
    comes_back(&cone(), MeasuredAngle::Push, &truth);
}

#[test]
fn an_euler_spiral_and_measured_radii() {
    let spiral = shipped::scene("euler_spiral");
    let [per_mm, per_mm2] =
        [SpiralPerMm, SpiralPerMm2].map(|parameter| parameter.value(&spiral).unwrap());
    let truth = [(SpiralPerMm, 1.1 * per_mm), (SpiralPerMm2, 0.9 * per_mm2)];
    comes_back(&spiral, MeasuredAngle::Push, &truth);
    let measured = shipped::scene("measured");
    comes_back(&measured, MeasuredAngle::Push, &[(ParabolaPerMm, 0.018)]);
    // The tip matters for pull-offs, far out.
    let rows = [[0.0, 30.0], [9.0, 21.0], [18.5, 11.5]];
    let short = measured.to_builder().profile(rows);
    let short = short.set(LengthMm, 18.5).set(TipExtensionMm, 1.6);
    let short = short.distance_mm([10.0]).build().unwrap();
    let truth = [(TipExtensionMm, 1.8), (ParabolaPerMm, 0.018)];
    comes_back(&short, MeasuredAngle::Push, &truth);
}
