//! Detachments to which the contact slides without doubt, by a few states of the row in place of its history.

use super::limit::{LimitPart, SlidingLimit, through};
use crate::sheet::{Crossing, Edge, LevelCurve, Sheet};
use glam::DVec2;
use std::f64::consts::PI;
use whiskmap_mechanics::shooting::FirstVariation;
use whiskmap_mechanics::shooting::batch::Batch;

/// Number of states between first touch and the end of the push.
const BETWEEN: u32 = 12;

/// Slid distance by which the end must be ahead of the states before it, as a part of the range of their slid distances. It allows for the
/// error of the cubics between them.
const AHEAD: f64 = 0.01;

/// Returns true for each of the `rows` of `sheet` whose contact slides toward the tip at the end of the push without doubt, `[row]`. The
/// contact is never ahead of all places where the tip limit has been. So it slides if the tip limit is farthest at the end.
pub fn surely_slides_to_end(sheet: &Sheet, rows: &[(usize, Crossing)]) -> Vec<bool> {
    let levels: Vec<LevelCurve> = rows.iter().map(|(row, _)| sheet.level(*row)).collect();
    let points = rows.iter().map(|(row, end)| points(sheet, *row, end));
    let points: Vec<Option<Vec<DVec2>>> = points.collect();
    let Some(first) = levels.first() else {
        return Vec::new();
    };
    let all = points.iter().flatten().flatten();
    let states: Vec<FirstVariation> =
        Batch::new(first.method).shoot_at(&sheet.rod, all.map(|point| (point.x, point.y)));
    let mut states = states.into_iter();
    let parts = rows.iter().zip(&levels).zip(&points);
    let parts = parts.map(|(((_, end), level), points)| {
        let points = points.as_ref()?;
        let mut last = level.touch();
        let mut nodes = vec![last];
        for (point, state) in points.iter().zip(states.by_ref()) {
            last = level.node(*point, &state.full, last.push, last.angle);
            nodes.push(last);
        }
        Some(LimitPart {
            level,
            nodes,
            has_fold: end.edge == Edge::Fold,
            is_stable: true,
        })
    });
    let limits = through(&parts.collect::<Vec<_>>()).into_iter();
    limits
        .map(|limit| limit.is_some_and(|limit| is_farthest_at_end(&limit)))
        .collect()
}

/// Points `(tau, load)` of a row after first touch, up to the `end` of its push; `None` without a guess, and for pushes beyond half a turn,
/// on which the contact angle can change by a turn from state to state.
fn points(sheet: &Sheet, row: usize, end: &Crossing) -> Option<Vec<DVec2>> {
    if end.push > PI {
        return None;
    }
    let pushes = (1..=BETWEEN).map(|i| end.push * f64::from(i) / f64::from(BETWEEN + 1));
    let guesses = sheet.guesses(row, &pushes.collect::<Vec<_>>()).into_iter();
    let between = guesses.map(|guess| guess.map(|guess| DVec2::new(guess.tau, guess.load)));
    let end = Some(DVec2::new(end.tau, end.load));
    between.chain([end]).collect()
}

/// Returns true if the slid distance at the end of `limit` is larger than everywhere before.
fn is_farthest_at_end(limit: &SlidingLimit) -> bool {
    let grows = limit
        .segments
        .iter()
        .all(|segment| segment.to.push > segment.from.push);
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
