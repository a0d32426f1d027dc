//! The stages in order, for a whole scene: sheets, guesses, shooting, refinement, regimes, panels.

mod answers;
mod cells;
mod doubt;
mod panel;
mod pushes;
mod summary;

use crate::integrate::{Engine, Fallback};
use crate::plan::Plan;
use crate::rod::Side;
use crate::scene::{Scene, Whisker};
use crate::sheet::Sheet;
use crate::shooting::batch::Method;
use cells::SettledRow;
pub use panel::{Panel, STATE_CHANNELS};
use pushes::Pushes;
use rayon::prelude::*;
pub use summary::{Shots, Stage, Summary};

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

/// Computes every panel of `scene` as `plan` says, on the threads of the current pool, best from within it
/// (`rayon::ThreadPool::install`): from outside, every stage of every strip of rows wakes it up. `engine` shoots before the
/// refinement; without one, or where it fails, the CPU does it all.
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
    let pushes = |side: &Side| Pushes::new(&scene.grid.push_angle_deg, *side);
    let sides: Vec<Pushes> = plan.sides.iter().map(pushes).collect();
    for group in scene.whisker_groups(plan.panels_at_once) {
        let whiskers: Vec<Whisker> = group.into_iter().map(|(_, whisker)| whisker).collect();
        let faces = summary.time(Stage::Sheets, || {
            faces(scene, plan.method, &whiskers, &sides)
        });
        let mut panels = vec![Panel::unresolved(width * height); whiskers.len()];
        let rows = (0..faces.len()).flat_map(|face| (0..height).map(move |row| (face, row)));
        for strip in rows.collect::<Vec<_>>().chunks(rows_at_once) {
            let settled = cells::settle(plan.method, &faces, strip, &mut engine, &mut summary);
            summary.time(Stage::Regimes, || {
                answers::fill(width, &whiskers, &faces, sides.len(), &settled, &mut panels);
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
    whiskers: &[Whisker],
    sides: &'a [Pushes],
) -> Vec<Face<'a>> {
    let of_whisker = |whisker| sides.iter().map(move |side| (whisker, side));
    let pairs: Vec<(&Whisker, &'a Pushes)> = whiskers.iter().flat_map(of_whisker).collect();
    let face = |&(whisker, pushes): &(&Whisker, &'a Pushes)| {
        let rod = whisker.rod(&scene.pole, pushes.side);
        let distances = scene.grid.distance_mm.iter();
        let distances: Vec<f64> = distances.map(|d| d / whisker.length_mm).collect();
        let sheet = Sheet::new(method, &rod, pushes.side, &distances);
        Face { pushes, sheet }
    };
    pairs.par_iter().map(face).collect()
}
