//! The whisker at rest.

use glam::DVec2;
use whiskmap_mechanics::rod::{Rest, Rod};

/// The vertex is at the base, or so near that Halley's method is used.
#[test]
fn a_chord_ends_on_the_parabola() {
    for bend in [0.0, 0.02, -0.4, 5.0] {
        for slope in [0.0, 1e-12, 0.3] {
            let rest = Rest::new(&Rod {
                bend,
                slope,
                ..Rod::default()
            });
            for chord in [1e-6, 0.3, 1.0] {
                // In the frame of the parabola.
                let base = DVec2::new(1.0, slope).normalize();
                let x = base.rotate(rest.point_at_distance(chord)).x;
                let length = DVec2::new(x, x * (bend * x + slope)).length();
                assert!(
                    (length / chord - 1.0).abs() < 4.0 * f64::EPSILON,
                    "{bend} {slope}: {length} for {chord}"
                );
            }
        }
    }
}
