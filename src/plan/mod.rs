//! Plan of a run: what will be computed, decided without a device, a disk or a clock.

pub(crate) mod channels;
mod digits;
mod effects;
mod error;
mod expansions;
mod memory;
mod selection;

pub(crate) use channels::names as channel_names;
pub use channels::{Channel, Channels, STATE_CHANNELS};
pub use digits::{Digits, rounded};
pub use effects::{Cost, Effect, effects};
pub use error::PlanError;
pub use expansions::{ExpansionCount, USUAL_NET, net_cost};
pub use memory::{BYTES_PER_THREAD, MEMORY_LIMIT};

use crate::scene::Scene;
use memory::{
    BYTES_ON_GPU, BYTES_PER_CELL, DRIVER_BYTES, PACKED_BYTES_PER_CELL, bytes_of_sheets, fits,
};
use std::ops::Range;
use whiskmap_mechanics::rod::{Effects, Rod, Side};
use whiskmap_mechanics::shooting::batch::Method;

/// Maximum number of cells of a row batch: enough for every lane of a GPU, in little memory.
pub const CELLS_IN_FLIGHT: usize = 1 << 17;

/// Rows of a row batch for an engine: the expansions of each take memory, however few its cells are.
const ROWS_IN_FLIGHT: usize = 1 << 10;

/// Cells of the panels computed and packed together: enough for several threads, in little memory.
const CELLS_OF_PANELS: usize = 1 << 18;

/// Number of rows of a block of an EXR file of one panel.
pub const BLOCK_ROWS: usize = 16;

/// Returns the number of rows of a band of a panel with these numbers of rows and push angles, and of a chunk of its store: whole blocks
/// of an EXR file.
#[must_use]
pub fn rows_of_band([rows, push_angles]: [usize; 2]) -> usize {
    let band = (CELLS_OF_PANELS / push_angles).max(1);
    band.next_multiple_of(BLOCK_ROWS).min(rows)
}

/// Maximum number of panels computed together: each has two sheets of about 100 KiB.
const MOST_PANELS: usize = 64;

/// Maximum number of push angles, and of distances, of a sample that estimates the time of a scene: 16,384 cells per whisker. A
/// cell of a sparser sample costs more than one of the map.
pub const SAMPLE_LINES: usize = 128;

/// Number of values of each sweep axis in a sample that estimates the time of a scene.
pub const SAMPLE_VALUES: usize = 2;

/// Number of states that a trajectory carries for the rod: cos and sin of its tilt, and two coordinates.
pub const ROD_STATES: usize = 4;

/// The sizes and effects of a run.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Number of whiskers of the sweep.
    pub whiskers: usize,
    /// Integration method of the run: effects of the scene, and resolution of the refinement.
    pub method: Method,
    /// Sides of the whisker that the push angles of the run need, `[side]`; first touch belongs to CB.
    pub sides: Vec<Side>,
    /// Number of cells of all panels of the run.
    pub cells: usize,
    /// Whiskers that the run computes, as ranges of their indices in the sweep, `[part]`.
    pub parts: Vec<Range<usize>>,
    /// Channels that the run computes.
    pub channels: Channels,
    /// Digits of the run's channels in files.
    pub digits: Digits,
    /// Number of panels computed together, so that small panels fill an engine.
    pub panels_at_once: usize,
    /// Number of rows of a panel that are finished together, a band: all rows, unless a single panel is computed in bands.
    pub band_rows: usize,
    /// Maximum number of rows of a batch for an engine.
    pub rows_at_once: usize,
    /// Maximum number of batches for an engine.
    pub engine_calls: usize,
    /// Number of cells of the panels that are in memory together.
    pub cells_at_once: usize,
    /// Memory of panels, computed and packed, and of sheets, in bytes. Each thread adds [`BYTES_PER_THREAD`].
    pub bytes: u64,
    /// Memory of a GPU's driver and of what is in flight with it, in bytes.
    pub gpu_bytes: u64,
}

impl Plan {
    /// Creates the plan of a run for `scene`.
    ///
    /// # Errors
    /// When one panel takes more than [`MEMORY_LIMIT`].
    pub fn new(scene: &Scene) -> Result<Self, PlanError> {
        Self::in_blocks(scene, 1)
    }

    /// Creates the plan of a run for `scene` that keeps the packed panels of this number of `whiskers` until their blocks are written.
    ///
    /// # Errors
    /// When one panel, or the blocks, take more than [`MEMORY_LIMIT`].
    pub fn in_blocks(scene: &Scene, whiskers: usize) -> Result<Self, PlanError> {
        Self::with_band(scene, scene.grid.distance_mm.len(), whiskers)
    }

    /// Returns the plan for a run of `scene` that keeps bands of rows: a single panel is never in memory as a whole, except as packed.
    ///
    /// # Errors
    /// When one panel takes more than [`MEMORY_LIMIT`].
    pub fn in_bands(scene: &Scene) -> Result<Self, PlanError> {
        let panel = [&scene.grid.distance_mm, &scene.grid.push_angle_deg].map(Vec::len);
        match scene.whisker_count() {
            1 => Self::with_band(scene, rows_of_band(panel), 1),
            _ => Self::new(scene),
        }
    }

    fn with_band(scene: &Scene, band_rows: usize, packed_panels: usize) -> Result<Self, PlanError> {
        let push_angles = scene.grid.push_angle_deg.len();
        let distances = scene.grid.distance_mm.len();
        let cells = push_angles * distances;
        let whiskers = scene.whisker_count();
        let panels_at_once = (CELLS_OF_PANELS / cells).clamp(1, MOST_PANELS).min(whiskers);
        let sides = Self::sides(scene);
        // Some are packed while the next ones are computed.
        let rows = whiskers * distances;
        let computed = rows.min(2 * panels_at_once * band_rows) * push_angles;
        let packed = cells * packed_panels.max(panels_at_once);
        let bytes = computed as u64 * BYTES_PER_CELL
            + packed as u64 * PACKED_BYTES_PER_CELL
            + bytes_of_sheets(scene, panels_at_once);
        let gpu_bytes = DRIVER_BYTES + CELLS_IN_FLIGHT.max(push_angles) as u64 * BYTES_ON_GPU;
        if !fits(bytes, gpu_bytes) {
            return Err(PlanError::Panel {
                push_angles,
                distances,
                needed: bytes.div_ceil(1 << 20),
            });
        }
        let corners: Vec<Rod> = scene.corner_whiskers().map(|swept| swept.rod(Side::Cb)).collect();
        let rows_at_once = (CELLS_IN_FLIGHT / push_angles).clamp(1, ROWS_IN_FLIGHT);
        let of_rows = |rows: usize| (rows * sides.len()).div_ceil(rows_at_once);
        let calls = |group: usize| {
            let bands = distances / band_rows * of_rows(group * band_rows);
            bands + of_rows(group * (distances % band_rows))
        };
        Ok(Self {
            method: Method::fine().with_effects(Effects::of(&corners)),
            engine_calls: whiskers / panels_at_once * calls(panels_at_once)
                + calls(whiskers % panels_at_once),
            cells: cells * whiskers,
            parts: std::iter::once(0..whiskers).collect(),
            channels: Channels::of_scene(scene),
            digits: Digits::ALL,
            sides,
            panels_at_once,
            band_rows,
            rows_at_once,
            cells_at_once: computed,
            bytes,
            gpu_bytes,
            whiskers,
        })
    }

    /// Creates the plan of a run of `scene` that keeps the panels of all whiskers in memory.
    ///
    /// # Errors
    /// When one panel, or all panels, take more than [`MEMORY_LIMIT`].
    pub fn in_memory(scene: &Scene) -> Result<Self, PlanError> {
        let plan = Self::new(scene)?;
        let cells = plan.cells / plan.whiskers;
        let bytes =
            plan.cells as u64 * BYTES_PER_CELL + bytes_of_sheets(scene, plan.panels_at_once);
        if !fits(bytes, plan.gpu_bytes) {
            return Err(PlanError::AllPanels {
                whiskers: plan.whiskers,
                cells,
                needed: bytes.div_ceil(1 << 20),
            });
        }
        Ok(Self { bytes, cells_at_once: plan.cells, ..plan })
    }

    /// Returns the whisker sides that the push angles of `scene` need, `[side]`.
    #[must_use]
    pub fn sides(scene: &Scene) -> Vec<Side> {
        let pushes = &scene.grid.push_angle_deg;
        let is_wanted = |side: &Side| pushes.iter().any(|push| Side::of_push(*push) == *side);
        Side::BOTH.into_iter().filter(is_wanted).collect()
    }

    /// Returns the count of cells and of expansions for the whisker side with the most push angles; `None` for states of whiskers with measured
    /// radii, which have no expansions.
    #[must_use]
    pub fn expansions(&self, scene: &Scene) -> Option<ExpansionCount> {
        let pushes = &scene.grid.push_angle_deg;
        let columns =
            |side: &Side| pushes.iter().filter(|push| Side::of_push(**push) == *side).count();
        let most = self.sides.iter().map(columns).max().unwrap_or(0);
        let needs_states = self.channels.needs_states();
        let count = ExpansionCount::new(scene.grid.distance_mm.len(), most, needs_states);
        (!self.method.effects.profile || !needs_states).then_some(count)
    }

    /// Returns the number of cells of the panels of the parts that the run computes.
    #[must_use]
    pub fn cells_of_parts(&self) -> usize {
        let whiskers: usize = self.parts.iter().map(ExactSizeIterator::len).sum();
        self.cells / self.whiskers * whiskers
    }

    /// Returns the groups of whiskers that are computed together, in order.
    pub fn groups(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        self.parts.iter().flat_map(|part| {
            let firsts = part.clone().step_by(self.panels_at_once);
            firsts.map(|first| first..(first + self.panels_at_once).min(part.end))
        })
    }

    /// Returns the number of states that a trajectory carries for derivatives of the rod: by the force and, if they do not follow from
    /// it, two by the contact.
    #[must_use]
    pub const fn derivative_states(&self) -> usize {
        if self.method.effects.similar() { 3 } else { 5 }
    }

    /// Returns the number of states that a trajectory carries for the rest shape: cos and sin of its tangent, if it is curved.
    #[must_use]
    pub const fn rest_states(&self) -> usize {
        if self.method.effects.curvature { 2 } else { 0 }
    }
}
