//! GPU device whose errors are returned as values.

use super::adapters::{AdapterReport, enumerate, preferred};
use super::guard::guarded;
use super::missing::missing;
use super::{EngineError, Precision};
use std::sync::{Arc, mpsc};
use std::time::Duration;
use wgpu::BufferUsages as Usage;

/// Maximum time of a submission: hundreds of times the goal of the pace.
const PATIENCE: Duration = Duration::from_secs(60);

/// GPU device, its queue, and the errors that have not been returned yet.
///
/// wgpu reports errors at any time; they are kept until [`Device::check`] returns the first one.
#[derive(Debug)]
pub struct Device {
    pub info: wgpu::AdapterInfo,
    pub queue: wgpu::Queue,
    pub handle: wgpu::Device,
    errors: mpsc::Receiver<String>,
}

impl Device {
    /// Opens the GPU adapter at `index` of [`adapters`](super::adapters), or the [`preferred`] one.
    pub fn open(index: Option<usize>, precision: Precision) -> Result<Self, EngineError> {
        let found = enumerate();
        let reports: Vec<_> = found.iter().map(AdapterReport::new).collect();
        let preferred = |precision| preferred(&reports, precision);
        let index = index.or_else(|| preferred(precision)).or_else(|| preferred(Precision::F32));
        let adapter = index.and_then(|index| found.get(index)).ok_or_else(|| {
            EngineError::NoAdapter(match index {
                Some(index) => format!("there are {}, not one at {index}", found.len()),
                None => missing(),
            })
        })?;
        let features = adapter.features();
        if precision == Precision::F64 && !features.contains(wgpu::Features::SHADER_F64) {
            return Err(EngineError::Unsupported {
                adapter: adapter.get_info().name,
                what: "compute in f64 (no SHADER_F64)".to_owned(),
            });
        }
        let useful = wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::SHADER_F64;
        let wanted = wgpu::DeviceDescriptor {
            required_features: features & useful,
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let (handle, queue) = guarded(|| pollster::block_on(adapter.request_device(&wanted)))
            .map_err(EngineError::Device)?
            .map_err(|error| EngineError::Device(error.to_string()))?;
        let (sender, errors) = mpsc::channel();
        let note = move |what: String| {
            // In one line, whatever the device reports. The receiver lives as long as the device.
            let line = what.split_whitespace().collect::<Vec<_>>().join(" ");
            let _ = sender.send(line);
        };
        let noted = note.clone();
        handle.on_uncaptured_error(Arc::new(move |error: wgpu::Error| noted(error.to_string())));
        handle.set_device_lost_callback(move |reason, message| {
            note(format!("device lost ({reason:?}) {message}"));
        });
        Ok(Self { info: adapter.get_info(), queue, handle, errors })
    }

    /// Returns the first error of the device since the last call, if any.
    pub fn check(&self) -> Result<(), EngineError> {
        let mut unseen = self.errors.try_iter();
        let first = unseen.next();
        unseen.for_each(drop);
        first.map_or(Ok(()), |what| Err(EngineError::Device(what)))
    }

    /// Waits until the device has finished all submissions up to `submission`.
    pub fn wait(&self, submission: wgpu::SubmissionIndex) -> Result<(), EngineError> {
        let waiting =
            wgpu::PollType::Wait { submission_index: Some(submission), timeout: Some(PATIENCE) };
        let handle = &self.handle;
        let waited = guarded(|| handle.poll(waiting).map_err(|error| error.to_string()));
        self.check()?;
        waited.flatten().map(drop).map_err(EngineError::Device)
    }

    /// Returns true if shaders of this device may compute in `f64`.
    pub fn has_f64(&self) -> bool {
        let features = self.handle.features();
        features.contains(wgpu::Features::SHADER_F64)
    }

    /// Returns the size in bytes of the largest storage buffer of this device.
    pub fn most_bytes(&self) -> u64 {
        self.handle.limits().max_storage_buffer_binding_size
    }

    /// Creates a buffer on the device.
    pub fn buffer(
        &self,
        label: &str,
        size: u64,
        usage: Usage,
    ) -> Result<wgpu::Buffer, EngineError> {
        let buffer = self.handle.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size,
            usage,
            mapped_at_creation: false,
        });
        self.check().map(|()| buffer)
    }

    /// Applies `read` to the first `size` bytes of `buffer`, which [`copy_back`] has mapped.
    pub fn read<R>(
        buffer: &wgpu::Buffer,
        size: u64,
        read: impl FnOnce(&[u8]) -> R,
    ) -> Result<R, EngineError> {
        let bytes = buffer
            .get_mapped_range(..size)
            .map_err(|error| EngineError::Device(error.to_string()))?;
        let result = read(&bytes);
        drop(bytes);
        buffer.unmap();
        Ok(result)
    }

    /// Returns `kept`, or a new buffer in its place if it has less than `size` bytes of `what`.
    pub fn grown<'a>(
        &self,
        what: &'static str,
        kept: &'a mut Option<wgpu::Buffer>,
        size: u64,
        usage: Usage,
    ) -> Result<&'a wgpu::Buffer, EngineError> {
        let most = self.most_bytes();
        if size > most {
            return Err(EngineError::Unsupported {
                adapter: self.info.name.clone(),
                what: format!("hold {size} bytes of {what}, at most {most}"),
            });
        }
        let buffer = match kept.take() {
            Some(buffer) if buffer.size() >= size => buffer,
            _ => self.buffer(what, size, usage)?,
        };
        Ok(kept.insert(buffer))
    }

    /// Compiles the entry point `entry` of `shader` with the values of its `constants`.
    pub fn pipeline(
        &self,
        entry: &str,
        shader: &str,
        constants: &[(&str, f64)],
    ) -> Result<wgpu::ComputePipeline, EngineError> {
        let module = wgpu::ShaderModuleDescriptor {
            label: Some(entry),
            source: wgpu::ShaderSource::Wgsl(shader.into()),
        };
        let module = self.handle.create_shader_module(module);
        self.check()?;
        let pipeline = wgpu::ComputePipelineDescriptor {
            label: Some(entry),
            layout: None,
            module: &module,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants,
                ..Default::default()
            },
            cache: None,
        };
        let pipeline = self.handle.create_compute_pipeline(&pipeline);
        self.check().map(|()| pipeline)
    }
}

/// Copies the first `size` bytes of `from` to `readback` and maps them, for [`Device::read`].
pub fn copy_back(
    commands: &mut wgpu::CommandEncoder,
    from: &wgpu::Buffer,
    readback: &wgpu::Buffer,
    size: u64,
) {
    commands.copy_buffer_to_buffer(from, 0, readback, 0, size);
    // `get_mapped_range` returns the error, if any.
    commands.map_buffer_on_submit(readback, wgpu::MapMode::Read, ..size, |_| ());
}
