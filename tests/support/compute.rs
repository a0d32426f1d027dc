//! Whole maps in memory, how far two of them are apart, and engines that are looked after.
#![allow(clippy::panic, reason = "a test fails by panicking")]

use crate::shipped;
use std::collections::VecDeque;
use std::sync::Arc;
use whiskmap::classify::Regime;
use whiskmap::engine::gpu::{Gpu, Precision};
use whiskmap::engine::{Cells, Engine, EngineDescription, EngineError, RowBatch};
use whiskmap::map::{self, EngineCells, Panel, STATE_CHANNELS, Summary};
use whiskmap::plan::Plan;
use whiskmap::scene::{Parameter, Scene};

/// Returns true for the code of a regime with contact.
pub fn is_contact(regime: u32) -> bool {
    let contacts = [Regime::Contact, Regime::Unreachable];
    contacts.map(Regime::code).contains(&regime)
}

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
    let summary = map::run_to_end(scene, plan, engine, |panels| all.append(panels));
    (summary, all)
}

/// The GPU engine.
pub fn open(precision: Precision) -> Gpu {
    Gpu::open(None, precision).unwrap_or_else(|error| panic!("{error}"))
}

/// The GPU engine with this shader.
pub fn open_with(precision: Precision, shader: String) -> Gpu {
    let mut gpu = open(precision);
    gpu.shader = shader;
    gpu
}

/// The cells of a run with an engine, whoever solved them, without those of the audit.
pub fn all_cells(cells: &EngineCells) -> u64 {
    cells.solved + cells.fallback() + cells.without_row + cells.on_cpu_instead
}

/// Whether the engine did its work in a run: maps are right without an engine, too. It must solve `least` of the cells of rows that
/// have expansions, and pass its audit.
pub fn works(summary: &Summary, least: f64) -> Result<(), String> {
    let cells = &summary.engine_cells;
    let found = format!("{cells:?}, {:?}", summary.audit);
    let asked = cells.solved + cells.fallback();
    let enough = asked > 0 && cells.solved as f64 >= least * asked as f64;
    if summary.engine_failure.is_none() && enough && summary.audit.differing == 0 {
        Ok(())
    } else {
        Err(found)
    }
}

/// The response to a batch.
pub type Response = Result<Cells, EngineError>;

/// A replacement of the response to a batch.
pub trait Call: FnMut(usize, &mut Gpu, &dyn Fn(&mut Gpu) -> Response) -> Response + Send {}

impl<F: FnMut(usize, &mut Gpu, &dyn Fn(&mut Gpu) -> Response) -> Response + Send> Call for F {}

/// A GPU that gets one batch at a time. `call` gets the number of each, from 0 on, and how the GPU solves it, and returns the response.
pub struct Watched<F> {
    gpu: Gpu,
    call: F,
    submitted: VecDeque<Arc<RowBatch>>,
    pub calls: usize,
}

impl<F: Call> Watched<F> {
    pub const fn new(gpu: Gpu, call: F) -> Self {
        Self { gpu, call, submitted: VecDeque::new(), calls: 0 }
    }
}

impl<F: Call> Engine for Watched<F> {
    fn describe(&self) -> EngineDescription {
        self.gpu.describe()
    }

    fn residual_bound(&self) -> f64 {
        self.gpu.residual_bound()
    }

    fn row_residual(&self) -> f64 {
        self.gpu.row_residual()
    }

    fn has_device(&self) -> bool {
        true
    }

    fn submit(&mut self, batch: Arc<RowBatch>) -> Result<(), EngineError> {
        self.submitted.push_back(batch);
        Ok(())
    }

    fn collect(&mut self) -> Response {
        let batch = self.submitted.pop_front().unwrap();
        self.calls += 1;
        let solve = |gpu: &mut Gpu| {
            gpu.submit(Arc::clone(&batch))?;
            gpu.collect()
        };
        (self.call)(self.calls - 1, &mut self.gpu, &solve)
    }
}

/// A [`Watched`] GPU with something done to its device before the batch number `at`.
pub fn sabotaged(
    gpu: Gpu,
    at: usize,
    mut sabotage: impl FnMut(&wgpu::Device) + Send,
) -> Watched<impl Call> {
    Watched::new(gpu, move |call, gpu: &mut Gpu, solve: &dyn Fn(&mut Gpu) -> Response| {
        if call == at {
            sabotage(gpu.device());
        }
        solve(gpu)
    })
}

/// How far the states of an engine may be from those of the CPU, in parts of a channel's largest value along a whisker: at worst, and
/// in the median over the cells that the engine solved. In `f32`, a pole is missed by up to 6e-7 of the length. At worst, a component of the
/// force that is smaller than the force is then off by 1.4e-6 (`scenes/follicle.toml`).
pub const WORST: f32 = 1.5e-6;
pub const MEDIAN: f32 = 1e-7;

/// So many cells tell a median from chance.
const ENOUGH: usize = 100;

/// Asserts that regimes are equal, and states as far as an engine may be off.
pub fn assert_close(wanted: &[Panel], found: &[Panel], what: &str) {
    assert_eq!(wanted.len(), found.len());
    for (a, b) in wanted.iter().zip(found) {
        assert!(a.regime == b.regime, "{what}");
        for (channel, apart) in STATE_CHANNELS.iter().zip(differences(a, b)) {
            let (median, worst) = median_and_worst(&apart);
            assert!(worst <= WORST, "{channel} of {what}: {worst:.1e}");
            let few = apart.len() < ENOUGH;
            assert!(few || median <= MEDIAN, "{channel} of {what}: {median:.1e}");
        }
    }
}

/// The median and the largest of sorted numbers; 0 of none.
pub fn median_and_worst(sorted: &[f32]) -> (f32, f32) {
    let at = |index: usize| sorted.get(index).copied().unwrap_or(0.0);
    (at(sorted.len() / 2), at(sorted.len().saturating_sub(1)))
}

/// For each channel how far the states are apart that two engines found, in parts of its largest value, sorted. A cell was solved by
/// another engine if its residual is another.
pub fn differences(a: &Panel, b: &Panel) -> [Vec<f32>; STATE_CHANNELS.len()] {
    let other: Vec<bool> =
        (a.residual.iter().zip(&b.residual)).map(|(a, b)| a.to_bits() != b.to_bits()).collect();
    std::array::from_fn(|channel| {
        let apart = relative(&a.state[channel], &b.state[channel]);
        let theirs = apart.zip(&other);
        let theirs = theirs.filter(|(apart, other)| **other || *apart > 0.0);
        let mut theirs: Vec<f32> = theirs.map(|(apart, _)| apart).collect();
        theirs.sort_by(f32::total_cmp);
        theirs
    })
}

/// Differences of a stored channel, relative to the largest value; infinite where only one is NaN.
fn relative<'a>(a: &'a [f32], b: &'a [f32]) -> impl Iterator<Item = f32> + 'a {
    let finite = a.iter().filter(|x| x.is_finite());
    let largest = finite.fold(f32::MIN_POSITIVE, |m, x| m.max(x.abs()));
    let pairs = a.iter().zip(b);
    pairs.map(move |(x, y)| match (x.is_nan(), y.is_nan()) {
        (true, true) => 0.0,
        (false, false) => (x - y).abs() / largest,
        _ => f32::INFINITY,
    })
}

/// The largest difference of two stored channels, relative to the largest value.
pub fn difference(a: &[f32], b: &[f32]) -> f32 {
    relative(a, b).fold(0.0, f32::max)
}

/// Asserts that two maps are equal bit by bit, Newton steps included.
pub fn assert_identical(wanted: &[Panel], found: &[Panel]) {
    assert_same_states(wanted, found);
    for (a, b) in wanted.iter().zip(found) {
        assert!(a.newton_steps == b.newton_steps);
    }
}

/// Asserts that two maps are equal bit by bit, but for Newton steps: an engine takes none to find that a cell has no state.
pub fn assert_same_states(wanted: &[Panel], found: &[Panel]) {
    let bits = |channel: &Vec<f32>| -> Vec<u32> { channel.iter().map(|x| x.to_bits()).collect() };
    assert_eq!(wanted.len(), found.len());
    for (a, b) in wanted.iter().zip(found) {
        assert!(a.regime == b.regime && a.status == b.status);
        assert!(a.state.each_ref().map(bits) == b.state.each_ref().map(bits));
        assert!(bits(&a.residual) == bits(&b.residual));
        assert!(bits(&a.margin_deg) == bits(&b.margin_deg));
    }
}

/// Checks that maps by `solve` have no load at first touch: a logarithmic scale would show what rounding makes of it.
pub fn assert_no_load_at_touch(mut solve: impl FnMut(&Scene) -> Panel) {
    let cone = shipped::scene("cone");
    let changed = [
        cone.with(Parameter::ParabolaPerMm, 0.075),
        cone.with(Parameter::Friction, 0.3),
        cone.with(Parameter::TipRadiusUm, 0.0),
    ];
    let others = ["euler_spiral", "measured", "traced"].map(shipped::scene);
    let scenes = changed.map(Result::unwrap).into_iter().chain(others);
    let pushes = [-1e-3, -0.0, 1e-3, 2.0, 5.0];
    let distances = [4.0, 7.0, 11.0, 15.0];
    for scene in scenes {
        let scene = scene.to_builder().push_angle_deg(pushes).build().unwrap();
        let scene = scene.to_builder().distance_mm(distances).build().unwrap();
        let panel = solve(&scene);
        for (name, values) in STATE_CHANNELS.iter().zip(&panel.state) {
            let is_load = |kind: &&str| name.contains(*kind);
            let is_load = ["force", "base_", "energy"].iter().any(is_load);
            for row in values.chunks(pushes.len()) {
                if is_load {
                    let are_none = row.iter().map(|value| value.to_bits() == 0);
                    let only_touch = [false, true, false, false, false];
                    assert!(are_none.eq(only_touch), "{}: {name} {row:?}", scene.title);
                } else {
                    let middle = 0.5 * (row[0] + row[2]);
                    let off = (row[1] - middle).abs() - (row[2] - row[0]).abs();
                    assert!(off <= 1e-4, "{}: {name} {row:?}", scene.title);
                }
            }
        }
        for row in 0..distances.len() {
            let touch = row * pushes.len() + 1;
            assert_eq!((panel.regime[touch], panel.residual[touch]), (1, 0.0));
        }
    }
}
