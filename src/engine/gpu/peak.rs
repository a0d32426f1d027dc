//! Peak rate of a GPU device.

use super::packing::WORKGROUP;
use super::{EngineError, Gpu, shaders};
use std::time::Instant;

/// Workgroups of a dispatch.
const GROUPS: u32 = 1024;

/// Entry points of `shaders/peak.wgsl`, and their accumulators: too few wait for one another's results, too many for memory.
const KERNELS: [(&str, u64); 2] = [("peak_of_8", 8), ("peak_of_16", 16)];

/// Operations of an invocation for each accumulator: 64 rounds of eight.
const OPERATIONS: u64 = 2 * 8 * 64;

/// Shortest timed submission, in seconds: long against the latency of the device, short against any watchdog.
const LONG_ENOUGH: f64 = 0.05;

/// Maximum number of timed dispatches; a power of 2.
const MOST: u32 = 1 << 14;

impl Gpu {
    /// Measures the peak rate of the device in floating-point operations per second, in the engine's precision, with kernels that only
    /// multiply and add. It is that of the fastest of `runs` of each kernel, and of one before them.
    ///
    /// # Errors
    /// When the device fails.
    pub fn peak(&self, runs: usize) -> Result<f64, EngineError> {
        KERNELS
            .iter()
            .try_fold(0.0, |most: f64, (entry, accumulators)| {
                let seconds = self.seconds_of_invocation(entry, runs)?;
                let operations = OPERATIONS * accumulators;
                Ok(most.max(operations as f64 / seconds))
            })
    }

    /// Seconds per invocation of the kernel `entry`.
    fn seconds_of_invocation(&self, entry: &str, runs: usize) -> Result<f64, EngineError> {
        let device = &self.device;
        let pipeline = device.pipeline(entry, &shaders::peak(self.precision), &[])?;
        let invocations = u64::from(GROUPS * WORKGROUP);
        let usage = wgpu::BufferUsages::STORAGE;
        let sums = device.buffer("sums", 8 * invocations, usage)?;
        let bindings = device.handle.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("peak"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: sums.as_entire_binding(),
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
        Ok(fastest / (u64::from(dispatches) * invocations) as f64)
    }
}
