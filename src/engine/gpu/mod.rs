//! The GPU engine: WGSL compute shaders through wgpu, one cell per invocation.
//!
//! The shaders are joined from whole pieces ([`shaders`]), in `f32` or `f64` by a type alias; each set of
//! effects has a pipeline of its own, made from `override` constants. Work goes out in submissions short
//! enough for any watchdog, at most two in flight; a device that fails is an error.
//!
//! Absent on purpose: a second try on a lost device. A [`Worker`](super::Worker) does without it.

mod adapters;
mod base_point;
mod bytes;
mod device;
mod flight;
mod guard;
mod layout;
mod pace;
mod peak;
mod pending;
mod pipeline;
mod precision;
pub mod shaders;
mod stamps;

pub use super::Precision;
pub use adapters::{AdapterReport, adapters, named, preferred};
pub use flight::Times;
pub use guard::DRIVER_CALL;

use super::{Cells, Engine, EngineDescription, EngineError, RowBatch};
use crate::rod::Effects;
use crate::shooting::Resolution;
use device::Device;
use flight::{Buffers, Call, Flight};
use layout::BufferLayout;
use pending::PendingBatch;
use pipeline::Pipeline;
use std::collections::hash_map::Entry;
use std::collections::{HashMap, VecDeque};
use std::sync::Arc;
use std::time::Instant;

/// The GPU engine on one adapter.
#[derive(Debug)]
pub struct Gpu {
    precision: Precision,
    /// In place of [`shaders::cells`].
    shader: Option<String>,
    layout: BufferLayout,
    device: Device,
    pushes: Option<wgpu::Buffer>,
    /// Buffers that no flight uses.
    buffers: Vec<Buffers>,
    pipelines: HashMap<Effects, Pipeline>,
    /// The batches submitted and not collected.
    pending: VecDeque<PendingBatch>,
    /// The submissions under way, in order, each with whether it has the last cells of its batch.
    flights: VecDeque<(Flight, bool)>,
    /// Since when the device has had nothing else to do, as far as is known.
    idle_since: Instant,
    /// Whether the device times its work.
    timed: bool,
    times: Times,
    /// What it has failed of.
    failure: Option<EngineError>,
}

/// Submissions in flight: one runs while the answers of the other are read.
const IN_FLIGHT: usize = 2;

/// About the most dispatches of a submission: 4 MiB for where their steps start.
const MOST_DISPATCHES: usize = 64;

impl Gpu {
    /// Opens the [`preferred`] adapter.
    ///
    /// # Errors
    /// [`EngineError::NoAdapter`] without a driver, [`EngineError::Unsupported`] where the adapter has no
    /// `f64`, [`EngineError::Device`] when the driver refuses a device.
    pub fn new(precision: Precision) -> Result<Self, EngineError> {
        Device::open(precision).map(|device| Self::with_device(precision, device))
    }

    /// Opens the adapter that is at `index` of [`adapters`].
    ///
    /// # Errors
    /// Those of [`Gpu::new`].
    pub fn at(index: usize, precision: Precision) -> Result<Self, EngineError> {
        Device::at(index, precision).map(|device| Self::with_device(precision, device))
    }

    /// Opens the adapter at `index`, and lets the device time its work.
    ///
    /// # Errors
    /// Those of [`Gpu::new`].
    pub fn timed(index: usize, precision: Precision) -> Result<Self, EngineError> {
        Ok(Self {
            timed: true,
            ..Self::at(index, precision)?
        })
    }

    fn with_device(precision: Precision, device: Device) -> Self {
        Self {
            precision,
            shader: None,
            layout: BufferLayout::of(precision),
            device,
            pushes: None,
            buffers: Vec::new(),
            pipelines: HashMap::new(),
            pending: VecDeque::new(),
            flights: VecDeque::new(),
            idle_since: Instant::now(),
            timed: false,
            times: Times::default(),
            failure: None,
        }
    }

    /// What its stages have taken since this was asked last.
    pub fn take_times(&mut self) -> Times {
        std::mem::take(&mut self.times)
    }

    /// Opens the [`preferred`] adapter for a shader other than [`shaders::cells`]: a seam for tests, which spoil it.
    ///
    /// # Errors
    /// Those of [`Gpu::new`].
    pub fn with_shader(precision: Precision, shader: String) -> Result<Self, EngineError> {
        Ok(Self {
            shader: Some(shader),
            ..Self::new(precision)?
        })
    }

    /// Does `work`, unless it has failed before: then it fails again.
    fn working<R>(
        &mut self,
        work: impl FnOnce(&mut Self) -> Result<R, EngineError>,
    ) -> Result<R, EngineError> {
        if let Some(failure) = &self.failure {
            return Err(failure.clone());
        }
        let worked = work(self);
        if let Err(failure) = &worked {
            self.failure = Some(failure.clone());
            self.pending.clear();
            self.flights.clear();
        }
        worked
    }

    /// Sends submissions as long as there is something to send, and not enough of them are in flight.
    fn send(&mut self) -> Result<(), EngineError> {
        let Self {
            precision,
            layout,
            device,
            ..
        } = self;
        while self.flights.len() < IN_FLIGHT
            && let Some(pending) = self.pending.iter_mut().find(|own| own.is_waiting())
        {
            let begun = Instant::now();
            let batch = Arc::clone(&pending.batch);
            let pushes = (layout.pushes)(&batch.pushes);
            let pushes = device.upload("push angles", &mut self.pushes, &pushes)?;
            let pipeline = match self.pipelines.entry(batch.method.effects) {
                Entry::Occupied(known) => known.into_mut(),
                Entry::Vacant(new) => {
                    let text = self.shader.clone();
                    let text = text.unwrap_or_else(|| shaders::cells(*precision));
                    let effects = batch.method.effects;
                    new.insert(Pipeline::new(device, &text, layout, *precision, effects)?)
                }
            };
            let call = Call {
                device,
                layout,
                pipeline: &pipeline.handle,
                pushes: (pushes, batch.pushes.len()),
                timed: self.timed,
            };
            let steps = MOST_DISPATCHES * precision.most_steps();
            let part = pending.next(pipeline.pace.cells, steps);
            let packed = (layout.packed)(&batch, part, precision.most_steps());
            let flight = Flight::submit(&call, self.buffers.pop(), &packed)?;
            self.flights.push_back((flight, !pending.is_waiting()));
            self.times.upload += begun.elapsed();
        }
        Ok(())
    }

    /// Waits for the oldest submission.
    fn receive(&mut self) -> Result<(), EngineError> {
        let pending = self.pending.iter_mut().find(|own| !own.is_done());
        let (Some(pending), Some((flight, is_last))) = (pending, self.flights.pop_front()) else {
            let lost = "a batch has no submission under way";
            return Err(EngineError::Device(lost.to_owned()));
        };
        let (count, started) = (flight.cells, flight.submitted.max(self.idle_since));
        let buffers = flight.finish(&self.device, &self.layout, pending, &mut self.times)?;
        self.buffers.push(buffers);
        self.idle_since = Instant::now();
        if let Some(Pipeline { pace, .. }) = self.pipelines.get_mut(&pending.batch.method.effects) {
            pace.learn(count, is_last, self.idle_since - started);
        }
        Ok(())
    }

    /// The device: a seam for tests, which destroy it.
    #[must_use]
    pub const fn device(&self) -> &wgpu::Device {
        &self.device.handle
    }
}

impl Engine for Gpu {
    fn describe(&self) -> EngineDescription {
        let info = &self.device.info;
        EngineDescription {
            engine: format!("gpu {}", self.precision),
            adapter: format!(
                "{}, {}, {} {}",
                info.name, info.backend, info.driver, info.driver_info
            ),
        }
    }

    fn residual_bound(&self) -> f64 {
        self.precision.goal()
    }

    fn resolution(&self, resolution: Resolution) -> Resolution {
        self.precision.resolution(resolution)
    }

    fn submit(&mut self, batch: Arc<RowBatch>) -> Result<(), EngineError> {
        self.working(|gpu| {
            gpu.pending.push_back(PendingBatch::new(batch));
            gpu.send()
        })
    }

    fn collect(&mut self) -> Result<Cells, EngineError> {
        self.working(|gpu| {
            loop {
                gpu.send()?;
                if gpu.pending.front().is_none_or(PendingBatch::is_done) {
                    let first = gpu.pending.pop_front();
                    return Ok(first.map_or_else(Cells::default, |first| first.cells));
                }
                gpu.receive()?;
            }
        })
    }
}
