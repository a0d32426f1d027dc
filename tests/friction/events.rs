//! Events of courses with friction are those of the course, whatever its samples.

use crate::random_rods::Random;
use std::sync::Arc;
use whiskmap::rod::CurvaturePolynomial;
use whiskmap::scene::{Parameter, Pole, Scene, Whisker};
use whiskmap::whisk::{AngleCourse, Whisk, WhiskEvent, whisk};

/// Random whisker in front of a pole with friction, and a course through turning points.
struct RandomCourse {
    whisker: Whisker,
    pole: Pole,
    /// Distance of first touch on CB, in mm.
    distance_mm: f64,
    /// Turning points of the base's angle, in degrees.
    turns: Vec<f64>,
}

impl RandomCourse {
    /// Cones, nearly cylindrical whiskers and traced shapes in turn, with friction between 0.3 and 1. The course begins and turns back on
    /// both sides, also beyond detachments.
    fn new(seed: u64) -> Option<Self> {
        let random = &mut Random(seed);
        let taper = match seed % 3 {
            0 => 0.95,
            1 => 0.05 * random.unit(),
            _ => random.between(0.3, 0.97),
        };
        let scene = Scene::builder("random")
            .set(Parameter::LengthMm, 20.0)
            .set(Parameter::BaseRadiusUm, 30.0)
            .set(Parameter::Taper, taper)
            .set(Parameter::YoungsModulusGpa, 3.0)
            .set(Parameter::ParabolaPerMm, 0.04 * random.unit())
            .set(Parameter::PoleRadiusMm, random.unit() * random.unit())
            .set(Parameter::Friction, random.between(0.3, 1.0))
            .push_angle_deg([1.0])
            .distance_mm([5.0])
            .build()
            .unwrap();
        let mut whisker = scene.whisker.clone();
        if seed % 3 == 2 {
            let mut size = 1.0;
            let terms = std::array::from_fn(|_| {
                let term = size * random.between(-1.0, 1.0);
                size *= 0.6;
                term
            });
            whisker.curvature = None;
            whisker.traced = Some(Arc::new(CurvaturePolynomial::new(terms)));
        }
        let mut own = Self {
            whisker,
            pole: scene.pole,
            distance_mm: 2.0 + 16.0 * random.unit(),
            turns: vec![-1.0, 170.0, -170.0],
        };
        let found = own.sampled(1)?;
        let ends = found.events.iter();
        let ends = ends.filter(|own| own.energy_nj.is_some_and(|energy| energy > 0.0));
        let ends: Vec<f64> = ends.map(|own| own.angle_deg).collect();
        let [cb, cf] = ends[..] else { return None };
        let [low, high] = [cf.min(-1.0), cb.max(found.cf_touch_deg)];
        // To one side, back, and so on: at least half of the turning points are in contact.
        own.turns = vec![-0.5];
        if seed % 2 == 0 {
            own.turns.push(1.5 * high + 0.5);
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
            own.turns.push(turn.clamp(-350.0, 350.0));
        }
        Some(own)
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

/// Returns true if two events agree: kind and side, angles to 1e-9 degrees, times to 1e-9 s and values to 1e-9 of them.
fn agree(one: &WhiskEvent, other: &WhiskEvent) -> bool {
    let near = |a: f64, b: f64, scale: f64| (a - b).abs() <= 1e-9 * scale;
    let values = |own: &WhiskEvent| [own.force_un, own.base_moment_nnm, own.energy_nj];
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

/// Courses with the events of three samplings, [`SAMPLINGS`], that differ; with the number of all courses.
const SAMPLINGS: [u32; 3] = [1, 7, 40];

#[test]
#[ignore = "measurement"]
fn attack() {
    let count: u64 = std::env::var("COUNT").map_or(300, |own| own.parse().unwrap());
    let (mut total, mut differing) = (0, 0);
    let mut kinds = std::collections::BTreeMap::<String, usize>::new();
    let mut reasons = std::collections::BTreeMap::<String, usize>::new();
    for seed in 0..count {
        let Some(own) = RandomCourse::new(seed) else { continue };
        let found = SAMPLINGS.map(|parts| own.sampled(parts));
        let [Some(a), Some(b), Some(c)] = found else { println!("{seed} fails"); continue };
        total += 1;
        for event in &a.events { *kinds.entry(format!("{:?}", event.event)).or_default() += 1; }
        for (i, samples) in [&a, &b, &c].into_iter().enumerate() {
            for s in &samples.samples { *reasons.entry(format!("{i} {:?}", s.reason)).or_default() += 1; }
        }
        let mut bad = false;
        for other in [&b, &c] {
            let same = a.events.len() == other.events.len() && a.events.iter().zip(&other.events).all(|(x, y)| agree(x, y));
            if !same && !bad {
                bad = true;
                let short = |w: &Whisk| w.events.iter().map(|e| format!("{:?}{:?}@{:.10}[{:?}]", e.event, e.side, e.angle_deg, e.energy_nj)).collect::<Vec<_>>().join(" ");
                println!("{seed} fam {}: turns {:?}\n   {}\n   {}", seed % 3, own.turns, short(&a), short(other));
            }
        }
        let mut mism = 0;
        for (k, other) in [(7, &b), (40, &c)] {
            for (x, y) in a.samples.iter().zip(other.samples.iter().step_by(k)) {
                if (x.reason, x.sliding, x.regime) != (y.reason, y.sliding, y.regime) { mism += 1; }
            }
        }
        if mism > 0 { println!("{seed} samples differ: {mism}"); }
        differing += usize::from(bad);
    }
    println!("{differing} of {total} differ; {kinds:?}; {reasons:?}");
}
