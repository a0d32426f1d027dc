//! The GPU engine: WGSL compute shaders through wgpu. One solves cells from the expansions of rows, one per invocation; another integrates
//! trajectories ([`Gpu::shoot`]).
//!
//! The shaders are in `f32` or `f64` by a type alias ([`shaders`]). Each selection of channels has a pipeline, made from `override`
//! constants. Work is sent in submissions short enough for driver watchdogs, at most two in flight. A device that
//! fails is an error.
//!
//! Deliberately absent: a second attempt on a lost device. [`Worker`](super::Worker) continues without it.

mod adapters;
mod cells;
mod device;
mod flight;
mod guard;
mod missing;
mod pace;
mod packing;
mod pending;
mod precision;
pub mod shaders;
mod shoot;
mod stamps;
mod submission;

pub use super::Precision;
pub use adapters::{AdapterReport, adapters, named, preferred};
pub use flight::Times;
pub use guard::DRIVER_CALL;
pub use missing::missing;
pub use shoot::shoots;

use super::{Cells, Engine, EngineDescription, EngineError, Nodes, RowBatch};
use crate::plan::Channels;
use cells::cell_bytes;
use device::Device;
use flight::Flight;
use pace::Pace;
use packing::{Packed, WORKGROUP};
use pending::PendingBatch;
use std::collections::hash_map::Entry;
use std::collections::{HashMap, VecDeque};
use std::sync::Arc;
use std::time::Instant;
use submission::Buffers;
use whiskmap_mechanics::rod::Effects;
use whiskmap_mechanics::shooting::PlainState;

/// GPU engine on one adapter.
#[derive(Debug)]
pub struct Gpu {
    precision: Precision,
    /// Text of the engine's shader, by default [`shaders::cells`]: tests replace it before the first batch.
    pub shader: String,
    /// True if the device's clock times submissions.
    pub is_timed: bool,
    /// Wall times of the stages of all submissions of the engine.
    pub times: Times,
    device: Device,
    /// Buffers that no flight uses.
    buffers: Vec<Buffers>,
    /// For each selection of channels, the compiled shader of cells and its pace.
    pipelines: HashMap<Channels, (wgpu::ComputePipeline, Pace)>,
    /// For each precision and set of effects, the compiled shader of trajectories and its pace.
    shooters: HashMap<(Precision, Effects), (wgpu::ComputePipeline, Pace)>,
    /// Buffers of trajectories that no submission uses.
    shoot_buffers: Vec<Buffers>,
    /// The batches submitted and not collected.
    pending: VecDeque<PendingBatch>,
    /// The flights, in order.
    flights: VecDeque<Flight>,
    /// Earliest time at which the device may have become idle.
    idle_since: Instant,
    /// The first failure, which all later calls return.
    failure: Option<EngineError>,
}

/// Submissions in flight: one runs while the cells of the other are read.
const IN_FLIGHT: usize = 2;

impl Gpu {
    /// Opens the GPU engine on the adapter at `index` of [`adapters`], or on the [`preferred`] one.
    ///
    /// # Errors
    /// [`EngineError::NoAdapter`] without such an adapter, [`EngineError::Unsupported`] if the adapter has no `f64`,
    /// [`EngineError::Device`] if the driver refuses a device.
    pub fn open(index: Option<usize>, precision: Precision) -> Result<Self, EngineError> {
        Ok(Self {
            precision,
            shader: shaders::cells(precision),
            is_timed: false,
            times: Times::default(),
            device: Device::open(index, precision)?,
            buffers: Vec::new(),
            pipelines: HashMap::new(),
            shooters: HashMap::new(),
            shoot_buffers: Vec::new(),
            pending: VecDeque::new(),
            flights: VecDeque::new(),
            idle_since: Instant::now(),
            failure: None,
        })
    }

    /// Calls `work`; after a failure, returns the failure instead.
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

    /// Sends submissions until enough are in flight or nothing is left to send.
    fn send(&mut self) -> Result<(), EngineError> {
        let (device, precision) = (&self.device, self.precision);
        while self.flights.len() < IN_FLIGHT
            && let Some(pending) = self.pending.iter_mut().find(|batch| batch.is_waiting())
        {
            let begun = Instant::now();
            let batch = Arc::clone(&pending.batch);
            let channels = batch.channels;
            let (pipeline, pace) = match self.pipelines.entry(channels) {
                Entry::Occupied(known) => known.into_mut(),
                Entry::Vacant(new) => {
                    let constants = shaders::overrides(channels);
                    let pipeline = device.pipeline("solve_cells", &self.shader, &constants)?;
                    let groups = device.handle.limits().max_compute_workgroups_per_dimension;
                    let bytes = cell_bytes(channels);
                    let pace = Pace::new(device.most_bytes(), bytes, groups, WORKGROUP);
                    new.insert((pipeline, pace))
                }
            };
            let packed = Packed::new(precision, &batch, pending.next(pace.cells));
            if packed.cells == 0 {
                continue;
            }
            let mut buffers = self.buffers.pop().unwrap_or_default();
            if self.is_timed {
                buffers = buffers.timed(device)?;
            }
            let is_last = !pending.is_waiting();
            let flight = Flight::submit(device, pipeline, packed, channels, buffers, is_last)?;
            pending.in_flight += 1;
            self.flights.push_back(flight);
            self.times.upload += begun.elapsed();
        }
        Ok(())
    }

    /// Waits for the oldest submission.
    fn receive(&mut self) -> Result<(), EngineError> {
        let pending = self.pending.iter_mut().find(|batch| batch.in_flight > 0);
        let (Some(pending), Some(flight)) = (pending, self.flights.pop_front()) else {
            let lost = "a batch has no submission in flight";
            return Err(EngineError::Device(lost.to_owned()));
        };
        let (count, is_last) = (flight.cells, flight.is_last);
        let started = flight.submitted.max(self.idle_since);
        let buffers = flight.finish(&self.device, pending, &mut self.times)?;
        self.buffers.push(buffers);
        self.idle_since = Instant::now();
        if let Some((_, pace)) = self.pipelines.get_mut(&pending.batch.channels) {
            pace.learn(count, is_last, self.idle_since - started);
        }
        Ok(())
    }

    /// Returns the GPU device, which tests destroy.
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

    fn row_residual(&self) -> f64 {
        self.precision.row_residual()
    }

    fn has_device(&self) -> bool {
        true
    }

    fn integrates_nodes(&self, effects: Effects) -> bool {
        self.device.has_f64() && shoots(effects).is_ok()
    }

    fn shoot_nodes(&mut self, nodes: &Nodes) -> Result<Vec<PlainState>, EngineError> {
        // The nets of both precisions need trajectories in `f64`.
        self.shoot_with(Precision::F64, nodes.method, &nodes.conditions())
    }

    fn submit(&mut self, batch: Arc<RowBatch>) -> Result<(), EngineError> {
        self.working(|gpu| {
            gpu.pending.push_back(PendingBatch::new(batch, gpu.precision));
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
