//! The stages in order, for a whole scene: sheets, an engine's cells, guesses and refinement of all others, regimes, panels.

mod answers;
mod audit;
mod cells;
mod channels;
mod doubt;
mod panel;
mod pushes;
mod strip;
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
use std::ops::Range;
use std::time::Instant;
pub use summary::{Audit, EngineCells, Stage, Summary};

/// Cells in flight for each thread where no engine shoots: so many that nearly all blocks of the refinement are full, and
/// hardly a page of memory is new for them.
const CELLS_OF_A_THREAD: usize = 8192;

/// One side of one whisker.
struct Face<'a> {
    pushes: &'a Pushes,
    sheet: Sheet,
}

/// Computes the panels of `scene` as `plan` says, on the threads of the current pool, best from within it
/// (`rayon::ThreadPool::install`): from outside, every stage of every strip of rows wakes it up. `engine` solves
/// cells in place of the refinement; without one, or where it fails, the CPU does it all. `settled` hears how many more cells are settled; `keep` gets the
/// finished panels, in the order of the sweep, while the next ones are computed: it holds at most one group of them.
///
/// # Errors
/// What `keep` refuses panels with, which ends the run; a cell without an answer is no error.
pub fn run<E: Send>(
    scene: &Scene,
    plan: &Plan,
    engine: Option<&mut dyn Engine>,
    settled: &mut dyn FnMut(usize),
    keep: &mut (dyn FnMut(Vec<Panel>) -> Result<(), E> + Send),
) -> Result<Summary, E> {
    let mut run = Run::new(scene, plan, engine);
    let mut finished: Option<Vec<Panel>> = None;
    for group in plan.groups() {
        let (before, mut kept) = (finished.take(), Ok(()));
        let computed = rayon::in_place_scope(|scope| {
            scope.spawn(|_| kept = before.map_or(Ok(()), &mut *keep));
            finished = Some(run.compute(group, settled));
            Instant::now()
        });
        run.summary.add(Stage::Files, computed.elapsed());
        kept?;
    }
    let last = || finished.map_or(Ok(()), keep);
    run.summary.time(Stage::Files, last)?;
    let mut summary = run.summary;
    summary.engine_failure = run.engine.failure;
    Ok(summary)
}

/// A run under way.
struct Run<'a, 'e> {
    scene: &'a Scene,
    plan: &'a Plan,
    engine: Fallback<'e>,
    rows_at_once: usize,
    sides: Vec<Pushes>,
    /// Signed push angles of the columns of all sides.
    angles: Vec<f64>,
    summary: Summary,
}

impl<'a, 'e> Run<'a, 'e> {
    fn new(scene: &'a Scene, plan: &'a Plan, engine: Option<&'e mut dyn Engine>) -> Self {
        let rows_at_once = match engine {
            Some(_) => plan.rows_at_once,
            None => {
                let cells = CELLS_OF_A_THREAD * rayon::current_num_threads();
                let rows = cells / scene.grid.push_angle_deg.len();
                rows.clamp(1, plan.rows_at_once)
            }
        };
        let mut sides: Vec<Pushes> = Vec::new();
        let mut angles: Vec<f64> = Vec::new();
        for side in &plan.sides {
            // A row has fewer columns than `u32` can count.
            let side = Pushes::new(&scene.grid.push_angle_deg, *side, angles.len() as u32);
            angles.extend(side.columns.iter().map(|push| push.angle));
            sides.push(side);
        }
        let failure = None;
        Self {
            scene,
            plan,
            engine: Fallback { engine, failure },
            rows_at_once,
            sides,
            angles,
            summary: Summary::default(),
        }
    }

    /// The panels of some whiskers.
    fn compute(&mut self, group: Range<usize>, settled: &mut dyn FnMut(usize)) -> Vec<Panel> {
        let Self {
            scene,
            plan,
            sides,
            angles,
            summary,
            ..
        } = self;
        let width = scene.grid.push_angle_deg.len();
        let height = scene.grid.distance_mm.len();
        let group: Vec<Swept> = group.map(|index| scene.whisker(index)).collect();
        let faces = summary.time(Stage::Sheets, || faces(scene, plan.method, &group, sides));
        let mut panels = vec![Panel::unresolved(width * height, plan.channels); group.len()];
        let rows = (0..faces.len()).flat_map(|face| (0..height).map(move |row| (face, row)));
        for strip in rows.collect::<Vec<_>>().chunks(self.rows_at_once) {
            let cells = strip::settle(
                plan.method,
                &faces,
                angles,
                strip,
                &mut self.engine,
                summary,
            );
            summary.time(Stage::Regimes, || {
                answers::fill(width, &group, &faces, sides.len(), &cells, &mut panels);
            });
            let columns = |row: &SettledRow| faces[row.face].pushes.columns.len();
            settled(cells.rows.iter().map(columns).sum());
        }
        for panel in &panels {
            summary.count(panel);
        }
        panels
    }
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
