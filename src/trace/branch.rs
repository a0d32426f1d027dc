//! Solution branch at one pole: stable states from first touch to the fold, then unstable states.

use super::columns::{StateRow, row};
use super::curve::snaps_deg;
use super::resample::targets;
use super::{BranchMark, FINER, NoState, StateAtPush};
use crate::friction::{ContactHistory, Sliding};
use crate::scene::{Pole, Whisker};
use crate::sheet::{CurveNode, Edge, LevelCurve, Path, Row, Sheet, Stretch};
use serde::Serialize;
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap_mechanics::rod::{Rest, Side, Units};
use whiskmap_mechanics::shooting::PeakStrain;
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method};

/// Number of points that are computed between two looks at the flag that cancels.
const POINTS_AT_ONCE: usize = 1 << 10;

/// Branch: all states of one whisker at one pole that are connected with first touch. Unstable states beyond nine turns of the base are left
/// out, and the last point then has no mark.
#[derive(Clone, Debug)]
pub struct Branch {
    pub(super) path: Path,
    pub(super) units: Units,
    /// Sliding history of the contact; `None` without friction, and if it is not found.
    pub(super) history: Option<ContactHistory>,
    distance_mm: f64,
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
        Self::followed((whisker, pole, side), distance_mm, Stretch::PastFold)
    }

    /// The branch along a `stretch` of its level curve from first touch.
    pub(super) fn followed(
        (whisker, pole, side): (&Whisker, &Pole, Side),
        distance_mm: f64,
        stretch: Stretch,
    ) -> Result<Self, NoState> {
        let rod = whisker.rod(pole, side);
        let rest = Rest::new(&rod);
        let row = Row::new(&rest, distance_mm / whisker.length_mm);
        if !row.is_reached() {
            let reach_mm = rest.reach() * whisker.length_mm;
            return Err(NoState::OutOfReach { reach_mm });
        }
        let level = LevelCurve::new(Method::new(FINER), &rod, side, &row);
        let path = level.continuation(level.touch(), stretch);
        // From first touch at the tip there may be no state to continue to.
        let none = match row.is_at_reach() {
            true => NoState::PulledOff { at_deg: 0.0 },
            false => NoState::Failed { push_deg: 0.0 },
        };
        let path = path.ok_or(none)?;
        if path.fold.is_none() && path.end.is_none() {
            return Err(NoState::BeyondTurns);
        }
        let has_friction = rod.friction != 0.0;
        Ok(Self {
            history: has_friction.then(|| ContactHistory::along(&path)).flatten(),
            path,
            units: whisker.units(),
            distance_mm,
        })
    }

    /// Returns the row of the branch: distance and direction of the pole.
    #[must_use]
    pub fn row(&self) -> &Row {
        &self.path.level.row
    }

    /// Returns the signed push angle at which the stable states end, at the fold or at the tip, in degrees.
    #[must_use]
    pub fn stable_end_deg(&self) -> f64 {
        let stable = self.path.stable();
        stable[stable.len() - 1].push.to_degrees()
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
        let Path {
            nodes, fold, end, ..
        } = &self.path;
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
        states.extend(self.beyond_fold(&nodes[stable..]));
        let mut peaks = Vec::with_capacity(states.len());
        for states in states.chunks(POINTS_AT_ONCE) {
            go_on()?;
            peaks.extend(self.peaks(states));
        }
        let is_detachment =
            |mark: &BranchMark| matches!(mark, BranchMark::SlipOff | BranchMark::PullOff);
        let snaps_deg = self.snaps_deg();
        let points = marked.iter().zip(states.iter().zip(peaks));
        let points = points.map(|((_, mark), (state, peak))| {
            go_on()?;
            let mark = mark.filter(|mark| self.detaches() || !is_detachment(mark));
            let point = BranchPoint {
                mark,
                snaps_deg: mark.filter(is_detachment).and(snaps_deg),
                ..self.point(state, peak)
            };
            Ok((*state, point))
        });
        points.collect()
    }

    /// Returns the push angle, in degrees, up to which the row has other stable states where the stable states from first touch end.
    fn snaps_deg(&self) -> Option<f64> {
        let LevelCurve {
            method, rod, side, ..
        } = &self.path.level;
        let distance = self.distance_mm / self.units.length_mm;
        snaps_deg(&Sheet::of_ends(*method, rod, *side, &[distance]), 0)
    }

    /// Returns true if a push detaches at the end of the stable states. With friction, it does not if the contact sticks there.
    fn detaches(&self) -> bool {
        let end = self.stable_end_deg().to_radians().abs();
        let history = self.history.as_ref();
        let sliding = history.and_then(|history| history.sliding_at_end(end));
        sliding.is_none_or(|sliding| sliding == Sliding::Tip)
    }

    /// Returns the error of a failed continuation or corrector.
    pub(super) fn failed(&self) -> NoState {
        let nodes = &self.path.nodes;
        let push_deg = nodes[nodes.len() - 1].push.to_degrees();
        NoState::Failed { push_deg }
    }

    /// Returns the largest bending strains of `states`, `[state]`.
    pub(super) fn peaks(&self, states: &[StateAtPush]) -> Vec<PeakStrain> {
        let rods: Vec<_> = states.iter().map(|state| self.rod(state.ratio)).collect();
        let conditions = rods
            .iter()
            .zip(states)
            .map(|(rod, state)| InitialCondition {
                rod,
                tau: state.tau,
                load: state.load,
            });
        Batch::new(self.path.level.method).shoot(&conditions.collect::<Vec<_>>())
    }

    /// Returns `state` with its largest bending strain as a point without a mark.
    pub(super) fn point(&self, state: &StateAtPush, peak: PeakStrain) -> BranchPoint {
        let LevelCurve { side, row, .. } = &self.path.level;
        let rod = &self.rod(state.ratio);
        BranchPoint {
            distance_mm: self.distance_mm,
            side: *side,
            stable: state.stable,
            push_angle_deg: state.push.to_degrees(),
            contact_angle_deg: state.angle.to_degrees(),
            peak_strain: peak.strain * self.units.strain,
            peak_strain_mm: peak.arclength * self.units.length_mm,
            // From (ln D, phi) by (tau, load) to (D, phi) by (s, f): dtau/ds = 1/rho, dload/df = 1/rho^2, and f is the
            // normal component of the force.
            det: state.full.map.det() * row.pole_distance
                / (rod.radius(state.tau).powi(3) * rod.contact_tangent().x),
            sliding: state.sliding,
            ..BranchPoint::default().with_state(Some(&self.read(state)))
        }
    }
}
