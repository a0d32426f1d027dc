//! What will be computed, decided before anything is: pure, no device, no disk, no clock.

mod channels;
mod effects;

pub use channels::{Channel, Channels, STATE_CHANNELS};
pub use effects::{Cost, Effect, effects};

use crate::rod::{Effects, Rod, Side};
use crate::scene::Scene;
use crate::shooting::batch::Method;
use std::ops::Range;

/// Bytes that a run may take for its panels.
pub const MEMORY_LIMIT: u64 = 4 << 30;

/// Bytes per cell of a panel: 14 channels of 4 bytes.
const BYTES_PER_CELL: u64 = 14 * 4;

/// Bytes per cell in flight: shots, answers and states of the refinement, with an engine references of three strips.
const BYTES_IN_FLIGHT: u64 = 1536;

/// Cells settled, or handed to an engine, at once: enough for every lane of a GPU, little memory.
pub const CELLS_IN_FLIGHT: usize = 1 << 17;

/// Rows handed to an engine at once: the references of each take some 40 KiB, however few its cells are.
const ROWS_IN_FLIGHT: usize = 1 << 10;

/// Cells of the panels computed, and packed, together: enough for several threads, little memory.
const CELLS_OF_PANELS: usize = 1 << 18;

/// Most panels computed together: each has two sheets of some 100 KiB.
const MOST_PANELS: usize = 64;

/// Most push angles, and distances, of a sample that is computed to see how long a scene takes: 16384 cells per whisker. Twelve
/// estimates of shipped scenes were 0.9 to 1.9 times what their runs took right after, on two cores busy with other work.
/// Estimates of the cone repeated in one process differed by a factor of 1.25; with 32 lines, of 2.6.
pub const SAMPLE_LINES: usize = 128;

/// Values of a sweep's axis in such a sample: four whiskers where there are two axes.
pub const SAMPLE_VALUES: usize = 2;

/// States of a trajectory for the rod itself: cos and sin of its tilt, two coordinates.
pub const ROD_STATES: usize = 4;

/// A run.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Whiskers of the sweep.
    pub whiskers: usize,
    /// The effects that the scene calls for, and the resolution of the refinement.
    pub method: Method,
    /// The sides that the push angles ask for; first touch itself belongs to CB.
    pub sides: Vec<Side>,
    /// Cells of all panels.
    pub cells: usize,
    /// The whiskers to compute, in some runs of their indices.
    pub parts: Vec<Range<usize>>,
    /// What to compute of each cell.
    pub channels: Channels,
    /// Panels computed together, so that small panels fill an engine too.
    pub panels_at_once: usize,
    /// Most rows of a panel handed to an engine at once.
    pub rows_at_once: usize,
    /// Calls of an engine at most, each with the rows of some whiskers and sides; rows of few cells need none.
    pub engine_calls: usize,
    /// Most bytes that panels and cells in flight take.
    pub bytes: u64,
}

/// A run that takes more than [`MEMORY_LIMIT`].
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum PlanError {
    /// One panel is too large.
    #[error(
        "grid: {push_angles} push angles x {distances} distances make a panel of {cells} cells that takes \
         {needed} MiB: must be at most {limit} MiB; lower grid.push_angle_deg.count or grid.distance_mm.count",
        cells = push_angles * distances,
        limit = MEMORY_LIMIT >> 20
    )]
    Panel {
        /// Push angles of the grid.
        push_angles: usize,
        /// Distances of the grid.
        distances: usize,
        /// Memory of the run, in MiB.
        needed: u64,
    },
    /// The panels of all whiskers together are too large to be kept in memory.
    #[error(
        "grid: {whiskers} panels of {cells} cells take {needed} MiB in memory: must be at most {limit} MiB; \
         take one panel at a time with `for_each_panel`, or lower the counts of the axes",
        limit = MEMORY_LIMIT >> 20
    )]
    AllPanels {
        /// Whiskers of the sweep.
        whiskers: usize,
        /// Cells of one panel.
        cells: usize,
        /// Memory of the run, in MiB.
        needed: u64,
    },
}

/// Bytes of the cells in flight.
fn bytes_in_flight(scene: &Scene) -> u64 {
    CELLS_IN_FLIGHT.max(scene.grid.push_angle_deg.len()) as u64 * BYTES_IN_FLIGHT
}

impl Plan {
    /// The plan for `scene`.
    ///
    /// # Errors
    /// When one panel takes more than [`MEMORY_LIMIT`].
    pub fn new(scene: &Scene) -> Result<Self, PlanError> {
        let push_angles = scene.grid.push_angle_deg.len();
        let distances = scene.grid.distance_mm.len();
        let cells = push_angles * distances;
        let whiskers = scene.whisker_count();
        let panels_at_once = (CELLS_OF_PANELS / cells)
            .clamp(1, MOST_PANELS)
            .min(whiskers);
        // As computed and as packed; in a sweep, where a panel is one block, also rearranged, and some are computed meanwhile.
        let copies = if whiskers > 1 { 4 } else { 2 };
        let panels = (copies * cells * panels_at_once) as u64;
        let bytes = panels * BYTES_PER_CELL + bytes_in_flight(scene);
        if bytes > MEMORY_LIMIT {
            return Err(PlanError::Panel {
                push_angles,
                distances,
                needed: bytes.div_ceil(1 << 20),
            });
        }
        let corners: Vec<Rod> = scene
            .corner_whiskers()
            .map(|own| own.rod(Side::Cb))
            .collect();
        let sides = Self::sides(scene);
        let rows_at_once = (CELLS_IN_FLIGHT / push_angles).clamp(1, ROWS_IN_FLIGHT);
        let calls = |group: usize| (group * sides.len() * distances).div_ceil(rows_at_once);
        Ok(Self {
            method: Method::fine().with_effects(Effects::of(&corners)),
            engine_calls: whiskers / panels_at_once * calls(panels_at_once)
                + calls(whiskers % panels_at_once),
            cells: cells * whiskers,
            parts: std::iter::once(0..whiskers).collect(),
            channels: Channels::ALL,
            sides,
            panels_at_once,
            rows_at_once,
            bytes,
            whiskers,
        })
    }

    /// The plan for a run of `scene` that keeps the panels of all whiskers in memory.
    ///
    /// # Errors
    /// When one panel, or all panels with those that are being computed, take more than [`MEMORY_LIMIT`].
    pub fn in_memory(scene: &Scene) -> Result<Self, PlanError> {
        let plan = Self::new(scene)?;
        let cells = plan.cells / plan.whiskers;
        let panels = (plan.cells + cells * plan.panels_at_once) as u64;
        let bytes = panels * BYTES_PER_CELL + bytes_in_flight(scene);
        if bytes > MEMORY_LIMIT {
            return Err(PlanError::AllPanels {
                whiskers: plan.whiskers,
                cells,
                needed: bytes.div_ceil(1 << 20),
            });
        }
        Ok(Self { bytes, ..plan })
    }

    /// The sides that the push angles of `scene` ask for.
    #[must_use]
    pub fn sides(scene: &Scene) -> Vec<Side> {
        let pushes = &scene.grid.push_angle_deg;
        let asked = |side: &Side| pushes.iter().any(|push| Side::of_push(*push) == *side);
        Side::BOTH.into_iter().filter(asked).collect()
    }

    /// The whiskers that are computed together, one group after the other.
    pub fn groups(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        self.parts.iter().flat_map(|part| {
            let firsts = part.clone().step_by(self.panels_at_once);
            firsts.map(|first| first..(first + self.panels_at_once).min(part.end))
        })
    }

    /// States of a trajectory for the derivatives of the rod: those by the force, and where they do not follow, two by the contact.
    #[must_use]
    pub const fn derivative_states(&self) -> usize {
        if self.method.effects.similar() { 3 } else { 5 }
    }

    /// States of a trajectory for the rest shape: cos and sin of its tangent, if it is curved.
    #[must_use]
    pub const fn rest_states(&self) -> usize {
        if self.method.effects.curvature { 2 } else { 0 }
    }
}
