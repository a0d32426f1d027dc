//! Dispatch of a pipeline: one submission, from its bindings to the copy of its results for the CPU.

use super::EngineError;
use super::device::{Device, copy_back};
use super::packing::WORKGROUP;
use super::stamps::Stamps;

/// Work of one submission.
pub struct Dispatch<'a> {
    /// Name of the work in messages of the driver.
    pub label: &'static str,
    /// Shader of the work.
    pub pipeline: &'a wgpu::ComputePipeline,
    /// Buffers of the shader.
    pub entries: &'a [wgpu::BindGroupEntry<'a>],
    /// Number of invocations: fewer groups than `u32` can count.
    pub invocations: usize,
    /// Buffer that the shader writes, and the buffer in which the CPU reads it.
    pub results: [&'a wgpu::Buffer; 2],
    /// Number of bytes that the shader writes.
    pub size: u64,
    /// Time stamps around the work; `None` if it is not timed.
    pub stamps: Option<&'a Stamps>,
}

impl Dispatch<'_> {
    /// Submits the work to `device`. Its results are mapped after it, for [`Device::read`].
    pub fn submit(&self, device: &Device) -> Result<wgpu::SubmissionIndex, EngineError> {
        let label = Some(self.label);
        let bindings = device.handle.create_bind_group(&wgpu::BindGroupDescriptor {
            label,
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: self.entries,
        });
        let mut commands = device.handle.create_command_encoder(&Default::default());
        let [written, readback] = self.results;
        // An invocation that does not write must not keep the results of another submission.
        commands.clear_buffer(written, 0, Some(self.size));
        {
            let mut pass = commands.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label,
                timestamp_writes: self.stamps.map(Stamps::writes),
            });
            pass.set_pipeline(self.pipeline);
            pass.set_bind_group(0, &bindings, &[]);
            let groups = self.invocations.div_ceil(WORKGROUP as usize) as u32;
            pass.dispatch_workgroups(groups, 1, 1);
        }
        copy_back(&mut commands, written, readback, self.size);
        if let Some(stamps) = self.stamps {
            stamps.resolve(&mut commands);
        }
        let index = device.queue.submit([commands.finish()]);
        device.check().map(|()| index)
    }
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
