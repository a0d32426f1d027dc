//! One contract for every engine, and the shaders against their twins.
//!
//! Without an adapter the GPU's part is skipped, loudly; `WHISKMAP_REQUIRE_GPU=1` makes that a failure.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stderr,
    reason = "a test fails by panicking, and says aloud what it measured and skipped"
)]

mod adapters;
mod bench;
#[path = "../compute/mod.rs"]
mod compute;
#[path = "../effect_sets/mod.rs"]
mod effect_sets;
mod probe;
mod shots;

use compute::open;
use shots::{Range, USUAL};
use whiskmap::bench::Solver;
use whiskmap::integrate::gpu::{Precision, adapters, preferred};
use whiskmap::integrate::{Description, Engine, EngineError, Hit, Outcome, Shot};
use whiskmap::numerics::Unit;
use whiskmap::rod::{Effects, Rod};
use whiskmap::shooting::Resolution;

/// The twin of the shaders on the CPU.
struct Cpu;

impl Engine for Cpu {
    fn describe(&self) -> Description {
        Description::of(None)
    }

    fn shoot(
        &mut self,
        effects: Effects,
        rods: &[Rod],
        shots: &[Shot],
    ) -> Result<Vec<Hit>, EngineError> {
        let solver = Solver {
            unit: Unit::detect(),
            resolution: Resolution::COARSE,
            tolerance: 1e-6,
        };
        Ok(solver.solve(effects, rods, shots))
    }
}

/// An engine, and how far off its poles may be at worst and in the median, in whisker lengths.
struct Candidate {
    engine: Box<dyn Engine>,
    worst: f64,
    median: f64,
}

/// Every engine of this machine. Measured on 1,600,000 shots, of which at most 26 stall, on the CPU too:
/// worst 4.7e-6 and median 3e-7 in `f32`, worst 9e-7 and median 2e-9 in `f64`; of the CPU, which takes the coarse
/// resolution, on these shots: worst 4.7e-8, median 5.2e-10.
fn engines() -> Vec<Candidate> {
    let mut engines = vec![Candidate {
        engine: Box::new(Cpu),
        worst: 1e-6,
        median: 1e-8,
    }];
    for (precision, worst, median) in [(Precision::F32, 1e-5, 5e-7), (Precision::F64, 1e-6, 5e-9)] {
        if let Some(gpu) = open(precision) {
            let engine = Box::new(gpu);
            engines.push(Candidate {
                engine,
                worst,
                median,
            });
        }
    }
    engines
}

#[test]
fn every_engine_finds_what_was_hidden() {
    for Candidate {
        mut engine,
        worst,
        median,
    } in engines()
    {
        for (seed, effects) in (1..).zip(effect_sets::all()) {
            let range = Range::new(effects, 5000, 6.0, seed);
            let hits = engine.shoot(effects, &range.rods, &range.shots).unwrap();
            assert_eq!(hits.len(), range.shots.len());
            assert!(hits.iter().all(|hit| hit.outcome == Outcome::Converged));
            let mut misses = range.misses(hits.iter().map(|hit| (hit.tau, hit.load)));
            misses.sort_by(f64::total_cmp);
            let found = (misses[2500], misses[4999]);
            let name = engine.describe().engine;
            eprintln!(
                "{name}, {effects:?}: median {:.1e}, worst {:.1e}",
                found.0, found.1
            );
            assert!(found.0 < median && found.1 < worst);
        }
    }
}

/// Shoots in groups of `size`.
fn in_groups(engine: &mut dyn Engine, range: &Range, size: usize) -> Vec<Hit> {
    let groups = range.shots.chunks(size);
    groups
        .flat_map(|shots| engine.shoot(range.effects, &range.rods, shots).unwrap())
        .collect()
}

#[test]
fn the_size_of_a_call_changes_nothing() {
    let range = Range::new(USUAL, 20_000, 6.5, 9);
    for Candidate { mut engine, .. } in engines() {
        let at_once = in_groups(engine.as_mut(), &range, range.shots.len());
        let converged = at_once.iter().filter(|h| h.outcome == Outcome::Converged);
        eprintln!("{} converged", converged.clone().count());
        assert!(converged.count() > 19_990);
        for size in [63, 64, 65, 4096, 10_001] {
            assert_eq!(in_groups(engine.as_mut(), &range, size), at_once);
        }
    }
}

#[test]
fn no_number_hurts_only_itself() {
    type Spoil = fn(&mut Shot);
    let range = Range::new(USUAL, 1000, 6.5, 10);
    let spoil: [(usize, Spoil); 3] = [
        (100, |shot| shot.tau = f64::NAN),
        (333, |shot| shot.load = f64::INFINITY),
        (999, |shot| shot.pole.y = f64::NAN),
    ];
    for Candidate { mut engine, .. } in engines() {
        let sound = engine
            .shoot(range.effects, &range.rods, &range.shots)
            .unwrap();
        let mut shots = range.shots.clone();
        for (i, spoil) in spoil {
            spoil(&mut shots[i]);
        }
        let hits = engine.shoot(range.effects, &range.rods, &shots).unwrap();
        for (i, (hit, sound)) in hits.iter().zip(&sound).enumerate() {
            if spoil.iter().any(|&(spoilt, _)| spoilt == i) {
                assert_eq!((hit.outcome, hit.steps), (Outcome::NotFinite, 0));
            } else {
                assert_eq!(hit, sound);
            }
        }
    }
}

#[test]
fn nothing_in_nothing_out() {
    for Candidate { mut engine, .. } in engines() {
        assert_eq!(engine.shoot(Effects::default(), &[], &[]).unwrap(), []);
    }
}

#[test]
fn what_the_device_refuses_is_an_error_and_passes() {
    let range = Range::new(Effects::default(), 100, 6.5, 12);
    for precision in [Precision::F32, Precision::F64] {
        let Some(mut gpu) = open(precision) else {
            continue;
        };
        let refused = gpu.shoot(range.effects, &[], &range.shots);
        assert!(
            matches!(refused, Err(EngineError::Device(_))),
            "{refused:?}"
        );
        let hits = gpu.shoot(range.effects, &range.rods, &range.shots).unwrap();
        assert!(hits.iter().all(|hit| hit.outcome == Outcome::Converged));
    }
}

#[test]
fn the_engine_runs_on_the_preferred_adapter() {
    let Some(gpu) = open(Precision::F32) else {
        return;
    };
    let reports = adapters();
    let chosen = &reports[preferred(&reports, Precision::F32).unwrap()];
    assert!(gpu.describe().adapter.starts_with(&chosen.info.name));
    assert_eq!(gpu.describe().engine, "gpu f32");
}
