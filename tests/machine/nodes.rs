//! Trajectories of nets that an engine integrates for the sheets of a map.

use crate::compute::{assert_close, assert_identical, compute_as, open};
use crate::shipped;
use std::sync::Arc;
use whiskmap::engine::gpu::Precision;
use whiskmap::engine::{Cells, Engine, EngineDescription, EngineError, Nodes, RowBatch, Spectral};
use whiskmap::map::{Panel, Summary};
use whiskmap::mechanics::rod::Effects;
use whiskmap::mechanics::shooting::PlainState;
use whiskmap::mechanics::shooting::batch::Batch;
use whiskmap::plan::Plan;
use whiskmap::scene::Scene;

tests! {
    Nothing:
        nets_do_not_depend_on_who_integrates,
        an_engine_that_fails_to_integrate_is_disabled,
        a_failure_keeps_its_reason_whatever_waits;
    Adapter:
        the_device_integrates_the_nets_of_a_sweep,
        a_table_with_measured_radii_keeps_the_device;
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
    /// Number of batches that it solves before it fails.
    most: usize,
}

/// The states of nodes by the CPU, each rod's alone.
fn by_cpu(nodes: &Nodes) -> Vec<PlainState> {
    let batch = Batch::new(nodes.method).padded();
    let rods = nodes.rods.iter().zip(&nodes.points);
    let states =
        rods.flat_map(|(rod, points)| batch.shoot_at::<PlainState>(rod, points.iter().copied()));
    states.collect()
}

impl<F: FnMut(&Nodes, usize) -> States + Send> Shooting<F> {
    fn new(shoot: F) -> Self {
        Self { spectral: Spectral::default(), shoot, collected: 0, most: usize::MAX }
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

    fn integrates_nodes(&self, _: Effects) -> bool {
        true
    }

    fn shoot_nodes(&mut self, nodes: &Nodes) -> States {
        (self.shoot)(nodes, self.collected)
    }

    fn submit(&mut self, batch: Arc<RowBatch>) -> Result<(), EngineError> {
        self.spectral.submit(batch)
    }

    fn collect(&mut self) -> Result<Cells, EngineError> {
        if self.collected == self.most {
            return Err(EngineError::Device("lost".to_owned()));
        }
        self.collected += 1;
        self.spectral.collect()
    }
}

/// Computes the panels of 16 whiskers by `engine`, in groups of 2 whiskers with one batch each.
fn sweep(engine: Option<&mut dyn Engine>) -> (Summary, Vec<Panel>) {
    sweep_in_batches(1 << 10, engine)
}

/// Computes the panels of [`sweep`] by `engine`, in batches of at most this number of `rows`.
fn sweep_in_batches(rows: usize, engine: Option<&mut dyn Engine>) -> (Summary, Vec<Panel>) {
    let scene = shipped::scene("morphology").thinned(96, 4);
    let mut plan = Plan::new(&scene).unwrap();
    plan.panels_at_once = 2;
    plan.rows_at_once = rows;
    compute_as(&scene, &plan, engine)
}

fn nets_do_not_depend_on_who_integrates() {
    let (alone, wanted) = sweep(Some(&mut Spectral::default()));
    assert_eq!(alone.trajectories, 0);
    let mut shot = 0;
    let mut engine = Shooting::new(|nodes: &Nodes, _| {
        let states = by_cpu(nodes);
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
    let (_, wanted) = sweep(None);
    let failures: [(Failure, &str); 3] = [
        (|_| Err(EngineError::Device("lost".to_owned())), "GPU: lost"),
        (|nodes| Ok(by_cpu(nodes).split_off(1)), "states of"),
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
                    false => Ok(by_cpu(nodes)),
                }
            });
            let (summary, panels) = sweep(Some(&mut engine));
            let failure = summary.engine_failure.unwrap().to_string();
            assert!(failure.contains(what), "{failure}");
            assert_eq!(summary.engine_cells.solved > 0, sound > 0, "{what}");
            assert!(summary.engine_cells.on_cpu_instead > 0);
            assert_close(&wanted, &panels, what);
        }
    }
}

/// A batch that fails while nodes of the next group wait, and nodes that fail while batches wait: both report why.
fn a_failure_keeps_its_reason_whatever_waits() {
    let (_, wanted) = sweep(None);
    for rows in [16, 100, 1 << 10] {
        for (most, sound) in [(0, usize::MAX), (3, usize::MAX), (usize::MAX, 0), (usize::MAX, 5)] {
            let mut engine = Shooting::new(|nodes: &Nodes, collected| match collected < sound {
                true => Ok(by_cpu(nodes)),
                false => Err(EngineError::Device("lost".to_owned())),
            });
            engine.most = most;
            let (summary, panels) = sweep_in_batches(rows, Some(&mut engine));
            let failure = summary.engine_failure.unwrap().to_string();
            assert_eq!(failure, "GPU: lost", "{rows} {most} {sound}");
            assert!(summary.engine_cells.on_cpu_instead > 0);
            assert_close(&wanted, &panels, "after a failure");
        }
    }
}

/// The shaders lack measured radii. In a table that has them, the CPU integrates the nets of the other whiskers, and the device evaluates them.
fn a_table_with_measured_radii_keeps_the_device() {
    let text = "title = \"Two\"\n[whisker]\nlength_mm = 20\nyoungs_modulus_gpa = 3\n\
        [whiskers]\ntable = [{ name = \"cone\", base_radius_um = 30, tip_radius_um = 3 }, \
        { name = \"measured\", profile = [[0, 30], [10, 18], [20, 2]] }]\n\
        [pole]\nradius_mm = 0.25\n[grid]\n\
        push_angle_deg = { from = 1, to = 60, count = 128 }\ndistance_mm = { from = 5, to = 20, count = 128 }\n";
    let scene = Scene::parse(text, "table.toml").unwrap();
    let plan = Plan::new(&scene).unwrap();
    let (_, wanted) = compute_as(&scene, &plan, None);
    let (summary, panels) = compute_as(&scene, &plan, Some(&mut open(Precision::F64)));
    assert!(summary.engine_failure.is_none(), "{:?}", summary.engine_failure);
    assert!(summary.engine_cells.solved > 1000);
    assert_eq!(summary.trajectories, 0);
    assert_eq!(summary.unresolved(), 0);
    assert_close(&wanted, &panels, "a table");
}

/// In `f64`, whatever the precision of cells: nets in `f32` would not be accurate enough.
fn the_device_integrates_the_nets_of_a_sweep() {
    let (_, wanted) = sweep(None);
    let (summary, panels) = sweep(Some(&mut open(Precision::F64)));
    assert!(summary.trajectories > 10_000, "{}", summary.trajectories);
    assert!(summary.engine_cells.solved > 0);
    assert_eq!(summary.audit.differing, 0);
    assert_close(&wanted, &panels, "f64");
    let (summary, _) = sweep(Some(&mut open(Precision::F32)));
    assert!(summary.trajectories > 10_000, "{}", summary.trajectories);
    assert!(summary.engine_cells.solved > 0);
    assert_eq!(summary.audit.differing, 0);
}
