//! Solution branch at one pole: stable states from first touch to the fold, then unstable states.

use super::columns::row;
use super::curve::snaps_deg;
use super::resample::targets;
use super::{BranchMark, NoState, StableBranch, StateAtPush};
use crate::friction::Sliding;
use crate::scene::{Pole, Whisker};
use crate::sheet::{CurveNode, Edge, LevelCurve, Path, Sheet, Stretch};
use serde::Serialize;
use std::ops::{Deref, RangeInclusive};
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap_mechanics::rod::Side;

/// Numbers of points of a branch that can be requested.
pub const BRANCH_POINTS: RangeInclusive<u32> = 3..=1_000_000;

/// Number of points that are computed between two looks at the flag that cancels.
const POINTS_AT_ONCE: usize = 1 << 10;

/// Branch: all states of one whisker at one pole that are connected with first touch. Unstable states beyond nine turns of the base are left
/// out, and the last point then has no mark.
///
/// A branch has the methods of its stable part, which also read and draw unstable states. Its method [`Branch::state`] selects the part.
#[derive(Clone, Debug)]
pub struct Branch(StableBranch);

impl Deref for Branch {
    type Target = StableBranch;

    fn deref(&self) -> &StableBranch {
        &self.0
    }
}

row! {
    /// Point of a branch: a state in mm, deg, uN and nN m.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
    pub struct BranchPoint of a state {
        pub distance_mm: f64,
        pub side: Side,
        /// True if the state is stable; at the fold, true for the last stable state.
        pub stable: bool,
        pub push_angle_deg: f64,
        pub push_chord_deg: f64 = place,
        pub arc_length_mm: f64 = place,
        pub contact_angle_deg: f64 = place,
        pub force_un: f64 = load,
        pub contact_force_un: f64 = load,
        pub base_force_x_un: f64 = load,
        pub base_force_y_un: f64 = load,
        pub base_moment_nnm: f64 = load,
        pub energy_nj: f64 = load,
        pub peak_strain: f64,
        pub peak_strain_mm: f64,
        /// Determinant of d(D, phi)/d(s_obj, f) with f = F L^2/(E I_base): 0 at a fold.
        pub det: f64,
        /// Mark: first-touch; slip-off, pull-off (stable); second-fold, tip (unstable).
        pub mark: Option<BranchMark>,
        /// Sliding direction of the contact, with friction: tip, base or sticks.
        pub sliding: Option<Sliding>,
        pub snaps_deg: Option<f64>,
    }
}

impl Branch {
    /// Computes the branch of `whisker` at `pole`, whose first touch is at `distance_mm` from the base.
    ///
    /// # Errors
    /// The whisker at rest does not reach the pole, the stable states do not end within nine turns of the base, or the continuation fails.
    pub fn new(
        whisker: &Whisker,
        pole: &Pole,
        side: Side,
        distance_mm: f64,
    ) -> Result<Self, NoState> {
        StableBranch::followed((whisker, pole, side), distance_mm, Stretch::PastFold).map(Self)
    }

    /// Computes the stable or the unstable state at `signed_push`, in radians, of `pushed`: a whisker, its pole and the side. Also returns the states
    /// that were followed: up to the fold for a stable state, and past it for an unstable one.
    ///
    /// # Errors
    /// Fails as [`StableBranch::new`] or [`Branch::new`] does, or if no such state exists.
    pub fn at_push(
        pushed: (&Whisker, &Pole, Side),
        distance_mm: f64,
        signed_push: f64,
        stable: bool,
    ) -> Result<(StableBranch, StateAtPush), NoState> {
        let stretch = match stable {
            true => Stretch::Stable,
            false => Stretch::PastFold,
        };
        let branch = Self(StableBranch::followed(pushed, distance_mm, stretch)?);
        let state = branch.state(signed_push, stable)?;
        Ok((branch.0, state))
    }

    /// Returns the state at `signed_push`, in radians, on the stable or the unstable part of the branch.
    ///
    /// # Errors
    /// No such state exists. The error names how the whisker leaves the pole, and at which push angle.
    pub fn state(&self, signed_push: f64, stable: bool) -> Result<StateAtPush, NoState> {
        if stable {
            return self.0.state(signed_push);
        }
        let unstable = self
            .path
            .unstable()
            .ok_or_else(|| NoState::NoFold { at_deg: self.stable_end_deg() })?;
        let not_there =
            |ends: [f64; 2]| NoState::NotUnstable { ends_deg: ends.map(f64::to_degrees) };
        let node = self.node_at(unstable, signed_push, not_there)?;
        Ok(self.beyond_fold(&node))
    }

    /// Returns `count` points of the branch, at least 3, among them the fold. The points are evenly spaced on each side of the fold.
    /// Lengths are measured in push angle and contact angle (radians), and arclength of the contact (whisker lengths).
    ///
    /// # Errors
    /// The corrector fails at a point between two nodes of the continuation.
    pub fn points(&self, count: usize) -> Result<Vec<BranchPoint>, NoState> {
        self.points_until(count, &AtomicBool::new(false))
    }

    /// Returns points of the branch as [`Branch::points`] does. If `cancel` is true, the function soon returns [`NoState::Cancelled`].
    ///
    /// # Errors
    /// Fails as [`Branch::points`] does, and if it is cancelled.
    pub fn points_until(
        &self,
        count: usize,
        cancel: &AtomicBool,
    ) -> Result<Vec<BranchPoint>, NoState> {
        let states = self.states(count, cancel)?;
        Ok(states.into_iter().map(|(_, point)| point).collect())
    }

    /// Returns the points of [`Branch::points_until`], each with its state.
    pub(crate) fn states(
        &self,
        count: usize,
        cancel: &AtomicBool,
    ) -> Result<Vec<(StateAtPush, BranchPoint)>, NoState> {
        let go_on = || match cancel.load(Ordering::Relaxed) {
            true => Err(NoState::Cancelled),
            false => Ok(()),
        };
        let Path { nodes, fold, end, .. } = &self.path;
        let lengths = self.path.lengths();
        let (targets, fold_at) = targets(&lengths, *fold, count.max(3));
        let mut between = Vec::with_capacity(targets.len());
        for targets in targets.chunks(POINTS_AT_ONCE) {
            go_on()?;
            between.extend(self.path.at_lengths(&lengths, targets));
        }
        let (last, last_node) = (targets.len() - 1, nodes.len() - 1);
        let end_mark = end.map(|end| match (fold, end) {
            (Some(_), Edge::Fold) => BranchMark::SecondFold,
            (Some(_), Edge::Tip) => BranchMark::Tip,
            (None, _) => BranchMark::PullOff,
        });
        let mut marked = Vec::with_capacity(targets.len());
        for (i, between) in between.into_iter().enumerate() {
            // The ends and the fold are more accurate than states between nodes.
            let exact = match i {
                0 => Some((nodes[0], Some(BranchMark::FirstTouch))),
                _ if i == last => Some((nodes[last_node], end_mark)),
                _ if Some(i) == fold_at => {
                    fold.map(|fold| (nodes[fold], Some(BranchMark::SlipOff)))
                }
                _ => None,
            };
            let found = exact.or(between.map(|node| (node, None)));
            marked.push(found.ok_or_else(|| self.failed())?);
        }
        let stable = fold_at.map_or(marked.len(), |fold| fold + 1);
        let nodes: Vec<CurveNode> = marked.iter().map(|(node, _)| *node).collect();
        let mut states = Vec::with_capacity(nodes.len());
        for nodes in nodes[..stable].chunks(POINTS_AT_ONCE) {
            go_on()?;
            states.extend(self.pushed(nodes)?);
        }
        states.extend(nodes[stable..].iter().map(|node| self.beyond_fold(node)));
        let mut peaks = Vec::with_capacity(states.len());
        for states in states.chunks(POINTS_AT_ONCE) {
            go_on()?;
            peaks.extend(self.peaks(states));
        }
        let is_detachment =
            |mark: &BranchMark| matches!(mark, BranchMark::SlipOff | BranchMark::PullOff);
        let points = marked.iter().zip(states.iter().zip(peaks));
        let points = points.map(|((_, mark), (state, peak))| {
            go_on()?;
            let mark = mark.filter(|mark| self.detaches() || !is_detachment(mark));
            let point = BranchPoint {
                mark,
                snaps_deg: mark.filter(is_detachment).and_then(|_| self.snaps_deg()),
                ..self.point(state, peak)
            };
            Ok((*state, point))
        });
        points.collect()
    }

    /// Returns the push angle, in degrees, up to which the row has other stable states where the stable states from first touch end.
    fn snaps_deg(&self) -> Option<f64> {
        let LevelCurve { method, rod, side, .. } = &self.path.level;
        let distance = self.distance_mm / self.units.length_mm;
        snaps_deg(&Sheet::of_ends(*method, rod, *side, &[distance]), 0)
    }

    /// Returns the unstable state of `node`. It has the friction of a contact that slides toward the tip, as the last stable states do.
    fn beyond_fold(&self, node: &CurveNode) -> StateAtPush {
        let friction = self.path.level.rod.friction;
        let sliding = (friction != 0.0).then_some(Sliding::Tip);
        StateAtPush::of(node, false, friction, sliding)
    }
}
