//! Submissions: one run of a shader each, from the upload of its inputs to the copy of its results for the CPU.

use super::EngineError;
use super::device::{Device, copy_back};
use super::packing::WORKGROUP;
use super::stamps::Stamps;
use std::time::Duration;
use wgpu::BufferUsages as Usage;

/// Buffers of a submission on the device, which are used again and grow when they must.
#[derive(Debug, Default)]
pub struct Buffers {
    inputs: Vec<Option<wgpu::Buffer>>,
    /// Buffer that the shader writes.
    written: Option<wgpu::Buffer>,
    /// Buffer in which the CPU reads the results.
    readback: Option<wgpu::Buffer>,
    /// Number of bytes that the shader writes.
    size: u64,
    /// Time stamps around the run; `None` if it is not timed.
    stamps: Option<Stamps>,
}

impl Buffers {
    /// Adds time stamps, if the device has a clock.
    pub fn timed(mut self, device: &Device) -> Result<Self, EngineError> {
        if self.stamps.is_none() {
            self.stamps = Stamps::new(device)?;
        }
        Ok(self)
    }

    /// Submits a run of `pipeline` with these `inputs`, in the order of their bindings; the next binding is the buffer that the shader writes.
    /// Each of the `invocations` writes `each` bytes of `what`. Their groups are fewer than `u32` can count. The results are mapped for
    /// [`Buffers::read`].
    pub fn submit(
        &mut self,
        device: &Device,
        pipeline: &wgpu::ComputePipeline,
        inputs: &[&[u8]],
        what: &'static str,
        [invocations, each]: [usize; 2],
    ) -> Result<wgpu::SubmissionIndex, EngineError> {
        self.size = (invocations * each) as u64;
        let usage = Usage::STORAGE | Usage::COPY_SRC | Usage::COPY_DST;
        let written = device.grown(what, &mut self.written, self.size, usage)?;
        let usage = Usage::MAP_READ | Usage::COPY_DST;
        let readback = device.grown("readback", &mut self.readback, self.size, usage)?;
        // Shaders count invocations by the sizes of their bindings.
        let mut entries = vec![binding(inputs.len(), written, self.size)];
        self.inputs.resize(inputs.len(), None);
        for (index, (kept, bytes)) in self.inputs.iter_mut().zip(inputs).enumerate() {
            let size = bytes.len() as u64;
            let usage = Usage::STORAGE | Usage::COPY_DST;
            let buffer = device.grown("inputs", kept, size, usage)?;
            device.queue.write_buffer(buffer, 0, bytes);
            entries.push(binding(index, buffer, size));
        }
        let label = Some(what);
        let bindings = device.handle.create_bind_group(&wgpu::BindGroupDescriptor {
            label,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let mut commands = device.handle.create_command_encoder(&Default::default());
        // An invocation that does not write must not keep the results of another submission.
        commands.clear_buffer(written, 0, Some(self.size));
        {
            let mut pass = commands.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label,
                timestamp_writes: self.stamps.as_ref().map(Stamps::writes),
            });
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &bindings, &[]);
            let groups = invocations.div_ceil(WORKGROUP as usize) as u32;
            pass.dispatch_workgroups(groups, 1, 1);
        }
        copy_back(&mut commands, written, readback, self.size);
        if let Some(stamps) = &self.stamps {
            stamps.resolve(&mut commands);
        }
        let index = device.queue.submit([commands.finish()]);
        device.check().map(|()| index)
    }

    /// Applies `read` to the bytes that the shader has written in the last submission, which the device has finished.
    pub fn read(&self, read: impl FnOnce(&[u8])) -> Result<(), EngineError> {
        let Some(readback) = &self.readback else {
            return Ok(());
        };
        Device::read(readback, self.size, read)
    }

    /// Returns the run time of the last submission, which the device has finished, by the device's clock; 0 if it is not timed.
    pub fn run_time(&self, device: &Device) -> Result<Duration, EngineError> {
        let stamps = self.stamps.as_ref();
        stamps.map_or(Ok(Duration::ZERO), |stamps| stamps.read(device))
    }
}

/// Binds the first `size` bytes of a buffer.
fn binding(binding: usize, buffer: &wgpu::Buffer, size: u64) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry {
        binding: binding as u32,
        resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer,
            offset: 0,
            size: wgpu::BufferSize::new(size),
        }),
    }
}
