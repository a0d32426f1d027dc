//! The GPU engine: WGSL compute shaders through wgpu, one Newton iteration per invocation.
//!
//! The shaders are joined from whole pieces ([`shaders`]), in `f32` or `f64` by a type alias; each set of
//! effects has a pipeline of its own, made from `override` constants. Work goes out in dispatches short
//! enough for any watchdog, at most two in flight; a device that fails is an error.
//!
//! Absent on purpose: a second try on a lost device. [`Fallback`](super::Fallback) does without it.

mod adapters;
mod device;
mod flight;
mod guard;
mod layout;
mod pace;
mod peak;
mod pipeline;
mod precision;
pub mod shaders;
mod stamps;

pub use adapters::{AdapterReport, adapters, named, preferred};
pub use flight::Times;
pub use guard::is_guarded;
pub use precision::Precision;

use super::{Description, Engine, EngineError, Hit, Outcome, Shot};
use crate::rod::{Effects, Rod, arclength};
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
    /// In place of [`shaders::shoot`].
    shader: Option<String>,
    layout: BufferLayout,
    device: Device,
    rods: Option<wgpu::Buffer>,
    pieces: Option<wgpu::Buffer>,
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
            rods: None,
            pieces: None,
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

    /// Opens the [`preferred`] adapter for a shader other than [`shaders::shoot`]: a seam for tests, which spoil it.
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

    fn run(
        &mut self,
        effects: Effects,
        rods: &[Rod],
        shots: &[Shot],
    ) -> Result<Vec<Hit>, EngineError> {
        let most = rods.iter().map(|rod| rod.taper * rod.tau_tip());
        let effects = effects.reaching(most.fold(0.0, f64::max));
        let (device, layout, precision) = (&self.device, &self.layout, self.precision);
        // All rods share one profile.
        let pieces = match rods.first().filter(|_| effects.profile) {
            Some(rod) => {
                let bytes = (layout.pieces)(rod);
                let buffer = device.upload("pieces of a profile", &mut self.pieces, &bytes)?;
                Some((buffer, bytes.len() as u64))
            }
            None => None,
        };
        let steps = |shot: &Shot| {
            let measured = rods.get(shot.rod as usize).filter(|_| effects.profile);
            precision.steps(measured, shot.tau, shot.load)
        };
        let rods = device.upload("rods", &mut self.rods, &(layout.rods)(rods))?;
        let shader = || shaders::shoot(precision, effects);
        let Pipeline { handle, pace } = match self.pipelines.entry(effects) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(new) => {
                let text = self.shader.clone().unwrap_or_else(shader);
                new.insert(Pipeline::new(device, &text, layout, effects)?)
            }
        };
        let call = Call {
            device,
            layout,
            pipeline: handle,
            rods,
            pieces,
            timed: self.times.is_some(),
        };
        let mut times = Times::default();
        let mut hits = Vec::with_capacity(shots.len());
        let mut waiting = shots;
        let mut flights: VecDeque<Flight> = VecDeque::new();
        let mut idle_since = Instant::now();
        loop {
            if flights.len() < IN_FLIGHT && !waiting.is_empty() {
                let (now, later) = waiting.split_at(pace.shots.min(waiting.len()));
                waiting = later;
                let begun = Instant::now();
                flights.push_back(Flight::dispatch(&call, self.buffers.pop(), now, &steps)?);
                times.upload += begun.elapsed();
            } else if let Some(flight) = flights.pop_front() {
                let (count, started) = (flight.shots, flight.submitted.max(idle_since));
                self.buffers
                    .push(flight.finish(&call, &mut hits, &mut times)?);
                idle_since = Instant::now();
                pace.learn(count, idle_since - started);
            } else {
                self.times = self.times.map(|_| times);
                return Ok(hits);
            }
        }
    }
}

/// The largest `|load| s^2`, times the softness, for which the shaders take enough steps. No cone has a fold beyond, unless it
/// has friction or a gradient. Under larger loads a whisker coils up, and trajectories are wrong by more than the residual
/// tells: measured 1e-4 whisker lengths beyond 30, 8e-4 beyond 100.
const MOST_Q: f64 = 30.0;

fn coils_up(rod: &Rod, hit: &Hit) -> bool {
    let s = arclength(rod, hit.tau);
    hit.load.abs() * s * s * rod.softness(hit.tau) > MOST_Q
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

    fn shoot(
        &mut self,
        effects: Effects,
        rods: &[Rod],
        shots: &[Shot],
    ) -> Result<Vec<Hit>, EngineError> {
        if shots.is_empty() {
            return Ok(Vec::new());
        }
        let mut hits = self.run(effects, rods, shots)?;
        for (hit, shot) in hits.iter_mut().zip(shots) {
            let rod = rods.get(shot.rod as usize);
            if hit.outcome == Outcome::Converged && rod.is_some_and(|rod| coils_up(rod, hit)) {
                hit.outcome = Outcome::Stalled;
            }
        }
        Ok(hits)
    }
}
