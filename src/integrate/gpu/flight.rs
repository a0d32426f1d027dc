//! A dispatch under way, in buffers that are used again and again.

use super::EngineError;
use super::device::{Device, answer};
use super::layout::{BufferLayout, Steps};
use super::shaders::WORKGROUP;
use super::stamps::Stamps;
use crate::integrate::{Hit, Shot};
use std::time::{Duration, Instant};
use wgpu::BufferUsages as Usage;

/// What all dispatches of a call share.
#[derive(Clone, Copy, Debug)]
pub struct Call<'a> {
    pub device: &'a Device,
    pub layout: &'a BufferLayout,
    pub pipeline: &'a wgpu::ComputePipeline,
    /// The rods.
    pub rods: &'a wgpu::Buffer,
    /// The pieces of their profile, and how many bytes they are.
    pub pieces: Option<(&'a wgpu::Buffer, u64)>,
    /// Whether dispatches are timed by the device.
    pub timed: bool,
}

/// What the stages of a call took.
#[derive(Clone, Copy, Debug, Default)]
pub struct Times {
    /// Packing and handing over.
    pub upload: Duration,
    /// The shader, by the device's own clock; 0 where it has none.
    pub dispatch: Duration,
    /// Unpacking, after the wait.
    pub readback: Duration,
}

/// Room for a number of shots and their hits.
#[derive(Debug)]
pub struct Buffers {
    stamps: Option<Stamps>,
    capacity: usize,
    shots: wgpu::Buffer,
    hits: wgpu::Buffer,
    readback: wgpu::Buffer,
}

impl Buffers {
    fn new(call: &Call, capacity: usize) -> Result<Self, EngineError> {
        let device = call.device;
        let bytes = |each: usize| (capacity * each) as u64;
        let (shots, hits) = (bytes(call.layout.shot), bytes(call.layout.hit));
        Ok(Self {
            stamps: Stamps::new(device, call.timed)?,
            capacity,
            shots: device.buffer("shots", shots, Usage::STORAGE | Usage::COPY_DST)?,
            hits: device.buffer("hits", hits, Usage::STORAGE | Usage::COPY_SRC)?,
            readback: device.buffer("readback", hits, Usage::MAP_READ | Usage::COPY_DST)?,
        })
    }
}

/// A dispatch under way.
#[derive(Debug)]
pub struct Flight {
    /// How many shots.
    pub shots: usize,
    /// When it was handed to the queue.
    pub submitted: Instant,
    index: wgpu::SubmissionIndex,
    buffers: Buffers,
}

/// The first `size` bytes of a buffer.
fn part(binding: u32, buffer: &wgpu::Buffer, size: u64) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry {
        binding,
        resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer,
            offset: 0,
            size: wgpu::BufferSize::new(size),
        }),
    }
}

impl Flight {
    /// Sends shots, and the steps of their trajectories, on their way, in buffers of a finished flight if they are large enough.
    pub fn dispatch(
        call: &Call,
        buffers: Option<Buffers>,
        shots: &[Shot],
        steps: Steps,
    ) -> Result<Self, EngineError> {
        let (device, layout, count) = (call.device, call.layout, shots.len());
        let buffers = match buffers {
            Some(buffers) if buffers.capacity >= count => buffers,
            _ => Buffers::new(call, count)?,
        };
        let bytes = (layout.shots)(shots, steps);
        device.queue.write_buffer(&buffers.shots, 0, &bytes);
        let hits_size = (count * layout.hit) as u64;
        let mut entries = vec![
            part(0, call.rods, call.rods.size()),
            part(1, &buffers.shots, bytes.len() as u64),
            part(2, &buffers.hits, hits_size),
        ];
        entries.extend(call.pieces.map(|(pieces, size)| part(3, pieces, size)));
        let bindings = device.handle.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("shoot"),
            layout: &call.pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let mut commands = device.handle.create_command_encoder(&Default::default());
        {
            let mut pass = commands.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("shoot"),
                timestamp_writes: buffers.stamps.as_ref().map(Stamps::writes),
            });
            pass.set_pipeline(call.pipeline);
            pass.set_bind_group(0, &bindings, &[]);
            // The pace keeps the shots below what `u32` can count.
            pass.dispatch_workgroups((count as u32).div_ceil(WORKGROUP), 1, 1);
        }
        answer(&mut commands, &buffers.hits, &buffers.readback, hits_size);
        if let Some(stamps) = &buffers.stamps {
            stamps.resolve(&mut commands);
        }
        let submitted = Instant::now();
        let index = device.queue.submit([commands.finish()]);
        device.check()?;
        Ok(Self {
            shots: count,
            submitted,
            index,
            buffers,
        })
    }

    /// Waits for the hits, appends them, and gives the buffers back.
    pub fn finish(
        self,
        call: &Call,
        hits: &mut Vec<Hit>,
        times: &mut Times,
    ) -> Result<Buffers, EngineError> {
        call.device.wait(self.index)?;
        let arrived = Instant::now();
        let size = (self.shots * call.layout.hit) as u64;
        Device::read(&self.buffers.readback, size, |bytes| {
            (call.layout.hits)(bytes, hits)
        })?;
        times.readback += arrived.elapsed();
        if let Some(stamps) = &self.buffers.stamps {
            times.dispatch += stamps.read(call.device)?;
        }
        Ok(self.buffers)
    }
}
