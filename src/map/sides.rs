//! Whisker sides of a map: columns, sheets, derivatives and nets.

use crate::engine::{SideColumns, WhiskerSide};
use crate::plan::Plan;
use crate::scene::{Parameter, Scene, SweptWhisker};
use crate::sensitivity::of_rows;
use crate::sheet::{Sheet, SheetRequest, SheetUse};
use rayon::prelude::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap_mechanics::shooting::batch::Method;

/// Computes every side of some `whiskers` of `scene`, whisker by whisker, with the derivatives of the plan. Sheets are for the use `serves`. With
/// `most`, a side also has a net of values, whose rows have a residual of at most `most` whisker lengths. If `cancel` is true,
/// the function soon returns `None`.
pub fn whisker_sides(
    scene: &Scene,
    (plan, method): (&Plan, Method),
    (serves, most): (SheetUse, Option<f64>),
    columns: &[Arc<SideColumns>],
    whiskers: &[SweptWhisker],
    cancel: &AtomicBool,
) -> Option<Vec<WhiskerSide>> {
    let of_whisker = |swept| columns.iter().map(move |columns| (swept, columns));
    let pairs: Vec<_> = whiskers.iter().flat_map(of_whisker).collect();
    let grid = &scene.grid;
    let derivatives: Vec<Parameter> = plan.channels.derivatives().collect();
    let request = |(swept, columns): &(&SweptWhisker, &Arc<SideColumns>)| {
        let distances = grid.distance_mm.iter();
        SheetRequest {
            rod: swept.rod(columns.side),
            side: columns.side,
            distances: distances.map(|d| d / swept.whisker.length_mm).collect(),
            serves,
        }
    };
    let sheets = Sheet::several(method, pairs.iter().map(request).collect(), cancel)?;
    let sides = pairs.into_par_iter().zip(sheets);
    let sides = sides.map(|((swept, columns), sheet)| {
        if cancel.load(Ordering::Relaxed) {
            return None;
        }
        let mut side = WhiskerSide::new(Arc::clone(columns), swept.whisker.units(), sheet);
        if !derivatives.is_empty() {
            let (resolution, sheet) = (method.resolution, &side.sheet);
            let pushed = (&swept.whisker, &swept.pole);
            side.push_derivatives =
                of_rows(resolution, sheet, pushed, &grid.distance_mm, &derivatives);
        }
        Some(match most {
            Some(most) => side.with_net(most),
            None => side,
        })
    });
    sides.collect()
}
