//! Which crossings of a row belong together. With friction or strong curvature `D` can have a saddle on the edge of the sheet: the
//! level curve of a row is then in several pieces, whose push angles may overlap.

use crate::rod::Side;
use crate::sheet::continuation::level_curve::{LevelCurve, Node};
use crate::sheet::continuation::stepper::MOST_PUSH;
use crate::sheet::continuation::{Continuation, NODE_MISS, continuations};
use crate::sheet::row::Crossing;
use crate::sheet::span::{RowSpan, SpanNode};

/// How far apart, relative to contact and load, two crossings are at most if they are the same.
const SAME_CROSSING: f64 = 1e-5;

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

impl StablePiece {
    /// The piece between its nodes; `None` where the row parameter turns back, or there are too few.
    pub fn span(&self, side: Side) -> Option<RowSpan> {
        let node = |node: &Node| SpanNode {
            w: node.point.y.abs() * node.point.x * node.point.x,
            push: side.sign() * node.push,
            tau: node.point.x,
        };
        let mut nodes: Vec<SpanNode> = self.nodes.iter().map(node).collect();
        nodes.sort_by(|a, b| a.push.total_cmp(&b.push));
        RowSpan::through(side.sign(), nodes)
    }
}

/// A row to be continued.
#[derive(Clone, Copy, Debug)]
pub struct ContinuedRow<'a> {
    /// Its level curve.
    pub level: &'a LevelCurve,
    /// Whether it has a first touch.
    pub touches: bool,
    /// Its crossings as far as they are known, which tell where to look.
    pub crossings: &'a [Crossing],
}

/// The pieces of a row; that from first touch comes first.
#[derive(Clone, Debug, Default)]
pub struct StablePieces {
    /// Those that were followed; none where it was not possible from first touch.
    pub pieces: Vec<StablePiece>,
    /// Whether these are all: no continuation was lost.
    pub are_complete: bool,
}

impl StablePieces {
    /// Whether one of them begins or ends at `crossing`.
    fn have_end(&self, crossing: &Crossing) -> bool {
        let ends = |piece: &StablePiece| [piece.begin, Some(piece.end)];
        let mut known = self.pieces.iter().flat_map(ends).flatten();
        known.any(|other| same(crossing, &other))
    }
}

/// The pieces of all `rows`, whose trajectories share batches. No answer depends on the other rows.
pub fn stable_pieces(rows: &[ContinuedRow]) -> Vec<StablePieces> {
    let mut found: Vec<StablePieces> = from_touch(rows);
    let most = rows.iter().map(|row| row.crossings.len()).max();
    for index in 0..most.unwrap_or_default() {
        let crossings: Vec<Option<Crossing>> = rows
            .iter()
            .zip(&found)
            .map(|(row, found)| {
                let is_continued = found.are_complete || !found.pieces.is_empty();
                // No cell has a push angle of several turns.
                let is_near = |crossing: &Crossing| crossing.push.abs() <= MOST_PUSH;
                let crossing = row.crossings.get(index).copied();
                crossing.filter(|crossing| is_continued && is_near(crossing))
            })
            .collect();
        through_crossings(rows, &crossings, &mut found);
    }
    found
}

/// Where a piece ends, and its nodes.
type PieceEnd = (Crossing, Vec<Node>);

fn from_touch(rows: &[ContinuedRow]) -> Vec<StablePieces> {
    let at_touch = |row: &ContinuedRow| row.crossings.iter().copied().find(Crossing::is_at_touch);
    let starts: Vec<Option<Node>> = rows
        .iter()
        .map(|row| {
            let is_continued = row.touches && at_touch(row).is_none();
            is_continued.then(|| row.level.touch()).flatten()
        })
        .collect();
    let ends = ends_of_pieces(rows, &starts, false);
    rows.iter()
        .zip(ends)
        .map(|(row, end)| {
            if !row.touches {
                return StablePieces {
                    pieces: Vec::new(),
                    are_complete: true,
                };
            }
            let end = at_touch(row).map(|end| (end, Vec::new())).or(end);
            let piece = end.map(|(end, nodes)| StablePiece {
                begin: None,
                end,
                nodes,
            });
            StablePieces {
                are_complete: piece.is_some(),
                pieces: piece.into_iter().collect(),
            }
        })
        .collect()
}

/// Adds to what was `found` the piece of each row that begins or ends at its crossing, if there is one that is not known.
fn through_crossings(
    rows: &[ContinuedRow],
    crossings: &[Option<Crossing>],
    found: &mut [StablePieces],
) {
    // A crossing that is only near the level curve stands for where the piece begins that it is near to.
    let is_sound = |crossing: &Option<Crossing>| crossing.is_some_and(|c| c.is_sound());
    let unsound = |crossing: &Option<Crossing>| crossing.filter(|c| !c.is_sound());
    let near = at_crossings(rows, &crossings.iter().map(unsound).collect::<Vec<_>>());
    let begins = ends_of_pieces(rows, &near, true);
    let entries: Vec<Option<Crossing>> = crossings
        .iter()
        .zip(near.iter().zip(begins))
        .zip(found.iter_mut())
        .map(|((crossing, (near, begin)), found)| {
            // On the unstable side there is no piece to lose.
            let may_begin = near.is_none_or(|near| near.full.map.det() > 0.0);
            let has_failed = unsound(crossing).is_some() && may_begin && begin.is_none();
            found.are_complete &= !has_failed;
            let entry = crossing.filter(|_| is_sound(crossing));
            let entry = entry.or(begin.map(|(begin, _)| begin));
            entry.filter(|entry| !found.have_end(entry))
        })
        .collect();
    let starts = at_crossings(rows, &entries);
    let ahead = ends_of_pieces(rows, &starts, false);
    // From where a piece ends, the way on leads nowhere, and the way back to where it begins.
    let leads = |entry: &Crossing, end: Option<PieceEnd>| end.filter(|(end, _)| !same(entry, end));
    let ahead: Vec<Option<PieceEnd>> = entries
        .iter()
        .zip(ahead)
        .map(|(entry, end)| leads(entry.as_ref()?, end))
        .collect();
    let back: Vec<Option<Node>> = starts
        .iter()
        .zip(&ahead)
        .map(|(start, ahead)| start.filter(|_| ahead.is_none()))
        .collect();
    let behind = ends_of_pieces(rows, &back, true);
    for (i, found) in found.iter_mut().enumerate() {
        let Some(entry) = entries[i] else { continue };
        let piece = match (&ahead[i], &behind[i]) {
            (Some((end, nodes)), _) => Some((Some(entry), *end, nodes)),
            (None, Some((begin, nodes))) if !same(&entry, begin) => {
                let is_new = !found.have_end(begin);
                is_new.then_some((Some(*begin), entry, nodes))
            }
            (None, Some(_)) => None,
            (None, None) => {
                found.are_complete = false;
                None
            }
        };
        found
            .pieces
            .extend(piece.map(|(begin, end, nodes)| StablePiece {
                begin,
                end,
                nodes: nodes.clone(),
            }));
    }
}

/// The states at the crossings that are there.
fn at_crossings(rows: &[ContinuedRow], crossings: &[Option<Crossing>]) -> Vec<Option<Node>> {
    rows.iter()
        .zip(crossings)
        .map(|(row, crossing)| row.level.at_crossing(crossing.as_ref()?))
        .collect()
}

/// Where the pieces end that begin at `starts`, or begin that end there; `None` without a start, or where the continuation is lost.
fn ends_of_pieces(
    rows: &[ContinuedRow],
    starts: &[Option<Node>],
    backward: bool,
) -> Vec<Option<PieceEnd>> {
    let started: Vec<(usize, Node)> = starts
        .iter()
        .enumerate()
        .filter_map(|(i, start)| Some((i, (*start)?)))
        .collect();
    let levels: Vec<LevelCurve> = started
        .iter()
        .map(|(i, _)| match backward {
            true => rows[*i].level.backward(),
            false => rows[*i].level.clone(),
        })
        .collect();
    let curves = levels.iter().zip(started.iter().map(|(_, start)| *start));
    let continued = continuations(curves.collect(), false, NODE_MISS);
    let mut ends = vec![None; starts.len()];
    for ((level, (i, _)), piece) in levels.iter().zip(&started).zip(continued) {
        ends[*i] = piece.and_then(|piece| end_of_piece(level, piece));
    }
    ends
}

/// Where `piece` ends, and its nodes.
fn end_of_piece(level: &LevelCurve, piece: Continuation) -> Option<PieceEnd> {
    let end = piece.nodes.last()?;
    let distance = end.full.map.pole.length();
    let crossing = Crossing {
        edge: piece.end,
        tau: end.point.x,
        load: end.point.y,
        push: level.side.sign() * end.push,
        residual: libm::log(level.row.pole_distance / distance).abs(),
        slope: piece.end.slope(&end.full.map),
    };
    Some((crossing, piece.nodes))
}

fn same(one: &Crossing, other: &Crossing) -> bool {
    let load = (one.load - other.load).abs() / one.load.abs();
    one.edge == other.edge && load + (one.tau / other.tau - 1.0).abs() < SAME_CROSSING
}
