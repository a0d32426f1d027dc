//! Along a level curve, through the fold to the end of the branch, in steps that suit the curve.

use crate::sheet::continuation::level_curve::{LevelCurve, Node, ON_CURVE};
use crate::sheet::edges::edge_newton::{Edge, Wanted, seek_finely};
use glam::DVec2;

/// Nodes are about this far apart.
const STEP: f64 = 0.05;

/// Neighbouring chords make at most this angle, unless they are short, so that their length is that of the curve.
const SHARPEST_TURN: f64 = 0.1;

/// Chords shorter than this may turn as they like: after a longer one, no step is short enough not to.
const SHORT: f64 = 0.01 * STEP;

/// The first step of the continuation, relative to contact and load.
const FIRST_STEP: f64 = 0.05;

/// A step that has become this short leads nowhere.
const SHORTEST_STEP: f64 = 1e-9;

/// Most nodes: no branch known has more than 300.
const MOST_NODES: usize = 10_000;

/// A branch as it was walked.
#[derive(Clone, Debug)]
pub struct Walk {
    /// From the start on.
    pub nodes: Vec<Node>,
    /// Index of the fold; `None` where the tip comes first.
    pub fold: Option<usize>,
    /// What the last node is.
    pub end: Edge,
}

/// What `ln D` may miss at the tip, where moving the contact would do more harm.
const TIP_MISS: f64 = 1e-11;

/// Walks along `level` from `start` in the direction of growing push angles, past the fold or only to it; `None` where
/// the continuation gets lost.
#[must_use]
pub fn walk(level: &LevelCurve, start: Node, past_fold: bool) -> Option<Walk> {
    let mut nodes = vec![start];
    let mut fold = None;
    let mut step = FIRST_STEP;
    while nodes.len() < MOST_NODES && step > SHORTEST_STEP {
        let last = *nodes.last()?;
        let next = level.step(&last, step);
        let fits = |next: &Node| {
            let chord = level.place(next) - level.place(&last);
            let before = nodes.iter().rev().nth(1);
            let turn = before.map_or(0.0, |before| {
                chord.angle_between(level.place(&last) - level.place(before))
            });
            chord.length() < 2.0 * STEP && (turn < SHARPEST_TURN || chord.length() < SHORT)
        };
        let Some(next) = next.filter(fits) else {
            step *= 0.5;
            continue;
        };
        let (edge, node) = match meet(level, &last, &next, fold.is_none()) {
            Meeting::None => {
                step *= (STEP / level.length(&last, &next)).clamp(0.5, 2.0);
                nodes.push(next);
                continue;
            }
            Meeting::Unclear => {
                step *= 0.5;
                continue;
            }
            Meeting::Edge(edge, node) => (edge, node),
        };
        // Two nodes next to each other are a poor base for interpolation.
        if let [.., before, _] = nodes[..]
            && fold != Some(nodes.len() - 1)
            && level.length(&last, &node) < 0.2 * level.length(&before, &last)
        {
            nodes.pop();
        }
        nodes.push(node);
        let first_fold = edge == Edge::Fold && fold.is_none();
        if first_fold {
            fold = Some(nodes.len() - 1);
        }
        if !(first_fold && past_fold) {
            return Some(Walk {
                nodes,
                fold,
                end: edge,
            });
        }
    }
    None
}

/// What lies between two nodes.
enum Meeting {
    None,
    Edge(Edge, Node),
    /// An edge, but Newton's method did not find it from here.
    Unclear,
}

/// The first edge between two nodes of the stable or the unstable part.
fn meet(level: &LevelCurve, from: &Node, to: &Node, stable: bool) -> Meeting {
    let mut met = Meeting::None;
    if to.point.x > level.rod.tau_tip() {
        let Some(tip) = edge(level, Edge::Tip, from, to) else {
            return Meeting::Unclear;
        };
        met = Meeting::Edge(Edge::Tip, tip);
    }
    if (to.full.map.det() < 0.0) == stable {
        match edge(level, Edge::Fold, from, to) {
            None => return Meeting::Unclear,
            Some(fold) if fold.point.x <= level.rod.tau_tip() => {
                met = Meeting::Edge(Edge::Fold, fold);
            }
            Some(_) => {}
        }
    }
    met
}

/// The point of an edge between two nodes; `None` if Newton's method found none, or one somewhere else.
fn edge(level: &LevelCurve, edge: Edge, from: &Node, to: &Node) -> Option<Node> {
    let height = |node: &Node| match edge {
        Edge::Fold => node.full.map.det(),
        Edge::Tip => node.point.x - level.rod.tau_tip(),
    };
    let part = height(from) / (height(from) - height(to));
    let start = from.point.lerp(to.point, part.clamp(0.0, 1.0));
    let start = match edge {
        Edge::Fold => start,
        Edge::Tip => DVec2::new(level.rod.tau_tip(), start.y),
    };
    let wanted = Wanted {
        rod: &level.rod,
        edge,
        pole_distance: level.row.pole_distance,
        from: start,
    };
    let sought = *seek_finely(level.method, &[wanted]).first()?;
    // At a fold rounding can leave Newton's method a little beside the curve; at the tip it is on it.
    let tolerance = match edge {
        Edge::Fold => ON_CURVE,
        Edge::Tip => TIP_MISS,
    };
    let (point, full) = level.settle(&[sought.point], tolerance).pop()??;
    let node = level.node(point, &full, from.push, from.angle);
    let reach = 2.0 * level.length(from, to) + f64::EPSILON;
    let near = level.length(from, &node).max(level.length(to, &node)) <= reach;
    (sought.is_found && near).then_some(node)
}
