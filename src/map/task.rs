//! What all row batches of a run share, and the whisker sides of a group of panels.

use crate::engine::{SideColumns, WhiskerSide};
use crate::plan::{CELLS_IN_FLIGHT, Plan};
use crate::scene::{Scene, SweptWhisker};
use crate::sheet::Sheet;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// Cells per thread in a batch for the CPU alone: nearly all blocks of the refinement are full, and hardly a page of memory is new.
const CELLS_PER_THREAD: usize = 8192;

/// The scene, the plan and the columns of a run.
pub struct Task<'a> {
    pub scene: &'a Scene,
    pub plan: &'a Plan,
    pub rows_at_once: usize,
    sides: Vec<Arc<SideColumns>>,
    /// Signed push angles of the columns of all sides, in radians.
    pub pushes: Arc<[f64]>,
}

impl<'a> Task<'a> {
    /// A run with an engine beside the CPU or without.
    pub fn new(scene: &'a Scene, plan: &'a Plan, has_engine: bool) -> Self {
        let rows_at_once = if has_engine {
            plan.rows_at_once
        } else {
            let cells = CELLS_PER_THREAD * rayon::current_num_threads();
            let rows = cells.min(CELLS_IN_FLIGHT) / scene.grid.push_angle_deg.len();
            rows.max(1)
        };
        let mut sides: Vec<Arc<SideColumns>> = Vec::new();
        let mut pushes: Vec<f64> = Vec::new();
        for side in &plan.sides {
            // A row has fewer columns than `u32` can count.
            let first = pushes.len() as u32;
            let side = SideColumns::new(&scene.grid.push_angle_deg, *side, first);
            pushes.extend(side.columns.iter().map(|column| column.push));
            sides.push(Arc::new(side));
        }
        Self {
            scene,
            plan,
            rows_at_once,
            sides,
            pushes: pushes.into(),
        }
    }

    /// Every side of some of the whiskers, in order.
    pub fn sides(&self, whiskers: Range<usize>) -> Arc<[WhiskerSide]> {
        let whiskers: Vec<SweptWhisker> = whiskers.map(|index| self.scene.whisker(index)).collect();
        let of_whisker = |swept| self.sides.iter().map(move |side| (swept, side));
        let pairs: Vec<(&SweptWhisker, &Arc<SideColumns>)> =
            whiskers.iter().flat_map(of_whisker).collect();
        let side = |&(swept, columns): &(&SweptWhisker, &Arc<SideColumns>)| {
            let rod = swept.rod(columns.side);
            let distances = self.scene.grid.distance_mm.iter();
            let distances: Vec<f64> = distances.map(|d| d / swept.whisker.length_mm).collect();
            let sheet = Sheet::new(self.plan.method, &rod, columns.side, &distances);
            WhiskerSide::new(Arc::clone(columns), swept.whisker.units(), sheet)
        };
        let sides: Vec<WhiskerSide> = pairs.par_iter().map(side).collect();
        sides.into()
    }

    /// Number of whisker sides of a panel.
    pub fn sides_per_panel(&self) -> usize {
        self.sides.len()
    }
}
