//! The GPU engine: WGSL compute shaders through wgpu, one cell per invocation.
//!
//! The shaders are joined from whole pieces ([`shaders`]), in `f32` or `f64` by a type alias; each set of
//! effects has a pipeline of its own, made from `override` constants. Work goes out in dispatches short
//! enough for any watchdog, at most two in flight; a device that fails is an error.
//!
//! Absent on purpose: a second try on a lost device. [`Fallback`](super::Fallback) does without it.

mod adapters;
mod bytes;
mod device;
mod flight;
mod guard;
mod layout;
mod pace;
mod peak;
mod pipeline;
mod precision;
mod reference;
pub mod shaders;
mod stamps;

pub use adapters::{AdapterReport, adapters, named, preferred};
pub use flight::Times;
pub use guard::is_guarded;
pub use precision::Precision;

use super::{CellDifference, Description, Engine, EngineError, Reference};
use crate::rod::{Effects, Rod};
use crate::shooting::batch::Method;
use device::Device;
use flight::{Buffers, Call, Flight};
use layout::BufferLayout;
use pipeline::Pipeline;
use std::collections::hash_map::Entry;
use std::collections::{HashMap, VecDeque};
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
    /// Those of no flight.
    buffers: Vec<Buffers>,
    pipelines: HashMap<Effects, Pipeline>,
    /// The stages of the last call, for those who ask.
    times: Option<Times>,
}

/// Dispatches in flight: one runs while the answers of the other are read.
const IN_FLIGHT: usize = 2;

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

    /// The same, to have it timed stage by stage.
    ///
    /// # Errors
    /// Those of [`Gpu::new`].
    pub fn timed(index: usize, precision: Precision) -> Result<Self, EngineError> {
        Ok(Self {
            times: Some(Times::default()),
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
            times: None,
        }
    }

    /// What the stages of the last call took, of an engine that is timed.
    #[must_use]
    pub const fn times(&self) -> Option<Times> {
        self.times
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

    /// The device: a seam for tests, which destroy it.
    #[must_use]
    pub const fn device(&self) -> &wgpu::Device {
        &self.device.handle
    }
}

impl Engine for Gpu {
    fn describe(&self) -> Description {
        let info = &self.device.info;
        Description {
            engine: format!("gpu {}", self.precision),
            adapter: format!(
                "{}, {}, {} {}",
                info.name, info.backend, info.driver, info.driver_info
            ),
        }
    }

    fn goal(&self) -> f64 {
        self.precision.goal()
    }

    fn solve(
        &mut self,
        method: Method,
        rods: &[Rod],
        pushes: &[f64],
        references: &[Reference],
    ) -> Result<Vec<CellDifference>, EngineError> {
        let effects = method.effects;
        let (device, layout, precision) = (&self.device, &self.layout, self.precision);
        let resolution = precision.resolution(method.resolution);
        let uploaded = device.upload("push angles", &mut self.pushes, &(layout.pushes)(pushes))?;
        let Pipeline { handle, pace } = match self.pipelines.entry(effects) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(new) => {
                let text = self.shader.clone();
                let text = text.unwrap_or_else(|| shaders::cells(precision));
                new.insert(Pipeline::new(device, &text, layout, precision, effects)?)
            }
        };
        let call = Call {
            device,
            layout,
            pipeline: handle,
            pushes: (uploaded, pushes.len()),
            timed: self.times.is_some(),
        };
        let mut times = Times::default();
        let all = references.iter().map(|reference| reference.cells.len());
        let mut cells = Vec::with_capacity(all.sum());
        let most_steps = precision.most_steps();
        let steps = references.iter().map(|reference| {
            let Reference { tau, load, .. } = *reference;
            let steps = resolution.steps(&rods[reference.rod as usize], tau, load);
            // Exact states take dozens; only numbers that are none ask for thousands.
            steps.min(most_steps as u32)
        });
        let steps: Vec<u32> = steps.collect();
        let mut waiting = (references, &steps[..]);
        let mut flights: VecDeque<(Flight, bool)> = VecDeque::new();
        let mut idle_since = Instant::now();
        loop {
            if flights.len() < IN_FLIGHT && !waiting.0.is_empty() {
                let begun = Instant::now();
                let count = together(waiting.0, pace.cells, waiting.1, most_steps);
                let (now, later) = waiting.0.split_at(count);
                let (now_steps, later_steps) = waiting.1.split_at(count);
                waiting = (later, later_steps);
                let packed = (layout.references)(rods, now, now_steps, most_steps);
                let flight = Flight::dispatch(&call, self.buffers.pop(), &packed)?;
                flights.push_back((flight, waiting.0.is_empty()));
                times.upload += begun.elapsed();
            } else if let Some((flight, is_last)) = flights.pop_front() {
                let (count, started) = (flight.cells, flight.submitted.max(idle_since));
                self.buffers
                    .push(flight.finish(&call, &mut cells, &mut times)?);
                idle_since = Instant::now();
                pace.learn(count, is_last, idle_since - started);
            } else {
                self.times = self.times.map(|_| times);
                return Ok(cells);
            }
        }
    }
}

/// How many of the first of the `references`, at least one, have together at most so many `cells`, and at most `most` of the `steps`.
fn together(references: &[Reference], cells: usize, steps: &[u32], most: usize) -> usize {
    let mut sums = (0, 0);
    let fits = references
        .iter()
        .zip(steps)
        .take_while(|(reference, steps)| {
            sums = (sums.0 + reference.cells.len(), sums.1 + **steps as usize);
            sums.0 <= cells && sums.1 <= most
        });
    fits.count().max(1)
}
