//! The largest bending strain along a whisker.

use std::sync::Arc;
use whiskmap_mechanics::rod::{RadiusProfile, Rod};
use whiskmap_mechanics::shooting::shape::profile;
use whiskmap_mechanics::shooting::{PeakStrain, Resolution, bending_strain};

/// Resolution of branches and shapes.
const FINER: Resolution = Resolution::FINE.doubled();

/// Under a small load the lever is the distance to the contact at `c`. On a cone of taper `b`, `(c - s)/(1 - b s)^3` is largest at
/// `s = (3 b c - 1)/(2 b)`, or at the base.
#[test]
fn small_loads_have_the_peak_of_the_straight_cone() {
    for taper in [0.0, 0.2, 0.5, 0.9, 1.0] {
        let rod = Rod {
            taper,
            ..Rod::default()
        };
        for contact in [0.1, 0.5, 0.8, 0.99] {
            let (tau, load) = (rod.tau(contact), 1e-6);
            let place = match taper {
                0.0 => 0.0,
                _ => ((3.0 * taper * contact - 1.0) / (2.0 * taper)).max(0.0),
            };
            let force = load * (1.0 - taper * contact).powi(2);
            let strain = force * (contact - place) / (1.0 - taper * place).powi(3);
            let peak = PeakStrain::new(&rod, tau, load, FINER);
            let case = format!("{taper} {contact}: {peak:?} {place} {strain}");
            assert!((peak.arclength - place).abs() < 1e-7, "{case}");
            assert!((peak.strain / strain - 1.0).abs() < 1e-9, "{case}");
            // Without a load, the place is the limit.
            let none = PeakStrain::new(&rod, tau, 0.0, FINER);
            assert_eq!(none.strain, 0.0, "{case}");
            assert!((none.arclength - place).abs() < 1e-7, "{case}");
        }
    }
}

/// No point of a densely computed shape has a larger strain, and the point at the place has the same one. Rows of radii have several
/// maxima.
#[test]
fn no_point_of_a_shape_has_a_larger_strain() {
    let rows = [
        [0.0, 1.0],
        [0.2, 0.8],
        [0.35, 0.9],
        [0.6, 0.45],
        [0.8, 0.5],
        [1.0, 0.1],
    ];
    let measured = Rod {
        taper: 0.9,
        bend: 0.4,
        profile: Some(Arc::new(RadiusProfile::new(&rows, 1.0))),
        ..Rod::default()
    };
    let cone = |taper: f64| Rod {
        taper,
        bend: 0.4,
        pole: 0.01,
        ..Rod::default()
    };
    let graded = Rod {
        gradient: -0.6,
        friction: 0.4,
        ..cone(0.7)
    };
    let mut inside = 0;
    for rod in [cone(0.0), cone(0.95), graded, measured] {
        for contact in [0.3, 0.7, 0.95] {
            for turn in [-6.0, -1.0, 0.5, 3.0, 9.0] {
                let tau = rod.tau(contact);
                let load = turn / (contact * contact * rod.softness(tau));
                let peak = PeakStrain::new(&rod, tau, load, FINER);
                let strain = |at: &[f64]| -> Vec<f64> {
                    let points = profile(&rod, tau, load, FINER, at);
                    let strains = points
                        .iter()
                        .map(|point| bending_strain(&rod, point.arclength, point.moment));
                    strains.collect()
                };
                let case = format!("{rod:?} {contact} {turn}: {peak:?}");
                let there = strain(&[peak.arclength])[0];
                assert!((there / peak.strain - 1.0).abs() < 1e-9, "{case}: {there}");
                let places: Vec<f64> = (0..4000).map(|i| contact * f64::from(i) / 4000.0).collect();
                let most = strain(&places).into_iter().fold(0.0, f64::max);
                assert!(most <= peak.strain * (1.0 + 1e-10), "{case}: {most}");
                inside += u32::from(peak.arclength > 0.0);
            }
        }
    }
    assert!(inside > 20, "{inside} peaks beyond the base");
}
