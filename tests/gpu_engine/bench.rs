//! A device for single entry points: numbers in, numbers out.

use bytemuck::Pod;
use wgpu::util::DeviceExt;
use whiskmap::integrate::gpu::Precision;

/// A device that runs the entry points of `shaders/probe.wgsl`.
pub struct Bench {
    device: wgpu::Device,
    queue: wgpu::Queue,
}

impl Bench {
    /// `None` (said aloud) where the engine is not to be had either.
    pub fn open(precision: Precision) -> Option<Self> {
        crate::compute::open(precision)?;
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options)).unwrap();
        let required_features = match precision {
            Precision::F32 => wgpu::Features::empty(),
            Precision::F64 => wgpu::Features::SHADER_F64,
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            required_features,
            ..Default::default()
        }))
        .unwrap();
        Some(Self { device, queue })
    }

    /// Runs `entry` once per case and returns `answers` numbers for each.
    pub fn run<T: Pod>(
        &self,
        text: &str,
        entry: &str,
        overrides: &[(&str, f64)],
        cases: &[Vec<T>],
        answers: usize,
    ) -> Vec<Vec<T>> {
        use wgpu::BufferUsages as Usage;
        let device = &self.device;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(text.into()),
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: None,
            module: &module,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: overrides,
                ..Default::default()
            },
            cache: None,
        });
        let input = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents: bytemuck::cast_slice(&cases.concat()),
            usage: Usage::STORAGE,
        });
        let size = (cases.len() * answers * size_of::<T>()) as u64;
        let buffer = |usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let output = buffer(Usage::STORAGE | Usage::COPY_SRC);
        let readback = buffer(Usage::MAP_READ | Usage::COPY_DST);
        let entries = [&input, &output].into_iter().enumerate();
        let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &Vec::from_iter(entries.map(|(i, buffer)| wgpu::BindGroupEntry {
                binding: i as u32,
                resource: buffer.as_entire_binding(),
            })),
        });
        let mut commands = device.create_command_encoder(&Default::default());
        {
            let mut pass = commands.begin_compute_pass(&Default::default());
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &bindings, &[]);
            pass.dispatch_workgroups(cases.len() as u32, 1, 1);
        }
        commands.copy_buffer_to_buffer(&output, 0, &readback, 0, size);
        self.queue.submit([commands.finish()]);
        readback.map_async(wgpu::MapMode::Read, .., |mapped| mapped.unwrap());
        device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        let bytes = readback.get_mapped_range(..).unwrap();
        let numbers = bytes.chunks_exact(size_of::<T>());
        let numbers: Vec<T> = numbers.map(bytemuck::pod_read_unaligned).collect();
        numbers.chunks(answers).map(<[T]>::to_vec).collect()
    }
}
