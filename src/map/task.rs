//! What all strips of a run share: the scene, the plan, the push angles; and the sheets of a group of whiskers.

use super::WhiskerSide;
use super::columns::SideColumns;
use crate::plan::{CELLS_IN_FLIGHT, Plan};
use crate::scene::{Scene, Swept};
use crate::sheet::Sheet;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// Cells in flight for each thread where no engine shoots: so many that nearly all blocks of the refinement are full, and
/// hardly a page of memory is new for them.
const CELLS_OF_A_THREAD: usize = 8192;

/// What a run is to do.
pub struct Task<'a> {
    pub scene: &'a Scene,
    pub plan: &'a Plan,
    pub rows_at_once: usize,
    pub sides: Vec<SideColumns>,
    /// Signed push angles of the columns of all sides.
    pub angles: Arc<[f64]>,
}

impl<'a> Task<'a> {
    /// With an engine or without.
    pub fn new(scene: &'a Scene, plan: &'a Plan, has_engine: bool) -> Self {
        let rows_at_once = if has_engine {
            plan.rows_at_once
        } else {
            let cells = CELLS_OF_A_THREAD * rayon::current_num_threads();
            let rows = cells.min(CELLS_IN_FLIGHT) / scene.grid.push_angle_deg.len();
            rows.max(1)
        };
        let mut sides: Vec<SideColumns> = Vec::new();
        let mut angles: Vec<f64> = Vec::new();
        for side in &plan.sides {
            // A row has fewer columns than `u32` can count.
            let side = SideColumns::new(&scene.grid.push_angle_deg, *side, angles.len() as u32);
            angles.extend(side.columns.iter().map(|push| push.angle));
            sides.push(side);
        }
        Self {
            scene,
            plan,
            rows_at_once,
            sides,
            angles: angles.into(),
        }
    }

    /// Some of its whiskers.
    pub fn group(&self, whiskers: Range<usize>) -> Group<'_> {
        let whiskers: Vec<Swept> = whiskers.map(|index| self.scene.whisker(index)).collect();
        let faces = self.faces(&whiskers);
        Group { whiskers, faces }
    }

    /// Every side of every whisker, in order.
    fn faces(&self, whiskers: &[Swept]) -> Vec<WhiskerSide<'_>> {
        let of_whisker = |swept| self.sides.iter().map(move |side| (swept, side));
        let pairs: Vec<(&Swept, &SideColumns)> = whiskers.iter().flat_map(of_whisker).collect();
        let face = |&(swept, pushes): &(&Swept, _)| {
            let pushes: &SideColumns = pushes;
            let rod = swept.rod(pushes.side);
            let distances = self.scene.grid.distance_mm.iter();
            let distances: Vec<f64> = distances.map(|d| d / swept.whisker.length_mm).collect();
            let sheet = Sheet::new(self.plan.method, &rod, pushes.side, &distances);
            WhiskerSide { pushes, sheet }
        };
        let faces = pairs.par_iter().map(|pair| face(pair));
        faces.collect()
    }
}

/// Whiskers whose panels are kept together.
pub struct Group<'a> {
    pub whiskers: Vec<Swept>,
    pub faces: Vec<WhiskerSide<'a>>,
}
