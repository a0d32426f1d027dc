//! Devices that are lost: before, between and within the calls of a run.

use super::{assert_same, cone};
use crate::cells::{RandomRows, solve};
use crate::compute::{all_cells, assert_identical, compute, compute_as, open, sabotaged};
use crate::random_rods::USUAL;
use std::sync::Arc;
use whiskmap::engine::gpu::Precision;
use whiskmap::engine::{Cells, Engine, EngineError, RowBatch};
use whiskmap::map::EngineCells;
use whiskmap::plan::Plan;
use whiskmap::scene::Scene;

tests! {
    Adapter:
        lost_between_two_calls,
        lost_within_a_call,
        lost_to_another_thread;
    Precision:
        lost_with_batches_submitted;
}

/// A plan of 16 calls of 16 rows each.
fn in_batches(scene: &Scene) -> Plan {
    let mut plan = Plan::new(scene).unwrap();
    plan.rows_at_once = 16;
    plan
}

/// Number of cells that a sound run counts.
fn sound_cells(scene: &Scene, plan: &Plan) -> u64 {
    let (summary, _) = compute_as(scene, plan, Some(&mut open(Precision::F32)));
    assert_eq!(summary.engine_cells.on_cpu_instead, 0);
    all_cells(&summary.engine_cells)
}

fn lost_between_two_calls() {
    let scene = cone(128);
    let plan = in_batches(&scene);
    let all = sound_cells(&scene, &plan);
    let (_, cpu) = compute_as(&scene, &plan, None);
    for call in [0, 1, 7, 12] {
        let gpu = open(Precision::F32);
        let mut engine = sabotaged(gpu, call, wgpu::Device::destroy);
        let (summary, panels) = compute_as(&scene, &plan, Some(&mut engine));
        assert_eq!(engine.calls, call + 1, "a lost device gets no further batch");
        assert!(matches!(summary.engine_failure, Some(EngineError::Device(_))));
        let cells = summary.engine_cells;
        assert_eq!(cells.solved == 0, call == 0);
        assert!(cells.on_cpu_instead > 0);
        assert_eq!(all_cells(&cells), all);
        assert_same(&cpu, &panels);
        if call == 0 {
            assert_identical(&cpu, &panels);
        }
    }
}

/// Has the device destroyed while wgpu looks for finished work for the `looks + 1`-th time from now on: at the end of
/// each submission, before what it read back is mapped, and in each wait.
fn destroy_within(device: &wgpu::Device, looks: usize) {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 4,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    again(device.clone(), buffer, looks);
}

fn again(device: wgpu::Device, buffer: wgpu::Buffer, looks: usize) {
    let same = buffer.clone();
    buffer.map_async(wgpu::MapMode::Read, .., move |_| {
        if looks == 0 {
            device.destroy();
        } else {
            same.unmap();
            again(device, same, looks - 1);
        }
    });
}

/// 256 x 256 cells are one call of several submissions. All of its cells are left to the refinement, so the map is that of the CPU.
fn lost_within_a_call() {
    let scene = cone(256);
    let all = sound_cells(&scene, &Plan::new(&scene).unwrap());
    // The first submissions have 4096 cells, and each is looked for more than once.
    assert!(all > 4 * 8192, "{all}");
    let failed = EngineCells { on_cpu_instead: all, ..EngineCells::default() };
    let (_, cpu) = compute(&scene, None);
    for looks in 0..4 {
        let gpu = open(Precision::F32);
        let mut engine = sabotaged(gpu, 0, |device: &wgpu::Device| {
            destroy_within(device, looks);
        });
        let (summary, panels) = compute(&scene, Some(&mut engine));
        let failure = summary.engine_failure.unwrap();
        assert!(matches!(failure, EngineError::Device(_)), "{failure}");
        assert_eq!(summary.engine_cells, failed);
        assert_identical(&cpu, &panels);
    }
}

/// Whenever the other thread comes, all cells are counted once, as the engine's or not.
fn lost_to_another_thread() {
    let scene = cone(128);
    let plan = in_batches(&scene);
    let all = sound_cells(&scene, &plan);
    let (_, cpu) = compute_as(&scene, &plan, None);
    for _ in 0..10 {
        let gpu = open(Precision::F32);
        let mut thread = None;
        let destroy = |device: &wgpu::Device| {
            let device = device.clone();
            thread = Some(std::thread::spawn(move || device.destroy()));
        };
        let mut engine = sabotaged(gpu, 2, destroy);
        let (summary, panels) = compute_as(&scene, &plan, Some(&mut engine));
        drop(engine);
        assert_eq!(all_cells(&summary.engine_cells), all);
        thread.unwrap().join().unwrap();
        assert_same(&cpu, &panels);
    }
}

/// Whatever is submitted when a device is lost: a response is right, or it is an error, and so are all after it.
fn lost_with_batches_submitted(precision: Precision) {
    let rows = RandomRows::many(120, USUAL, 4, 2, |_, _| ());
    let mut gpu = open(precision);
    let part = rows.len() / 4;
    let batches = (0..4).map(|i| rows.part(&gpu, i * part..(i + 1) * part));
    let batches: Vec<RowBatch> = batches.collect();
    // NaN is not equal to itself.
    let text = |cells: Cells| format!("{cells:?}");
    let alone = batches.iter().map(|batch| text(solve(&mut gpu, batch)));
    let alone: Vec<String> = alone.collect();
    for before in 0..batches.len() {
        let mut gpu = open(precision);
        for batch in &batches {
            gpu.submit(Arc::new(batch.clone())).unwrap();
        }
        let mut is_lost = false;
        for (number, alone) in alone.iter().enumerate() {
            if number == before {
                gpu.device().destroy();
            }
            match gpu.collect() {
                Ok(cells) => assert!(!is_lost && text(cells) == *alone),
                Err(EngineError::Device(_)) if number >= before => is_lost = true,
                Err(error) => panic!("{error}"),
            }
        }
        assert!(is_lost, "the last batch cannot have been sent as a whole");
    }
}
