//! Whisker sides of a map: columns, sheets, derivatives and nets.

use crate::engine::{SideColumns, WhiskerSide};
use crate::plan::Plan;
use crate::scene::{Parameter, Scene, SweptWhisker};
use crate::sensitivity::of_rows;
use crate::sheet::{Sheet, SheetRequest, SheetUse};
use rayon::prelude::*;
use std::sync::Arc;
use whiskmap_mechanics::shooting::batch::Method;

/// Net that a side gets with its sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SideNet {
    /// For guesses of all cells.
    Guesses,
    /// For guesses, and with values whose rows have a residual of at most this many whisker lengths.
    Values(f64),
    /// For known rows, of which few cells need guesses.
    KnownRows,
}

/// Computes every side of some `whiskers` of `scene` with this `net`, whisker by whisker, with the derivatives of the plan.
pub fn whisker_sides(
    scene: &Scene,
    (plan, method, net): (&Plan, Method, SideNet),
    columns: &[Arc<SideColumns>],
    whiskers: &[SweptWhisker],
) -> Vec<WhiskerSide> {
    let of_whisker = |swept| columns.iter().map(move |columns| (swept, columns));
    let pairs: Vec<_> = whiskers.iter().flat_map(of_whisker).collect();
    let grid = &scene.grid;
    let derivatives: Vec<Parameter> = plan.channels.derivatives().collect();
    let serves = match net {
        SideNet::KnownRows => SheetUse::KnownRows,
        SideNet::Guesses | SideNet::Values(_) => SheetUse::Guesses,
    };
    let request = |(swept, columns): &(&SweptWhisker, &Arc<SideColumns>)| {
        let distances = grid.distance_mm.iter();
        SheetRequest {
            rod: swept.rod(columns.side),
            side: columns.side,
            distances: distances.map(|d| d / swept.whisker.length_mm).collect(),
            serves,
        }
    };
    let sheets = Sheet::several(method, pairs.iter().map(request).collect());
    let sides = pairs.into_par_iter().zip(sheets);
    let sides = sides.map(|((swept, columns), sheet)| {
        let mut side = WhiskerSide::new(Arc::clone(columns), swept.whisker.units(), sheet);
        if !derivatives.is_empty() {
            let (resolution, sheet) = (method.resolution, &side.sheet);
            let pushed = (&swept.whisker, &swept.pole);
            side.push_derivatives =
                of_rows(resolution, sheet, pushed, &grid.distance_mm, &derivatives);
        }
        match net {
            SideNet::Values(most) => side.with_net(most),
            SideNet::Guesses | SideNet::KnownRows => side,
        }
    });
    sides.collect()
}
