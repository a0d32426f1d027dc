//! The largest bending strain along a whisker.

use super::effects::rods;
use std::sync::Arc;
use whiskmap_mechanics::numerics::Unit;
use whiskmap_mechanics::rod::{RadiusProfile, Rod};
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap_mechanics::shooting::shape::profile;
use whiskmap_mechanics::shooting::{PeakStrain, Resolution, bending_strain};

/// Resolution of branches and shapes.
const FINER: Resolution = Resolution::FINE.doubled();

fn peak_of(rod: &Rod, tau: f64, load: f64) -> PeakStrain {
    Batch::new(Method::new(FINER)).shoot_at(rod, [(tau, load)])[0]
}

/// Under a small load the lever is the distance to the contact at `c`. On a cone of taper `b`, `(c - s)/(1 - b s)^3` is largest at
/// `s = (3 b c - 1)/(2 b)`, or at the base.
#[test]
fn small_loads_have_the_peak_of_the_straight_cone() {
    for taper in [0.0, 0.2, 0.5, 0.9, 1.0] {
        let rod = Rod { taper, ..Rod::default() };
        for contact in [0.1, 0.5, 0.8, 0.99] {
            let (tau, load) = (rod.tau(contact), 1e-6);
            let place = match taper {
                0.0 => 0.0,
                _ => ((3.0 * taper * contact - 1.0) / (2.0 * taper)).max(0.0),
            };
            let force = load * (1.0 - taper * contact).powi(2);
            let strain = force * (contact - place) / (1.0 - taper * place).powi(3);
            let peak = peak_of(&rod, tau, load);
            let case = format!("{taper} {contact}: {peak:?} {place} {strain}");
            assert!((peak.arclength - place).abs() < 1e-7, "{case}");
            assert!((peak.strain / strain - 1.0).abs() < 1e-9, "{case}");
            // Without a load, the place is the limit.
            let none = peak_of(&rod, tau, 0.0);
            assert_eq!(none.strain, 0.0, "{case}");
            assert!((none.arclength - place).abs() < 1e-7, "{case}");
        }
    }
}

/// No point of a densely computed shape has a larger strain, and the point at the place has the same one. Rows of radii have several
/// maxima.
#[test]
fn no_point_of_a_shape_has_a_larger_strain() {
    let rows = [[0.0, 1.0], [0.2, 0.8], [0.35, 0.9], [0.6, 0.45], [0.8, 0.5], [1.0, 0.1]];
    let measured = Rod {
        taper: 0.9,
        bend: 0.4,
        profile: Some(Arc::new(RadiusProfile::new(&rows, 1.0))),
        ..Rod::default()
    };
    let cone = |taper: f64| Rod { taper, bend: 0.4, pole: 0.01, ..Rod::default() };
    let graded = Rod { gradient: -0.6, friction: 0.4, ..cone(0.7) };
    let mut inside = 0;
    for rod in [cone(0.0), cone(0.95), graded, measured] {
        for contact in [0.3, 0.7, 0.95] {
            for turn in [-6.0, -1.0, 0.5, 3.0, 9.0] {
                let tau = rod.tau(contact);
                let load = turn / (contact * contact * rod.softness(tau));
                let peak = peak_of(&rod, tau, load);
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

/// Peaks of a batch on rods with each effect have the errors that `docs/commands.md` states, by a run with eight times as many steps.
#[test]
fn peaks_of_batches_are_those_of_much_finer_steps() {
    let mut rods = rods();
    let more = rods.iter().map(|rod| Rod {
        friction: 0.4,
        mount: 0.2,
        gradient: -0.5,
        pole: -0.02,
        ..rod.clone()
    });
    rods.extend(more.collect::<Vec<_>>());
    let mut conditions = Vec::new();
    for rod in &rods {
        for i in 1..100 {
            let contact = 0.0099 * f64::from(i);
            let tau = rod.tau(contact);
            // Loads of both signs, spread over those of stable states and beyond.
            let turn = 12.0 * (f64::from(i * 37 % 99) / 49.0 - 1.0);
            let load = turn / (contact * contact * rod.softness(tau));
            conditions.push(InitialCondition { rod, tau, load });
        }
    }
    let peaks = |resolution: Resolution, unit| -> Vec<PeakStrain> {
        let batch = Batch::new(Method::new(resolution)).on(unit);
        batch.shoot(&conditions)
    };
    let finest = peaks(FINER.doubled().doubled().doubled(), Unit::detect());
    let (mut strain, mut place, mut inside) = (0.0_f64, 0.0_f64, 0);
    for unit in Unit::all() {
        let found = peaks(FINER, unit);
        for (found, finest) in found.iter().zip(&finest) {
            strain = strain.max((found.strain / finest.strain - 1.0).abs());
            place = place.max((found.arclength - finest.arclength).abs());
            inside += u32::from(found.arclength > 0.0);
        }
    }
    assert!(strain < 1e-9 && place < 1e-7, "{strain:e} {place:e}");
    assert!(inside > 300, "{inside} peaks beyond the base");
}
