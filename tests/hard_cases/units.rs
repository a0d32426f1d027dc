//! Independence of units: maps of whiskers of 0.1 mm to 1 m, soft and stiff, differ only by scale factors.

use super::case::{Case, compute};
use super::named::named;
use whiskmap::map::{Panel, STATE_CHANNELS};
use whiskmap::scene::Scene;

/// Power of the length with which each channel grows at constant proportions and modulus.
const POWERS: [(&str, i32); STATE_CHANNELS.len()] = [
    ("arc_length_mm", 1),
    ("contact_angle_deg", 0),
    ("force_un", 2),
    ("base_force_x_un", 2),
    ("base_force_y_un", 2),
    ("base_moment_nnm", 3),
    ("push_chord_deg", 0),
    ("contact_distance_mm", 1),
    ("energy_nj", 3),
];

/// Largest difference of a channel, with `b` divided by `factor`, relative to its largest value.
fn difference(a: &[f32], b: &[f32], factor: f64) -> f64 {
    let pairs = || a.iter().zip(b).map(|(a, b)| (f64::from(*a), f64::from(*b) / factor));
    let largest = pairs().map(|(a, _)| a.abs()).filter(|a| a.is_finite());
    let largest = largest.fold(f64::MIN_POSITIVE, f64::max);
    let apart = pairs().map(|(a, b)| match (a.is_nan(), b.is_nan()) {
        (true, true) => 0.0,
        (false, false) => (a - b).abs() / largest,
        _ => f64::INFINITY,
    });
    apart.fold(0.0, f64::max)
}

fn map(case: &Case, gpa: f64) -> Panel {
    compute(&Scene::parse(&case.text_at(gpa), "hard").unwrap(), None).1
}

/// Largest measured difference 8.5e-8; two roundings to `f32` are 1.2e-7.
#[test]
fn lengths_and_moduli_scale() {
    for (name, case) in named() {
        let reference = map(&case, 3.0);
        assert_eq!(case.length_mm, 20.0, "{name}");
        for length_mm in [0.1, 1000.0] {
            let scaled = Case { length_mm, ..case.clone() };
            let panel = map(&scaled, 3.0);
            assert_eq!(panel.regime, reference.regime, "{name} at {length_mm} mm");
            let channels = reference.state.iter().zip(&panel.state);
            for ((a, b), (channel, power)) in channels.zip(POWERS) {
                let factor = (length_mm / case.length_mm).powi(power);
                let miss = difference(a, b, factor);
                assert!(miss <= 2e-7, "{name} at {length_mm} mm: {channel} {miss:.1e}");
            }
        }
        let soft = map(&case, 3e-6);
        assert_eq!(soft.regime, reference.regime, "{name}, soft");
        let channels = reference.state.iter().zip(&soft.state);
        for ((a, b), (channel, power)) in channels.zip(POWERS) {
            let factor = if power < 2 { 1.0 } else { 1e-6 };
            let miss = difference(a, b, factor);
            assert!(miss <= 2e-7, "{name}, soft: {channel} {miss:.1e}");
        }
    }
}

#[test]
fn powers_name_every_channel() {
    assert_eq!(POWERS.map(|(channel, _)| channel), STATE_CHANNELS);
}
