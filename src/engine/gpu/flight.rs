//! Flights: submissions on the device, in buffers that are used again.

use super::EngineError;
use super::cells::{Planes, read_cells};
use super::device::{Device, copy_back};
use super::packing::{CellsOfRow, Packed, WORKGROUP};
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
    heads: Option<wgpu::Buffer>,
    rows: Option<wgpu::Buffer>,
    terms: Option<wgpu::Buffer>,
    cells: Option<wgpu::Buffer>,
    readback: Option<wgpu::Buffer>,
}

/// Flight: cells that were submitted to the device and whose results are not read yet, with their buffers.
#[derive(Debug)]
pub struct Flight {
    /// Number of cells of the flight.
    pub cells: usize,
    /// Places of the flight in the cells of the batch: `[run]`.
    runs: Vec<CellsOfRow>,
    /// Time at which the flight was submitted.
    pub submitted: Instant,
    index: wgpu::SubmissionIndex,
    buffers: Buffers,
}

/// Binds the first `size` bytes of a buffer, or the whole buffer.
pub fn binding(binding: u32, buffer: &wgpu::Buffer, size: Option<u64>) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry {
        binding,
        resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer,
            offset: 0,
            size: size.and_then(wgpu::BufferSize::new),
        }),
    }
}

impl Flight {
    /// Submits the packed `rows` of a batch with these `planes`, in the `buffers` of a finished flight, and returns the flight. There is a cell at
    /// least. If `is_timed`, the device's clock times it.
    pub fn submit(
        device: &Device,
        pipeline: &wgpu::ComputePipeline,
        pushes: &wgpu::Buffer,
        is_timed: bool,
        mut buffers: Buffers,
        (packed, planes): (Packed, Planes),
    ) -> Result<Self, EngineError> {
        if is_timed && buffers.stamps.is_none() {
            buffers.stamps = Stamps::new(device)?;
        }
        let bytes = (packed.cells * planes.cell_bytes()) as u64;
        let usage = Usage::STORAGE | Usage::COPY_SRC | Usage::COPY_DST;
        let cells = device.grown("cells", &mut buffers.cells, bytes, usage)?;
        let usage = Usage::MAP_READ | Usage::COPY_DST;
        let readback = device.grown("readback", &mut buffers.readback, bytes, usage)?;
        let heads = bytemuck::cast_slice(&packed.heads);
        let heads_size = heads.len() as u64;
        let heads = device.upload("runs", &mut buffers.heads, heads)?;
        let rows = device.upload("rows", &mut buffers.rows, &packed.rows)?;
        let terms = device.upload("coefficients", &mut buffers.terms, &packed.terms)?;
        // The shader counts runs and cells by the sizes of their buffers.
        let entries = [
            binding(0, heads, Some(heads_size)),
            binding(1, rows, None),
            binding(2, terms, None),
            binding(3, pushes, None),
            binding(4, cells, Some(bytes)),
        ];
        let bindings = device.handle.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("cells"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let mut commands = device.handle.create_command_encoder(&Default::default());
        // A cell that the shader does not write must not keep the value of another submission.
        commands.clear_buffer(cells, 0, Some(bytes));
        {
            let mut pass = commands.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("cells"),
                timestamp_writes: buffers.stamps.as_ref().map(Stamps::writes),
            });
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &bindings, &[]);
            // The pace keeps them below what `u32` can count.
            let groups = packed.cells.div_ceil(WORKGROUP as usize) as u32;
            pass.dispatch_workgroups(groups, 1, 1);
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
            runs: packed.runs,
            submitted,
            index,
            buffers,
        })
    }

    /// Waits for the cells, writes them into the cells of the batch, and returns the buffers.
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
        if let Some(readback) = &self.buffers.readback {
            let size = (self.cells * Planes::of(&pending.batch).cell_bytes()) as u64;
            Device::read(readback, size, |bytes| {
                read_cells(bytes, &pending.batch, &self.runs, &mut pending.cells);
            })?;
        }
        pending.in_flight -= 1;
        times.readback += arrived.elapsed();
        if let Some(stamps) = &self.buffers.stamps {
            times.dispatch += stamps.read(device)?;
        }
        Ok(self.buffers)
    }
}
