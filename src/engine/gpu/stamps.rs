//! Time of a submission by the device's clock.

use super::EngineError;
use super::device::{Device, copy_back};
use std::time::Duration;
use wgpu::BufferUsages as Usage;

/// Bytes of two time stamps.
const BYTES: u64 = 16;

/// Time stamps at the begin and the end of one submission's compute pass, by the device's clock.
#[derive(Debug)]
pub struct Stamps {
    set: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    readback: wgpu::Buffer,
}

impl Stamps {
    /// Creates time stamps; returns `None` if the device has no clock.
    pub fn new(device: &Device) -> Result<Option<Self>, EngineError> {
        let features = device.handle.features();
        if !features.contains(wgpu::Features::TIMESTAMP_QUERY) {
            return Ok(None);
        }
        let set = device.handle.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("stamps"),
            ty: wgpu::QueryType::Timestamp,
            count: 2,
        });
        let usage = Usage::QUERY_RESOLVE | Usage::COPY_SRC;
        Ok(Some(Self {
            set,
            resolved: device.buffer("stamps", BYTES, usage)?,
            readback: device.buffer("stamps", BYTES, Usage::MAP_READ | Usage::COPY_DST)?,
        }))
    }

    /// Returns the time stamps to write before and after the compute pass.
    pub fn writes(&self) -> wgpu::ComputePassTimestampWrites<'_> {
        wgpu::ComputePassTimestampWrites {
            query_set: &self.set,
            beginning_of_pass_write_index: Some(0),
            end_of_pass_write_index: Some(1),
        }
    }

    /// Copies the time stamps to a buffer for the CPU after the compute pass.
    pub fn resolve(&self, commands: &mut wgpu::CommandEncoder) {
        commands.resolve_query_set(&self.set, 0..2, &self.resolved, 0);
        copy_back(commands, &self.resolved, &self.readback, BYTES);
    }

    /// Returns the duration of the compute pass, which the device has finished.
    pub fn read(&self, device: &Device) -> Result<Duration, EngineError> {
        let [start, end]: [u64; 2] =
            Device::read(&self.readback, BYTES, bytemuck::pod_read_unaligned)?;
        let nanoseconds =
            end.saturating_sub(start) as f64 * f64::from(device.queue.get_timestamp_period());
        Ok(Duration::from_secs_f64(1e-9 * nanoseconds))
    }
}
