//! Cells in doubt, solved once more by continuation along the level curve of their row.
//!
//! A row of the net has one contact at each load, and its guesses can miss where the level curve turns back, as with friction. Continuation needs
//! no guesses. It costs some hundred trajectories a row, so only rows with a cell in doubt are followed.

use crate::classify::{Outcome, RowBoundary, TIE};
use crate::engine::{RowCells, WhiskerSide};
use crate::refine::{ContactState, TOLERANCE};
use crate::sheet::{CurveNode, Edge, LevelCurve, NODE_MISS, ON_CURVE, Stretch, continuations};

/// Solves the cells in some `columns` of `row` once more by continuation. Cells that no continuation reaches stay as they are.
pub fn solve(
    side: &WhiskerSide,
    row: usize,
    boundary: &RowBoundary,
    columns: &[usize],
    cells: &mut RowCells,
) {
    let sheet = &side.sheet;
    let level = sheet.level(row);
    let sign = sheet.side.sign();
    let starts = boundary.spans().iter().map(|span| {
        let start = match &span.begin {
            None => level.touch(),
            Some(begin) => level.at_crossing(begin)?,
        };
        Some((&level, start))
    });
    // Nodes only bracket the states of cells.
    let followed = continuations(&starts.collect::<Vec<_>>(), Stretch::Stable, NODE_MISS);
    let pieces = boundary.spans().iter().zip(followed).map(|(span, piece)| {
        let piece = piece.filter(|path| path.crossing().is_some_and(|end| end.is_same(&span.end)));
        piece.map(|path| path.nodes)
    });
    let pieces: Vec<Option<Vec<CurveNode>>> = pieces.collect();
    for &column in columns {
        let (push, signed_push) = (side.columns.pushes[column], side.columns.signed_push(column));
        let steps = cells.steps[column];
        let solved = |state: &ContactState| side.solved(row, signed_push, state, steps, true);
        let mut spans = boundary.spans().iter().zip(&pieces);
        match spans.find(|(span, _)| span.contains(push)) {
            Some((span, Some(nodes))) => {
                let [first, last] = [0, nodes.len() - 1].map(|i| sign * nodes[i].signed_push);
                if push > last {
                    cells.outcome[column] = beyond(span.end.edge);
                } else {
                    let node = level.state_at_push(nodes, sign * push.max(first));
                    let state = node.map(|node| state(&level, &node, signed_push));
                    if let Some(state) = state.filter(|state| state.residual <= TOLERANCE) {
                        cells.set(column, &solved(&state));
                    }
                }
            }
            // Every piece of the level curve has been followed from end to end, and none has this push angle.
            None if pieces.iter().all(Option::is_some) => {
                let end = boundary.detachment();
                cells.outcome[column] = end.map_or(Outcome::OffSheet, |span| beyond(span.end.edge));
            }
            _ => {}
        }
        if !cells.outcome[column].is_solved()
            && push <= TIE
            && boundary.detachment().is_some()
            && let Some(state) = first_touch(&level, signed_push)
        {
            cells.set(column, &solved(&state));
        }
    }
}

/// First touch is known from the shape at rest; its residual is the error of the integration, largest at the tip of a cone. A Newton
/// step from there mostly leaves a smaller one.
fn first_touch(level: &LevelCurve, signed_push: f64) -> Option<ContactState> {
    let touch = level.touch();
    let map = &touch.full.map;
    let step = map.solve(map.residual(level.row.pole(signed_push)));
    let stepped = level.correct(&[touch.point + step], ON_CURVE).pop()?;
    let stepped =
        stepped.map(|(point, full)| level.node(point, &full, touch.signed_push, touch.angle));
    [Some(touch), stepped]
        .into_iter()
        .flatten()
        .map(|node| state(level, &node, signed_push))
        .filter(|state| state.residual.is_finite())
        .min_by(|a, b| a.residual.total_cmp(&b.residual))
}

const fn beyond(edge: Edge) -> Outcome {
    match edge {
        Edge::Fold => Outcome::BeyondFold,
        Edge::Tip => Outcome::BeyondTip,
    }
}

fn state(level: &LevelCurve, node: &CurveNode, signed_push: f64) -> ContactState {
    ContactState {
        point: node.point,
        full: node.full,
        residual: node.full.map.pole.distance(level.row.pole(signed_push)),
    }
}
