//! Row batches in order: an engine solves one while the previous one is completed, and results do not depend on threads.

use crate::compute::{Response, Watched, assert_identical, compute_as, open};
use crate::shipped;
use std::convert::Infallible;
use std::sync::atomic::AtomicBool;
use std::sync::mpsc;
use std::time::Duration;
use whiskmap::engine::gpu::{Gpu, Precision};
use whiskmap::engine::{Engine, EngineError, Spectral};
use whiskmap::map::{self, Panel, Stage, Summary};
use whiskmap::plan::Plan;
use whiskmap::scene::Scene;
use whiskmap::store::MapWriter;

tests! {
    Nothing:
        stages_are_one_sequence,
        the_spectral_engine_is_a_stage;
    Adapter:
        a_batch_is_solved_while_the_previous_one_is_completed,
        outcomes_do_not_depend_on_threads,
        a_response_of_too_few_cells_is_a_failure,
        an_engine_goes_from_run_to_run,
        stages_are_one_sequence_beside_an_engine;
}

/// The paper's cone, and a plan that takes 16 of its rows at a time.
fn in_batches() -> (Scene, Plan) {
    let scene = shipped::scene("cone").thinned(128, 1);
    let mut plan = Plan::new(&scene).unwrap();
    plan.rows_at_once = 16;
    (scene, plan)
}

fn on_threads<R: Send>(count: usize, work: impl FnOnce() -> R + Send) -> R {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
    pool.unwrap().install(work)
}

/// Batches of which the engine certainly gets all; the last ones of a side are out of reach and have no expansions.
const AT_ONCE: usize = 6;

/// The response to a call waits until the previous batch is completed, which waits for the call: in sequence, one would wait for ever.
fn a_batch_is_solved_while_the_previous_one_is_completed() {
    let (scene, plan) = in_batches();
    let gpu = open(Precision::F32);
    let wait = |other: &mpsc::Receiver<usize>, until: usize| {
        while other.recv_timeout(Duration::from_secs(60)).unwrap() < until {}
    };
    let ((call_begins, calls), (batch_ends, ends)) = (mpsc::channel(), mpsc::channel());
    let call = move |before: usize, gpu: &mut Gpu, solve: &dyn Fn(&mut Gpu) -> Response| {
        let cells = solve(gpu)?;
        call_begins.send(before + 1).unwrap();
        if (1..AT_ONCE).contains(&before) {
            wait(&ends, before);
        }
        Ok(cells)
    };
    let mut engine = Watched::new(gpu, call);
    on_threads(1, move || {
        let mut completed = 0;
        let mut one_more = |_| {
            completed += 1;
            batch_ends.send(completed).unwrap();
            if completed < AT_ONCE {
                wait(&calls, completed + 1);
            }
        };
        let discard = &mut |_: &mut Vec<Panel>| Ok::<(), Infallible>(());
        let never = AtomicBool::new(false);
        let Ok(_) = map::run(&scene, &plan, Some(&mut engine), &mut one_more, &never, discard);
        assert_eq!(completed, 16);
    });
}

/// The fifth call fails, or its cells are wrong, which the audit finds while the sixth is submitted: all cells of both are the CPU's.
fn outcomes_do_not_depend_on_threads() {
    let (scene, plan) = in_batches();
    let run = |threads: usize, is_wrong: bool| -> (Summary, Vec<Panel>) {
        let gpu = open(Precision::F32);
        let call = |before, gpu: &mut Gpu, solve: &dyn Fn(&mut Gpu) -> Response| {
            let mut cells = solve(gpu)?;
            if before == 4 && !is_wrong {
                return Err(EngineError::Device("lost".to_owned()));
            }
            if before == 4 {
                cells.values[2].iter_mut().for_each(|force| *force *= 1.5);
            }
            Ok(cells)
        };
        let mut engine = Watched::new(gpu, call);
        let work = || compute_as(&scene, &plan, Some(&mut engine));
        on_threads(threads, work)
    };
    let (wanted, panels) = run(1, false);
    assert!(wanted.engine_cells.solved > 0 && wanted.engine_cells.on_cpu_instead > 0);
    for (threads, is_wrong) in [(4, false), (1, true), (4, true)] {
        let (summary, found) = run(threads, is_wrong);
        assert_eq!(summary.engine_cells, wanted.engine_cells);
        assert_eq!(summary.audit.differing > 0, is_wrong);
        assert!(summary.engine_failure.is_some());
        assert_identical(&panels, &found);
    }
}

/// An engine that returns too few cells is disabled, and the map is complete.
fn a_response_of_too_few_cells_is_a_failure() {
    let (scene, plan) = in_batches();
    let gpu = open(Precision::F32);
    let forget = |_, gpu: &mut Gpu, solve: &dyn Fn(&mut Gpu) -> Response| {
        let mut cells = solve(gpu)?;
        cells.outcome.pop();
        Ok(cells)
    };
    let mut engine = Watched::new(gpu, forget);
    let (summary, panels) = compute_as(&scene, &plan, Some(&mut engine));
    let failure = summary.engine_failure.unwrap().to_string();
    assert!(failure.contains("a response of"), "{failure}");
    // Responses to batches already submitted are discarded.
    assert!((1..=3).contains(&engine.calls), "{}", engine.calls);
    assert_eq!(summary.engine_cells.solved, 0);
    assert_identical(&compute_as(&scene, &plan, None).1, &panels);
}

/// Cells of batches that were submitted when a run ended early do not appear in the next run.
fn an_engine_goes_from_run_to_run() {
    let (scene, plan) = in_batches();
    let mut gpu = open(Precision::F32);
    let fresh = compute_as(&scene, &plan, Some(&mut gpu)).1;
    let sweep = shipped::scene("morphology").thinned(48, 1);
    let mut plan_of_sweep = Plan::new(&sweep).unwrap();
    plan_of_sweep.panels_at_once = 1;
    for _ in 0..3 {
        let refuse = &mut |_: &mut Vec<Panel>| Err("no room");
        let refused = map::run(
            &sweep,
            &plan_of_sweep,
            Some(&mut gpu),
            &mut |_| {},
            &AtomicBool::new(false),
            refuse,
        );
        assert_eq!(refused.unwrap_err(), "no room");
        assert_identical(&fresh, &compute_as(&scene, &plan, Some(&mut gpu)).1);
    }
}

fn stages_are_one_sequence() {
    for threads in [1, 3] {
        on_threads(threads, || stages_follow_each_other(None));
    }
}

fn stages_are_one_sequence_beside_an_engine() {
    for threads in [1, 3] {
        let mut gpu = open(Precision::F32);
        on_threads(threads, || stages_follow_each_other(Some(&mut gpu)));
    }
}

/// The engine's seconds are those of its stage, not beside the others.
fn the_spectral_engine_is_a_stage() {
    let scene = shipped::scene("cone").thinned(256, 1);
    let plan = Plan::new(&scene).unwrap();
    let (summary, _) = compute_as(&scene, &plan, Some(&mut Spectral::default()));
    for stage in [Stage::Rows, Stage::Cells] {
        assert!(summary.stage_seconds(stage) > 0.0, "{stage:?}");
    }
    assert_eq!((summary.device_seconds, summary.waiting_seconds), (0.0, 0.0));
    let all = Stage::ALL.map(|(stage, _)| summary.stage_seconds(stage));
    let sequence = all.iter().sum::<f64>() - summary.stage_seconds(Stage::Packing);
    assert!(sequence <= summary.wall_seconds + 1e-9, "{all:?}");
}

/// Asserts that every stage takes time, and that no second counts for two stages.
fn stages_follow_each_other(engine: Option<&mut dyn Engine>) {
    let (scene, plan) = in_batches();
    let has_engine = engine.is_some();
    let summary = map::run_to_end(&scene, &plan, engine, |panels| {
        assert!(MapWriter::sample(&scene.grid, &plan, panels) > 0);
    });
    for (stage, name) in Stage::ALL {
        let has_worked = match stage {
            Stage::Rows => has_engine,
            Stage::Cells => false,
            _ => true,
        };
        assert_eq!(summary.stage_seconds(stage) > 0.0, has_worked, "{name}");
    }
    let beside = summary.stage_seconds(Stage::Packing);
    let all = Stage::ALL.map(|(stage, _)| summary.stage_seconds(stage));
    let sequence = all.iter().sum::<f64>() - beside + summary.waiting_seconds;
    let wall = summary.wall_seconds;
    // Sums of rounded seconds.
    assert!(sequence <= wall + 1e-9, "{all:?}: {sequence} of {wall}");
    assert_eq!(summary.device_seconds > 0.0, has_engine);
    assert!(summary.cpu_seconds.is_some_and(|cpu| cpu > 0.0));
}
