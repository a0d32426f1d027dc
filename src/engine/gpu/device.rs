//! A device whose errors are values.

use super::adapters::{AdapterReport, enumerate, preferred};
use super::guard::guarded;
use super::{EngineError, Precision};
use std::sync::{Arc, mpsc};
use std::time::Duration;
use wgpu::BufferUsages as Usage;

/// How long a device may take for a submission: hundreds of times what the pace aims at.
const PATIENCE: Duration = Duration::from_secs(60);

/// A device, its queue, and the errors that nobody has seen yet.
///
/// wgpu reports errors when it likes; they wait until [`Device::check`] hands the first one out.
#[derive(Debug)]
pub struct Device {
    pub info: wgpu::AdapterInfo,
    pub queue: wgpu::Queue,
    pub handle: wgpu::Device,
    errors: mpsc::Receiver<String>,
}

impl Device {
    /// Opens the preferred adapter for shaders of this precision.
    pub fn open(precision: Precision) -> Result<Self, EngineError> {
        let found = enumerate();
        let reports: Vec<_> = found.iter().map(AdapterReport::new).collect();
        let chosen = preferred(&reports, precision);
        let Some(chosen) = chosen.or_else(|| preferred(&reports, Precision::F32)) else {
            let tried = "no driver of Vulkan, Metal or DirectX 12 answered".to_owned();
            return Err(EngineError::NoAdapter(tried));
        };
        Self::on(&found[chosen], precision)
    }

    /// Opens the adapter that is at `index` of [`adapters`](super::adapters).
    pub fn at(index: usize, precision: Precision) -> Result<Self, EngineError> {
        let found = enumerate();
        let adapter = found.get(index).ok_or_else(|| {
            EngineError::NoAdapter(format!("there are {}, not one at {index}", found.len()))
        })?;
        Self::on(adapter, precision)
    }

    fn on(adapter: &wgpu::Adapter, precision: Precision) -> Result<Self, EngineError> {
        let features = adapter.features();
        if precision == Precision::F64 && !features.contains(wgpu::Features::SHADER_F64) {
            return Err(EngineError::Unsupported {
                adapter: adapter.get_info().name,
                what: "compute in f64 (no SHADER_F64)".to_owned(),
            });
        }
        let clock = features & wgpu::Features::TIMESTAMP_QUERY;
        let required_features = match precision {
            Precision::F32 => clock,
            Precision::F64 => clock | wgpu::Features::SHADER_F64,
        };
        let wanted = wgpu::DeviceDescriptor {
            required_features,
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let (handle, queue) = guarded(|| pollster::block_on(adapter.request_device(&wanted)))
            .map_err(EngineError::Device)?
            .map_err(|error| EngineError::Device(error.to_string()))?;
        let (sender, errors) = mpsc::channel();
        let note = move |what: String| {
            // In one line, whatever the device says; without a receiver there is nobody to tell.
            let line = what.split_whitespace().collect::<Vec<_>>().join(" ");
            let _ = sender.send(line);
        };
        let noted = note.clone();
        handle.on_uncaptured_error(Arc::new(move |error: wgpu::Error| noted(error.to_string())));
        handle.set_device_lost_callback(move |reason, message| {
            note(format!("device lost ({reason:?}) {message}"));
        });
        Ok(Self {
            info: adapter.get_info(),
            queue,
            handle,
            errors,
        })
    }

    /// The first error that has come in since the last call, if any.
    pub fn check(&self) -> Result<(), EngineError> {
        let mut unseen = self.errors.try_iter();
        let first = unseen.next();
        unseen.for_each(drop);
        first.map_or(Ok(()), |what| Err(EngineError::Device(what)))
    }

    /// Waits until everything up to `submission` is done.
    pub fn wait(&self, submission: wgpu::SubmissionIndex) -> Result<(), EngineError> {
        let waiting = wgpu::PollType::Wait {
            submission_index: Some(submission),
            timeout: Some(PATIENCE),
        };
        let handle = &self.handle;
        let waited = guarded(|| handle.poll(waiting).map_err(|error| error.to_string()));
        self.check()?;
        waited.flatten().map(drop).map_err(EngineError::Device)
    }

    /// Largest storage buffer of this device, in bytes.
    pub fn most_bytes(&self) -> u64 {
        self.handle.limits().max_storage_buffer_binding_size
    }

    /// A new buffer.
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

    /// What `read` makes of the first `size` bytes of `buffer`, which were asked for before the device was waited for.
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

    /// Uploads `bytes`, `what` they are, to `kept`, a buffer that grows when it must.
    pub fn upload<'a>(
        &self,
        what: &'static str,
        kept: &'a mut Option<wgpu::Buffer>,
        bytes: &[u8],
    ) -> Result<&'a wgpu::Buffer, EngineError> {
        let size = bytes.len() as u64;
        let most = self.most_bytes();
        if size > most {
            return Err(EngineError::Unsupported {
                adapter: self.info.name.clone(),
                what: format!("hold {size} bytes of {what}, at most {most}"),
            });
        }
        let buffer = match kept.take() {
            Some(buffer) if buffer.size() >= size => buffer,
            _ => {
                let usage = Usage::STORAGE | Usage::UNIFORM | Usage::COPY_DST;
                self.buffer(what, size, usage)?
            }
        };
        self.queue.write_buffer(&buffer, 0, bytes);
        Ok(kept.insert(buffer))
    }
}

/// Has the first `size` bytes of `from` copied to `readback`, for [`Device::read`].
pub fn answer(
    commands: &mut wgpu::CommandEncoder,
    from: &wgpu::Buffer,
    readback: &wgpu::Buffer,
    size: u64,
) {
    commands.copy_buffer_to_buffer(from, 0, readback, 0, size);
    // Whether it worked is told by `get_mapped_range`.
    commands.map_buffer_on_submit(readback, wgpu::MapMode::Read, ..size, |_| ());
}
