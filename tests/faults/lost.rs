//! Devices that are lost: before, between and within the calls of a run.

use crate::compute::{compute, compute_as};
use crate::{assert_identical, assert_same, cone, sound};
use whiskmap::integrate::gpu::{Gpu, Precision};
use whiskmap::integrate::{Description, Engine, EngineError, Hit, Shot};
use whiskmap::plan::Plan;
use whiskmap::rod::{Effects, Rod};

/// A GPU to which something is done before one of its calls.
struct Sabotaged<F> {
    gpu: Gpu,
    call: usize,
    sabotage: F,
    calls: usize,
    /// Shots that the GPU has solved.
    solved: u64,
}

impl<F> Sabotaged<F> {
    fn new(gpu: Gpu, call: usize, sabotage: F) -> Self {
        Self {
            gpu,
            call,
            sabotage,
            calls: 0,
            solved: 0,
        }
    }
}

impl<F: FnMut(&wgpu::Device)> Engine for Sabotaged<F> {
    fn describe(&self) -> Description {
        self.gpu.describe()
    }

    fn shoot(
        &mut self,
        effects: Effects,
        rods: &[Rod],
        shots: &[Shot],
    ) -> Result<Vec<Hit>, EngineError> {
        if self.calls == self.call {
            (self.sabotage)(self.gpu.device());
        }
        self.calls += 1;
        let hits = self.gpu.shoot(effects, rods, shots)?;
        self.solved += hits.len() as u64;
        Ok(hits)
    }
}

/// 16 calls of 8 rows each.
fn in_strips(scene: &whiskmap::scene::Scene) -> Plan {
    let mut plan = Plan::new(scene).unwrap();
    plan.rows_at_once = 8;
    plan
}

#[test]
fn lost_between_two_calls() {
    let scene = cone(64);
    let plan = in_strips(&scene);
    let (_, cpu) = compute_as(&scene, &plan, None);
    for call in [0, 1, 7, 12] {
        let Some(gpu) = sound(Precision::F32) else {
            return;
        };
        let mut engine = Sabotaged::new(gpu, call, wgpu::Device::destroy);
        let (summary, panels) = compute_as(&scene, &plan, Some(&mut engine));
        assert_eq!(engine.calls, call + 1, "a lost device is not asked again");
        assert!(matches!(
            summary.engine_failure,
            Some(EngineError::Device(_))
        ));
        assert_eq!(engine.solved == 0, call == 0);
        let left = summary.shots.all - engine.solved;
        assert_eq!(summary.shots.on_cpu_instead, left);
        assert!(left > 0);
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

/// 128 x 128 cells are one call of several dispatches. All of its shots are left to the refinement, so the map is that of the CPU.
#[test]
fn lost_within_a_call() {
    let scene = cone(128);
    let (_, cpu) = compute(&scene, None);
    for looks in 0..4 {
        let Some(gpu) = sound(Precision::F32) else {
            return;
        };
        let mut engine = Sabotaged::new(gpu, 0, |device: &wgpu::Device| {
            destroy_within(device, looks);
        });
        let (summary, panels) = compute(&scene, Some(&mut engine));
        let failure = summary.engine_failure.unwrap();
        assert!(matches!(failure, EngineError::Device(_)), "{failure}");
        assert!(summary.shots.all > 8192, "{:?}", summary.shots);
        assert_eq!(summary.shots.on_cpu_instead, summary.shots.all);
        assert_identical(&cpu, &panels);
    }
}

/// Whenever the other thread comes, all shots are counted once, as the engine's or not.
#[test]
fn lost_to_another_thread() {
    let scene = cone(64);
    let plan = in_strips(&scene);
    let (_, cpu) = compute_as(&scene, &plan, None);
    for _ in 0..10 {
        let Some(gpu) = sound(Precision::F32) else {
            return;
        };
        let mut thread = None;
        let mut engine = Sabotaged::new(gpu, 2, |device: &wgpu::Device| {
            let device = device.clone();
            thread = Some(std::thread::spawn(move || device.destroy()));
        });
        let (summary, panels) = compute_as(&scene, &plan, Some(&mut engine));
        let left = summary.shots.all - engine.solved;
        assert_eq!(summary.shots.on_cpu_instead, left);
        thread.unwrap().join().unwrap();
        assert_same(&cpu, &panels);
    }
}
