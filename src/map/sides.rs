//! Whisker sides of a map: columns, sheets, derivatives and nets.

use crate::engine::{Nodes, SideColumns, WhiskerSide, Worker};
use crate::plan::Plan;
use crate::scene::{Parameter, Scene, SweptWhisker};
use crate::sensitivity::of_rows;
use crate::sheet::Sheet;
use crate::sheet::net::{ValueDraft, ValueNet};
use rayon::prelude::*;
use std::sync::Arc;
use whiskmap_mechanics::rod::Side;
use whiskmap_mechanics::shooting::PlainState;
use whiskmap_mechanics::shooting::batch::Method;

/// Returns the columns of each of `sides`, `[side]`, and the signed push angles of all of them, in radians.
pub fn side_columns(push_angle_deg: &[f64], sides: &[Side]) -> (Vec<Arc<SideColumns>>, Arc<[f64]>) {
    let mut pushes: Vec<f64> = Vec::new();
    let columns = sides.iter().map(|side| {
        // A row has fewer columns than `u32` can count.
        let side = SideColumns::new(push_angle_deg, *side, pushes.len() as u32);
        pushes.extend(side.columns.iter().map(|column| column.push));
        Arc::new(side)
    });
    (columns.collect(), pushes.into())
}

/// Computes every side of some `whiskers` of `scene`, whisker by whisker, with the channels of the plan. If an engine evaluates
/// rows, each side gets a `net` with this residual, in whisker lengths; a device of `worker` integrates its trajectories.
pub fn whisker_sides(
    scene: &Scene,
    (plan, method, net): (&Plan, Method, Option<f64>),
    columns: &[Arc<SideColumns>],
    whiskers: &[SweptWhisker],
    worker: &mut Worker,
) -> Arc<[WhiskerSide]> {
    let of_whisker = |swept| columns.iter().map(move |columns| (swept, columns));
    let pairs: Vec<_> = whiskers.iter().flat_map(of_whisker).collect();
    let grid = &scene.grid;
    let derivatives: Vec<Parameter> = plan.channels.derivatives().collect();
    let shoots = worker.shoots();
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
        match net {
            Some(most) if !shoots => side.with_net(most),
            _ => side,
        }
    });
    let sides: Vec<WhiskerSide> = sides.collect();
    match net {
        Some(most) if shoots => with_nets(sides, method, most, worker),
        _ => sides.into(),
    }
}

/// Adds nets with a residual of at most `most` whisker lengths to `sides`. In each round, the engine of `worker` integrates the trajectories that
/// the panels of all sides need next; after its failure, the CPU does.
fn with_nets(
    sides: Vec<WhiskerSide>,
    method: Method,
    most: f64,
    worker: &mut Worker,
) -> Arc<[WhiskerSide]> {
    let drafts = sides.par_iter().map(|side| side.draft(most));
    let mut drafts: Vec<Option<ValueDraft>> = drafts.collect();
    loop {
        let points = drafts.par_iter_mut();
        let points = points.map(|own| own.as_mut().map_or_else(Vec::new, ValueDraft::nodes));
        let nodes = Arc::new(Nodes {
            method,
            rods: sides.iter().map(|side| side.sheet.rod.clone()).collect(),
            points: points.collect(),
        });
        if nodes.count() == 0 {
            break;
        }
        let counts: Vec<usize> = nodes.points.iter().map(Vec::len).collect();
        let states = worker.shoot_nodes(&nodes).unwrap_or_else(|| nodes.shoot());
        let mut rest = &states[..];
        let parts = counts
            .into_iter()
            .map(|count| rest.split_off(..count).unwrap_or_default());
        let parts: Vec<&[PlainState]> = parts.collect();
        let taken = drafts.par_iter_mut().zip(parts);
        taken.for_each(|(draft, states)| {
            if let Some(draft) = draft {
                draft.take(states);
            }
        });
    }
    let nets = drafts.into_par_iter().map(|own| own?.finish());
    let nets: Vec<Option<ValueNet>> = nets.collect();
    let all = sides.into_iter().zip(nets);
    all.map(|(side, net)| side.with(net)).collect()
}
