//! Classification of cells by the boundary of their row and, at the reach of the resting whisker, by its shape at rest.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use crate::compute;

use compute::compute_as;
use whiskmap::Side;
use whiskmap::accuracy::cheapest;
use whiskmap::classify::{Outcome, PushSpan, Regime, RowBoundary, Status, TIE};
use whiskmap::mechanics::shooting::Resolution;
use whiskmap::plan::Plan;
use whiskmap::scene::{Scene, SweptWhisker, Whisker};
use whiskmap::sheet::{Crossing, Edge};
use whiskmap::trace::{Detachment, DetachmentKind, curve_at};

const LENGTH_MM: f64 = 20.0;

/// Distances in whisker lengths: well within reach, a tenth of a micrometre from it, at it but for rounding, and beyond.
const DISTANCES: [f64; 7] = [0.9, 1.0 - 5e-9, 1.0 - 1e-15, 1.0, 1.0 + 1e-15, 1.0 + 5e-9, 1.01];

/// Number of distances that a whisker reaches. A perfect cone ends a billionth of its length before its point.
const REACHED: usize = 5;
const REACHED_BY_A_POINT: usize = 2;

/// Scene of straight whiskers from cylinder to perfect cone.
fn straight(pole: f64, friction: f64) -> Scene {
    let distances = DISTANCES.map(|d| d * LENGTH_MM);
    let text = format!(
        "title = \"straight\"\n[whisker]\nlength_mm = {LENGTH_MM:?}\nbase_radius_um = 30\nyoungs_modulus_gpa = 3\n\
         [pole]\nradius_mm = {pole:?}\n[contact]\nfriction = {friction:?}\n[grid]\n\
         push_angle_deg = [-120, -70, -10, -1, 0, 1, 10, 70, 120]\ndistance_mm = {distances:?}\n\
         taper = [0, 1e-9, 0.3, 0.7, 0.9, 0.95, 0.98, 0.999, 0.999999, 1]"
    );
    Scene::parse(&text, "straight").unwrap()
}

/// Holds at every resolution, and at the one that a tolerance of 1e-3 degrees selects.
#[test]
fn the_shape_at_rest_decides_at_the_straight_length() {
    for (pole, friction) in [(0.0, 0.0), (0.25, 0.0), (1.0, 0.0), (0.25, 0.4)] {
        let scene = straight(pole, friction);
        let cheapest = cheapest(&scene, &Side::BOTH, 1e-3).unwrap().resolution;
        let mut first: Option<Vec<Vec<u32>>> = None;
        for resolution in Resolution::LADDER.into_iter().rev().chain([cheapest]) {
            let mut plan = Plan::new(&scene).unwrap();
            plan.method.resolution = resolution;
            let (summary, panels) = compute_as(&scene, &plan, None);
            let case = format!("pole {pole}, friction {friction}, {resolution:?}");
            assert_eq!((summary.unresolved(), summary.disagreements), (0, 0), "{case}");
            let regimes: Vec<Vec<u32>> = panels.into_iter().map(|panel| panel.regime).collect();
            for (SweptWhisker { whisker, .. }, regimes) in scene.whiskers().flatten().zip(&regimes)
            {
                let case = format!("{case}, taper {}", whisker.taper());
                for side in Side::BOTH {
                    let case = format!("{case}, {side:?}");
                    agrees_with_its_curve(&scene, &whisker, side, resolution, regimes, &case);
                }
            }
            let first = first.get_or_insert_with(|| regimes.clone());
            assert_eq!(*first, regimes, "{case}");
        }
    }
}

/// Asserts that the curve of `whisker` agrees with `regimes`, and that all distances at the reach have the same kind of end.
fn agrees_with_its_curve(
    scene: &Scene,
    whisker: &Whisker,
    side: Side,
    resolution: Resolution,
    regimes: &[u32],
    case: &str,
) {
    let pushes = &scene.grid.push_angle_deg;
    let ends = curve_at(resolution, whisker, &scene.pole, side, &scene.grid.distance_mm);
    for (end, regimes) in ends.iter().zip(regimes.chunks(pushes.len())) {
        let case = format!("{case}: {end:?}");
        let (beyond, at) = match (end.kind, end.push_angle_deg) {
            (DetachmentKind::SlipOff, Some(at)) => (Regime::SlipOff, at.abs()),
            (DetachmentKind::PullOff, Some(at)) => (Regime::PullOff, at.abs()),
            (DetachmentKind::OutOfReach, None) => (Regime::OutOfReach, -1.0),
            _ => panic!("{case}"),
        };
        for (push, regime) in pushes.iter().zip(regimes) {
            if Side::of_push(*push) == side {
                let expected = if push.abs() <= at { Regime::Contact } else { beyond };
                // A thick pole beyond the reach can be touched, but not by a push from rest.
                let entered = beyond == Regime::OutOfReach && *regime == Regime::Unreachable.code();
                assert!(entered || *regime == expected.code(), "{case}, push {push}: {regime}");
            }
        }
    }
    let reached = |end: &Detachment| end.kind != DetachmentKind::OutOfReach;
    let count = if whisker.taper() == 1.0 { REACHED_BY_A_POINT } else { REACHED };
    assert!(ends[..count].iter().all(reached), "{case}");
    assert!(!ends[count..].iter().any(reached), "{case}");
    let kind = ends[count - 1].kind;
    assert!(ends[1..count].iter().all(|end| end.kind == kind), "{case}");
}

fn crossing(edge: Edge, push: f64) -> Crossing {
    Crossing { edge, tau: 1.0, load: 1.0, push, residual: 0.0, slope: 0.0 }
}

#[test]
fn a_row_that_touches_ends_at_its_edge() {
    let row = RowBoundary::new(true, &[crossing(Edge::Fold, 0.5)]);
    assert_eq!(row.classify(0.3, Outcome::Solved), (Regime::Contact, Status::Solved));
    assert_eq!(row.classify(0.6, Outcome::OffSheet), (Regime::SlipOff, Status::Outside));
    let row = RowBoundary::new(true, &[crossing(Edge::Tip, 0.5)]);
    assert_eq!(row.classify(0.6, Outcome::BeyondTip), (Regime::PullOff, Status::BeyondTip));
}

#[test]
fn a_row_beyond_reach_is_entered_over_an_edge() {
    let row = RowBoundary::new(false, &[crossing(Edge::Tip, 0.2), crossing(Edge::Fold, 0.5)]);
    assert_eq!(row.classify(0.3, Outcome::Solved), (Regime::Unreachable, Status::Solved));
    for push in [0.1, 0.6] {
        assert_eq!(row.classify(push, Outcome::OffSheet), (Regime::OutOfReach, Status::Outside));
    }
}

#[test]
fn contradictions_are_unresolved() {
    let row = RowBoundary::new(true, &[crossing(Edge::Fold, 0.5)]);
    for (push, outcome) in
        [(0.6, Outcome::Solved), (0.3, Outcome::OffSheet), (0.0, Outcome::BeyondFold)]
    {
        assert_eq!(row.classify(push, outcome), (Regime::Unresolved, Status::Disagreement));
    }
    let odd = RowBoundary::new(false, &[crossing(Edge::Fold, 0.5)]);
    assert_eq!(odd.classify(0.3, Outcome::Solved), (Regime::Unresolved, Status::NoBoundary));
}

/// Known spans are valid. Beyond them another piece of the row may have a state.
#[test]
fn cells_beyond_the_known_spans_of_an_incomplete_row_are_unresolved() {
    let row = RowBoundary::new(true, &[crossing(Edge::Fold, 0.5), Crossing::unknown()]);
    assert_eq!(row.classify(0.3, Outcome::Solved).0, Regime::Contact);
    assert_eq!(row.detachment().map(PushSpan::to), Some(0.5));
    for outcome in [Outcome::OffSheet, Outcome::BeyondFold, Outcome::Solved] {
        assert_eq!(row.classify(0.6, outcome), (Regime::Unresolved, Status::NoBoundary));
    }
    let unknown = RowBoundary::new(false, &[Crossing::unknown()]);
    assert_eq!(unknown.classify(0.1, Outcome::OffSheet).0, Regime::Unresolved);
}

#[test]
fn both_verdicts_are_correct_on_the_edge() {
    let row = RowBoundary::new(true, &[crossing(Edge::Fold, 0.5)]);
    let at = 0.5 + 0.5 * TIE;
    assert_eq!(row.classify(at, Outcome::Solved).0, Regime::Contact);
    assert_eq!(row.classify(at, Outcome::BeyondFold).0, Regime::SlipOff);
}

/// Rows beyond the reach of the resting whisker that a thick pole enters, with poor guesses near their first states. With coarse steps
/// the end of the continuation differs slightly from the boundary; this difference must not make cells doubtful.
#[test]
fn coarse_steps_leave_no_cell_in_doubt() {
    let slender = "title = 'slender'\n[whisker]\nlength_mm = 20\nbase_radius_um = 30\ntip_radius_um = 0.0003\n\
                   youngs_modulus_gpa = 3\n[whisker.curvature]\nparabola_per_mm = 0.05\n[pole]\nradius_mm = 1.4\n[grid]\n\
                   push_angle_deg = [0, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.3, 0.5]\n\
                   distance_mm = { from = 16, to = 19.98, count = 1000 }";
    let cone = include_str!("../scenes/cone.toml");
    let pointed = Scene::parse(cone, "cone.toml").unwrap();
    let pointed = pointed.with(whiskmap::scene::Parameter::TipRadiusUm, 0.0).unwrap();
    let pushes: Vec<f64> = (-256..=256).map(|i| 70.0 * f64::from(i) / 256.0).collect();
    let pointed = pointed.to_builder().push_angle_deg(pushes).build().unwrap();
    for (scene, tolerances) in
        [(Scene::parse(slender, "slender").unwrap(), [1e-1, 1e-4]), (pointed, [1e-1, 1e-3])]
    {
        for tolerance_deg in tolerances {
            let mut plan = Plan::new(&scene).unwrap();
            let cheapest = cheapest(&scene, &Side::BOTH, tolerance_deg).unwrap();
            plan.method.resolution = cheapest.resolution;
            let (summary, _) = compute_as(&scene, &plan, None);
            assert_eq!(summary.unresolved(), 0, "{}, {cheapest:?}", scene.title);
        }
    }
}

/// All push angles of a range with one verdict are classified alike. A range at the end of a span is not one.
#[test]
fn one_verdict_holds_from_end_to_end() {
    let fold = |push| crossing(Edge::Fold, push);
    let rows = [
        RowBoundary::new(true, &[fold(0.5)]),
        RowBoundary::new(true, &[fold(0.5), crossing(Edge::Tip, 0.7), fold(0.8)]),
        RowBoundary::new(false, &[crossing(Edge::Tip, 0.0), fold(0.8)]),
        RowBoundary::new(true, &[fold(0.5), Crossing::unknown()]),
        RowBoundary::new(false, &[Crossing::unknown()]),
    ];
    let near = |end: f64| [-2.0, -0.5, 0.0, 0.5, 2.0].map(|ties| end + ties * TIE);
    let ends = [0.0, 0.5, 0.7, 0.8].into_iter().flat_map(near);
    let pushes = ends.chain([0.3, 0.6, 0.75, 1.0]);
    let mut pushes: Vec<f64> = pushes.filter(|push| *push >= 0.0).collect();
    pushes.sort_by(f64::total_cmp);
    let outcomes = [
        Outcome::Solved,
        Outcome::AtTip,
        Outcome::BeyondTip,
        Outcome::BeyondFold,
        Outcome::OffSheet,
        Outcome::NotConverged,
    ];
    for row in &rows {
        let alike = |outcome: Outcome, from: usize, to: usize| {
            let verdict = |push: &f64| (row.classify(*push, outcome), row.span(*push));
            pushes[from..=to].iter().all(|push| verdict(push) == verdict(&pushes[from]))
        };
        for from in 0..pushes.len() {
            for to in from..pushes.len() {
                let holds = outcomes.iter().all(|outcome| alike(*outcome, from, to));
                if row.is_one_verdict(pushes[from], pushes[to]) {
                    assert!(holds, "{row:?}: {} to {}", pushes[from], pushes[to]);
                }
            }
            // A push angle away from all ends is a range with one verdict.
            let ends = row.spans().iter().flat_map(|span| [span.from(), span.to()]);
            let is_apart = ends.into_iter().all(|end| (end - pushes[from]).abs() > 1.5 * TIE);
            assert_eq!(row.is_one_verdict(pushes[from], pushes[from]), is_apart);
        }
    }
}
