//! What the device could do at best.

use super::pipeline::compile;
use super::shaders::WORKGROUP;
use super::{EngineError, Gpu, shaders};
use std::time::Instant;

/// Workgroups of a dispatch.
const GROUPS: u32 = 1024;

/// Operations of an invocation of `shaders/peak.wgsl`: four chains of vectors of four, 64 rounds of eight.
const OPERATIONS: u64 = 4 * 4 * 2 * 8 * 64;

/// Seconds, beside which the way to the device and back is nothing, and well below what a watchdog allows.
const LONG_ENOUGH: f64 = 0.05;

/// Most dispatches on the clock; a power of 2.
const MOST: u32 = 1 << 14;

impl Gpu {
    /// Floating-point operations per second, in the engine's precision, of a kernel that only multiplies and adds; the fastest
    /// of so many `runs`, and of one before them.
    ///
    /// # Errors
    /// When the device fails.
    pub fn peak(&self, runs: usize) -> Result<f64, EngineError> {
        let device = &self.device;
        let pipeline = compile(device, "peak", &shaders::peak(self.precision), &[])?;
        let invocations = u64::from(GROUPS * WORKGROUP);
        let usage = wgpu::BufferUsages::STORAGE;
        let ends = device.buffer("ends", 8 * invocations, usage)?;
        let bindings = device.handle.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("peak"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: ends.as_entire_binding(),
            }],
        });
        let seconds = |dispatches: u32| {
            let start = Instant::now();
            let mut commands = device.handle.create_command_encoder(&Default::default());
            {
                let mut pass = commands.begin_compute_pass(&Default::default());
                pass.set_pipeline(&pipeline);
                pass.set_bind_group(0, &bindings, &[]);
                for _ in 0..dispatches {
                    pass.dispatch_workgroups(GROUPS, 1, 1);
                }
            }
            device.wait(device.queue.submit([commands.finish()]))?;
            Ok(start.elapsed().as_secs_f64())
        };
        let mut dispatches = 1;
        let mut fastest = seconds(dispatches)?;
        while fastest <= LONG_ENOUGH && dispatches < MOST {
            dispatches *= 2;
            fastest = seconds(dispatches)?;
        }
        for _ in 0..runs {
            fastest = fastest.min(seconds(dispatches)?);
        }
        Ok((u64::from(dispatches) * invocations * OPERATIONS) as f64 / fastest)
    }
}
