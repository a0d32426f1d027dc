//! Ends of pushes next to jumps of the detachment curve, where the push passes a shallow pair of folds.

use crate::random_rods::Random;
use crate::shipped;
use std::sync::Arc;
use whiskmap::mechanics::rod::{CurvaturePolynomial, RadiusProfile, Rest, Rod, Side};
use whiskmap::mechanics::shooting::batch::Method;
use whiskmap::scene::Scene;
use whiskmap::sheet::{Edge, LevelCurve, Row, Sheet, Stretch};
use whiskmap::trace::{Branch, BranchMark, DetachmentKind, curve};
use whiskmap::whisk::{AngleCourse, WhiskEventKind, whisk};
use whiskmap::{Options, Regime};

/// End of a push from an independent solver: reverse shooting and continuation by arclength, in steps of 0.03 to 0.001.
struct Reference {
    scene: Scene,
    side: Side,
    distance_mm: f64,
    kind: DetachmentKind,
    push_deg: f64,
    /// Accuracy of the reference, in degrees.
    tolerance: f64,
}

fn references() -> Vec<Reference> {
    let folder = shipped::root().join("tests/data/jumps");
    let text = std::fs::read_to_string(folder.join("reference.csv")).unwrap();
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    let reference = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let scene = Scene::read(folder.join(format!("{}.toml", cells[0]))).unwrap();
        let side = if cells[1] == "cb" { Side::Cb } else { Side::Cf };
        // The table has some distances in few digits; the scene has the exact one.
        let distance_mm = scene.grid.distance_mm[0];
        let part: f64 = cells[2].parse().unwrap();
        assert!((distance_mm / scene.whisker.length_mm / part - 1.0).abs() < 1e-5);
        Reference {
            side,
            distance_mm,
            kind: DetachmentKind::SlipOff,
            push_deg: cells[4].parse().unwrap(),
            tolerance: if cells[0] == "09" { 1e-3 } else { 1e-6 },
            scene,
        }
    };
    let all: Vec<Reference> = lines.map(reference).collect();
    assert_eq!(all.len(), 5);
    all
}

#[test]
fn curves_branches_and_courses_end_at_the_first_fold() {
    for reference in references() {
        let Reference { scene, side, distance_mm, push_deg, tolerance, .. } = &reference;
        let (whisker, pole) = (&scene.whisker, &scene.pole);
        let end = curve(whisker, pole, *side, &[*distance_mm])[0];
        assert_eq!(end.kind, reference.kind);
        let off = |found: f64| (found - push_deg).abs();
        assert!(off(end.push_angle_deg.unwrap()) < *tolerance, "{end:?}");

        let branch = Branch::new(whisker, pole, *side, *distance_mm).unwrap();
        assert!(off(branch.stable_end_deg()) < *tolerance, "{push_deg}");
        let points = branch.points(200).unwrap();
        assert!(points.iter().all(|point| !point.stable || point.det > -1e-9));
        let last = points.iter().find(|point| point.mark == Some(BranchMark::SlipOff)).unwrap();
        assert!(off(last.push_angle_deg) < *tolerance);
        // The push passes the pair of folds to other stable states, which end later.
        let snaps = end.snaps_deg.unwrap();
        assert!(snaps.abs() > push_deg.abs(), "{snaps}");
        // The steps of a branch are finer than those of a curve.
        assert!((last.snaps_deg.unwrap() / snaps - 1.0).abs() < 1e-9);

        let rests = [Side::Cb, *side].map(|side| Rest::new(&whisker.rod(pole, side)));
        let touch = rests[1].pole_at_distance(distance_mm / whisker.length_mm);
        let on_cb = rests[0].distance_of_pole(touch.length()) * whisker.length_mm;
        // Angle of the base at first touch: 0 on CB.
        let turn = (touch.to_angle()
            - rests[0].pole_at_distance(on_cb / whisker.length_mm).to_angle())
        .to_degrees();
        let sign = side.sign();
        let angles = [turn - sign, turn + push_deg + sign];
        let course = AngleCourse::new(vec![0.0, 1.0], angles.to_vec()).unwrap();
        let found = whisk(whisker, pole, on_cb, &course).unwrap();
        let slip =
            found.events.iter().find(|event| event.event == WhiskEventKind::SlipOff).unwrap();
        assert!(off(slip.push_angle_deg.unwrap()) < *tolerance, "{slip:?}");
        assert!((slip.snaps_deg.unwrap() / snaps - 1.0).abs() < 1e-6, "{slip:?}");
    }
}

#[test]
fn maps_end_at_the_first_fold() {
    for Reference { scene, side, push_deg, tolerance, .. } in references() {
        let sign = side.sign();
        let pushes = [push_deg - sign * tolerance, push_deg + sign * tolerance];
        let pushes = if sign > 0.0 { pushes } else { [pushes[1], pushes[0]] };
        let scene = scene.to_builder().push_angle_deg(pushes).build().unwrap();
        let map = whiskmap::map(&scene, Options::default()).unwrap();
        let regime = |push: usize| map.regime(0, 0, push).unwrap();
        let regimes = if sign > 0.0 { [regime(0), regime(1)] } else { [regime(1), regime(0)] };
        assert_eq!(regimes, [Regime::Contact, Regime::Unreachable], "{push_deg}");
    }
}

/// Nearly cylindrical rods of the families whose detachment curves jump: strong parabolas of either sign, spirals, traced shapes with
/// several bends and measured radii with waists; half of them with friction up to 1.
fn rod(random: &mut Random, family: usize) -> (Rod, Side) {
    let side = if random.unit() < 0.5 { Side::Cb } else { Side::Cf };
    let friction = (2.0 * random.unit() - 1.0).max(0.0);
    let mut rod = Rod {
        taper: random.between(0.0, 0.3),
        pole: side.sign() * random.between(0.0, 0.05),
        friction: side.sign() * friction,
        ..Rod::default()
    };
    match family {
        0 => {
            rod.bend = random.between(0.5, 4.0);
            rod.slope = -2.0 * rod.bend * random.between(-0.5, 1.5);
        }
        1 => rod.spiral = Some([random.between(-4.0, 4.0), random.between(-6.0, 6.0)]),
        2 => {
            let mut size = 3.0;
            let terms = std::array::from_fn(|_| {
                size *= 0.7;
                size * random.between(-1.0, 1.0)
            });
            rod.polynomial = Some(Arc::new(CurvaturePolynomial::new(terms)));
        }
        _ => {
            let inner = [0.2, 0.4, 0.6, 0.8].map(|s| [s, random.between(0.5, 1.0)]);
            let tip = random.between(0.3, 1.0);
            let rows = [&[[0.0, 1.0]][..], &inner, &[[1.0, tip]]].concat();
            rod.taper = 1.0 - tip;
            rod.profile = Some(Arc::new(RadiusProfile::new(&rows, 1.0)));
        }
    }
    (rod, side)
}

/// The stable piece of a branch from first touch has no state with negative `det`, its push grows throughout, and it ends where the
/// detachment curve does.
#[test]
fn branches_agree_with_curves_on_random_rows() {
    let mut random = Random::new(17);
    let mut compared = 0;
    for i in 0..48 {
        let (rod, side) = rod(&mut random, i % 4);
        let rest = Rest::new(&rod);
        let reach = rest.at_arclength(rest.end()).0.length().min(0.99);
        let mut distances: Vec<f64> = (0..8).map(|_| reach * random.between(0.02, 0.98)).collect();
        distances.sort_by(f64::total_cmp);
        let sheet = Sheet::new(Method::fine(), &rod, side, &distances);
        for (row, distance) in distances.iter().enumerate() {
            let level = LevelCurve::new(Method::fine(), &rod, side, &Row::new(&rest, *distance));
            let Some(found) = level.continuation(level.touch(), Stretch::Stable) else {
                continue;
            };
            let end = sheet.crossings[row][0];
            let last = found.nodes.last().unwrap();
            // A fold whose push changes by 1e-11 for an error of 1e-14 in `ln D` has a slope of at most 1000 radians.
            let off = (side.sign() * last.signed_push - end.push).abs();
            assert!(
                off < 1e-8 && found.end == Some(end.edge),
                "{rod:?} {side:?} {distance} {off:e}"
            );
            for pair in found.nodes.windows(2) {
                let is_last = std::ptr::eq(&pair[1], last) && found.end == Some(Edge::Fold);
                assert!(is_last || pair[1].full.map.det() > 0.0, "{rod:?} {side:?} {distance}");
                let rise = side.sign() * (pair[1].signed_push - pair[0].signed_push);
                assert!(rise > 0.0, "{rod:?} {side:?} {distance} {rise:e}");
            }
            compared += 1;
        }
    }
    assert!(compared > 300, "{compared}");
}

/// Rod with measured radii, `[arclength, radius]` in parts of the length and of the base radius.
fn measured(rows: &[[f64; 2]], pole: f64, friction: f64) -> Rod {
    Rod {
        taper: 1.0 - rows[rows.len() - 1][1],
        pole,
        friction,
        profile: Some(Arc::new(RadiusProfile::new(rows, 1.0))),
        ..Rod::default()
    }
}

/// Traced rod with much friction and curvature.
fn traced() -> Rod {
    let terms = [
        2.654_884_177_567_555_3,
        1.761_418_882_575_023_9,
        -1.226_190_879_796_888,
        -0.470_227_172_253_574,
        -0.561_198_326_888_229_5,
        0.304_118_807_419_533_6,
        -0.145_882_973_113_839_35,
    ];
    Rod {
        taper: 0.250_807_513_056_135_86,
        friction: -0.972_814_226_406_048_4,
        polynomial: Some(Arc::new(CurvaturePolynomial::new(terms))),
        ..Rod::default()
    }
}

/// Level curves that nearly meet another branch at a saddle of `D`, in steps far longer than the gap between them, and one that reaches the
/// tip twice, between two nodes. The ends come from a continuation in steps of a hundredth, with a search of the minima of `det` between its
/// nodes.
#[test]
fn pushes_end_before_gaps_shorter_than_a_step() {
    let waist = measured(
        &[
            [0.0, 1.0],
            [0.120_273_790_851_375_23, 0.701_816_237_684_189_9],
            [0.565_614_881_010_162_7, 0.859_236_950_672_322_1],
            [1.0, 0.795_023_202_215_322_2],
        ],
        0.025_842_504_292_571_4,
        0.933_739_850_467_233_6,
    );
    let step = measured(
        &[
            [0.0, 1.0],
            [0.133_142_525_111_076_44, 0.504_016_329_239_883_3],
            [0.502_633_312_183_676_6, 0.581_387_739_024_055],
            [0.551_307_402_512_389_3, 0.956_953_606_309_727_5],
            [0.702_410_845_145_232_1, 0.839_133_484_331_663_1],
            [1.0, 0.804_790_098_253_018_5],
        ],
        0.008_199_250_898_155_463,
        0.0,
    );
    let cases = [
        (waist, Side::Cb, 0.308_197_230_046_580_3, Edge::Fold, 5.618_329_609_858),
        (step, Side::Cb, 0.350_664_723_819_827_4, Edge::Tip, 10.122_996_071_435),
        (traced(), Side::Cf, 0.110_074_426_2, Edge::Fold, 5.123_694_933_287),
    ];
    for (rod, side, distance, edge, end) in cases {
        let found = Sheet::new(Method::fine(), &rod, side, &[distance]).crossings[0][0];
        // Measured: 4e-9, where the end changes by 13,000 radians for a change of 1 in `ln D`.
        let off = (found.push - end).abs();
        assert!(found.edge == edge && off < 1e-8, "{found:?} {off:e}");
    }
}

/// Where friction and curvature leave no state that slides at a small push, there is no end to report.
#[test]
fn a_contact_that_jams_at_first_touch_has_no_end() {
    let rod = traced();
    let rest = Rest::new(&rod);
    for distance in [0.636_76, 0.637_909_01, 0.65] {
        let row = Row::new(&rest, distance);
        let level = LevelCurve::new(Method::fine(), &rod, Side::Cf, &row);
        assert!(level.touch().full.map.det() < 0.0, "{distance}");
        let sheet = Sheet::new(Method::fine(), &rod, Side::Cf, &[distance]);
        assert!(sheet.touches(0));
        assert!(sheet.crossings[0].first().is_none_or(|end| end.is_unknown()), "{distance}");
    }
}
