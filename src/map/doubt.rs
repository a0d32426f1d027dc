//! Cells in doubt, settled once more by continuation along the level curve of their row.
//!
//! The lattice follows a row from load to load, and its guesses can miss in two places: where a level curve runs almost
//! along a line of constant load, as near the tip of a perfect cone, and where it turns back, as with friction.
//! Continuation needs no guesses. It costs some hundred trajectories a row, so only rows with a cell in doubt are followed.

use super::cells::{Cell, State};
use crate::classify::{RowBoundary, Status};
use crate::refine::{ContactState, TOLERANCE};
use crate::sheet::{Edge, LevelCurve, Node, ON_CURVE, Sheet};

/// How far, relative to contact and load, the end of a continuation may be from the boundary's. The two are computed apart, and
/// the boundary in blocks that may take more steps: they differ by the error of the resolution.
const SAME_END: f64 = 1e-5;

/// Settles `cells` of `row` again. Cells that no continuation reaches keep what they have.
pub fn settle<'a, 'b: 'a>(
    sheet: &Sheet,
    row: usize,
    boundary: &RowBoundary,
    cells: impl Iterator<Item = &'a mut Cell<'b>>,
) {
    let level = sheet.level(row);
    let sign = sheet.side.sign();
    let parts: Vec<Option<Vec<Node>>> = boundary
        .spans()
        .iter()
        .enumerate()
        .map(|(index, span)| {
            let start = if sheet.touches(row) && index == 0 {
                level.touch()?
            } else {
                let entry = sheet.crossings[row].iter().find(|c| c.push == span.from)?;
                level.at_crossing(entry)?
            };
            let piece = level.continuation(start, false)?;
            let end = piece.nodes.last()?.point;
            let exit = sheet.crossings[row].iter().find(|c| c.push == span.to)?;
            let apart = (end.x / exit.tau - 1.0).abs() + (end.y / exit.load - 1.0).abs();
            (apart < SAME_END && piece.end == span.edge).then_some(piece.nodes)
        })
        .collect();
    for cell in cells {
        let push = cell.push.angle;
        let magnitude = sign * push;
        let mut spans = boundary.spans().iter().zip(&parts);
        match spans.find(|(span, _)| span.contains(magnitude)) {
            Some((span, Some(nodes))) => {
                let [first, last] = [0, nodes.len() - 1].map(|i| sign * nodes[i].push);
                if magnitude > last {
                    cell.status = beyond(span.edge);
                } else if let Some(node) = level.state_at_push(nodes, sign * magnitude.max(first)) {
                    let state = state(&level, &node, push);
                    if state.residual <= TOLERANCE {
                        cell.status = Status::Solved;
                        cell.state = State::Refined(state);
                    }
                }
            }
            // Every piece of the level curve has been followed from end to end, and none has this push angle.
            None if parts.iter().all(Option::is_some) => {
                let end = boundary.detachment();
                cell.status = end.map_or(Status::Outside, |span| beyond(span.edge));
            }
            _ => {}
        }
        if cell.status != Status::Solved
            && cell.is_first_touch(boundary)
            && let Some(touch) = first_touch(&level, push)
        {
            cell.status = Status::Solved;
            cell.state = State::Refined(touch);
        }
    }
}

/// First touch is known from the shape at rest; its residual is the error of the integration, largest at the tip of a cone. A Newton
/// step from there mostly leaves a smaller one.
fn first_touch(level: &LevelCurve, push: f64) -> Option<ContactState> {
    let touch = level.touch()?;
    let map = &touch.full.map;
    let step = map.solve(map.residual(level.row.pole(push)));
    let stepped = level.correct(&[touch.point + step], ON_CURVE).pop()?;
    let stepped = stepped.map(|(point, full)| level.node(point, &full, touch.push, touch.angle));
    [Some(touch), stepped]
        .into_iter()
        .flatten()
        .map(|node| state(level, &node, push))
        .filter(|state| state.residual.is_finite())
        .min_by(|a, b| a.residual.total_cmp(&b.residual))
}

fn beyond(edge: Edge) -> Status {
    match edge {
        Edge::Fold => Status::BeyondFold,
        Edge::Tip => Status::BeyondTip,
    }
}

fn state(level: &LevelCurve, node: &Node, push: f64) -> ContactState {
    ContactState {
        tau: node.point.x,
        load: node.point.y,
        full: node.full,
        residual: node.full.map.pole.distance(level.row.pole(push)),
    }
}
