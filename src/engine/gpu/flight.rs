//! Flights: submissions of cells on the device.

use super::EngineError;
use super::cells::{cell_bytes, read_cells};
use super::device::Device;
use super::packing::Packed;
use super::pending::PendingBatch;
use super::submission::Buffers;
use crate::plan::Channels;
use std::ops::Range;
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

/// Flight: cells that were submitted to the device and whose results are not read yet, with their buffers.
#[derive(Debug)]
pub struct Flight {
    /// Number of cells of the flight.
    pub cells: usize,
    /// True if the flight has the last cells of its batch.
    pub is_last: bool,
    /// Runs of the flight's cells as ranges of the cells of the batch: `[run]`.
    runs: Vec<Range<usize>>,
    /// Time at which the flight was submitted.
    pub submitted: Instant,
    index: wgpu::SubmissionIndex,
    buffers: Buffers,
}

impl Flight {
    /// Submits the packed rows of a batch with these `channels`, in the `buffers` of a finished flight, and returns the flight. There is a cell
    /// at least.
    pub fn submit(
        device: &Device,
        pipeline: &wgpu::ComputePipeline,
        packed: Packed,
        channels: Channels,
        mut buffers: Buffers,
        is_last: bool,
    ) -> Result<Self, EngineError> {
        let inputs: [&[u8]; 4] =
            [bytemuck::cast_slice(&packed.heads), &packed.rows, &packed.terms, &packed.pushes];
        let submitted = Instant::now();
        let sizes = [packed.cells, cell_bytes(channels)];
        let index = buffers.submit(device, pipeline, &inputs, "cells", sizes)?;
        Ok(Self { cells: packed.cells, is_last, runs: packed.runs, submitted, index, buffers })
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
        self.buffers.read(|bytes| {
            read_cells(bytes, &pending.batch, &self.runs, &mut pending.cells);
        })?;
        pending.in_flight -= 1;
        times.readback += arrived.elapsed();
        times.dispatch += self.buffers.run_time(device)?;
        Ok(self.buffers)
    }
}
