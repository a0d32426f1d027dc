//! The stages in order, for a whole scene: sheets, guesses, shooting, refinement, regimes, panels.

mod cells;
mod doubt;
mod panel;
mod pushes;
mod summary;

pub use summary::Summary;

use crate::integrate::{Engine, Fallback};
use crate::model::batch::Method;
use crate::model::{Rod, Side};
use crate::plan::Plan;
use crate::scene::{Scene, Whisker};
use crate::sheet::Sheet;
use crate::store::{Error, Panel};
use cells::{Row, Strip};
use pushes::Pushes;
use rayon::prelude::*;
use summary::Stage;

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
    sheet: Option<Sheet>,
}

impl<'a> Face<'a> {
    fn new(scene: &Scene, method: Method, whisker: &Whisker, pushes: &'a Pushes) -> Self {
        let side = pushes.side;
        let rod = Rod::new(whisker, &scene.pole, side);
        let distances: Vec<f64> = scene
            .grid
            .distance_mm
            .iter()
            .map(|d| d / whisker.length_mm)
            .collect();
        let sheet = Sheet::new(method, &rod, side, &distances);
        Self { pushes, sheet }
    }
}

/// Computes every panel of `scene` as `plan` says, on the threads of the current pool, best from within it
/// (`rayon::ThreadPool::install`): from outside, every stage of every strip wakes it up. Where the engine fails the CPU goes on in its stead.
///
/// # Errors
/// What `observe` refuses panels with, which ends the run; a cell without an answer is no error.
pub fn run(
    scene: &Scene,
    plan: &Plan,
    engine: &mut dyn Engine,
    observe: &mut dyn FnMut(Progress<'_>) -> Result<(), Error>,
) -> Result<Summary, Error> {
    let mut engine = Fallback::new(engine);
    let mut summary = Summary::default();
    let width = scene.grid.push_angle_deg.len();
    let pushes = |side: &Side| Pushes::new(&scene.grid.push_angle_deg, *side);
    let sides: Vec<Pushes> = plan.sides.iter().map(pushes).collect();
    let rows_at_once = engine.shots_at_once() / width;
    let rows_at_once = rows_at_once.clamp(1, plan.rows_at_once);
    for whiskers in plan.whiskers.chunks(plan.panels_at_once) {
        let faces: Vec<Face> = summary.time(Stage::Sheets, || {
            let sides = &sides;
            let pairs: Vec<(&Whisker, &Pushes)> = whiskers
                .iter()
                .flat_map(|whisker| sides.iter().map(move |side| (whisker, side)))
                .collect();
            pairs
                .par_iter()
                .map(|(whisker, side)| Face::new(scene, plan.method, whisker, side))
                .collect()
        });
        let mut panels: Vec<Panel> = whiskers.iter().map(|_| panel::blank(scene)).collect();
        for strip in Strip::all(faces.len(), scene.grid.distance_mm.len(), rows_at_once) {
            let settled = cells::settle(plan.method, &faces, &strip, &mut engine, &mut summary);
            summary.time(Stage::Regimes, || {
                panel::fill(width, whiskers, &faces, sides.len(), &settled, &mut panels);
            });
            let columns = |row: &Row| faces[row.face].pushes.columns.len();
            observe(Progress::Settled(settled.rows.iter().map(columns).sum()))?;
        }
        for panel in &panels {
            summary.count(panel);
        }
        summary.time(Stage::Files, || observe(Progress::Panels(&panels)))?;
    }
    summary.engine_failure = engine.failure().cloned();
    Ok(summary)
}
