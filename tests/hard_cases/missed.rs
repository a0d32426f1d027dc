//! Ends that sheet samples can miss or at which continuation can fail. Each case once gave a wrong end or none.

use super::case::{Case, compute};
use super::ends::agree;
use whiskmap::Options;
use whiskmap::classify::Regime;
use whiskmap::mechanics::rod::{Rest, Rod, Side};
use whiskmap::mechanics::shooting::ShootingMap;
use whiskmap::mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap::scene::Parameter;
use whiskmap::sheet::{Row, Sheet};
use whiskmap::trace::DetachmentKind;

/// Cylinder at a point contact with friction.
fn cylinder(bend: f64, friction: f64, tip_to_base: f64, distance: f64) -> Case {
    Case {
        length_mm: 20.0,
        taper: 0.0,
        bend,
        pole: 0.0,
        friction,
        tip_to_base,
        stretch: 1.0,
        compliance: 0.0,
        rows: Vec::new(),
        pushes_deg: vec![0.0],
        distances: vec![distance],
    }
}

/// Cylinders that coil up: the distance has a minimum along the tip edge or the fold that is too narrow for the samples of a sheet.
#[test]
fn narrow_dips_are_not_missed() {
    use DetachmentKind::{PullOff, SlipOff};
    let coiled = [
        (Side::Cb, 0.0, 0.8985976550518069, 1.0, 0.01197993778232795, PullOff),
        (Side::Cb, 0.1344136525243472, 0.8870166499183616, 1.0, 0.006561675176450292, SlipOff),
        (Side::Cf, 0.046872210686984314, 0.8550808096527569, 1.0, 0.004602123462169978, PullOff),
        (
            Side::Cb,
            0.004535013423207362,
            0.8712990696537211,
            0.84679680609,
            0.0010233092092122975,
            SlipOff,
        ),
    ];
    for (side, bend, friction, tip_to_base, distance, kind) in coiled {
        let scene = cylinder(bend, friction, tip_to_base, distance).scene();
        for (_, end) in whiskmap::curve(&scene, Options::default()).unwrap() {
            assert!(end.side != side || end.kind == kind, "{end:?}");
            agree(&scene, &end).unwrap();
        }
    }
}

/// Difference of the first two folds of `rod` with the contact at the arclength `s` in `q = |load| s^2`, up to 40, on the CB side.
fn between_folds(rod: &Rod, s: f64) -> f64 {
    const STEP: f64 = 0.05;
    let condition =
        |i: i32| InitialCondition { rod, tau: rod.tau(s), load: STEP * f64::from(i) / (s * s) };
    let conditions: Vec<InitialCondition> = (0..800).map(condition).collect();
    let maps = Batch::new(Method::fine()).shoot::<ShootingMap>(&conditions);
    let folds = maps.windows(2).enumerate();
    let mut folds = folds.filter(|(_, pair)| pair[0].det() * pair[1].det() <= 0.0);
    let [first, second] = [folds.next(), folds.next()].map(|fold| fold.unwrap().0);
    STEP * (second - first) as f64
}

/// Strongly bent whiskers with two folds so close together that sampling along the load may skip both.
#[test]
fn close_folds_are_not_missed() {
    // Taper, `A*`, slope at the base, modulus gradient, contact with the close folds, and distance there.
    let whiskers = [
        (0.196, 3.175, -2.506, 0.286, 0.8, 0.593),
        (0.142, 8.141, -2.119, 0.0, 0.25, 0.171),
        (0.038, 9.524, -2.384, -0.373, 0.25, 0.181),
    ];
    for (taper, bend, slope, gradient, contact, distance) in whiskers {
        let case = Case {
            length_mm: 20.0,
            taper,
            bend,
            pole: 0.0,
            friction: 0.0,
            tip_to_base: 1.0 + gradient,
            stretch: 1.0,
            compliance: 0.0,
            rows: Vec::new(),
            pushes_deg: vec![0.0],
            distances: [0.5, 0.8, 0.9, 0.95, 0.98, 1.0, 1.02, 1.05]
                .map(|part| part * distance)
                .to_vec(),
        };
        let vertex_mm = -slope / (2.0 * bend) * case.length_mm;
        let scene = case.scene().with(Parameter::VertexMm, vertex_mm).unwrap();
        let apart = between_folds(&scene.first_whisker().rod(Side::Cb), contact);
        assert!((0.1..1.6).contains(&apart), "{apart}");
        let mut ends = 0;
        for (_, end) in whiskmap::curve(&scene, Options::default()).unwrap() {
            assert_ne!(end.kind, DetachmentKind::Unresolved, "{end:?}");
            let alone = scene.to_builder().distance_mm([end.distance_mm]).build().unwrap();
            agree(&alone, &end).unwrap();
            ends += usize::from(end.push_angle_deg.is_some());
        }
        assert!(ends > 8, "{ends}");
    }
}

/// Push angle of `rod` in degrees on the CB side, in front of the pole of `row` with the contact at the arclength `s`, on its stable side:
/// `det` is positive at this load and at all smaller ones. Plain sampling along the load, with twice the steps.
fn stable_push_deg(rod: &Rod, row: &Row, s: f64) -> f64 {
    const STEP: f64 = 0.005;
    let condition =
        |i: i32| InitialCondition { rod, tau: rod.tau(s), load: STEP * f64::from(i) / (s * s) };
    let conditions: Vec<InitialCondition> = (0..3000).map(condition).collect();
    let maps = Batch::new(Method::fine().doubled()).shoot::<ShootingMap>(&conditions);
    let stable: Vec<_> = maps.iter().take_while(|map| map.det() > 0.0).collect();
    let miss = |map: &ShootingMap| map.pole.length() - row.pole_distance;
    let pair = stable.windows(2).find(|w| miss(w[0]) * miss(w[1]) <= 0.0);
    (pair.unwrap()[0].pole.to_angle() - row.touch).to_degrees()
}

/// A cone whose fold leaps between two samples. Rows in between have a second piece that no sample shows: its states lie beyond the
/// detachment of the push from first touch. Without `SLOPE_TOLERANCE` and `FOLD_OFF`, which cover each other, they are lost.
#[test]
fn a_piece_between_samples_of_the_fold_is_not_missed() {
    let (bend, slope) = (3.388, -1.5577);
    let case = Case { taper: 1.0, pole: 0.097, ..cylinder(bend, 0.0, 0.23, 0.2772) };
    let vertex_mm = -slope / (2.0 * bend) * case.length_mm;
    let scene = case.scene().with(Parameter::VertexMm, vertex_mm).unwrap();
    let rod = scene.first_whisker().rod(Side::Cb);
    let row = Row::new(&Rest::new(&rod), 0.2772);
    let pushes = [0.5, 0.51, 0.53].map(|s| stable_push_deg(&rod, &row, s));
    assert!(pushes.is_sorted() && pushes[0] > 45.0, "{pushes:?}");
    let scene = scene.to_builder().push_angle_deg(pushes).build().unwrap();
    let (summary, panel) = compute(&scene, None);
    assert_eq!((summary.unresolved(), summary.disagreements), (0, 0));
    assert_eq!(panel.regime, [Regime::Unreachable.code(); 3]);
}

/// Slightly tapered whiskers, with and without friction, whose row crosses the fold three times between two samples of the fold edge, or
/// twice where both samples are nearer. The push ends at the first crossing. Samples alone put it up to 0.1 degrees off.
#[test]
fn folds_that_meet_between_samples_are_not_missed() {
    // Taper, `A*`, slope at the base, pole radius, friction, and distances.
    let whiskers = [
        (
            0.15584595680236815,
            0.7655836105346681,
            -0.4527052946111325,
            0.014768532514572143,
            0.4825040340423584,
            [0.27775, 0.27793, 0.2782, 0.2785],
        ),
        (
            0.060352342128753664,
            1.4475895464420319,
            -0.6127812271547874,
            0.022718337178230286,
            0.0,
            [0.25218, 0.25236, 0.25254, 0.2526],
        ),
    ];
    for (taper, bend, slope, pole, friction, distances) in whiskers {
        for distance in distances {
            let case = Case { taper, pole, ..cylinder(bend, friction, 1.0, distance) };
            let vertex_mm = -slope / (2.0 * bend) * case.length_mm;
            let scene = case.scene().with(Parameter::VertexMm, vertex_mm).unwrap();
            for (_, end) in whiskmap::curve(&scene, Options::default()).unwrap() {
                agree(&scene, &end).unwrap();
            }
        }
    }
}

/// Coiled cylinders whose first fold leaps between two samples. With a `FOLD_LOAD_TOLERANCE` of infinity, without the bisection between the
/// samples, or with a `SHORT_CHORD` of 0, a row has a piece whose ends are not found.
#[test]
fn all_pieces_are_found_where_the_fold_leaps() {
    let leaping = Case {
        pole: 0.005195859681852056,
        ..cylinder(2.9777634126889846, 0.4446239876410852, 1.0, 0.042655084182320564)
    };
    let bisected = Case {
        pole: 0.000111816758367984,
        stretch: 1.003922709284042,
        ..cylinder(0.9974105441445368, 0.9607572582694287, 0.735862310097628, 0.0028471454535629152)
    };
    let whiskers = [
        (leaping, 8.061794309983636, 0.4183332955529271, 3),
        (bisected, 0.0, 0.3067723827029361, 5),
    ];
    for (case, vertex_mm, farther, most) in whiskers {
        let scene = case.scene().with(Parameter::VertexMm, vertex_mm).unwrap();
        let rod = scene.first_whisker().rod(Side::Cb);
        let distances = [case.distances[0], farther];
        let sheet = Sheet::new(Method::fine(), &rod, Side::Cb, &distances);
        let ends = sheet.crossings.iter().flatten();
        assert!(ends.clone().all(|end| end.is_sound()), "{:?}", sheet.crossings);
        assert_eq!(sheet.crossings.iter().map(Vec::len).max(), Some(most));
    }
}

/// A cylinder that is pushed by a whole turn: with nodes that are on the curve only to 1e-8, the continuation fails.
#[test]
fn failed_continuations_are_repeated_with_exact_nodes() {
    let scene =
        cylinder(0.007318811503537833, 0.8759848018136742, 1.0, 0.0023229318335218274).scene();
    let ends = whiskmap::curve(&scene, Options::default()).unwrap();
    assert_eq!(ends.len(), 2);
    for (_, end) in ends {
        assert_eq!(end.kind, DetachmentKind::SlipOff, "{end:?}");
        agree(&scene, &end).unwrap();
    }
}

/// For two thirds of a degree, between two nodes of the continuation, the contact lies beyond the tip.
#[test]
fn a_row_that_grazes_the_tip_ends_there() {
    let case = Case {
        taper: 1.0 - 29.5916686304334 / 30.0,
        pole: 0.00027453354913208,
        ..cylinder(0.023852954975056178, 0.9865609968131556, 1.0, 0.024479462769365525)
    };
    let scene = case.scene();
    for (_, end) in whiskmap::curve(&scene, Options::default()).unwrap() {
        assert_ne!(end.kind, DetachmentKind::Unresolved, "{end:?}");
        agree(&scene, &end).unwrap();
        assert!(end.side == Side::Cb || end.kind == DetachmentKind::PullOff, "{end:?}");
    }
}

/// A stiff cone that is pulled off next to its reach: along the tip edge the push angle changes 29 times as fast as the logarithm of the
/// distance, so an error of the logarithm counts 29 times.
#[test]
fn ends_that_change_fast_with_the_distance_are_as_exact() {
    let rod = Rod { taper: 0.476, pole: 9e-4, gradient: 7.89, ..Rod::default() };
    let at_end = |method| {
        let sheet = Sheet::new(method, &rod, Side::Cb, &[0.9967]);
        sheet.crossings[0][0]
    };
    let [found, exact] = [Method::fine(), Method::fine().doubled().doubled()].map(at_end);
    assert!(found.is_steep(), "{}", found.slope);
    let apart = (found.push - exact.push).to_degrees().abs();
    // Measured 5e-12, and 1.8e-10 with the default steps.
    assert!(apart < 3e-11, "{apart:e}");
}
