//! A submission under way, in buffers that are used again and again.

use super::EngineError;
use super::base_point::Packed;
use super::device::{Device, answer};
use super::layout::{BufferLayout, read_cells};
use super::pending::PendingBatch;
use super::stamps::Stamps;
use std::ops::Range;
use std::time::{Duration, Instant};
use wgpu::BufferUsages as Usage;

/// What a submission needs beside what it carries.
#[derive(Clone, Copy, Debug)]
pub struct Call<'a> {
    pub device: &'a Device,
    pub layout: &'a BufferLayout,
    pub pipeline: &'a wgpu::ComputePipeline,
    /// The push angles.
    pub pushes: (&'a wgpu::Buffer, usize),
    /// Whether it is timed by the device.
    pub timed: bool,
}

/// What the stages of submissions took.
#[derive(Clone, Copy, Debug, Default)]
pub struct Times {
    /// Packing and handing over.
    pub upload: Duration,
    /// The shader, by the device's own clock; 0 where it has none.
    pub dispatch: Duration,
    /// Waiting for the device.
    pub waiting: Duration,
    /// Unpacking, after the wait.
    pub readback: Duration,
}

/// Room for what a submission reads and writes.
#[derive(Debug)]
pub struct Buffers {
    stamps: Option<Stamps>,
    groups: Option<wgpu::Buffer>,
    base_points: Option<wgpu::Buffer>,
    starts: Option<wgpu::Buffer>,
    cells: wgpu::Buffer,
    readback: wgpu::Buffer,
}

impl Buffers {
    fn new(call: &Call, bytes: u64) -> Result<Self, EngineError> {
        let device = call.device;
        Ok(Self {
            stamps: Stamps::new(device, call.timed)?,
            groups: None,
            base_points: None,
            starts: None,
            cells: device.buffer(
                "cells",
                bytes,
                Usage::STORAGE | Usage::COPY_SRC | Usage::COPY_DST,
            )?,
            readback: device.buffer("readback", bytes, Usage::MAP_READ | Usage::COPY_DST)?,
        })
    }
}

/// A submission under way.
#[derive(Debug)]
pub struct Flight {
    /// Number of cells.
    pub cells: usize,
    /// End of its base points in the batch.
    base_points_end: usize,
    /// When it was handed to the queue.
    pub submitted: Instant,
    index: wgpu::SubmissionIndex,
    buffers: Buffers,
}

/// These bytes of a buffer.
fn bytes_of(binding: u32, buffer: &wgpu::Buffer, bytes: Range<u64>) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry {
        binding,
        resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer,
            offset: bytes.start,
            size: wgpu::BufferSize::new(bytes.end - bytes.start),
        }),
    }
}

impl Flight {
    /// Sends the cells of references on their way, in buffers of a finished flight if they are large enough.
    pub fn submit(
        call: &Call,
        buffers: Option<Buffers>,
        packed: &Packed,
    ) -> Result<Self, EngineError> {
        let (device, layout) = (call.device, call.layout);
        let bytes = (packed.cells * layout.cell) as u64;
        let mut buffers = match buffers {
            Some(buffers) if buffers.cells.size() >= bytes => buffers,
            _ => Buffers::new(call, bytes)?,
        };
        let groups = bytemuck::cast_slice(&packed.groups);
        let groups = device.upload("groups", &mut buffers.groups, groups)?;
        let base_points =
            device.upload("base points", &mut buffers.base_points, &packed.base_points)?;
        let starts = device.upload("steps", &mut buffers.starts, &packed.starts)?;
        let pushes = (call.pushes.1 * layout.push) as u64;
        let room = (packed.starts.len() / packed.dispatches.len()) as u64;
        let steps = (0..).map(|dispatch| dispatch * room..(dispatch + 1) * room);
        let bindings = packed
            .dispatches
            .iter()
            .zip(steps)
            .map(|(of_dispatch, steps)| {
                let groups_here = [of_dispatch.start, of_dispatch.end]
                    .map(|i| (i * size_of::<[u32; 4]>()) as u64);
                let entries = [
                    bytes_of(0, groups, groups_here[0]..groups_here[1]),
                    bytes_of(1, base_points, 0..packed.base_points.len() as u64),
                    bytes_of(2, starts, steps),
                    bytes_of(3, call.pushes.0, 0..pushes),
                    bytes_of(4, &buffers.cells, 0..bytes),
                ];
                device.handle.create_bind_group(&wgpu::BindGroupDescriptor {
                    label: Some("cells"),
                    layout: &call.pipeline.get_bind_group_layout(0),
                    entries: &entries,
                })
            });
        let bindings: Vec<wgpu::BindGroup> = bindings.collect();
        let mut commands = device.handle.create_command_encoder(&Default::default());
        // A cell that the shader does not write must not have the answer of another submission.
        commands.clear_buffer(&buffers.cells, 0, Some(bytes));
        {
            let mut pass = commands.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("cells"),
                timestamp_writes: buffers.stamps.as_ref().map(Stamps::writes),
            });
            pass.set_pipeline(call.pipeline);
            for (bindings, groups) in bindings.iter().zip(&packed.dispatches) {
                pass.set_bind_group(0, bindings, &[]);
                // The pace keeps them below what `u32` can count.
                pass.dispatch_workgroups(groups.len() as u32, 1, 1);
            }
        }
        answer(&mut commands, &buffers.cells, &buffers.readback, bytes);
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
        layout: &BufferLayout,
        pending: &mut PendingBatch,
        times: &mut Times,
    ) -> Result<Buffers, EngineError> {
        let begun = Instant::now();
        device.wait(self.index)?;
        let arrived = Instant::now();
        times.waiting += arrived - begun;
        let size = (self.cells * layout.cell) as u64;
        let base_points = pending.received..self.base_points_end;
        Device::read(&self.buffers.readback, size, |bytes| {
            read_cells(bytes, &pending.batch, base_points, &mut pending.cells);
        })?;
        pending.received = self.base_points_end;
        times.readback += arrived.elapsed();
        if let Some(stamps) = &self.buffers.stamps {
            times.dispatch += stamps.read(device)?;
        }
        Ok(self.buffers)
    }
}
