//! The GPU engine: WGSL compute shaders through wgpu, one Newton iteration per invocation.
//!
//! The shaders are joined from whole pieces ([`shaders`]), in `f32` or `f64` by a type alias; each set of
//! effects has a pipeline of its own, made from `override` constants. Work goes out in dispatches short
//! enough for any watchdog, at most two in flight; nothing here panics when a device fails.
//!
//! Absent on purpose: a second try on a lost device. [`Fallback`](super::Fallback) does without it.

mod adapters;
mod device;
mod guard;
mod layout;
mod pace;
mod peak;
mod pipeline;
mod precision;
pub mod shaders;
mod slot;
mod stamps;

pub use adapters::{AdapterReport, Kind, adapters, preferred};
pub use precision::Precision;

use super::{Description, Engine, EngineError, Hit, Outcome, Shot};
use crate::rod::{Effects, Piece, Rod, arclength};
use device::Device;
use layout::{Layout, Stretch, Task};
use pipeline::Pipeline;
pub use slot::Times;
use slot::{Flight, Shared, Slot};
use std::collections::hash_map::Entry;
use std::collections::{HashMap, VecDeque};
use std::time::Instant;

/// The GPU engine on the [`preferred`] adapter.
#[derive(Debug)]
pub struct Gpu {
    precision: Precision,
    /// In place of [`shaders::shoot`].
    shader: Option<String>,
    layout: &'static Layout,
    device: Device,
    rods: Option<wgpu::Buffer>,
    pieces: Option<wgpu::Buffer>,
    slots: Vec<Slot>,
    pipelines: HashMap<Effects, Pipeline>,
    /// The stages of the last call, for those who ask.
    times: Option<Times>,
}

/// Dispatches in flight: one runs while the answers of the other are read.
const IN_FLIGHT: usize = 2;

impl Gpu {
    /// Opens the adapter.
    ///
    /// # Errors
    /// [`EngineError::NoAdapter`] without a driver, [`EngineError::Unsupported`] where the adapter has no
    /// `f64`, [`EngineError::Device`] when the driver refuses a device.
    pub fn new(precision: Precision) -> Result<Self, EngineError> {
        Device::open(precision).map(|device| Self::with_device(precision, device))
    }

    /// Opens the adapter that is at `index` of [`adapters`], to have it timed stage by stage.
    ///
    /// # Errors
    /// [`EngineError::Device`] when the driver refuses a device.
    pub fn timed(index: usize, precision: Precision) -> Result<Self, EngineError> {
        Ok(Self {
            times: Some(Times::default()),
            ..Self::with_device(precision, Device::at(index, precision)?)
        })
    }

    fn with_device(precision: Precision, device: Device) -> Self {
        Self {
            precision,
            shader: None,
            layout: Layout::of(precision),
            device,
            rods: None,
            pieces: None,
            slots: Vec::new(),
            pipelines: HashMap::new(),
            times: None,
        }
    }

    /// What the stages of the last call took, of an engine that is timed.
    #[must_use]
    pub const fn times(&self) -> Option<Times> {
        self.times
    }

    /// Opens the adapter for a shader other than [`shaders::shoot`]: a seam for tests, which spoil it.
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

    /// Uploads `bytes`, `what` they are, in a buffer that grows when it must.
    fn upload(
        &self,
        what: &'static str,
        last: Option<wgpu::Buffer>,
        bytes: &[u8],
    ) -> Result<wgpu::Buffer, EngineError> {
        let size = bytes.len() as u64;
        let most = self.device.most_bytes();
        if size > most {
            return Err(EngineError::Unsupported {
                adapter: self.device.report.name.clone(),
                what: format!("hold {size} bytes of {what}, at most {most}"),
            });
        }
        let buffer = match last {
            Some(buffer) if buffer.size() >= size => buffer,
            _ => {
                let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
                self.device.buffer(what, size, usage)?
            }
        };
        self.device.queue.write_buffer(&buffer, 0, bytes);
        Ok(buffer)
    }

    /// Uploads the pieces of the profile that all rods share, and tells how many bytes they are.
    fn upload_pieces(&mut self, rod: &Rod) -> Result<(wgpu::Buffer, u64), EngineError> {
        let pieces = match &rod.profile {
            Some(profile) => &profile.pieces[..],
            None => &[Piece::cone(rod.taper)],
        };
        let stretches: Vec<Stretch> = pieces
            .iter()
            .map(|piece| Stretch {
                tau: rod.tau(piece.from),
                piece: *piece,
            })
            .collect();
        let bytes = (self.layout.pieces)(&stretches);
        let last = self.pieces.take();
        let buffer = self.upload("pieces of a profile", last, &bytes)?;
        self.pieces = Some(buffer.clone());
        Ok((buffer, bytes.len() as u64))
    }

    fn run(
        &mut self,
        effects: Effects,
        rods: &[Rod],
        shots: &[Shot],
    ) -> Result<Vec<Hit>, EngineError> {
        let most = rods.iter().map(|rod| rod.taper * rod.tau_tip());
        let effects = effects.reaching(most.fold(0.0, f64::max));
        let measured = rods.first().filter(|_| effects.profile);
        let pieces = measured.map(|rod| self.upload_pieces(rod)).transpose()?;
        let precision = self.precision;
        let task = |shot: &Shot| Task {
            shot: *shot,
            steps: precision.steps(
                rods.get(shot.rod as usize).filter(|_| effects.profile),
                shot.tau,
                shot.load,
            ),
        };
        let last = self.rods.take();
        let buffer = self.upload("rods", last, &(self.layout.rods)(rods))?;
        self.rods = Some(buffer.clone());
        let shader = || shaders::shoot(self.precision, effects);
        let pipeline = match self.pipelines.entry(effects) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(new) => new.insert(Pipeline::new(
                &self.device,
                &self.shader.clone().unwrap_or_else(shader),
                self.layout,
                effects,
            )?),
        };
        let shared = Shared {
            rods: &buffer,
            pieces: pieces.as_ref(),
            timed: self.times.is_some(),
        };
        let mut times = Times::default();
        let mut hits = Vec::with_capacity(shots.len());
        let mut waiting = shots;
        let mut flights: VecDeque<Flight> = VecDeque::new();
        let mut idle_since = Instant::now();
        loop {
            if flights.len() < IN_FLIGHT && !waiting.is_empty() {
                let (now, later) = waiting.split_at(pipeline.pace.shots.min(waiting.len()));
                waiting = later;
                let slot = self.slots.pop().unwrap_or_default();
                let (device, layout) = (&self.device, self.layout);
                let begun = Instant::now();
                let tasks: Vec<Task> = now.iter().map(task).collect();
                flights.push_back(slot.condition(device, layout, pipeline, &shared, &tasks)?);
                times.upload += begun.elapsed();
            } else if let Some(flight) = flights.pop_front() {
                let (count, started) = (flight.shots, flight.submitted.max(idle_since));
                self.slots
                    .push(flight.shoot(&self.device, self.layout, &mut hits, &mut times)?);
                idle_since = Instant::now();
                pipeline.pace.learn(count, idle_since - started);
            } else {
                self.times = self.times.map(|_| times);
                return Ok(hits);
            }
        }
    }
}

/// The largest `|load| s^2`, times the softness, under which the steps of the shaders do; without friction and gradient no
/// fold of a cone lies beyond. Under more a whisker coils up, and the residual would not tell that the trajectory is wrong
/// (by 1e-4 whisker lengths beyond 30, 8e-4 beyond 100, measured).
const MOST_Q: f64 = 30.0;

fn coils_up(rod: &Rod, hit: &Hit) -> bool {
    let s = arclength(rod, hit.tau);
    hit.load.abs() * s * s * rod.softness(hit.tau) > MOST_Q
}

impl Engine for Gpu {
    fn describe(&self) -> Description {
        let report = &self.device.report;
        Description {
            engine: format!("gpu {}", self.precision),
            adapter: format!(
                "{}, {}, {} {}",
                report.name, report.backend, report.driver, report.driver_info
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
