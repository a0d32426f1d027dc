//! Properties of every branch.

use super::{EVERY_BRANCH, POLE, branches_at_9_mm, whisker};
use std::sync::atomic::AtomicBool;
use whiskmap::Side;
use whiskmap::scene::Pole;
use whiskmap::trace::{
    Branch, BranchMark, BranchPoint, DetachmentKind, NoState, PushLoad, StableBranch,
};

/// Runs `check` on the branch of every whisker that reaches its pole, with `count` points.
fn every_branch(count: usize, check: impl Fn(&str, &Branch, &[BranchPoint], f64)) {
    let mut followed = 0;
    for traced in EVERY_BRANCH.iter() {
        let (case, end) = (traced.case(), traced.end);
        match &traced.branch {
            Ok(branch) => {
                let points = branch.points(count).unwrap();
                let push = traced.side.sign() * end.push_angle_deg.unwrap();
                check(&case, branch, &points, push);
                let kind = match points.iter().find(|point| point.mark == Some(BranchMark::SlipOff))
                {
                    Some(_) => DetachmentKind::SlipOff,
                    None => DetachmentKind::PullOff,
                };
                assert_eq!(kind, end.kind, "{case}");
                followed += 1;
            }
            Err(NoState::OutOfReach { .. }) => {
                assert_eq!(end.kind, DetachmentKind::OutOfReach, "{case}");
            }
            Err(why) => panic!("{case}: {why}"),
        }
    }
    assert!(followed > 450, "{followed}");
}

/// States of the stable part alone, and the reasons why there are none before first touch and after the end.
#[test]
fn the_stable_part_has_the_states_of_the_branch() {
    let mut compared = 0;
    for (traced, branch) in branches_at_9_mm() {
        let case = traced.case();
        let part = StableBranch::new(&traced.whisker, &traced.pole, traced.side, 9.0).unwrap();
        let end = branch.stable_end_deg();
        assert_eq!(part.stable_end_deg(), end, "{case}");
        let moments = [&part, &**branch].map(|part| part.rough_peak(PushLoad::BaseMoment));
        assert_eq!(moments[0], moments[1], "{case}");
        for share in [-0.1, 0.01, 0.3, 0.7, 0.99, 1.1] {
            let push = (share * end).to_radians();
            assert_eq!(part.state(push), branch.state(push, true), "{case}");
            compared += 1;
        }
    }
    assert!(compared > 600, "{compared}");
}

#[test]
fn det_changes_its_sign_at_the_fold_and_only_there() {
    every_branch(100, |case, _, points, end| {
        let fold = points.iter().position(|point| point.mark == Some(BranchMark::SlipOff));
        let stable = &points[..fold.unwrap_or(points.len())];
        assert!(stable.iter().all(|p| p.stable && p.det > 0.0), "{case}");
        if let Some(fold) = fold {
            let unstable = &points[fold + 1..points.len() - 1];
            assert!(unstable.iter().all(|p| !p.stable && p.det < 0.0), "{case}");
            let scale = points.iter().fold(0.0_f64, |most, p| most.max(p.det.abs()));
            assert!(points[fold].det.abs() < 1e-9 * scale, "{case}: {:?}", points[fold]);
        }
        let last = fold.unwrap_or(points.len() - 1);
        let most = points
            .iter()
            .map(|p| p.push_angle_deg.abs() * f64::from(u8::from(p.push_angle_deg * end >= 0.0)));
        let most = most.fold(0.0_f64, f64::max);
        let at_end = points[last].push_angle_deg.abs();
        assert!(at_end >= most || fold.is_none(), "{case}: {at_end} {most}");
        assert!((at_end - end.abs()).abs() < 1e-9, "{case}: {at_end} {end}");
    });
}

#[test]
fn a_branch_begins_at_first_touch_and_marks_its_end() {
    every_branch(20, |case, _, points, _| {
        let (first, last) = (points[0], points[points.len() - 1]);
        assert_eq!(first.mark, Some(BranchMark::FirstTouch), "{case}");
        assert!(first.push_angle_deg == 0.0 && first.force_un == 0.0, "{case}: {first:?}");
        match last.mark {
            Some(BranchMark::Tip | BranchMark::PullOff) => {
                assert!((last.arc_length_mm - 20.0).abs() < 1e-7, "{case}: {last:?}")
            }
            Some(BranchMark::SecondFold) => assert!(!last.stable, "{case}"),
            other => panic!("{case}: {other:?}"),
        }
        let marked = points.iter().filter(|point| point.mark.is_some()).count();
        assert!(points.len() == 20 && marked <= 3, "{case}");
    });
}

/// Chords between neighbours have equal lengths in push angle, contact angle and arclength of the contact. The fold divides the branch
/// into two parts, each with a whole number of intervals. With 2000 points chords are as long as arcs.
#[test]
fn points_are_evenly_spaced() {
    for (tip, a) in [(30.0, 0.0), (6.0, 0.04), (0.0, 0.02)] {
        for (radius, distance) in [(0.0, 4.0), (0.25, 0.5), (0.25, 12.0), (1.0, 18.5)] {
            let pole = Pole::smooth(radius);
            for side in Side::BOTH {
                let case = format!("tip {tip} a {a} {pole:?} at {distance} {side:?}");
                let branch = Branch::new(&whisker(tip, a), &pole, side, distance).unwrap();
                let points = branch.points(2000).unwrap();
                let chords: Vec<f64> =
                    points.windows(2).map(|pair| chord(pair[0], pair[1])).collect();
                let fold = points.iter().position(|point| point.mark == Some(BranchMark::SlipOff));
                let fold = fold.unwrap_or(chords.len());
                for part in [&chords[..fold], &chords[fold..]] {
                    let shortest = part.iter().copied().fold(f64::INFINITY, f64::min);
                    let longest = part.iter().copied().fold(0.0, f64::max);
                    assert!(longest <= 1.03 * shortest, "{case}: {shortest} {longest}");
                }
            }
        }
    }
}

fn chord(a: BranchPoint, b: BranchPoint) -> f64 {
    let push = (a.push_angle_deg - b.push_angle_deg).to_radians();
    let angle = (a.contact_angle_deg - b.contact_angle_deg).to_radians();
    let arc = (a.arc_length_mm - b.arc_length_mm) / 20.0;
    (push * push + angle * angle + arc * arc).sqrt()
}

/// The state at the push angle of a point equals the point.
#[test]
fn states_reproduce_points() {
    every_branch(12, |case, branch, points, _| {
        for point in points.iter().filter(|point| point.mark.is_none()) {
            let push = point.push_angle_deg.to_radians();
            let state = branch.state(push, point.stable).unwrap();
            let reading = branch.read(&state);
            let miss = (reading.arc_length_mm - point.arc_length_mm).abs();
            assert!(miss < 1e-9, "{case}: {point:?} {reading:?}");
            let pole = branch.row().pole(push);
            assert!(state.full.map.pole.distance(pole) < 1e-12, "{case}: {point:?}");
        }
    });
}

#[test]
fn a_cancelled_branch_says_so() {
    let whisker = whisker(2.5, 0.01);
    let branch = Branch::new(&whisker, &POLE, Side::Cb, 9.0).unwrap();
    let points = branch.points_until(50, &AtomicBool::new(true));
    assert_eq!(points, Err(NoState::Cancelled));
    assert_eq!(NoState::Cancelled.to_string(), "cancelled");
}

#[test]
fn missing_states_have_a_reason() {
    let branch = Branch::new(&whisker(1.5, 0.02), &POLE, Side::Cb, 15.660_459_763_365_8).unwrap();
    let slipped = branch.state(0.3, true).unwrap_err().to_string();
    assert_eq!(slipped, "slipped off at 15.607930004 deg");
    let lost = branch.state(-0.3, true).unwrap_err().to_string();
    assert_eq!(
        lost,
        "lost touch: the whisker has moved away from the pole; must be between 0.000000000 and 15.607930004 deg"
    );
    let unstable = branch.state(0.3, false).unwrap_err().to_string();
    assert!(
        unstable.starts_with("the unstable states lie between 15.607930004 and -22.11"),
        "{unstable}"
    );
    let branch = Branch::new(&whisker(30.0, 0.02), &POLE, Side::Cf, 17.063_022_998_952_17).unwrap();
    let pulled = branch.state(-1.7, true).unwrap_err().to_string();
    assert_eq!(pulled, "pulled off at -90.346386911 deg");
    let none = branch.state(-1.0, false).unwrap_err().to_string();
    assert_eq!(none, "no unstable state: pulled off at -90.346386911 deg, before any fold");
    let far = Branch::new(&whisker(1.5, 0.0), &POLE, Side::Cb, 20.5).unwrap_err();
    assert_eq!(
        far.to_string(),
        "out of reach: the tip of the resting whisker is 20.000000000 mm from its base"
    );
}
