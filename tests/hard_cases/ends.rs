//! The end of a push, computed in three ways: `curve` from the edges of the sheet, `branch` and `shape` by continuation, `map` by cells.

use super::case::Case;
use super::random::even_in_log;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use std::cell::Cell;
use whiskmap::Options;
use whiskmap::classify::Regime;
use whiskmap::mechanics::rod::{Rod, Side};
use whiskmap::mechanics::shooting::batch::Method;
use whiskmap::scene::Scene;
use whiskmap::sheet::Sheet;
use whiskmap::trace::{Detachment, DetachmentKind, NoState};

/// Distance before and after an end at which shapes and maps are computed, in degrees.
const BESIDE: f64 = 1e-6;

/// Tolerance of the difference between ends, in degrees; measured 1.5e-9.
const SAME: f64 = 1e-8;

/// Largest push angle of a map, in degrees.
const MOST_PUSH: f64 = 360.0;

/// Checks that shapes, branch and map agree with `end` at the only distance of `scene`.
pub fn agree(scene: &Scene, end: &Detachment) -> Result<(), TestCaseError> {
    let branch = whiskmap::branch(scene, end.distance_mm, end.side);
    let Some(push) = end.push_angle_deg else {
        prop_assert_eq!(end.kind, DetachmentKind::OutOfReach);
        let is_out = matches!(branch, Err(NoState::OutOfReach { .. }));
        prop_assert!(is_out);
        return Ok(());
    };
    // As `whiskmap::shape`, with one branch for both push angles.
    let shape = |push: f64| {
        let branch = branch.as_ref().map_err(|why| *why)?;
        let state = branch.state(push.to_radians(), true)?;
        Ok(branch.shape(&state, 200))
    };
    let beside = BESIDE * end.side.sign();
    let pulled_at_touch = push.abs() < BESIDE;
    if !pulled_at_touch {
        let before = shape(push - beside);
        let is_lost = matches!(before, Err(NoState::NoCourse { .. }));
        prop_assert!(before.is_ok() || is_lost, "{end:?}: {:?}", before.err());
    }
    let after = shape(push + beside).err();
    let (kind, at_deg) = match after {
        Some(NoState::SlippedOff { at_deg }) => (DetachmentKind::SlipOff, at_deg),
        Some(NoState::PulledOff { at_deg }) => (DetachmentKind::PullOff, at_deg),
        // The course of the contact was not found.
        Some(NoState::NoCourse { .. }) => return Ok(()),
        other => return Err(TestCaseError::fail(format!("{end:?}: {other:?}"))),
    };
    // Next to the corner both kinds are correct.
    prop_assert!(kind == end.kind || (at_deg - push).abs() < SAME);
    prop_assert!((at_deg - push).abs() < SAME, "{end:?}: {at_deg}");
    if push.abs() + BESIDE > MOST_PUSH || pulled_at_touch {
        return Ok(());
    }
    let (before, after) = (push - beside, push + beside);
    let pushes = [before.min(after), before.max(after)];
    let map = whiskmap::map(
        &scene.to_builder().push_angle_deg(pushes).build().unwrap(),
        Options::default(),
    )
    .unwrap();
    let regime = |push: f64| map.regime(0, 0, usize::from(push == pushes[1]));
    let gone = if kind == DetachmentKind::SlipOff { Regime::SlipOff } else { Regime::PullOff };
    prop_assert_eq!(regime(before), Some(Regime::Contact), "{:?}", end);
    // With friction a state can exist beyond the end that no push from rest reaches.
    let beyond = regime(after);
    prop_assert!(
        beyond == Some(gone) || beyond == Some(Regime::Unreachable),
        "{end:?}: {beyond:?}"
    );
    Ok(())
}

/// Strategy for whiskers with friction up to 1 and `A*` up to 10, at pole distances from a thousandth of the length.
fn whiskers() -> impl Strategy<Value = Case> {
    let taper = prop_oneof![2 => Just(0.0), 1 => Just(1.0), 4 => 0.0..1.0_f64, 2 => 0.9..1.0_f64];
    let bend = prop_oneof![Just(0.0), even_in_log(1e-3, 1.0), 1.0..10.0_f64];
    let pole = prop_oneof![Just(0.0), even_in_log(1e-4, 0.4)];
    let friction = prop_oneof![Just(0.0), 0.3..1.0_f64, 0.8..0.95_f64];
    let tip_to_base = prop_oneof![2 => Just(1.0), 1 => even_in_log(0.1, 10.0)];
    let distances = [even_in_log(1e-3, 0.1), even_in_log(0.1, 1.0)];
    let rows = prop_oneof![
        4 => Just(Vec::new()),
        1 => even_in_log(0.8, 1.25).prop_map(|f| vec![[0.0, 1.0], [0.4, 0.7 * f], [0.7, 0.4], [1.0, 0.1]])
    ];
    let whisker = (taper, bend, pole, friction, tip_to_base, rows);
    (whisker, distances).prop_map(
        |((taper, bend, pole, friction, tip_to_base, rows), distances)| {
            let sharpest = 0.45 / f64::max(bend, 1e-9);
            let distances: Vec<f64> = distances.into();
            let pole = f64::min(pole, sharpest).min(0.9 * distances[0]);
            Case {
                length_mm: 20.0,
                taper,
                bend,
                pole,
                friction,
                tip_to_base,
                stretch: 1.0,
                compliance: 0.0,
                rows,
                pushes_deg: vec![0.0],
                distances,
            }
        },
    )
}

#[test]
fn curves_branches_and_maps_agree_on_ends() {
    let config = Config {
        cases: 75,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(11),
        ..Config::default()
    };
    let ends = Cell::new(0);
    let holds = |case: Case| {
        let scene = case.scene();
        for (_, end) in whiskmap::curve(&scene, Options::default()).unwrap() {
            let alone = scene.to_builder().distance_mm([end.distance_mm]).build().unwrap();
            agree(&alone, &end)?;
            ends.set(ends.get() + usize::from(end.push_angle_deg.is_some()));
        }
        Ok(())
    };
    TestRunner::new(config).run(&whiskers(), holds).unwrap();
    assert!(ends.get() > 200, "{}", ends.get());
}

/// A nearer row in the same sheet does not change the ends of a row. This whisker straightens so far that it reaches the pole
/// of a row that it does not touch at rest.
#[test]
fn a_row_has_the_same_ends_beside_a_nearer_one() {
    let rod = Rod {
        taper: 0.7729485199727149,
        bend: 9.935603085321917,
        slope: -4.53937064594184,
        gradient: -0.2426349839752333,
        ..Rod::default()
    };
    let distance = 0.49135456912887043;
    let crossings = |distances: &[f64]| {
        let sheet = Sheet::new(Method::fine(), &rod, Side::Cb, distances);
        sheet.crossings[distances.len() - 1].clone()
    };
    let alone = crossings(&[distance]);
    let beside = crossings(&[0.05 * distance, distance]);
    assert_eq!((alone.len(), beside.len()), (4, 4));
    for (a, b) in alone.iter().zip(&beside) {
        assert!(a.edge == b.edge && (a.push - b.push).abs() < 1e-10, "{a:?} {b:?}");
    }
}
