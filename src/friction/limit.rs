//! Slid distance of a contact that slides all along a push, toward the tip or toward the base, as a piecewise polynomial.
//!
//! A row whose parameter `w` turns back has no row span (`src/sheet/span.rs`), so the variable is the push angle, which grows along
//! every stable row.

use super::segment::{LimitFolds, LimitPlace, LimitSegment, SlidingKnot};
use super::state::FrictionPoint;
use crate::sheet::{CurveNode, Edge, LevelCurve, NODE_MISS, Path, Stretch, continuations};
use glam::DVec2;
use whiskmap_mechanics::shooting::FirstVariation;
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition};

/// Slid distance of one row's contact by push angle, from first touch to the end of its stable states. It is the arclength of the contact
/// minus the distance rolled around the pole, in whisker lengths.
#[derive(Clone, Debug)]
pub struct SlidingLimit {
    /// Level curve of the limit, with the friction of its direction.
    pub level: LevelCurve,
    /// True if the states of the limit are stable.
    pub is_stable: bool,
    pub segments: Vec<LimitSegment>,
}

impl SlidingLimit {
    /// Creates the limit of `level` through `knots`, of which the first and the last one may be folds.
    pub fn through(
        level: LevelCurve,
        is_stable: bool,
        mut knots: Vec<SlidingKnot>,
        [begins, ends]: [bool; 2],
    ) -> Self {
        let at_fold = |knot: &mut SlidingKnot| {
            *knot = knot.at_fold();
            knot.push
        };
        let folds = LimitFolds {
            begin: knots.first_mut().filter(|_| begins).map(at_fold),
            end: knots.last_mut().filter(|_| ends).map(at_fold),
        };
        Self { level, is_stable, segments: LimitSegment::between(&knots, folds) }
    }

    /// Computes the sliding limits of `levels`, `[level]`; `None` where the continuation fails. All levels have one method, and their
    /// trajectories share batches.
    pub fn of(levels: &[LevelCurve]) -> Vec<Option<Self>> {
        let starts = levels.iter().map(|level| Some((level, level.touch())));
        let continued = continuations(&starts.collect::<Vec<_>>(), Stretch::Stable, NODE_MISS);
        let parts = continued.iter();
        let parts = parts.map(|path| path.as_ref().map(LimitPart::stable));
        through(&parts.collect::<Vec<_>>())
    }

    /// Creates the sliding limit along a `path` from first touch.
    pub fn along(path: &Path) -> Option<Self> {
        through(&[Some(LimitPart::stable(path))]).pop()?
    }

    /// Computes the sliding limit of `level`, and the limit of its unstable states up to the fold if there is one; `None` if the
    /// continuation fails.
    pub fn with_unstable(level: &LevelCurve) -> Option<(Self, Option<Self>)> {
        let start = Some((level, level.touch()));
        let path = continuations(&[start], Stretch::PastFold, NODE_MISS).pop()??;
        let stable = LimitPart::stable(&path);
        let unstable = path.unstable().map(|nodes| LimitPart {
            nodes: nodes.iter().rev().copied().collect(),
            folds: [path.end == Some(Edge::Fold), true],
            is_stable: false,
            ..stable.clone()
        });
        let mut limits = through(&[Some(stable), unstable]).into_iter();
        Some((limits.next()??, limits.next()?))
    }

    /// Returns the push angles, in radians, of the limit's knots, then those between them at which the limit reverses.
    pub fn pushes(&self) -> impl Iterator<Item = f64> {
        let knots = self.segments.first().map(|first| first.from.push);
        let ends = self.segments.iter().map(|segment| segment.to.push);
        let knots = knots.into_iter().chain(ends);
        let reversals = self.segments.iter().flat_map(LimitSegment::reversals);
        knots.chain(reversals.flatten())
    }

    /// Returns the push angle at which the limit begins, in radians.
    pub fn begin(&self) -> f64 {
        self.segments.first().map_or(0.0, |first| first.from.push)
    }

    /// Returns the push angle at which the stable states of the limit end, in radians.
    pub fn end(&self) -> f64 {
        self.segments.last().map_or(0.0, |last| last.to.push)
    }

    /// Returns true if the sliding limit moves toward the base anywhere.
    pub fn falls(&self) -> bool {
        self.segments.iter().any(LimitSegment::falls)
    }

    /// Returns the slid distance at the push angle `push` (radians), in whisker lengths; `None` beyond the ends.
    pub fn slid(&self, push: f64) -> Option<f64> {
        let (segment, x) = self.place(push)?;
        Some(self.segments[segment].slid.at(x).0)
    }

    /// Returns a state near the limit's state at the push angle `push` (radians); `None` beyond the ends.
    pub fn near(&self, push: f64) -> Option<FrictionPoint> {
        let (segment, x) = self.place(push)?;
        let [tau, load, angle] = self.segments[segment].contact(x);
        Some(FrictionPoint { point: DVec2::new(tau, load), ratio: self.level.rod.friction, angle })
    }

    /// Returns the index of the segment at the push angle `push` (radians), and its variable there; `None` beyond the ends.
    pub fn place(&self, push: f64) -> Option<(usize, f64)> {
        let last = self.segments.len().checked_sub(1)?;
        let after = self.segments.partition_point(|segment| segment.to.push <= push);
        let at = after.min(last);
        let segment = &self.segments[at];
        let is_inside = segment.from.push <= push && push <= segment.to.push;
        is_inside.then(|| (at, segment.part(push)))
    }

    /// Returns the places of all segments at the variables `parts`, `[segment][part]`, flat.
    pub fn inner(&self, parts: &[f64]) -> Vec<LimitPlace> {
        let segments = self.segments.iter();
        let places = segments.flat_map(|segment| parts.iter().map(|part| segment.inner(*part)));
        places.collect()
    }
}

/// States of a limit whose push angles grow.
#[derive(Clone, Debug)]
struct LimitPart<'a> {
    level: &'a LevelCurve,
    nodes: Vec<CurveNode>,
    /// True for the first and the last node if it is a fold.
    folds: [bool; 2],
    is_stable: bool,
}

impl<'a> LimitPart<'a> {
    /// Returns the stable states of a `path` from first touch.
    fn stable(path: &'a Path) -> Self {
        Self {
            level: &path.level,
            nodes: path.stable().to_vec(),
            folds: [false, path.fold.is_some()],
            is_stable: true,
        }
    }

    /// Makes the limit through the nodes, whose states have the derivatives `variations`, `[node]`.
    fn limit(&self, variations: impl Iterator<Item = FirstVariation>) -> SlidingLimit {
        let pairs = self.nodes.iter().zip(variations);
        let knots = pairs.map(|(node, variation)| SlidingKnot::new(self.level, *node, &variation));
        let (level, knots) = (self.level.clone(), knots.collect());
        SlidingLimit::through(level, self.is_stable, knots, self.folds)
    }
}

/// Makes limits through the nodes of `parts`, `[part]`. Nodes have no derivatives of the contact, because most of them are
/// extrapolated, so that each takes a trajectory. Trajectories share batches.
fn through(parts: &[Option<LimitPart>]) -> Vec<Option<SlidingLimit>> {
    let known = parts.iter().flatten();
    let conditions = known.clone().flat_map(|part| {
        let nodes = part.nodes.iter();
        nodes.map(|node| InitialCondition::new(&part.level.rod, node.point))
    });
    let conditions: Vec<InitialCondition> = conditions.collect();
    let method = known.clone().next().map(|part| part.level.method);
    let shot = method.map(|method| Batch::new(method).shoot::<FirstVariation>(&conditions));
    let mut shot = shot.into_iter().flatten();
    let limits = parts.iter();
    limits.map(|part| Some(part.as_ref()?.limit(&mut shot))).collect()
}
