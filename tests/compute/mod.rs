//! Whole maps in memory, how far two of them are apart, and engines that are looked after.
#![allow(dead_code, reason = "each test program uses its own share")]
#![allow(
    clippy::print_stderr,
    reason = "what is skipped or measured is said aloud"
)]

use std::convert::Infallible;
use whiskmap::integrate::gpu::{Gpu, Precision};
use whiskmap::integrate::{Description, Engine, EngineError, Hit, Outcome, Shot};
use whiskmap::map::{self, Panel, STATE_CHANNELS, Summary};
use whiskmap::plan::Plan;
use whiskmap::rod::{Effects, Rod};
use whiskmap::scene::Scene;
use whiskmap::shooting::ShootingMap;
use whiskmap::shooting::batch::{Batch, InitialCondition, Method};

/// The map of `scene`: by the CPU alone, or with an engine before it.
pub fn compute(scene: &Scene, engine: Option<&mut dyn Engine>) -> (Summary, Vec<Panel>) {
    compute_as(scene, &Plan::new(scene).unwrap(), engine)
}

pub fn compute_as(
    scene: &Scene,
    plan: &Plan,
    engine: Option<&mut dyn Engine>,
) -> (Summary, Vec<Panel>) {
    let mut all = Vec::new();
    let Ok(summary) = map::run(scene, plan, engine, &mut |_| (), &mut |panels| {
        all.extend(panels);
        Ok::<(), Infallible>(())
    });
    (summary, all)
}

/// The GPU engine, or `None` (said aloud) where there is none; `WHISKMAP_REQUIRE_GPU=1` makes that a failure, but for `f64`.
pub fn open(precision: Precision) -> Option<Gpu> {
    opened(precision, Gpu::new(precision))
}

/// The same with this shader.
pub fn open_with(precision: Precision, shader: String) -> Option<Gpu> {
    opened(precision, Gpu::with_shader(precision, shader))
}

fn opened(precision: Precision, gpu: Result<Gpu, EngineError>) -> Option<Gpu> {
    match gpu {
        Ok(gpu) => Some(gpu),
        Err(error) => {
            let required = std::env::var_os("WHISKMAP_REQUIRE_GPU").is_some_and(|x| x == "1");
            let optional = match error {
                EngineError::NoAdapter(_) => !required,
                EngineError::Unsupported { .. } => precision == Precision::F64,
                EngineError::Device(_) => false,
            };
            assert!(optional, "{error}");
            eprintln!("SKIPPED, NOT TESTED: gpu {precision}: {error}");
            None
        }
    }
}

/// An engine whose hits are kept. The lattice's guesses are so good that hits do not show who found them, so each call is
/// made once more from guesses that are off, and the hits of that one are looked at in `f64`.
pub struct Watched<E> {
    pub engine: E,
    pub hits: Vec<Hit>,
    /// How far from the wanted place, in whisker lengths, the poles of those guesses and hits really are, shot by shot.
    misses: [Vec<f64>; 2],
}

impl<E: Engine> Watched<E> {
    pub fn new(engine: E) -> Self {
        Self {
            engine,
            hits: Vec::new(),
            misses: [Vec::new(), Vec::new()],
        }
    }

    /// Whether the engine did its work in runs that counted so many shots as `restarted`: it must finish `least` of its shots,
    /// and come a hundred times closer than guesses that are off. Maps are right without an engine too.
    pub fn works(&self, restarted: u64, least: f64) -> Result<(), String> {
        let unfinished = self.hits.iter().filter(|h| h.outcome != Outcome::Converged);
        let (all, unfinished) = (self.hits.len(), unfinished.count());
        let [guesses, hits] = self.misses.each_ref().map(|misses| {
            let mut sorted = misses.clone();
            sorted.sort_by(f64::total_cmp);
            sorted[sorted.len() / 2]
        });
        let found = format!(
            "{unfinished} of {all} shots unfinished, {restarted} restarted; in the median off by {hits:.1e}, from {guesses:.1e}"
        );
        eprintln!("{found}");
        let finished = (all - unfinished) as f64 >= least * all as f64;
        let good = finished && hits * 100.0 <= guesses;
        if good && restarted == unfinished as u64 {
            Ok(())
        } else {
            Err(found)
        }
    }
}

impl<E: Engine> Engine for Watched<E> {
    fn describe(&self) -> Description {
        self.engine.describe()
    }

    fn shoot(
        &mut self,
        effects: Effects,
        rods: &[Rod],
        shots: &[Shot],
    ) -> Result<Vec<Hit>, EngineError> {
        let hits = self.engine.shoot(effects, rods, shots)?;
        let off = |shot: &Shot| Shot {
            tau: 0.99 * shot.tau,
            load: 0.99 * shot.load,
            ..*shot
        };
        let off: Vec<Shot> = shots.iter().map(off).collect();
        let guesses = off.iter().map(Hit::untouched).collect();
        let found = self.engine.shoot(effects, rods, &off)?;
        for (misses, found) in self.misses.iter_mut().zip([guesses, found]) {
            let conditions = found.iter().zip(shots).map(|(hit, shot)| InitialCondition {
                rod: &rods[shot.rod as usize],
                tau: hit.tau,
                load: hit.load,
            });
            let conditions: Vec<InitialCondition> = conditions.collect();
            let method = Method::fine().with_effects(effects);
            let maps: Vec<ShootingMap> = Batch::new(method).shoot(&conditions);
            let pairs = maps.iter().zip(shots);
            misses.extend(pairs.map(|(map, shot)| map.pole.distance(shot.pole)));
        }
        self.hits.extend_from_slice(&hits);
        Ok(hits)
    }
}

/// Asserts that regimes are equal, and states as far as their last digit in the file goes: where a GPU prepared the
/// refinement, that ends on the same state from another start.
pub fn assert_close(wanted: &[Panel], found: &[Panel], what: &str) {
    assert_eq!(wanted.len(), found.len());
    for (a, b) in wanted.iter().zip(found) {
        assert!(a.regime == b.regime, "{what}");
        for (channel, (x, y)) in STATE_CHANNELS.iter().zip(a.state.iter().zip(&b.state)) {
            let miss = difference(x, y);
            assert!(miss <= 2e-7, "{channel} of {what}: {miss:.1e}");
        }
    }
}

/// Largest difference of two stored channels, relative to the largest value; infinite where only one is NaN.
/// Two roundings to f32 are 1.2e-7.
pub fn difference(a: &[f32], b: &[f32]) -> f32 {
    let largest = a
        .iter()
        .filter(|x| x.is_finite())
        .fold(0.0_f32, |m, x| m.max(x.abs()));
    let misses = a
        .iter()
        .zip(b)
        .map(|(x, y)| match (x.is_nan(), y.is_nan()) {
            (true, true) => 0.0,
            (false, false) => (x - y).abs() / largest,
            _ => f32::INFINITY,
        });
    misses.fold(0.0, f32::max)
}
