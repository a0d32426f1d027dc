//! The contact in lanes against the standard library.

use whiskmap_mechanics::rod::{Rest, Rod, arclength, radius_and_arclength};
use whiskmap_mechanics::shooting::contact::{arc, direction, exp, parabola_tangent};

#[test]
fn algebra_is_as_good_as_the_library() {
    for taper in [0.0, 1e-12, 1e-3, 0.5, 0.95, 1.0] {
        let rod = Rod { taper, ..Rod::default() };
        for tau in [1e-9, 0.01, 0.7, 3.0, 20.0] {
            let [radius, s] = radius_and_arclength(taper, tau);
            assert!((radius / rod.radius(tau) - 1.0).abs() < 1e-14, "{taper} {tau}");
            assert!((s / arclength(&rod, tau) - 1.0).abs() < 4e-15, "{taper} {tau}");
        }
    }
    for x in [-25.6, -3.0, -1e-9, 0.0, 1e-3, 1.0, 25.6_f64] {
        assert!((exp(x) / x.exp() - 1.0).abs() < 1e-14, "{x}");
    }
    for angle in [-25.0, -3.0, -1e-9, 0.0, 1e-3, 1.0, 25.0_f64] {
        let [cos, sin] = direction(angle);
        assert!((cos - angle.cos()).abs() < 6e-14, "{angle}");
        assert!((sin - angle.sin()).abs() < 6e-14, "{angle}");
    }
    for bend in [0.0, 1e-9, 0.02, 0.4, 1.5, 10.0] {
        for slope in [-3.0, -0.3, 0.0, 1e-6, 2.0] {
            let rod = Rod { bend, slope, ..Rod::default() };
            for s in [0.0, 1e-6, 0.1, 0.5, 1.0, 1.2] {
                let found = parabola_tangent(bend, arc(slope), s);
                let known = Rest::parabola_tangent(&rod, s).to_array();
                for (a, b) in found.iter().zip(known) {
                    assert!((a - b).abs() < 4e-16 * (1.0 + 4.0 * bend), "{bend} {slope} {s}");
                }
            }
        }
    }
}
