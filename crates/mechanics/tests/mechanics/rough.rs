//! Trajectories along measured radii.

use std::sync::Arc;
use whiskmap_mechanics::rod::{RadiusProfile, Rod};
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap_mechanics::shooting::{Resolution, ShootingMap};

/// Quasi-random numbers in `[0, 1)`: fractional parts of multiples of the golden ratio, scrambled.
fn noise(i: u32) -> f64 {
    let scrambled = i.wrapping_mul(0x9e37_79b9) ^ (i.wrapping_mul(0x85eb_ca6b) >> 13);
    f64::from(scrambled.wrapping_mul(0xc2b2_ae35) >> 8) / 16_777_216.0
}

/// A whisker with `rows` measured radii with 30 % of noise, whose modulus has the `gradient`.
fn rough(rows: u32, gradient: f64) -> Rod {
    let row = |i: u32| {
        let s = f64::from(i) / f64::from(rows - 1);
        let radius = (1.0 - 0.9 * s) * (0.7 + 0.6 * noise(i));
        [s, if i == 0 { 1.0 } else { radius }]
    };
    let rows: Vec<[f64; 2]> = (0..rows).map(row).collect();
    Rod {
        taper: 1.0 - rows[rows.len() - 1][1],
        bend: 0.4,
        gradient,
        profile: Some(Arc::new(RadiusProfile::new(&rows, 1.0))),
        ..Rod::default()
    }
}

/// `count` contacts along the whole rod, under loads up to the fold of a cone.
fn conditions(rod: &Rod, count: u32) -> Vec<InitialCondition<'_>> {
    let condition = |i: u32| {
        let s = 0.1 + 0.89 * noise(2 * i + 7);
        let tau = rod.tau(s);
        let load = 8.0 * noise(2 * i + 8) / (s * s * rod.softness(tau));
        InitialCondition { rod, tau, load }
    };
    (0..count).map(condition).collect()
}

fn poles(least: u32, conditions: &[InitialCondition]) -> Vec<ShootingMap> {
    Batch::new(Method::new(Resolution::of(least))).shoot(conditions)
}

/// Poles at the resolution of maps against six times the steps, for various numbers of rows, with and without a gradient. The
/// largest error of 120,000 random states was 1.3e-10 of the pole's distance, with 1,000 rows.
#[test]
fn rough_radii_are_exact() {
    for (rows, gradient) in [(2, 0.0), (8, 3.0), (40, -0.6), (200, 0.0), (200, 5.0), (1000, 0.0)] {
        let rod = rough(rows, gradient);
        let conditions = conditions(&rod, 128);
        let least = Resolution::FINE.least;
        let [found, exact] = [least, 6 * least].map(|least| poles(least, &conditions));
        let miss = |(a, b): (&ShootingMap, &ShootingMap)| a.pole.distance(b.pole) / b.pole.length();
        let worst = found.iter().zip(&exact).map(miss).fold(0.0, f64::max);
        assert!(worst < 3e-10, "{rows} rows, gradient {gradient}: {worst:e}");
    }
}

/// Lanes wait for each other at their contacts and on every piece. Their outputs have the bits that they have alone.
#[test]
fn lanes_do_not_affect_each_other() {
    for (rows, gradient) in [(5, 0.0), (40, 2.0)] {
        let rod = rough(rows, gradient);
        let conditions = conditions(&rod, 100);
        let together = poles(20, &conditions);
        for (condition, together) in conditions.iter().zip(together) {
            assert_eq!(poles(20, std::slice::from_ref(condition))[0], together);
        }
    }
}

/// A load that needs thousands of steps, as after a diverging Newton step, does not change other lanes, which wait on every piece.
#[test]
fn a_diverged_lane_changes_no_other() {
    let rod = rough(3, 0.0);
    let mut conditions = conditions(&rod, 8);
    let alone = poles(20, &conditions);
    conditions[3].load = 1e12;
    let beside = poles(20, &conditions);
    for (i, (alone, beside)) in alone.iter().zip(&beside).enumerate() {
        assert!(i == 3 || alone == beside, "{i}: {alone:?} {beside:?}");
    }
}

/// The integrals of a piece are computed for a contact just before its end, and come from the table for a contact just after it.
#[test]
fn the_table_continues_what_is_computed() {
    let rod = rough(40, 0.0);
    for row in [5.0, 20.0, 38.0] {
        let conditions = [-1e-11, 1e-11].map(|beside| InitialCondition {
            rod: &rod,
            tau: rod.tau(row / 39.0 + beside),
            load: 5.0,
        });
        let [before, after] = [0, 1].map(|i| poles(20, &conditions)[i].pole);
        assert!(before.distance(after) < 1e-10, "{row}: {before} {after}");
    }
}
