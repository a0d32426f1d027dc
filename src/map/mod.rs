//! The stages in order, for a whole scene: sheets, an engine's cells, guesses and refinement of all others, regimes, panels.

mod answers;
mod audit;
mod cells;
mod channels;
mod doubt;
mod panel;
mod pushes;
mod summary;

use crate::integrate::{Engine, Fallback};
use crate::plan::Plan;
pub use crate::plan::{Channels, STATE_CHANNELS};
use crate::scene::{Scene, Swept};
use crate::sheet::Sheet;
use crate::shooting::batch::Method;
use cells::SettledRow;
pub use panel::Panel;
use pushes::Pushes;
use rayon::prelude::*;
pub use summary::{Audit, EngineCells, Stage, Summary};

/// Cells in flight for each thread where no engine shoots: so many that nearly all blocks of the refinement are full, and
/// hardly a page of memory is new for them.
const CELLS_OF_A_THREAD: usize = 8192;

/// What a run reports while it goes on.
#[derive(Clone, Copy, Debug)]
pub enum Progress<'a> {
    /// So many more cells are settled.
    Settled(usize),
    /// The next finished panels, in atlas order.
    Panels(&'a [Panel]),
}

/// One side of one whisker.
struct Face<'a> {
    pushes: &'a Pushes,
    sheet: Sheet,
}

/// Computes the panels of `scene` as `plan` says, on the threads of the current pool, best from within it
/// (`rayon::ThreadPool::install`): from outside, every stage of every strip of rows wakes it up. `engine` solves
/// cells in place of the refinement; without one, or where it fails, the CPU does it all.
///
/// # Errors
/// What `observe` refuses panels with, which ends the run; a cell without an answer is no error.
pub fn run<E>(
    scene: &Scene,
    plan: &Plan,
    engine: Option<&mut dyn Engine>,
    observe: &mut dyn FnMut(Progress<'_>) -> Result<(), E>,
) -> Result<Summary, E> {
    let width = scene.grid.push_angle_deg.len();
    let height = scene.grid.distance_mm.len();
    let rows_at_once = match engine {
        Some(_) => plan.rows_at_once,
        None => {
            let rows = CELLS_OF_A_THREAD * rayon::current_num_threads() / width;
            rows.clamp(1, plan.rows_at_once)
        }
    };
    let failure = None;
    let mut engine = Fallback { engine, failure };
    let mut summary = Summary::default();
    let mut sides: Vec<Pushes> = Vec::new();
    let mut angles: Vec<f64> = Vec::new();
    for side in &plan.sides {
        // A row has fewer columns than `u32` can count.
        let side = Pushes::new(&scene.grid.push_angle_deg, *side, angles.len() as u32);
        angles.extend(side.columns.iter().map(|push| push.angle));
        sides.push(side);
    }
    let groups = plan.parts.iter().flat_map(|part| {
        let firsts = part.clone().step_by(plan.panels_at_once);
        firsts.map(|first| first..(first + plan.panels_at_once).min(part.end))
    });
    for group in groups {
        let group: Vec<Swept> = group.map(|index| scene.whisker(index)).collect();
        let faces = summary.time(Stage::Sheets, || faces(scene, plan.method, &group, &sides));
        let mut panels = vec![Panel::unresolved(width * height, plan.channels); group.len()];
        let rows = (0..faces.len()).flat_map(|face| (0..height).map(move |row| (face, row)));
        for strip in rows.collect::<Vec<_>>().chunks(rows_at_once) {
            let settled = cells::settle(plan.method, &faces, &angles, strip, &mut engine, &mut summary);
            summary.time(Stage::Regimes, || {
                answers::fill(width, &group, &faces, sides.len(), &settled, &mut panels);
            });
            let columns = |row: &SettledRow| faces[row.face].pushes.columns.len();
            observe(Progress::Settled(settled.rows.iter().map(columns).sum()))?;
        }
        for panel in &panels {
            summary.count(panel);
        }
        summary.time(Stage::Files, || observe(Progress::Panels(&panels)))?;
    }
    summary.engine_failure = engine.failure;
    Ok(summary)
}

/// Every side of every whisker, in order.
fn faces<'a>(
    scene: &Scene,
    method: Method,
    whiskers: &[Swept],
    sides: &'a [Pushes],
) -> Vec<Face<'a>> {
    let of_whisker = |swept| sides.iter().map(move |side| (swept, side));
    let pairs: Vec<(&Swept, &'a Pushes)> = whiskers.iter().flat_map(of_whisker).collect();
    let face = |&(swept, pushes): &(&Swept, &'a Pushes)| {
        let rod = swept.rod(pushes.side);
        let distances = scene.grid.distance_mm.iter();
        let distances: Vec<f64> = distances.map(|d| d / swept.whisker.length_mm).collect();
        let sheet = Sheet::new(method, &rod, pushes.side, &distances);
        Face { pushes, sheet }
    };
    pairs.par_iter().map(face).collect()
}
