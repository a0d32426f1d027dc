//! Which crossings of a row belong together.
//!
//! With friction or strong curvature `D` can have a saddle on the edge of the sheet. The level curve of a row is then in
//! several pieces, whose push angles may overlap, and only walking along them tells which crossings they connect.

use crate::sheet::continuation::branch_steps::walk;
use crate::sheet::continuation::level_curve::{LevelCurve, Node};
use crate::sheet::edges::crossings::Crossing;

/// How far apart, relative to contact and load, two crossings are at most if they are the same.
const SAME: f64 = 1e-5;

/// The `crossings` of a row in pairs, but for the first, where a push from first touch ends if the row `touches`. A piece
/// that cannot be walked is left out; none are left if it is the one from first touch.
pub fn connect(level: &LevelCurve, touches: bool, crossings: &[Crossing]) -> Vec<Crossing> {
    let mut connected = Vec::new();
    if touches {
        let at_touch = crossings.iter().copied().find(Crossing::is_at_touch);
        let end = at_touch.or_else(|| follow(level, level.touch()?));
        let Some(end) = end else {
            return Vec::new();
        };
        connected.push(end);
    }
    for from in crossings {
        let known = |crossing: &Crossing| connected.iter().any(|other| same(crossing, other));
        let Some(from) = entry(level, from).filter(|from| !known(from)) else {
            continue;
        };
        let Some(start) = level.at(&from) else {
            continue;
        };
        // From where a piece ends, the way on leads nowhere, and the way back to where it begins.
        let leads = |end: &Crossing| !same(&from, end);
        if let Some(end) = follow(level, start).filter(leads) {
            connected.extend([from, end]);
        } else if let Some(begin) = follow(&backward(level), start).filter(leads)
            && !connected.iter().any(|other| same(&begin, other))
        {
            connected.extend([begin, from]);
        }
    }
    connected
}

/// `crossing` itself, or, if it is only near the level curve, where the piece begins that it is near to.
fn entry(level: &LevelCurve, crossing: &Crossing) -> Option<Crossing> {
    if crossing.is_sound() {
        return Some(*crossing);
    }
    follow(&backward(level), level.at(crossing)?)
}

fn backward(level: &LevelCurve) -> LevelCurve {
    LevelCurve {
        forward: false,
        ..*level
    }
}

/// Where the piece of the level curve that begins at `start` ends.
fn follow(level: &LevelCurve, start: Node) -> Option<Crossing> {
    let walk = walk(level, start, false)?;
    let end = walk.nodes.last()?;
    let distance = end.full.map.pole.length();
    Some(Crossing {
        edge: walk.end,
        tau: end.point.x,
        load: end.point.y,
        push: level.side.sign() * end.push,
        residual: (level.row.pole_distance / distance).ln().abs(),
    })
}

fn same(one: &Crossing, other: &Crossing) -> bool {
    let load = (one.load - other.load).abs() / one.load.abs();
    one.edge == other.edge && load + (one.tau / other.tau - 1.0).abs() < SAME
}
