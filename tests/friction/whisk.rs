//! Courses with friction that turn back: balance of energy, closed cycles, and an independent integration.

use super::cone;
use super::course::{allowed, stepped};
use whiskmap::friction::Sliding;
use whiskmap::mechanics::rod::{Rest, Side};
use whiskmap::scene::{Scene, Whisker};
use whiskmap::trace::Branch;
use whiskmap::whisk::{AngleCourse, Undecided, Whisk, WhiskEventKind, WhiskRegime, whisk};

const DISTANCE: f64 = 15.66;

/// The course of the scene's whisker through these angles in degrees, one a second.
fn through(scene: &Scene, angles: &[f64]) -> Whisk {
    through_at(scene, DISTANCE, angles)
}

/// The course as [`through`], at another distance in mm.
fn through_at(scene: &Scene, distance: f64, angles: &[f64]) -> Whisk {
    let times = (0..angles.len()).map(|i| i as f64).collect();
    let course = AngleCourse::new(times, angles.to_vec()).unwrap();
    whisk(&scene.whisker, &scene.pole, distance, &course).unwrap()
}

/// Angles from turning point to turning point, with `count` samples on each way; the first point is one of them.
fn to_and_fro(turns: &[f64], count: u32) -> Vec<f64> {
    let ways = turns.windows(2).flat_map(|pair| {
        let part = move |i| f64::from(i) / f64::from(count);
        (1..=count).map(move |i| (pair[1] - pair[0]).mul_add(part(i), pair[0]))
    });
    [turns[0]].into_iter().chain(ways).collect()
}

/// Work of the base over the samples, in nJ: trapezia between neighbours.
fn work(found: &Whisk) -> f64 {
    let pairs = found.samples.windows(2);
    let work = pairs.map(|pair| {
        let moments = [0, 1].map(|i| pair[i].base_moment_nnm.unwrap());
        let turned = (pair[1].angle_deg.unwrap() - pair[0].angle_deg.unwrap()).to_radians();
        0.5 * (moments[0] + moments[1]) * turned
    });
    work.sum()
}

/// Over a cycle from rest to rest, the work of the base is what friction dissipates and what detachments lose.
#[test]
fn the_work_of_the_base_is_dissipated() {
    const COUNT: u32 = 20_000;
    let mut snaps = 0;
    for (distance, [a_per_mm, radius_mm, friction], turns) in [
        (DISTANCE, [0.02, 0.25, 0.3], &[-0.5, 12.0, 4.0, 14.0, -0.5][..]),
        (DISTANCE, [0.02, 0.0, 0.9], &[-0.5, 9.0, -0.5]),
        (DISTANCE, [0.02, 0.25, 0.3], &[3.0, -20.0, -8.0, -24.0, 3.0]),
        (DISTANCE, [0.04, 1.0, 0.1], &[-0.5, 8.0, -0.5]),
        (DISTANCE, [0.02, 0.25, 0.3], &[-0.5, 17.0, -0.5]),
        // The contact meets the base limit next to its fold.
        (7.75, [0.02, 0.0, 0.3], &[3.0, -56.54, 3.0]),
    ] {
        let scene = cone(a_per_mm, radius_mm, friction);
        let through = |scene: &Scene, angles: &[f64]| through_at(scene, distance, angles);
        let mut angles = to_and_fro(turns, COUNT);
        let snap = |found: &Whisk| {
            let mut snaps = found.events.iter();
            snaps.find(|event| event.event == WhiskEventKind::Snap).copied()
        };
        // The moment jumps at a snap: it gets a sample just before and just after it.
        if let Some(snap) = snap(&through(&scene, &angles)) {
            let after = angles.iter().enumerate().position(|(i, _)| i as f64 > snap.time_s);
            let after = after.unwrap();
            let step = 1e-7_f64.copysign(angles[after] - angles[after - 1]);
            let beside = [-step, step].map(|step| snap.angle_deg + step);
            angles.splice(after..after, beside);
        }
        let found = through(&scene, &angles);
        assert_eq!(found.samples.last().unwrap().regime, WhiskRegime::Free);
        snaps += usize::from(snap(&found).is_some());
        let (work, taken) = (work(&found), found.dissipated_nj());
        // Measured: 2.4e-8.
        assert!(
            (work / taken - 1.0).abs() < 1e-6 && taken > 0.0,
            "{distance} {a_per_mm} {radius_mm} {friction} {turns:?}: {work} {taken} {:e}",
            work / taken - 1.0
        );
    }
    assert_eq!(snaps, 2);
}

/// After the first cycle, every cycle without a detachment returns to the same forces and dissipates the same energy.
#[test]
fn a_cycle_is_closed() {
    let scene = cone(0.02, 0.25, 0.3);
    let found = through(&scene, &to_and_fro(&[-0.5, 12.0, 4.0, 12.0, 4.0, 12.0], 60));
    let [second, third] = [60, 180].map(|from| &found.samples[from..=from + 120]);
    let mut slidings = [0; 3];
    for (one, other) in second.iter().zip(third) {
        let [a, b] = [one, other].map(|sample| sample.force_un.unwrap());
        assert!((a - b).abs() <= 1e-10 * a, "{a} {b}");
        assert_eq!(one.sliding, other.sliding);
        slidings[one.sliding.unwrap() as usize] += 1;
    }
    assert!(slidings.iter().all(|count| *count > 5), "{slidings:?}");
    let taken = [second, third].map(|cycle| {
        let [first, last] = [0, cycle.len() - 1].map(|i| cycle[i].dissipated_nj.unwrap());
        last - first
    });
    assert!((taken[0] / taken[1] - 1.0).abs() < 1e-9 && taken[0] > 0.0, "{taken:?}");
}

/// The end of a row's boundary and that of a limit differ by a rounding. Contacts slide to the slip-off there, whatever the friction.
#[test]
fn slip_offs_have_states() {
    let angles = to_and_fro(&[-0.5, 40.0, -60.0, -0.5], 50);
    for friction in [0.003, 0.01, 0.03, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5] {
        for distance in [12.0, 13.0, 14.5, 15.66, 17.0] {
            let found = through_at(&cone(0.02, 0.25, friction), distance, &angles);
            let ends = found.events.iter();
            let ends = ends.filter(|event| event.event == WhiskEventKind::SlipOff);
            let known = ends.filter(|event| event.energy_nj.is_some()).count();
            assert_eq!(known, 2, "{friction} {distance}: {:?}", found.events);
            assert!(found.samples.iter().all(|sample| sample.reason.is_none()));
        }
    }
}

/// A contact that sticks has a state at every turning point, and where the push is back at 0: the whisker is still bent there.
#[test]
fn turning_points_that_stick_have_states() {
    let scene = cone(0.02, 0.25, 0.9);
    for i in 0..120 {
        let turn = 0.1 * f64::from(i);
        let found = through_at(&scene, 5.0, &[-10.0, 60.0, turn, turn + 5.0]);
        let reasons: Vec<_> = found.samples.iter().map(|sample| sample.reason).collect();
        assert_eq!(reasons, [None; 4], "{turn}");
        assert_eq!(found.samples[2].sliding, Some(Sliding::Sticks), "{turn}");
    }
    let found = through_at(&scene, 5.0, &[-10.0, 60.0, 1e-9, 0.0]);
    let [before, at_zero] = [2, 3].map(|i| found.samples[i].force_un.unwrap());
    assert!((at_zero / before - 1.0).abs() < 1e-9 && at_zero > 100.0, "{before} {at_zero}");
}

/// A contact that sticks at a point stays where it is, however many samples there are. Newton's method stalls at other states of this cylinder.
#[test]
fn a_contact_that_sticks_stays() {
    let scene = cone(0.0, 0.0, 0.2);
    let whisker = Whisker { base_radius_um: 100.0, tip_radius_um: 100.0, ..scene.whisker.clone() };
    let back = to_and_fro(&[112.517, 0.0], 600);
    let angles: Vec<f64> = [-0.5].into_iter().chain(back).collect();
    let times = (0..angles.len()).map(|i| i as f64).collect();
    let course = AngleCourse::new(times, angles).unwrap();
    let found = whisk(&whisker, &scene.pole, 10.4, &course).unwrap();
    let mut sticking = 0;
    for pair in found.samples.windows(2) {
        if [0, 1].map(|i| pair[i].sliding) == [Some(Sliding::Sticks); 2] {
            let [before, after] = [0, 1].map(|i| pair[i].arc_length_mm.unwrap());
            assert!((before - after).abs() < 1e-9, "{before} {after}");
            sticking += 1;
        }
    }
    assert!(sticking > 100, "{sticking}");
}

/// A first push has the states of the branch, on both sides.
#[test]
fn a_first_push_has_the_states_of_the_branch() {
    let scene = cone(0.02, 0.25, 0.3);
    let found = through(&scene, &to_and_fro(&[-1.0, 18.0, -35.0], 200));
    let rests = Side::BOTH.map(|side| Rest::new(&scene.whisker.rod(&scene.pole, side)));
    let length = scene.whisker.length_mm;
    let pole = rests[1].pole_at_distance(DISTANCE / length).length();
    let distances = [rests[0].distance_of_pole(pole) * length, DISTANCE];
    let mut counts = [0; 3];
    for (side, distance) in Side::BOTH.into_iter().zip(distances) {
        let branch = Branch::new(&scene.whisker, &scene.pole, side, distance).unwrap();
        for sample in found.samples.iter().filter(|sample| sample.side == Some(side)) {
            let push = sample.push_angle_deg.unwrap().to_radians();
            let state = branch.state(push, true).unwrap();
            let wanted = branch.read(&state);
            for (value, wanted) in [
                (sample.force_un, wanted.force_un),
                (sample.base_moment_nnm, wanted.base_moment_nnm),
                (sample.energy_nj, wanted.energy_nj),
            ] {
                let value = value.unwrap();
                assert!((value - wanted).abs() <= 1e-8 * wanted.abs(), "{push} {value} {wanted}");
            }
            assert_eq!(sample.sliding, state.sliding);
            counts[state.sliding.unwrap() as usize] += 1;
        }
    }
    assert!(counts.iter().all(|count| *count > 3), "{counts:?}");
    use WhiskEventKind::{SlipOff, Touch};
    let kinds: Vec<_> = found.events.iter().map(|event| event.event).collect();
    assert_eq!(kinds, [Touch, SlipOff, Touch, SlipOff]);
}

/// A push to and fro has the states of an independent integration in small steps.
#[test]
fn a_course_is_that_of_small_steps() {
    const COUNT: u32 = 1500;
    for (friction, turns) in
        [(0.3, &[0.0, 12.0, 4.0, 14.0][..]), (0.9, &[0.0, 10.0, 3.0]), (0.3, &[0.0, -20.0, -6.0])]
    {
        let scene = cone(0.02, 0.25, friction);
        let side = Side::of_push(turns[1]);
        let first = through(&scene, &[-1.0, 0.0]);
        // Angles of the base on CF are counted from the touch on CB.
        let touch = if side == Side::Cb { 0.0 } else { first.cf_touch_deg };
        let pushes = &to_and_fro(turns, COUNT)[1..];
        let angles: Vec<f64> = pushes.iter().map(|push| push + touch).collect();
        let lead = match side {
            Side::Cb => vec![-1.0],
            Side::Cf => vec![-1.0, 60.0, touch + 1.0],
        };
        let found = through(&scene, &[&lead[..], &angles].concat());
        let rod = scene.whisker.rod(&scene.pole, side);
        let rests = Side::BOTH.map(|side| Rest::new(&scene.whisker.rod(&scene.pole, side)));
        let length = scene.whisker.length_mm;
        let pole = rests[1].pole_at_distance(DISTANCE / length).length();
        let distance = match side {
            Side::Cb => DISTANCE / length,
            Side::Cf => rests[0].distance_of_pole(pole),
        };
        let (contact, _) = Rest::new(&rod).touch_at_distance(distance);
        let magnitudes: Vec<f64> = pushes.iter().map(|push| push.abs().to_radians()).collect();
        let wanted = stepped(&scene, side).course(rod.tau(contact), &magnitudes);
        let units = scene.whisker.units();
        let mut counts = [0; 3];
        let samples = &found.samples[lead.len()..];
        for (sample, wanted) in samples.iter().zip(&wanted).skip(20).step_by(13) {
            let pairs = [
                (sample.force_un, wanted.loaded[1].abs() * units.force_un),
                (sample.base_moment_nnm, wanted.moment * units.moment_nnm),
                (sample.arc_length_mm, wanted.arclength * units.length_mm),
            ];
            for (value, wanted) in pairs {
                let value = value.unwrap();
                assert!(
                    (value / wanted - 1.0).abs() < allowed(sample.sliding.unwrap()),
                    "{friction} {turns:?}: {value} {wanted} {sample:?}"
                );
            }
            counts[sample.sliding.unwrap() as usize] += 1;
        }
        assert!(counts[Sliding::Sticks as usize] > 10, "{counts:?}");
    }
}

/// A contact that has slid far toward the tip sticks on the whole way back. The model does not follow the whisker beyond first touch.
#[test]
fn a_contact_that_sticks_at_the_release_is_undecided() {
    let scene = cone(0.02, 0.25, 0.3);
    let found = through(&scene, &to_and_fro(&[-1.0, 17.4, -5.0], 100));
    let last = found.samples.last().unwrap();
    assert_eq!(last.regime, WhiskRegime::Undecided, "{:?}", found.events);
    assert_eq!(last.reason, Some(Undecided::Stuck));
    assert!(found.dissipated_nj().is_nan() && last.force_un.is_none());
    assert_eq!(found.events[1].event, WhiskEventKind::Undecided);
}
