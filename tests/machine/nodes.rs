//! Trajectories of nets that an engine integrates for the sheets of a map.

use crate::compute::{assert_close, assert_identical, compute_as, open};
use crate::shipped;
use std::sync::Arc;
use whiskmap::engine::gpu::Precision;
use whiskmap::engine::{Cells, Engine, EngineDescription, EngineError, Nodes, RowBatch, Spectral};
use whiskmap::map::{Panel, Summary};
use whiskmap::mechanics::shooting::PlainState;
use whiskmap::plan::Plan;

tests! {
    Nothing:
        nets_do_not_depend_on_who_integrates,
        an_engine_that_fails_to_integrate_is_disabled;
    Adapter:
        the_device_integrates_the_nets_of_a_sweep;
}

type States = Result<Vec<PlainState>, EngineError>;

/// How an engine fails to integrate.
type Failure = fn(&Nodes) -> States;

/// An engine with a thread of its own, on which it integrates nodes as `shoot` does.
struct Shooting<F> {
    spectral: Spectral,
    /// Gets the number of batches that were collected before.
    shoot: F,
    collected: usize,
}

impl<F: FnMut(&Nodes, usize) -> States + Send> Shooting<F> {
    fn new(shoot: F) -> Self {
        Self {
            spectral: Spectral::default(),
            shoot,
            collected: 0,
        }
    }
}

impl<F: FnMut(&Nodes, usize) -> States + Send> Engine for Shooting<F> {
    fn describe(&self) -> EngineDescription {
        self.spectral.describe()
    }

    fn residual_bound(&self) -> f64 {
        self.spectral.residual_bound()
    }

    fn has_device(&self) -> bool {
        true
    }

    fn shoots(&self) -> bool {
        true
    }

    fn shoot_nodes(&mut self, nodes: &Nodes) -> States {
        (self.shoot)(nodes, self.collected)
    }

    fn submit(&mut self, batch: Arc<RowBatch>) -> Result<(), EngineError> {
        self.spectral.submit(batch)
    }

    fn collect(&mut self) -> Result<Cells, EngineError> {
        self.collected += 1;
        self.spectral.collect()
    }
}

/// Panels of 16 whiskers, in groups of 2, by `engine`.
fn sweep(engine: Option<&mut dyn Engine>) -> (Summary, Vec<Panel>) {
    let scene = shipped::scene("morphology").thinned(96, 4);
    let mut plan = Plan::new(&scene).unwrap();
    plan.panels_at_once = 2;
    compute_as(&scene, &plan, engine)
}

fn nets_do_not_depend_on_who_integrates() {
    let (alone, wanted) = sweep(Some(&mut Spectral::default()));
    assert_eq!(alone.trajectories, 0);
    let mut shot = 0;
    let mut engine = Shooting::new(|nodes: &Nodes, _| {
        let states = nodes.shoot();
        assert_eq!(states.len(), nodes.count());
        shot += states.len() as u64;
        Ok(states)
    });
    let (summary, panels) = sweep(Some(&mut engine));
    assert!(summary.engine_failure.is_none());
    assert_eq!(summary.trajectories, shot);
    assert!(shot > 10_000, "{shot}");
    assert_eq!(summary.engine_cells, alone.engine_cells);
    assert_identical(&wanted, &panels);
}

/// A failure, too few states, or a panic, in the first group or a later one.
fn an_engine_that_fails_to_integrate_is_disabled() {
    let (_, by_cpu) = sweep(None);
    let failures: [(Failure, &str); 3] = [
        (|_| Err(EngineError::Device("lost".to_owned())), "GPU: lost"),
        (|nodes| Ok(nodes.shoot().split_off(1)), "states of"),
        (|_| panic!("a panic on purpose"), "has panicked"),
    ];
    // At most three batches that were collected from the engine may be lost.
    for (fail, what) in failures {
        for sound in [0, 4] {
            let mut has_failed = false;
            let mut engine = Shooting::new(|nodes: &Nodes, collected| {
                assert!(!has_failed, "{what}");
                has_failed = collected >= sound;
                match has_failed {
                    true => fail(nodes),
                    false => Ok(nodes.shoot()),
                }
            });
            let (summary, panels) = sweep(Some(&mut engine));
            let failure = summary.engine_failure.unwrap().to_string();
            assert!(failure.contains(what), "{failure}");
            assert_eq!(summary.engine_cells.solved > 0, sound > 0, "{what}");
            assert!(summary.engine_cells.on_cpu_instead > 0);
            assert_close(&by_cpu, &panels, what);
        }
    }
}

/// In `f64`. Nets in `f32` would not be accurate enough, so that the CPU integrates them.
fn the_device_integrates_the_nets_of_a_sweep() {
    let (_, by_cpu) = sweep(None);
    let (summary, panels) = sweep(Some(&mut open(Precision::F64)));
    assert!(summary.trajectories > 10_000, "{}", summary.trajectories);
    assert!(summary.engine_cells.solved > 0);
    assert_eq!(summary.audit.differing, 0);
    assert_close(&by_cpu, &panels, "f64");
    let (summary, _) = sweep(Some(&mut open(Precision::F32)));
    assert_eq!(summary.trajectories, 0);
}
