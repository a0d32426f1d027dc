//! Shaders, compiled.

use super::base_point::WORKGROUP;
use super::device::Device;
use super::layout::BufferLayout;
use super::pace::Pace;
use super::shaders::overrides;
use super::{EngineError, Precision};
use crate::rod::Effects;

/// The engine's shader for a set of effects, and what has been learnt about its speed.
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
        precision: Precision,
        effects: Effects,
    ) -> Result<Self, EngineError> {
        // The last group of each reference may have one cell, and each has a step at least.
        let groups = device.handle.limits().max_compute_workgroups_per_dimension;
        let groups = groups.saturating_sub(precision.most_steps() as u32).max(1);
        Ok(Self {
            handle: compile(device, "solve_cells", shader, &overrides(effects))?,
            pace: Pace::new(device.most_bytes(), layout.cell, groups, WORKGROUP),
        })
    }
}

/// The pipeline of the entry point `entry` of `shader`.
pub fn compile(
    device: &Device,
    entry: &str,
    shader: &str,
    constants: &[(&str, f64)],
) -> Result<wgpu::ComputePipeline, EngineError> {
    let module = device
        .handle
        .create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(entry),
            source: wgpu::ShaderSource::Wgsl(shader.into()),
        });
    device.check()?;
    let pipeline = device
        .handle
        .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(entry),
            layout: None,
            module: &module,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants,
                ..Default::default()
            },
            cache: None,
        });
    device.check().map(|()| pipeline)
}
