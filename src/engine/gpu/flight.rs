//! Flights: submissions on the device, in buffers that are used again.

use super::EngineError;
use super::cells::{Planes, read_cells};
use super::device::Device;
use super::dispatch::{Dispatch, binding};
use super::packing::{CellsOfRow, Packed};
use super::pending::PendingBatch;
use super::stamps::Stamps;
use std::time::{Duration, Instant};

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
        let results = [&mut buffers.cells, &mut buffers.readback];
        let [cells, readback] = device.results("cells", results, bytes)?;
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
        let dispatch = Dispatch {
            label: "cells",
            pipeline,
            entries: &entries,
            // The pace keeps their groups below what `u32` can count.
            invocations: packed.cells,
            results: [cells, readback],
            size: bytes,
            stamps: buffers.stamps.as_ref(),
        };
        let submitted = Instant::now();
        let index = dispatch.submit(device)?;
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
