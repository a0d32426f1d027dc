//! The compiled shader of one set of effects.

use super::EngineError;
use super::device::Device;
use super::layout::BufferLayout;
use super::pace::Pace;
use super::shaders::{WORKGROUP, overrides};
use crate::rod::Effects;

/// A pipeline, and what has been learnt about its speed.
#[derive(Debug)]
pub struct Pipeline {
    pub handle: wgpu::ComputePipeline,
    pub pace: Pace,
}

impl Pipeline {
    pub fn new(
        device: &Device,
        shader: &str,
        layout: &BufferLayout,
        effects: Effects,
    ) -> Result<Self, EngineError> {
        let module = device
            .handle
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("shoot"),
                source: wgpu::ShaderSource::Wgsl(shader.into()),
            });
        device.check()?;
        let handle = device
            .handle
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some("shoot"),
                layout: None,
                module: &module,
                entry_point: Some("shoot"),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &overrides(effects),
                    ..Default::default()
                },
                cache: None,
            });
        device.check()?;
        let largest = layout.shot.max(layout.hit);
        let groups = device.handle.limits().max_compute_workgroups_per_dimension;
        Ok(Self {
            handle,
            pace: Pace::new(device.most_bytes(), largest, groups, WORKGROUP),
        })
    }
}
