//! Maps that are computed when they are read, whisker by whisker.
//!
//! Invariant: the values of a whisker do not depend on the whiskers that are read with it. Unless the engine fails, they equal the values
//! in a map of the whole scene by this engine.

use super::layout::SAMPLE_BYTES;
use super::{ChannelValues, StoreError};
use crate::classify::{Regime, Status};
use crate::engine::{Engine, EngineDescription};
use crate::map::{self, Panel};
use crate::plan::Plan;
use crate::scene::Scene;
use serde_json::{Value, json};
use std::collections::{BTreeMap, HashMap, VecDeque};
use std::convert::Infallible;
use std::fmt;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use std::sync::{Mutex, PoisonError};
use whiskmap_mechanics::numerics::ArithmeticClass;

/// Most bytes of the whiskers that a map keeps for further reads: all channels of 18 whiskers of 512 x 512 cells.
const KEPT_BYTES: usize = 256 << 20;

/// Map of a scene that is computed when it is read. All channels of a whisker are computed together, and kept for further reads: the newest
/// whiskers that take at most 256 MiB, or the newest one.
///
/// Reads of one map wait for each other. So tasks of one `rayon` pool must not read it at the same time: a task that computes may steal one that
/// waits for it.
pub struct ComputedMap {
    /// Scene whose map is computed.
    pub scene: Scene,
    /// Engine that solves the cells of the map, and its hardware.
    pub engine: EngineDescription,
    plan: Plan,
    tolerances: Value,
    solver: Mutex<MapSolver>,
}

/// Engine of a computed map, and what it has computed.
#[derive(Default)]
struct MapSolver {
    /// `None` for the CPU engine alone, and after a failure.
    engine: Option<Box<dyn Engine>>,
    /// Samples of all channels by whisker: `[channel][distance][push_angle]`, as bytes.
    kept: HashMap<usize, Vec<u8>>,
    /// Kept whiskers, the oldest first.
    order: VecDeque<usize>,
    /// Number of unresolved cells of each whisker that has some.
    unresolved: BTreeMap<usize, u64>,
    failure: Option<String>,
}

impl fmt::Debug for ComputedMap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut map = f.debug_struct("ComputedMap");
        let map = map.field("plan", &self.plan).field("engine", &self.engine);
        map.finish_non_exhaustive()
    }
}

impl ComputedMap {
    /// Creates the map of `scene` with the steps and channels of `plan`; no value is computed yet. `engine` solves cells, or the CPU engine
    /// without one. The `tolerances` are described in [`MapDescription`](super::MapDescription).
    #[must_use]
    pub fn new(
        scene: Scene,
        plan: Plan,
        engine: Option<Box<dyn Engine>>,
        tolerances: Value,
    ) -> Self {
        Self {
            engine: EngineDescription::of(engine.as_deref()),
            scene,
            plan,
            tolerances,
            solver: Mutex::new(MapSolver { engine, ..MapSolver::default() }),
        }
    }

    /// Returns the names of the channels that are computed, `[channel]`.
    #[must_use]
    pub fn channels(&self) -> Vec<&'static str> {
        self.plan.channels.names().collect()
    }

    /// Returns the attribute `name` that a stored map of the scene has, such as `scene`, `engine` or `tolerances`.
    ///
    /// # Errors
    /// There is no such attribute.
    pub fn attribute(&self, name: &str) -> Result<Value, StoreError> {
        Ok(match name {
            "scene" => json!(self.scene.text.to_string()),
            "title" => json!(self.scene.title),
            "whiskmap_version" => json!(env!("CARGO_PKG_VERSION")),
            "engine" => json!(self.engine.engine),
            "adapter" => json!(self.engine.adapter),
            "arithmetic" => json!(ArithmeticClass::detect().name()),
            "tolerances" => self.tolerances.clone(),
            _ => return Err(StoreError::NoAttribute(name.to_owned())),
        })
    }

    /// Returns warnings about the whiskers that were computed since the last call: a failure of the engine, and unresolved cells.
    #[must_use]
    pub fn take_warnings(&self) -> Vec<String> {
        let mut solver = self.solver.lock().unwrap_or_else(PoisonError::into_inner);
        let failure = solver.failure.take();
        let unresolved = std::mem::take(&mut solver.unresolved);
        let unresolved = (!unresolved.is_empty()).then(|| {
            let (cells, whiskers) = (unresolved.values().sum::<u64>(), unresolved.len());
            format!("{cells} cells of {whiskers} whiskers are unresolved: `status` has the reasons")
        });
        failure.into_iter().chain(unresolved).collect()
    }

    /// Returns a channel of some whiskers of the map, which are computed unless they are kept: `[whisker][distance][push_angle]`.
    /// `on_progress(n)` is called after `n` more cells are finished. If `cancel` is true, the read soon ends.
    ///
    /// # Errors
    /// There is no such channel or whisker, or the read is cancelled.
    pub fn read(
        &self,
        name: &str,
        whiskers: &[usize],
        on_progress: &mut dyn FnMut(usize),
        cancel: &AtomicBool,
    ) -> Result<ChannelValues, StoreError> {
        let names = self.channels();
        let channel = names.iter().position(|known| *known == name);
        let channel = channel.ok_or_else(|| StoreError::UnknownChannel {
            path: PathBuf::from(&self.scene.name),
            name: name.to_owned(),
            known: self.plan.channels.to_string(),
        })?;
        let panels = self.scene.whisker_count();
        if let Some(&index) = whiskers.iter().find(|index| **index >= panels) {
            return Err(StoreError::NoSuchPanel { index, panels });
        }
        let grid = &self.scene.grid;
        let size = grid.panel_cells() * SAMPLE_BYTES;
        let mut bytes = vec![0; whiskers.len() * size];
        let mut put = |places: &[usize], samples: &[u8]| {
            for place in places {
                bytes[place * size..][..size].copy_from_slice(&samples[channel * size..][..size]);
            }
        };
        let mut missing: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (place, whisker) in whiskers.iter().enumerate() {
            missing.entry(*whisker).or_default().push(place);
        }

        let mut solver = self.solver.lock().unwrap_or_else(PoisonError::into_inner);
        let solver = &mut *solver;
        missing.retain(|whisker, places| {
            let kept = solver.kept.get(whisker);
            kept.inspect(|samples| put(places, samples)).is_none()
        });
        let plan = Plan { parts: consecutive(missing.keys().copied()), ..self.plan.clone() };
        let mut computed = missing.into_iter();
        let (kept, order) = (&mut solver.kept, &mut solver.order);
        let unresolved = &mut solver.unresolved;
        let room = (KEPT_BYTES / (size * names.len())).max(1);
        let mut keep = |panels: &mut Vec<Panel>| {
            for (panel, (whisker, places)) in panels.iter().zip(&mut computed) {
                let samples = names.iter().map(|name| panel.bytes(name));
                let samples = samples.collect::<Vec<_>>().concat();
                put(&places, &samples);
                kept.insert(whisker, samples);
                order.push_back(whisker);
                if order.len() > room
                    && let Some(oldest) = order.pop_front()
                {
                    kept.remove(&oldest);
                }
                // Rows without a whisker have their reason before the map.
                let codes = panel.regime.iter().zip(&panel.status);
                let is_open = |(regime, status): &(&u32, &u32)| {
                    **regime == Regime::Unresolved.code() && **status != Status::NoWhisker.code()
                };
                let cells = codes.filter(is_open).count();
                if cells > 0 {
                    unresolved.insert(whisker, cells as u64);
                }
            }
            Ok::<(), Infallible>(())
        };
        let engine = solver.engine.as_mut().map(|engine| &mut **engine as _);
        let Ok(summary) = map::run(&self.scene, &plan, engine, on_progress, cancel, &mut keep);
        if let Some(failure) = summary.engine_failure {
            solver.engine = None;
            solver.failure = Some(format!("{failure}; the CPU solved the remaining cells"));
        }
        if summary.is_cancelled {
            return Err(StoreError::Cancelled);
        }
        Ok(ChannelValues::of_bytes(name, &bytes))
    }
}

/// Returns increasing numbers as ranges of consecutive ones.
fn consecutive(numbers: impl Iterator<Item = usize>) -> Vec<Range<usize>> {
    let mut ranges: Vec<Range<usize>> = Vec::new();
    for number in numbers {
        match ranges.last_mut() {
            Some(range) if range.end == number => range.end += 1,
            _ => ranges.push(number..number + 1),
        }
    }
    ranges
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_joined() {
        assert_eq!(consecutive([].into_iter()), []);
        assert_eq!(consecutive([2, 3, 4, 7, 9, 10].into_iter()), [2..5, 7..8, 9..11]);
    }
}
