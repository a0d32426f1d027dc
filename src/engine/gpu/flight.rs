//! Flights: submissions on the device, in buffers that are used again.

use super::EngineError;
use super::cells::{CELL_BYTES, read_cells};
use super::device::{Device, copy_back};
use super::packing::Packed;
use super::pending::PendingBatch;
use super::stamps::Stamps;
use std::time::{Duration, Instant};
use wgpu::BufferUsages as Usage;

/// Wall times of the stages of submissions, each summed over all submissions.
#[derive(Clone, Copy, Debug, Default)]
pub struct Times {
    /// Wall time to pack and submit on the CPU.
    pub upload: Duration,
    /// Run time of the shader by the device's own clock; 0 if the device has none.
    pub dispatch: Duration,
    /// Time in which the engine's thread waited for the device.
    pub waiting: Duration,
    /// Time to read the cells back and unpack them, after the wait.
    pub readback: Duration,
}

/// Buffers of a submission on the device, which grow when they must.
#[derive(Debug, Default)]
pub struct Buffers {
    stamps: Option<Stamps>,
    groups: Option<wgpu::Buffer>,
    base_points: Option<wgpu::Buffer>,
    starts: Option<wgpu::Buffer>,
    cells: Option<wgpu::Buffer>,
    readback: Option<wgpu::Buffer>,
}

/// Flight: cells that were submitted to the device and whose results are not read yet, with their buffers.
#[derive(Debug)]
pub struct Flight {
    /// Number of cells of the flight.
    pub cells: usize,
    /// End of its base points in the batch.
    base_points_end: usize,
    /// Time at which the flight was submitted.
    pub submitted: Instant,
    index: wgpu::SubmissionIndex,
    buffers: Buffers,
}

/// Binds a buffer from `offset` on: `size` bytes, or all to its end.
fn binding(
    binding: u32,
    buffer: &wgpu::Buffer,
    offset: usize,
    size: Option<usize>,
) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry {
        binding,
        resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer,
            offset: offset as u64,
            size: size.and_then(|size| wgpu::BufferSize::new(size as u64)),
        }),
    }
}

impl Flight {
    /// Submits packed cells in the `buffers` of a finished flight, and returns the flight. If `is_timed`, the device's clock times it.
    pub fn submit(
        device: &Device,
        pipeline: &wgpu::ComputePipeline,
        pushes: &wgpu::Buffer,
        is_timed: bool,
        mut buffers: Buffers,
        packed: &Packed,
    ) -> Result<Self, EngineError> {
        if is_timed && buffers.stamps.is_none() {
            buffers.stamps = Stamps::new(device)?;
        }
        let bytes = (packed.cells * CELL_BYTES) as u64;
        let usage = Usage::STORAGE | Usage::COPY_SRC | Usage::COPY_DST;
        let cells = device.grown("cells", &mut buffers.cells, bytes, usage)?;
        let usage = Usage::MAP_READ | Usage::COPY_DST;
        let readback = device.grown("readback", &mut buffers.readback, bytes, usage)?;
        let groups = bytemuck::cast_slice(&packed.groups);
        let groups = device.upload("groups", &mut buffers.groups, groups)?;
        let base_points =
            device.upload("base points", &mut buffers.base_points, &packed.base_points)?;
        let starts = device.upload("steps", &mut buffers.starts, &packed.starts)?;
        let room = packed.starts.len() / packed.dispatches.len();
        let dispatches = packed.dispatches.iter().enumerate();
        let bindings = dispatches.map(|(index, own)| {
            let entries = [
                binding(0, groups, own.start * size_of::<[u32; 4]>(), None),
                binding(1, base_points, 0, None),
                binding(2, starts, index * room, Some(room)),
                binding(3, pushes, 0, None),
                binding(4, cells, 0, None),
            ];
            device.handle.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("cells"),
                layout: &pipeline.get_bind_group_layout(0),
                entries: &entries,
            })
        });
        let bindings: Vec<wgpu::BindGroup> = bindings.collect();
        let mut commands = device.handle.create_command_encoder(&Default::default());
        // A cell that the shader does not write must not keep the value of another submission.
        commands.clear_buffer(cells, 0, Some(bytes));
        {
            let mut pass = commands.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("cells"),
                timestamp_writes: buffers.stamps.as_ref().map(Stamps::writes),
            });
            pass.set_pipeline(pipeline);
            for (bindings, groups) in bindings.iter().zip(&packed.dispatches) {
                pass.set_bind_group(0, bindings, &[]);
                // The pace keeps them below what `u32` can count.
                pass.dispatch_workgroups(groups.len() as u32, 1, 1);
            }
        }
        copy_back(&mut commands, cells, readback, bytes);
        if let Some(stamps) = &buffers.stamps {
            stamps.resolve(&mut commands);
        }
        let submitted = Instant::now();
        let index = device.queue.submit([commands.finish()]);
        device.check()?;
        Ok(Self {
            cells: packed.cells,
            base_points_end: packed.base_points_end,
            submitted,
            index,
            buffers,
        })
    }

    /// Waits for the cells, writes them into those of the batch, and returns the buffers.
    pub fn finish(
        self,
        device: &Device,
        pending: &mut PendingBatch,
        times: &mut Times,
    ) -> Result<Buffers, EngineError> {
        let begun = Instant::now();
        device.wait(self.index)?;
        let arrived = Instant::now();
        times.waiting += arrived - begun;
        let base_points = pending.received..self.base_points_end;
        if let Some(readback) = &self.buffers.readback {
            let size = (self.cells * CELL_BYTES) as u64;
            Device::read(readback, size, |bytes| {
                read_cells(bytes, &pending.batch, base_points, &mut pending.cells);
            })?;
        }
        pending.received = self.base_points_end;
        times.readback += arrived.elapsed();
        if let Some(stamps) = &self.buffers.stamps {
            times.dispatch += stamps.read(device)?;
        }
        Ok(self.buffers)
    }
}
