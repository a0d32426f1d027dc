//! A follicle in which the base turns: values of another solver, the limit of a clamp, agreement of engines, and its parameter.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::random_rods::Random;
use crate::shipped;
use whiskmap::classify::Status;
use whiskmap::fit::fit;
use whiskmap::measured::MeasuredPoints;
use whiskmap::scene::{Curvature, Parameter, Pole, Scene, Whisker};
use whiskmap::trace::{Branch, BranchMark, DetachmentKind, NoState, curve};
use whiskmap::{MapEngine, Options, Regime, Side, map};

/// Perfect cone of 16 mm with a base radius of 33.5 um, straight, in a follicle.
fn cone(stiffness_nnm_per_rad: Option<f64>) -> Whisker {
    Whisker {
        follicle_stiffness_nnm_per_rad: stiffness_nnm_per_rad,
        ..Whisker::cone(16.0, [33.5, 0.0], 5.0)
    }
}

/// Values for 5e-6 N m/rad from the states of a clamped whisker, and from another solver (65.21 degrees); and without a follicle.
#[test]
fn a_pad_lets_go_later() {
    for (stiffness, push_deg, moment_nnm) in [(Some(5000.0), 65.21147, 871.9), (None, 56.20, 684.0)]
    {
        let end = curve(&cone(stiffness), &Pole::smooth(0.0), Side::Cb, &[5.0])[0];
        assert_eq!(end.kind, DetachmentKind::SlipOff);
        let (push, moment) = (end.push_angle_deg.unwrap(), end.base_moment_nnm.unwrap());
        let digits = if stiffness.is_some() { 6e-6 } else { 6e-3 };
        assert!((push - push_deg).abs() < digits, "{push}");
        assert!((moment.abs() - moment_nnm).abs() < 0.6, "{moment}");
    }
}

/// Random tapered whiskers with parabola and friction.
fn random(random: &mut Random) -> (Whisker, Pole) {
    let whisker = Whisker {
        tip_radius_um: random.between(0.0, 15.0),
        curvature: Some(Curvature { parabola_per_mm: random.between(0.0, 0.03), vertex_mm: 0.0 }),
        modulus_tip_to_base: random.between(0.5, 2.0),
        ..cone(None)
    };
    let pole = Pole { radius_mm: random.between(0.0, 0.4), friction: random.between(0.0, 0.3) };
    (whisker, pole)
}

/// At a fixed pole, a state of the clamped whisker is one in a follicle that is pushed further, by moment over stiffness. So the push ends at the
/// largest sum of both along the clamped branch, also if it is among the states that are unstable in a clamp, or unless the tip comes first.
#[test]
fn a_push_is_that_of_a_clamp_and_the_turn_of_the_follicle() {
    let mut numbers = Random::new(5);
    let mut kinds = [0; 2];
    for index in 0..12 {
        let (mut clamped, pole) = random(&mut numbers);
        // A cylinder is pulled off far from the base.
        let mut range = [3.0, 12.0];
        if index % 2 == 1 {
            clamped.tip_radius_um = clamped.base_radius_um;
            range = [8.0, 15.0];
        }
        let pole = Pole::smooth(pole.radius_mm);
        let stiffness = clamped.units().moment_nnm * numbers.between(0.2, 5.0);
        let held = Whisker { follicle_stiffness_nnm_per_rad: Some(stiffness), ..clamped.clone() };
        for side in Side::BOTH {
            let distance_mm = numbers.between(range[0], range[1]);
            let end = curve(&held, &pole, side, &[distance_mm])[0];
            let branch = Branch::new(&clamped, &pole, side, distance_mm).unwrap();
            let points = branch.points(4001).unwrap();
            let pushes = points.iter().map(|point| {
                let turn = (side.sign() * point.base_moment_nnm / stiffness).to_degrees();
                side.sign() * point.push_angle_deg + turn
            });
            let pushes: Vec<f64> = pushes.collect();
            let top = pushes.windows(2).position(|pair| pair[1] < pair[0]);
            let largest = pushes[top.unwrap_or(pushes.len() - 1)];
            kinds[usize::from(end.kind == DetachmentKind::PullOff)] += 1;
            let push = side.sign() * end.push_angle_deg.unwrap();
            // Points are 0.02 degrees apart, and the top is flat.
            assert!((push - largest).abs() < 1e-4, "{held:?} {side:?}: {push} {largest}");
        }
    }
    assert!(kinds.iter().all(|count| *count > 2), "{kinds:?}");
}

#[test]
fn a_stiff_follicle_is_a_clamp() {
    let mut numbers = Random::new(6);
    for _ in 0..8 {
        let (clamped, pole) = random(&mut numbers);
        let held = Whisker { follicle_stiffness_nnm_per_rad: Some(1e15), ..clamped.clone() };
        for side in Side::BOTH {
            let distances = [2.0, 5.0, 8.0, 11.0, 14.0];
            let [held, clamped] =
                [&held, &clamped].map(|whisker| curve(whisker, &pole, side, &distances));
            for (held, clamped) in held.iter().zip(&clamped) {
                assert_eq!(held.kind, clamped.kind);
                if let (Some(held), Some(clamped)) = (held.push_angle_deg, clamped.push_angle_deg) {
                    assert!((held - clamped).abs() < 1e-9, "{held} {clamped}");
                }
            }
        }
    }
}

/// The base's tangent turns by moment over stiffness from the axis of the follicle, and the push does the work that is stored.
#[test]
fn the_base_turns_and_the_spring_stores_energy() {
    let stiffness = 5000.0;
    let whisker = Whisker { tip_radius_um: 2.0, ..cone(Some(stiffness)) };
    let branch = Branch::new(&whisker, &Pole::smooth(0.3), Side::Cb, 6.0).unwrap();
    let points = branch.points(2001).unwrap();
    let mut work = 0.0;
    for pair in points.windows(2) {
        let turn = (pair[1].push_angle_deg - pair[0].push_angle_deg).to_radians();
        work += 0.5 * (pair[0].base_moment_nnm + pair[1].base_moment_nnm) * turn;
        let energy = pair[1].energy_nj;
        assert!((work - energy).abs() < 1e-5 * energy.max(1.0), "{work} {energy}");
    }
    let state = branch.state(40f64.to_radians(), true).unwrap();
    let shape = branch.shape(&state, 200);
    let turn = (shape.state.base_moment_nnm / stiffness).to_degrees();
    assert!(turn > 5.0, "{turn}");
    assert!((shape.points[0].angle_deg - (turn - 40.0)).abs() < 1e-9);
    let moment = shape.points[0].moment_nnm;
    assert!((moment.abs() - shape.state.base_moment_nnm.abs()).abs() < 1e-9 * moment.abs());
}

/// A sweep from nearly a hinge to nearly a clamp.
const SCENE: &str = "title = 'Follicle'\n[whisker]\nlength_mm = 20\nbase_radius_um = 30\ntip_radius_um = 1.5\nyoungs_modulus_gpa = 3\n\
    curvature.parabola_per_mm = 0.02\n[pole]\nradius_mm = 0.25\n[grid]\n\
    push_angle_deg = { from = -120, to = 120, count = 241 }\ndistance_mm = { from = 4, to = 20, count = 65 }\n\
    follicle_stiffness_nnm_per_rad = [20, 300, 5000, 1e6]\n";

/// Cells are in the regimes that their boundaries say, by trajectories and by nets, and nothing is left open.
#[test]
fn engines_agree_from_hinge_to_clamp() {
    let scene = Scene::parse(SCENE, "follicle").unwrap();
    let maps = [MapEngine::Cpu, MapEngine::Spectral].map(|engine| {
        let mut options = Options::default();
        options.engine = engine;
        map(&scene, options).unwrap()
    });
    let [trajectories, nets] = &maps;
    let engine = &nets.summary.engine_cells;
    assert!(engine.solved > nets.summary.refined / 2, "{engine:?}");
    for (cell, other) in trajectories.cells().zip(nets.cells()) {
        assert_eq!(cell.regime, other.regime, "{cell:?}");
        assert_ne!(cell.regime, Regime::Unresolved, "{cell:?}");
    }
    // The softer the follicle, the later the whisker lets go.
    let contacts = |whisker: usize| {
        let cells = trajectories.cells().filter(|cell| cell.whisker == whisker);
        cells.filter(|cell| cell.regime == Regime::Contact).count()
    };
    let contacts: Vec<usize> = (0..4).map(contacts).collect();
    assert!(contacts.windows(2).all(|pair| pair[0] > pair[1]), "{contacts:?}");
}

/// Largest push angle whose end is found, in turns (`docs/scenes.md`).
const MOST_TURNS: f64 = 9.0;

/// Push angles of [`soft_scene`], in degrees.
const PUSHES_DEG: [f64; 8] = [-360.0, -90.0, -5.0, -1e-6, 1e-6, 5.0, 90.0, 360.0];

/// The whisker in a follicle of this stiffness, at a pole of 0.25 mm.
fn soft_scene(whisker: &Whisker, stiffness: f64, distances_mm: &[f64]) -> Scene {
    let Whisker { length_mm, base_radius_um, tip_radius_um, youngs_modulus_gpa, .. } = whisker;
    let bend = whisker.curvature.map_or(0.0, |parabola| parabola.parabola_per_mm);
    let text = format!(
        "title = 'Soft'\n[whisker]\nlength_mm = {length_mm}\nbase_radius_um = {base_radius_um}\ntip_radius_um = {tip_radius_um}\n\
         youngs_modulus_gpa = {youngs_modulus_gpa}\ncurvature.parabola_per_mm = {bend}\n\
         follicle.stiffness_nnm_per_rad = {stiffness:e}\n[pole]\nradius_mm = 0.25\n[grid]\n\
         push_angle_deg = {PUSHES_DEG:?}\ndistance_mm = {distances_mm:?}\n"
    );
    Scene::parse(&text, "soft").unwrap()
}

/// In soft follicles, down to the smallest stiffness of a scene, pushes end where the branch of the clamped whisker says. Those that end beyond
/// nine turns are unresolved, and no others; the engines agree on every cell.
#[test]
fn pushes_in_soft_follicles_end_within_nine_turns_or_are_unresolved() {
    let distances = [0.4, 6.0, 14.0, 15.9];
    let curved = |tip_radius_um: f64| Whisker {
        tip_radius_um,
        curvature: Some(Curvature { parabola_per_mm: 0.02, vertex_mm: 0.0 }),
        ..cone(None)
    };
    let mut counts = [0; 2];
    for clamped in [cone(None), curved(1.5), curved(33.5)] {
        let pole = Pole::smooth(0.25);
        let soft = [1.0, 100.0].map(|compliance| clamped.units().moment_nnm / compliance);
        for stiffness in soft.into_iter().chain([1e-6]) {
            let held =
                Whisker { follicle_stiffness_nnm_per_rad: Some(stiffness), ..clamped.clone() };
            let maps = [MapEngine::Cpu, MapEngine::Spectral].map(|engine| {
                let mut options = Options::default();
                options.engine = engine;
                map(&soft_scene(&held, stiffness, &distances), options).unwrap()
            });
            let [by_cpu, other] = [&maps[0].panels[0], &maps[1].panels[0]];
            assert_eq!(
                (&by_cpu.regime, &by_cpu.status),
                (&other.regime, &other.status),
                "{held:?}"
            );
            for (index, distance_mm) in distances.into_iter().enumerate() {
                for side in Side::BOTH {
                    let Ok(branch) = Branch::new(&clamped, &pole, side, distance_mm) else {
                        continue;
                    };
                    let points = branch.points(2001).unwrap();
                    let turns = points.iter().map(|point| {
                        let turn = (side.sign() * point.base_moment_nnm / stiffness).to_degrees();
                        (side.sign() * point.push_angle_deg + turn) / 360.0
                    });
                    let turns: Vec<f64> = turns.collect();
                    let top = turns.windows(2).position(|pair| pair[1] < pair[0]);
                    let end = turns[top.unwrap_or(turns.len() - 1)];
                    let found = curve(&held, &pole, side, &[distance_mm])[0];
                    let case = format!("{held:?} {side:?} at {distance_mm} mm: {end} {found:?}");
                    assert_eq!(found.push_angle_deg.is_some(), end < MOST_TURNS, "{case}");
                    counts[usize::from(end < MOST_TURNS)] += 1;
                    if let Some(push_deg) = found.push_angle_deg {
                        let off = side.sign() * push_deg / 360.0 / end - 1.0;
                        assert!(off.abs() < 1e-4, "{case}");
                    }
                    let cells = index * PUSHES_DEG.len()..(index + 1) * PUSHES_DEG.len();
                    for (cell, push_deg) in cells.zip(PUSHES_DEG) {
                        if side.sign() * push_deg <= 0.0 {
                            continue;
                        }
                        let is_open = by_cpu.regime[cell] == Regime::Unresolved.code();
                        assert_eq!(is_open, end > MOST_TURNS, "{case} {push_deg}");
                        let has_reason = by_cpu.status[cell] == Status::NoBoundary.code();
                        assert_eq!(is_open, has_reason, "{case} {push_deg}");
                    }
                }
            }
        }
    }
    assert!(counts.iter().all(|count| *count > 15), "{counts:?}");
}

/// The stiffness comes back from detachments of the shipped scene, from far away.
#[test]
fn a_fit_recovers_the_stiffness() {
    let scene = shipped::scene("follicle");
    let mut points = "side,distance_mm,push_angle_deg\n".to_owned();
    for side in Side::BOTH {
        for end in curve(&scene.whisker, &scene.pole, side, &[3.0, 5.0, 8.0]) {
            let push_deg = end.push_angle_deg.unwrap();
            let side = if side == Side::Cb { "cb" } else { "cf" };
            points += &format!("{side},{},{push_deg:.9}\n", end.distance_mm);
        }
    }
    let points = MeasuredPoints::parse(&points, "points.csv").unwrap();
    let stiffness = Parameter::FollicleStiffness;
    for start in [300.0, 1e5] {
        let start = scene.with(stiffness, start).unwrap();
        let fit = fit(&start, &points, &[stiffness]).unwrap();
        let found = fit.estimates[0];
        assert!((found.value / 5000.0 - 1.0).abs() < 1e-7, "{found:?}");
        assert!(found.standard_error.unwrap() < 1e-6 * found.value, "{found:?}");
    }
}

/// The base turns with the moment over the stiffness: far more than nine times, or so only along the unstable states.
#[test]
fn states_beyond_nine_turns_are_left_out() {
    let branch = |stiffness| Branch::new(&cone(Some(stiffness)), &Pole::smooth(0.0), Side::Cb, 5.0);
    let why = branch(5.0).unwrap_err();
    assert_eq!(why, NoState::BeyondTurns);
    assert!(why.to_string().contains("nine turns of the base (3240 deg)"));
    let kinds = [5.0, 25.0].map(|stiffness| {
        let end = curve(&cone(Some(stiffness)), &Pole::smooth(0.0), Side::Cb, &[5.0])[0];
        (end.kind, end.push_angle_deg)
    });
    assert_eq!(kinds[0], (DetachmentKind::Unresolved, None));
    let cut = branch(25.0).unwrap();
    let end = cut.stable_end_deg();
    assert!((end - kinds[1].1.unwrap()).abs() < 1e-6, "{end} {kinds:?}");
    let marks = |branch: &Branch| {
        let points = branch.points(200).unwrap();
        let largest = points.iter().map(|point| point.push_angle_deg.abs());
        let marks: Vec<BranchMark> = points.iter().filter_map(|point| point.mark).collect();
        (marks, largest.fold(0.0, f64::max))
    };
    let (cut, largest) = marks(&cut);
    assert_eq!(cut, [BranchMark::FirstTouch, BranchMark::SlipOff]);
    assert!(3240.0 < largest && largest < 3250.0, "{largest}");
    let (whole, largest) = marks(&branch(60.0).unwrap());
    assert_eq!(whole.last(), Some(&BranchMark::SecondFold));
    assert!(largest < 3240.0, "{largest}");
}
