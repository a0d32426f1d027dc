//! Courses with friction do not depend on how they are sampled, and begin as first pushes.

use super::cone;
use super::sliding::Frictions;
use crate::random_rods::Random;
use whiskmap::Side;
use whiskmap::friction::{
    ContactHistory, ContactPhase, ContactQuery, CourseLimits, Sliding, states,
};
use whiskmap::mechanics::shooting::batch::Method;
use whiskmap::scene::Scene;
use whiskmap::sheet::LevelCurve;
use whiskmap::whisk::{AngleCourse, Whisk, whisk};

/// Random cone at a random pole with friction, and the distance of first touch on CB in mm.
fn random_scene(random: &mut Random) -> (Scene, f64) {
    let a_per_mm = 0.04 * random.unit();
    let radius_mm = random.unit() * random.unit();
    let friction = 0.02 + 0.9 * random.unit() * random.unit();
    (cone(a_per_mm, radius_mm, friction), 4.0 + 14.0 * random.unit())
}

/// The course through `turns`, in degrees, with `parts` samples on each way.
fn course(scene: &Scene, distance: f64, turns: &[f64], parts: u32) -> Option<Whisk> {
    let ways = turns.windows(2).flat_map(|pair| {
        let part = move |i| f64::from(i) / f64::from(parts);
        (0..parts).map(move |i| (pair[1] - pair[0]).mul_add(part(i), pair[0]))
    });
    let angles: Vec<f64> = ways.chain(turns.last().copied()).collect();
    let times = (0..angles.len()).map(|i| i as f64).collect();
    let course = AngleCourse::new(times, angles).unwrap();
    whisk(&scene.whisker, &scene.pole, distance, &course).ok()
}

/// The largest pushes on CB and CF in degrees, with the angle of first touch on CF.
fn reach(scene: &Scene, distance: f64) -> Option<[f64; 3]> {
    let found = course(scene, distance, &[-1.0, 170.0, -170.0], 1)?;
    let ends: Vec<f64> = found
        .events
        .iter()
        .filter(|event| event.energy_nj.is_some_and(|energy| energy > 0.0))
        .filter_map(|event| event.push_angle_deg)
        .collect();
    let [cb, cf] = ends[..] else { return None };
    Some([cb, cf, found.cf_touch_deg])
}

/// A way of five turns on one side that reaches at most 0.9999 of the largest push.
fn turns([cb, cf, touch]: [f64; 3], is_cb: bool, random: &mut Random) -> Vec<f64> {
    let lead = match is_cb {
        true => vec![-0.5],
        false => vec![-0.5, 1.5 * cb.max(touch) + 0.5],
    };
    let turns = (0..5).map(|i| {
        let part = match i % 2 {
            0 => 1.0 - 0.7 * random.unit() * random.unit(),
            _ => 0.8 * random.unit(),
        };
        part.min(0.9999) * if is_cb { cb } else { cf }
    });
    let from = if is_cb { 0.0 } else { touch };
    lead.into_iter().chain(turns.map(|push| from + push)).collect()
}

/// A straight way has the same states and the same dissipated energy at its end with one sample as with six.
#[test]
fn a_course_does_not_depend_on_its_samples() {
    let mut counts = [0; 3];
    for seed in 0..20 {
        let random = &mut Random::new(seed);
        let (scene, distance) = random_scene(random);
        let Some(reach) = reach(&scene, distance) else {
            continue;
        };
        let turns = turns(reach, seed % 2 == 0, random);
        let [coarse, fine] = [1, 6].map(|parts| course(&scene, distance, &turns, parts).unwrap());
        for (sample, other) in coarse.samples.iter().zip(fine.samples.iter().step_by(6)) {
            assert_eq!((sample.sliding, sample.reason), (other.sliding, other.reason));
            let pairs = [
                (sample.force_un, other.force_un),
                (sample.base_moment_nnm, other.base_moment_nnm),
                (sample.dissipated_nj, other.dissipated_nj),
            ];
            for (value, other) in pairs {
                let [value, other] = [value, other].map(|value| value.unwrap_or(0.0));
                // Measured in 150 courses: below 1e-9.
                assert!(
                    (value - other).abs() <= 1e-9 * value.abs().max(1e-3),
                    "{seed}: {value} {other}"
                );
            }
            if let Some(sliding) = sample.sliding {
                counts[sliding as usize] += 1;
            }
        }
    }
    assert!(counts.iter().all(|count| *count > 0), "{counts:?}");
}

/// A first push on CF has the states of the course next to the end of sliding toward the base, where a small error of the slid distance
/// changes the force ratio by much. The course divides all segments of its limits at exact states, the history only some.
#[test]
fn a_first_push_has_the_states_of_the_course() {
    let (mut worst, mut count) = (0.0_f64, 0);
    for seed in 0..20 {
        let random = &mut Random::new(seed);
        let (scene, distance) = random_scene(random);
        let Frictions { rod, side, row } = Frictions::new(&scene, Side::Cf, distance);
        let level = LevelCurve::new(Method::fine(), &rod, side, &row);
        let limits = CourseLimits::new(&level).unwrap();
        let history = ContactHistory::of(std::slice::from_ref(&level)).remove(0);
        let history = &history.unwrap();
        let slides = |push: f64| history.phase(push) == ContactPhase::Slides(Sliding::Base);
        let pushes = (1..100).map(|i| 0.01 * f64::from(i));
        let Some(mut low) = pushes.clone().find(|push| slides(*push)) else {
            continue;
        };
        let Some(mut high) = pushes.skip_while(|push| *push < low).find(|push| !slides(*push))
        else {
            continue;
        };
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            *(if slides(middle) { &mut low } else { &mut high }) = middle;
        }
        for step in [-1e-3, -1e-4, -1e-6, 1e-6, 1e-4, 1e-3] {
            let push = low + step;
            if push <= 0.0 {
                continue;
            }
            let mut course = limits.begin();
            course.to(push);
            let first_push = ContactQuery { history, push, phase: history.phase(push) };
            let found = states(&[first_push, limits.query(course.phase, push)]);
            let [by_history, by_course] =
                [0, 1].map(|i| found[i].map(|state| state.variation.full.force));
            // Of 120 pairs of states, Newton's method finds neither state of one pair.
            assert_eq!(by_history.is_some(), by_course.is_some(), "{seed} {push}");
            if let Some((by_history, by_course)) = by_history.zip(by_course) {
                worst = worst.max((by_history / by_course - 1.0).abs());
                count += 1;
            }
        }
    }
    // Measured: below 1e-10.
    assert!(worst < 1e-10 && count > 100, "{worst:e} {count}");
}
