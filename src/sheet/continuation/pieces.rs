//! Which crossings of a row belong together. With friction or strong curvature `D` can have a saddle on the edge of the sheet: the
//! level curve of a row is then in several pieces, whose push angles may overlap.

use crate::sheet::continuation::level_curve::{LevelCurve, Node};
use crate::sheet::row::Crossing;

/// How far apart, relative to contact and load, two crossings are at most if they are the same.
const SAME: f64 = 1e-5;

/// A part of a level curve on the stable sheet, in the direction of growing push angles.
#[derive(Clone, Debug)]
pub struct StablePiece {
    /// Where it begins; `None` for first touch.
    pub begin: Option<Crossing>,
    /// Where it ends.
    pub end: Crossing,
    /// Its nodes, in this direction or the other.
    pub nodes: Vec<Node>,
}

/// The pieces of a row with these `crossings`, which tell where to look; that from first touch comes first if the row `touches`.
/// A piece on which the continuation gets lost is left out; none are left if it is the one from first touch.
pub fn stable_pieces(
    level: &LevelCurve,
    touches: bool,
    crossings: &[Crossing],
) -> Vec<StablePiece> {
    let mut pieces: Vec<StablePiece> = Vec::new();
    if touches {
        let at_touch = crossings.iter().copied().find(Crossing::is_at_touch);
        let at_touch = at_touch.map(|end| (end, Vec::new()));
        let Some((end, nodes)) = at_touch.or_else(|| end_of_piece(level, level.touch()?)) else {
            return Vec::new();
        };
        pieces.push(StablePiece {
            begin: None,
            end,
            nodes,
        });
    }
    for from in crossings {
        let is_known = |crossing: &Crossing| {
            let ends = |piece: &StablePiece| [piece.begin, Some(piece.end)];
            let mut known = pieces.iter().flat_map(ends).flatten();
            known.any(|other| same(crossing, &other))
        };
        let Some(from) = entry(level, from).filter(|from| !is_known(from)) else {
            continue;
        };
        let Some(start) = level.at_crossing(&from) else {
            continue;
        };
        // From where a piece ends, the way on leads nowhere, and the way back to where it begins.
        let leads = |(end, _): &(Crossing, Vec<Node>)| !same(&from, end);
        if let Some((end, nodes)) = end_of_piece(level, start).filter(leads) {
            pieces.push(StablePiece {
                begin: Some(from),
                end,
                nodes,
            });
        } else if let Some((begin, nodes)) = end_of_piece(&level.backward(), start).filter(leads)
            && !is_known(&begin)
        {
            pieces.push(StablePiece {
                begin: Some(begin),
                end: from,
                nodes,
            });
        }
    }
    pieces
}

/// `crossing` itself, or, if it is only near the level curve, where the piece begins that it is near to.
fn entry(level: &LevelCurve, crossing: &Crossing) -> Option<Crossing> {
    if crossing.is_sound() {
        return Some(*crossing);
    }
    let (begin, _) = end_of_piece(&level.backward(), level.at_crossing(crossing)?)?;
    Some(begin)
}

/// Where the piece of the level curve that begins at `start` ends, and its nodes.
fn end_of_piece(level: &LevelCurve, start: Node) -> Option<(Crossing, Vec<Node>)> {
    let piece = level.continuation(start, false)?;
    let end = piece.nodes.last()?;
    let distance = end.full.map.pole.length();
    let crossing = Crossing {
        edge: piece.end,
        tau: end.point.x,
        load: end.point.y,
        push: level.side.sign() * end.push,
        residual: (level.row.pole_distance / distance).ln().abs(),
    };
    Some((crossing, piece.nodes))
}

fn same(one: &Crossing, other: &Crossing) -> bool {
    let load = (one.load - other.load).abs() / one.load.abs();
    one.edge == other.edge && load + (one.tau / other.tau - 1.0).abs() < SAME
}
