//! Whisker sides of a map: columns, sheets, derivatives and nets.

use crate::engine::{SideColumns, WhiskerSide};
use crate::plan::Plan;
use crate::scene::{Parameter, Scene, SweptWhisker};
use crate::sensitivity::of_rows;
use crate::sheet::Sheet;
use rayon::prelude::*;
use std::sync::Arc;
use whiskmap_mechanics::shooting::batch::Method;

/// Computes every side of some `whiskers` of `scene`, whisker by whisker, with the derivatives of the plan. If an engine evaluates
/// rows, each side gets a net whose rows have at most `row_residual`, in whisker lengths.
pub fn whisker_sides(
    scene: &Scene,
    (plan, method, row_residual): (&Plan, Method, Option<f64>),
    columns: &[Arc<SideColumns>],
    whiskers: &[SweptWhisker],
) -> Vec<WhiskerSide> {
    let of_whisker = |swept| columns.iter().map(move |columns| (swept, columns));
    let pairs: Vec<_> = whiskers.iter().flat_map(of_whisker).collect();
    let grid = &scene.grid;
    let derivatives: Vec<Parameter> = plan.channels.derivatives().collect();
    let sides = pairs.into_par_iter().map(|(swept, columns)| {
        let rod = swept.rod(columns.side);
        let distances = grid.distance_mm.iter();
        let distances: Vec<f64> = distances.map(|d| d / swept.whisker.length_mm).collect();
        let sheet = Sheet::new(method, &rod, columns.side, &distances);
        let mut side = WhiskerSide::new(Arc::clone(columns), swept.whisker.units(), sheet);
        if !derivatives.is_empty() {
            let (resolution, sheet) = (method.resolution, &side.sheet);
            let pushed = (&swept.whisker, &swept.pole);
            side.push_derivatives =
                of_rows(resolution, sheet, pushed, &grid.distance_mm, &derivatives);
        }
        match row_residual {
            Some(most) => side.with_net(most),
            None => side,
        }
    });
    sides.collect()
}
