//! Detachments to which the contact slides without doubt, by a few states of the row in place of its history.

use super::limit::SlidingLimit;
use super::segment::SlidingKnot;
use crate::sheet::{Crossing, CurveNode, Edge, Sheet};
use glam::DVec2;
use std::f64::consts::PI;
use whiskmap_mechanics::shooting::FirstVariation;
use whiskmap_mechanics::shooting::batch::Batch;

/// Number of states between first touch and the end of the push.
const BETWEEN: u32 = 12;

/// The slid distance at the end must be larger than all before it by this part of their range. It allows for the error of the cubics between the
/// states.
const AHEAD: f64 = 0.01;

/// Returns true for each of the `rows` of `sheet` whose contact slides toward the tip at the end of the push without doubt, `[row]`. Each has
/// its index, the crossing at its end, and the state there. The contact cannot be farther toward the tip than the tip limit
/// has been. So if the tip limit is farthest at the end, the contact slides there.
pub fn surely_slides_to_end(
    sheet: &Sheet,
    rows: &[(usize, Crossing, FirstVariation)],
) -> Vec<bool> {
    let points = rows.iter().map(|(row, end, _)| points(sheet, *row, end));
    let points: Vec<Option<Vec<DVec2>>> = points.collect();
    let all = points.iter().flatten().flatten();
    let states: Vec<FirstVariation> =
        Batch::new(sheet.method()).shoot_at(&sheet.rod, all.map(|point| (point.x, point.y)));
    let mut states = states.into_iter();
    let surely = rows.iter().zip(&points).map(|((row, end, at_end), points)| {
        let Some(points) = points else {
            return false;
        };
        let level = sheet.level(*row);
        let pairs = points.iter().copied().zip(states.by_ref());
        let pairs = pairs.chain([(DVec2::new(end.tau, end.load), *at_end)]);
        let mut before: Option<CurveNode> = None;
        let knots = pairs.map(|(point, state)| {
            let node = match before {
                Some(before) => level.node(point, &state.full, before.signed_push, before.angle),
                None => CurveNode { signed_push: 0.0, ..level.node(point, &state.full, 0.0, 0.0) },
            };
            before = Some(node);
            SlidingKnot::new(&level, node, &state)
        });
        let (knots, folds) = (knots.collect(), [false, end.edge == Edge::Fold]);
        is_farthest_at_end(&SlidingLimit::through(level, true, knots, folds))
    });
    surely.collect()
}

/// Points `(tau, load)` of a row from first touch up to the `end` of its push, which is left out; `None` without a guess, and for pushes beyond
/// half a turn, on which the contact angle can change by a turn from state to state.
fn points(sheet: &Sheet, row: usize, end: &Crossing) -> Option<Vec<DVec2>> {
    if end.push > PI {
        return None;
    }
    let pushes = (1..=BETWEEN).map(|i| end.push * f64::from(i) / f64::from(BETWEEN + 1));
    let between = sheet.guesses(row, &pushes.collect::<Vec<_>>());
    let touch = Some(sheet.rows[row].first_touch(&sheet.rod));
    [touch].into_iter().chain(between).collect()
}

/// Returns true if the slid distance at the end of `limit` is larger than everywhere before.
fn is_farthest_at_end(limit: &SlidingLimit) -> bool {
    let grows = limit.segments.iter().all(|segment| segment.to.push > segment.from.push);
    let end = limit.end();
    let before = limit.pushes().filter(|push| *push < end);
    let before: Option<Vec<f64>> = before.map(|push| limit.slid(push)).collect();
    let Some((before, at_end)) = before.zip(limit.slid(end)) else {
        return false;
    };
    let least = before.iter().copied().fold(f64::INFINITY, f64::min);
    let is_ahead = |slid: &f64| at_end - slid > AHEAD * (at_end - least);
    grows && before.iter().all(is_ahead)
}
