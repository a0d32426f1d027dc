//! Events of courses with friction are those of the course, whatever its samples.

use crate::random_rods::Random;
use std::collections::BTreeMap;
use whiskmap::mechanics::rod::CurvaturePolynomial;
use whiskmap::scene::{Parameter, Pole, Scene, Whisker};
use whiskmap::whisk::{AngleCourse, Whisk, WhiskEvent, WhiskEventKind, WhiskSample, whisk};

/// Number of random courses.
const COURSES: u64 = 60;

/// Whisker in front of a pole with friction, and a course through turning points.
struct RoughCourse {
    whisker: Whisker,
    pole: Pole,
    /// Distance of first touch on CB, in mm.
    distance_mm: f64,
    /// Turning points of the base's angle, in degrees.
    turns: Vec<f64>,
}

impl RoughCourse {
    /// Cones, nearly cylindrical whiskers and traced shapes in turn, with friction between 0.3 and 1. The course begins and turns back on
    /// both sides, also beyond detachments.
    fn random(seed: u64) -> Option<Self> {
        let random = &mut Random::new(seed);
        let taper = match seed % 3 {
            0 => 0.95,
            1 => 0.05 * random.unit(),
            _ => random.between(0.3, 0.97),
        };
        let scene = scene(
            taper,
            0.04 * random.unit(),
            random.unit() * random.unit(),
            random.between(0.3, 1.0),
        );
        let mut whisker = scene.whisker.clone();
        if seed % 3 == 2 {
            let mut size = 1.0;
            let terms = std::array::from_fn(|_| {
                let term = size * random.between(-1.0, 1.0);
                size *= 0.6;
                term
            });
            whisker.curvature = None;
            whisker.traced = Some(CurvaturePolynomial::new(terms));
        }
        let mut course = Self {
            whisker,
            pole: scene.pole,
            distance_mm: 2.0 + 17.5 * random.unit(),
            turns: vec![-1.0, 170.0, -170.0],
        };
        let found = course.sampled(1)?;
        let ends = found.events.iter();
        let ends = ends.filter(|event| event.energy_nj.is_some_and(|energy| energy > 0.0));
        let ends: Vec<f64> = ends.map(|event| event.angle_deg).collect();
        let [cb, cf] = ends[..] else { return None };
        let [low, high] = [cf.min(-1.0), cb.max(found.cf_touch_deg)];
        // To one side, back, and so on: at least half of the turning points are in contact.
        course.turns = vec![-0.5];
        if seed.is_multiple_of(2) {
            course.turns.push(1.5 * high + 0.5);
        }
        for i in 0..7 {
            let part = match i % 2 {
                0 => 1.05 - 0.7 * random.unit() * random.unit(),
                _ => 0.9 * random.unit() - 0.1,
            };
            let turn = match seed % 2 {
                0 => found.cf_touch_deg + part * (low - found.cf_touch_deg),
                _ => part * high,
            };
            course.turns.push(turn.clamp(-350.0, 350.0));
        }
        Some(course)
    }

    /// The course with `parts` samples from turning point to turning point, one turning point a second.
    fn sampled(&self, parts: u32) -> Option<Whisk> {
        let part = |i| f64::from(i) / f64::from(parts);
        let ways = self.turns.windows(2).flat_map(|pair| {
            (0..parts).map(move |i| (pair[1] - pair[0]).mul_add(part(i), pair[0]))
        });
        let angles: Vec<f64> = ways.chain(self.turns.last().copied()).collect();
        let times = (0..angles.len()).map(|i| i as f64 / f64::from(parts));
        let course = AngleCourse::new(times.collect(), angles).unwrap();
        whisk(&self.whisker, &self.pole, self.distance_mm, &course).ok()
    }
}

/// Scene of a whisker of 20 mm with a parabola at rest, in front of a pole with friction.
fn scene(taper: f64, a_per_mm: f64, radius_mm: f64, friction: f64) -> Scene {
    let scene = Scene::builder("rough")
        .set(Parameter::LengthMm, 20.0)
        .set(Parameter::BaseRadiusUm, 30.0)
        .set(Parameter::Taper, taper)
        .set(Parameter::YoungsModulusGpa, 3.0)
        .set(Parameter::ParabolaPerMm, a_per_mm)
        .set(Parameter::PoleRadiusMm, radius_mm)
        .set(Parameter::Friction, friction);
    let scene = scene.push_angle_deg([1.0]).distance_mm([5.0]);
    scene.build().unwrap()
}

/// Returns true if two events agree: kind and side, angles to 1e-9 degrees, times to 1e-9 s and values to 1e-9 of them.
fn agree(one: &WhiskEvent, other: &WhiskEvent) -> bool {
    let near = |a: f64, b: f64, scale: f64| (a - b).abs() <= 1e-9 * scale;
    let values = |event: &WhiskEvent| [event.force_un, event.base_moment_nnm, event.energy_nj];
    let values = values(one).into_iter().zip(values(other));
    (one.event, one.side) == (other.event, other.side)
        && near(one.angle_deg, other.angle_deg, 1.0)
        && near(one.time_s, other.time_s, 1.0)
        && one.push_angle_deg.is_some() == other.push_angle_deg.is_some()
        && values.into_iter().all(|pair| match pair {
            (Some(a), Some(b)) => near(a, b, a.abs().max(1e-3)),
            (a, b) => a == b,
        })
}

/// Numbers of samples from turning point to turning point.
const SAMPLINGS: [u32; 3] = [1, 7, 40];

impl RoughCourse {
    /// Checks that the same course with more samples has the same events, and the same phases at the same times. Returns it.
    fn check(&self) -> Whisk {
        let [coarse, finer @ ..] = SAMPLINGS.map(|parts| self.sampled(parts).unwrap());
        for (parts, fine) in SAMPLINGS[1..].iter().zip(&finer) {
            let mut pairs = coarse.events.iter().zip(&fine.events);
            assert!(
                coarse.events.len() == fine.events.len()
                    && pairs.all(|(one, other)| agree(one, other)),
                "{:?}: {:#?} {:#?}",
                self.turns,
                coarse.events,
                fine.events
            );
            let at_turns = fine.samples.iter().step_by(*parts as usize);
            for (one, other) in coarse.samples.iter().zip(at_turns) {
                let phase = |sample: &WhiskSample| (sample.regime, sample.sliding, sample.reason);
                assert_eq!(phase(one), phase(other), "{:?} {}", self.turns, one.time_s);
            }
        }
        coarse
    }
}

/// The events of random courses are those of the course. Events of all kinds are among them.
#[test]
fn events_do_not_depend_on_samples() {
    let mut kinds = BTreeMap::<String, usize>::new();
    for course in (0..COURSES).filter_map(RoughCourse::random) {
        for event in course.check().events {
            *kinds.entry(format!("{:?}", event.event)).or_default() += 1;
        }
    }
    for kind in ["Touch", "Release", "SlipOff", "PullOff", "Snap", "Undecided"] {
        assert!(kinds.contains_key(kind), "{kinds:?}");
    }
}

/// A contact that slides back to the base from beside its unstable states is released, and the work of the base is dissipated. The unstable
/// states end at the tip, at a push at which this contact slides.
#[test]
fn a_contact_that_slides_back_is_released() {
    for (scene, distance_mm, turns) in [
        (scene(0.0353, 0.038, 0.13, 0.98), 16.69, vec![-0.5, 41.07, 19.7, 37.6, -0.5]),
        (scene(0.0425, 0.0275, 0.0004, 0.317), 12.417, vec![-0.5, 69.6, 57.8, 69.6, -0.5]),
    ] {
        let course =
            RoughCourse { whisker: scene.whisker.clone(), pole: scene.pole, distance_mm, turns };
        let kinds: Vec<_> = course.check().events.iter().map(|event| event.event).collect();
        assert_eq!(kinds, [WhiskEventKind::Touch, WhiskEventKind::Release]);
        let found = course.sampled(4000).unwrap();
        let pairs = found.samples.windows(2);
        let work: f64 = pairs
            .map(|pair| {
                let moments = [0, 1].map(|i| pair[i].base_moment_nnm.unwrap());
                let turned = (pair[1].angle_deg.unwrap() - pair[0].angle_deg.unwrap()).to_radians();
                0.5 * (moments[0] + moments[1]) * turned
            })
            .sum();
        // Measured: 7e-8, of the trapezia.
        let miss = work / found.dissipated_nj() - 1.0;
        assert!(miss.abs() < 1e-6, "{miss:e}");
    }
}
