//! Stable pieces of a row: the crossings that belong together. With friction or strong curvature, `D` can have a saddle on the edge of
//! the sheet. Then the level curve of a row is in several pieces, whose push angles may overlap.

use crate::sheet::case::SheetCase;
use crate::sheet::continuation::level_curve::{CurveNode, LevelCurve, Stretch};
use crate::sheet::continuation::stepper::MOST_PUSH;
use crate::sheet::continuation::{NODE_MISS, continuations};
use crate::sheet::fold::{FoldPoint, first_folds};
use crate::sheet::row::{Crossing, Edge};
use crate::sheet::span::{RowSpan, SpanNode};
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap_mechanics::rod::Side;

/// Stable piece of a row: a part of its level curve on the stable sheet, in the direction of growing push angles.
#[derive(Clone, Debug)]
pub struct StablePiece {
    /// Crossing at which the piece begins; `None` for first touch.
    pub begin: Option<Crossing>,
    /// Crossing at which the stable piece ends.
    pub end: Crossing,
    /// Nodes of the stable piece, in this direction or the opposite one, `[node]`.
    pub nodes: Vec<CurveNode>,
}

impl StablePiece {
    /// Returns the row span through the piece's nodes, or `None` if the row parameter turns back, or there are too few nodes.
    pub fn span(&self, side: Side) -> Option<RowSpan> {
        let node = |node: &CurveNode| SpanNode {
            w: node.point.y.abs() * node.point.x * node.point.x,
            push: side.sign() * node.signed_push,
            tau: node.point.x,
        };
        let mut nodes: Vec<SpanNode> = self.nodes.iter().map(node).collect();
        nodes.sort_by(|a, b| a.push.total_cmp(&b.push));
        RowSpan::through(side.sign(), nodes)
    }
}

/// Row to follow by continuation.
#[derive(Clone, Copy, Debug)]
pub struct ContinuedRow<'a> {
    /// Level curve of the row.
    pub level: &'a LevelCurve,
    /// True if the row has a first touch: the resting whisker reaches the pole.
    pub touches: bool,
    /// Crossings of the row found on the sampled edges: starts of further pieces.
    pub crossings: &'a [Crossing],
    /// True if only the piece from first touch is wanted.
    pub is_first_alone: bool,
}

/// Stable pieces of a row found by continuation. The piece from first touch comes first.
#[derive(Clone, Debug, Default)]
pub struct StablePieces {
    /// Stable pieces that were followed, `[piece]`; empty where the continuation from first touch failed.
    pub pieces: Vec<StablePiece>,
    /// True if `pieces` are all wanted stable pieces: no continuation has failed.
    pub are_complete: bool,
}

impl StablePieces {
    /// Returns the crossings at which the stable pieces begin and end, piece by piece. First touch is no crossing: a piece that begins
    /// there has only an end.
    pub fn ends(&self) -> impl Iterator<Item = Crossing> {
        let ends = |piece: &StablePiece| [piece.begin, Some(piece.end)];
        self.pieces.iter().flat_map(ends).flatten()
    }

    /// Returns true if one of the pieces begins or ends at `crossing`.
    fn have_end(&self, crossing: &Crossing) -> bool {
        self.ends().any(|end| end.is_same(crossing))
    }
}

/// Returns the wanted stable pieces of each of the `rows`, `[row]`. Their trajectories share batches. Results do not depend on the other rows. If
/// `cancel` is true, the function soon returns `None`.
pub fn stable_pieces(rows: &[ContinuedRow], cancel: &AtomicBool) -> Option<Vec<StablePieces>> {
    let go_on = || (!cancel.load(Ordering::Relaxed)).then_some(());
    go_on()?;
    let mut found: Vec<StablePieces> = from_touch(rows);
    let most = rows.iter().map(|row| row.crossings.len()).max();
    for index in 0..most.unwrap_or_default() {
        go_on()?;
        let crossings: Vec<Option<Crossing>> = rows
            .iter()
            .zip(&found)
            .map(|(row, found)| {
                let is_continued = found.are_complete || !found.pieces.is_empty();
                // No cell has a push angle of several turns.
                let is_near = |crossing: &Crossing| crossing.push.abs() <= MOST_PUSH;
                let crossing = row.crossings.get(index).copied();
                let crossing = crossing.filter(|_| is_continued && !row.is_first_alone);
                crossing.filter(is_near)
            })
            .collect();
        through_crossings(rows, &crossings, &mut found);
    }
    go_on()?;
    past_folds(rows, &mut found);
    Some(found)
}

/// Crossing at which a piece ends, and the nodes of the piece.
type PieceEnd = (Crossing, Vec<CurveNode>);

fn from_touch(rows: &[ContinuedRow]) -> Vec<StablePieces> {
    let at_touch = |row: &ContinuedRow| row.crossings.iter().copied().find(Crossing::is_at_touch);
    let start = |row: &ContinuedRow| {
        let is_continued = row.touches && at_touch(row).is_none();
        is_continued.then(|| row.level.touch())
    };
    let starts: Vec<Option<CurveNode>> = rows.iter().map(start).collect();
    let ends = ends_of_pieces(rows, &starts, Stretch::Stable, false);
    let pieces = rows.iter().zip(ends).map(|(row, end)| {
        let at_touch = at_touch(row).filter(|_| row.touches);
        let end = at_touch.map(|end| (end, Vec::new())).or(end);
        let piece = end.map(|(end, nodes)| StablePiece { begin: None, end, nodes });
        StablePieces {
            are_complete: piece.is_some() || !row.touches,
            pieces: piece.into_iter().collect(),
        }
    });
    pieces.collect()
}

/// Adds to `found` the piece of each row that begins or ends at its crossing, unless the piece is already there.
fn through_crossings(
    rows: &[ContinuedRow],
    crossings: &[Option<Crossing>],
    found: &mut [StablePieces],
) {
    // A crossing that is only near the level curve stands for the nearest beginning of a piece.
    let is_sound = |crossing: &Option<Crossing>| crossing.is_some_and(|c| c.is_sound());
    let unsound = |crossing: &Option<Crossing>| crossing.filter(|c| !c.is_sound());
    let near = at_crossings(rows, &crossings.iter().map(unsound).collect::<Vec<_>>());
    let begins = ends_of_pieces(rows, &near, Stretch::Stable, true);
    let entries: Vec<Option<Crossing>> = crossings
        .iter()
        .zip(near.iter().zip(begins))
        .zip(found.iter_mut())
        .map(|((crossing, (near, begin)), found)| {
            // On the unstable side no piece can be missing.
            let may_begin = near.is_none_or(|near| near.full.map.det() > 0.0);
            let has_failed = unsound(crossing).is_some() && may_begin && begin.is_none();
            found.are_complete &= !has_failed;
            let entry = crossing.filter(|_| is_sound(crossing));
            let entry = entry.or(begin.map(|(begin, _)| begin));
            entry.filter(|entry| !found.have_end(entry))
        })
        .collect();
    let starts = at_crossings(rows, &entries);
    let ahead = ends_of_pieces(rows, &starts, Stretch::Stable, false);
    // An entry may be the beginning or the end of a piece. From the end, a continuation leads away only backward; forward it comes back to
    // the same crossing.
    let leads =
        |entry: &Crossing, end: Option<PieceEnd>| end.filter(|(end, _)| !end.is_same(entry));
    let ahead: Vec<Option<PieceEnd>> =
        entries.iter().zip(ahead).map(|(entry, end)| leads(entry.as_ref()?, end)).collect();
    let back: Vec<Option<CurveNode>> =
        starts.iter().zip(&ahead).map(|(start, ahead)| start.filter(|_| ahead.is_none())).collect();
    let behind = ends_of_pieces(rows, &back, Stretch::Stable, true);
    for (i, found) in found.iter_mut().enumerate() {
        let Some(entry) = entries[i] else { continue };
        let (begin, end, nodes) = match (&ahead[i], &behind[i]) {
            (Some((end, nodes)), _) => (entry, *end, nodes),
            (None, Some((begin, nodes))) if !begin.is_same(&entry) && !found.have_end(begin) => {
                (*begin, entry, nodes)
            }
            (None, behind) => {
                found.are_complete &= behind.is_some();
                continue;
            }
        };
        found.pieces.push(StablePiece { begin: Some(begin), end, nodes: nodes.clone() });
    }
}

/// Adds to `found` the stable pieces that follow the one from first touch along its level curve: past the fold at which it ends, unstable
/// states can lead to another fold, where stable states begin again.
fn past_folds(rows: &[ContinuedRow], found: &mut [StablePieces]) {
    let from_touch = |found: &StablePieces| {
        let piece = found.pieces.first().filter(|piece| piece.begin.is_none());
        piece.map(|piece| piece.end)
    };
    let at_fold = |end: &Option<Crossing>| end.filter(|end| end.edge == Edge::Fold);
    let pairs = rows.iter().zip(&*found);
    let ends = pairs.map(|(row, found)| from_touch(found).filter(|_| !row.is_first_alone));
    let mut ends: Vec<Option<Crossing>> = ends.collect();
    while ends.iter().any(|end| at_fold(end).is_some()) {
        let folds = at_crossings(rows, &ends.iter().map(at_fold).collect::<Vec<_>>());
        let unstable = ends_of_pieces(rows, &folds, Stretch::Unstable, false);
        let begins = unstable.into_iter().zip(&*found).map(|(unstable, found)| {
            let (begin, _) = unstable?;
            at_fold(&Some(begin)).filter(|begin| !found.have_end(begin))
        });
        let begins: Vec<Option<Crossing>> = begins.collect();
        let stable = ends_of_pieces(rows, &at_crossings(rows, &begins), Stretch::Stable, false);
        let continued = rows.iter().zip(begins.into_iter().zip(stable));
        let pieces = continued.map(|(row, (begin, stable))| {
            let (end, nodes) = stable?;
            is_on_sheet(row.level, &nodes).then_some(StablePiece { begin, end, nodes })
        });
        let pieces: Vec<Option<StablePiece>> = pieces.collect();
        for ((end, piece), found) in ends.iter_mut().zip(pieces).zip(&mut *found) {
            *end = piece.as_ref().map(|piece| piece.end);
            found.pieces.extend(piece);
        }
    }
}

/// Returns true if one of the `nodes` of a piece with positive `det` is below the first fold of its contact. Then the whole piece is on the
/// stable sheet.
fn is_on_sheet(level: &LevelCurve, nodes: &[CurveNode]) -> bool {
    let case = SheetCase { method: level.method, rod: &level.rod, side: level.side };
    let contacts: Vec<f64> = nodes.iter().map(|node| node.point.x).collect();
    let is_below = |(node, fold): (&CurveNode, Option<FoldPoint>)| {
        let is_stable = node.full.map.det() > 0.0;
        is_stable && fold.is_some_and(|fold| node.point.y.abs() < fold.load.abs())
    };
    nodes.iter().zip(first_folds(case, &contacts)).any(is_below)
}

/// Returns the state at the crossing of each row, or `None` without a crossing, or where the corrector fails.
fn at_crossings(rows: &[ContinuedRow], crossings: &[Option<Crossing>]) -> Vec<Option<CurveNode>> {
    rows.iter()
        .zip(crossings)
        .map(|(row, crossing)| row.level.at_crossing(crossing.as_ref()?))
        .collect()
}

/// Returns the end of the `stretch` of the level curve that begins at each of the `starts`. With `backward`, the stretch
/// ends there. An entry is `None` without a start, or where the continuation fails.
fn ends_of_pieces(
    rows: &[ContinuedRow],
    starts: &[Option<CurveNode>],
    stretch: Stretch,
    backward: bool,
) -> Vec<Option<PieceEnd>> {
    let level = |row: &ContinuedRow| match backward {
        true => row.level.backward(),
        false => row.level.clone(),
    };
    let levels: Vec<LevelCurve> = rows.iter().map(level).collect();
    let starts = levels.iter().zip(starts);
    let starts = starts.map(|(level, start)| Some((level, (*start)?)));
    let continued = continuations(&starts.collect::<Vec<_>>(), stretch, NODE_MISS);
    continued.into_iter().map(|path| Some((path.as_ref()?.crossing()?, path?.nodes))).collect()
}
