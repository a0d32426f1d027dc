//! Stable part of a branch, with all that its unstable part shares: path, units, and history of the contact.

use super::columns::StateRow;
use super::{BranchPoint, FINER, NoState, StateAtPush};
use crate::friction::{ContactHistory, Sliding};
use crate::scene::{Pole, Whisker};
use crate::sheet::{LevelCurve, Path, Row, Stretch};
use whiskmap_mechanics::rod::{Rest, Side, Units};
use whiskmap_mechanics::shooting::PeakStrain;
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method};

/// Stable part of a [`Branch`](super::Branch): the states from first touch to the fold or the tip. A continuation that ends there
/// saves most of the time. The path of a [`Branch`](super::Branch) also has the unstable states beyond the fold.
#[derive(Clone, Debug)]
pub struct StableBranch {
    pub(super) path: Path,
    pub(super) units: Units,
    /// Sliding history of the contact; `None` without friction, and if it is not found.
    pub(super) history: Option<ContactHistory>,
    pub(super) distance_mm: f64,
}

impl StableBranch {
    /// Computes the stable states of `whisker` at `pole`, whose first touch is at `distance_mm` from the base.
    ///
    /// # Errors
    /// The whisker at rest does not reach the pole, the states do not end within nine turns of the base, or the continuation fails.
    pub fn new(
        whisker: &Whisker,
        pole: &Pole,
        side: Side,
        distance_mm: f64,
    ) -> Result<Self, NoState> {
        Self::followed((whisker, pole, side), distance_mm, Stretch::Stable)
    }

    /// Computes the branch along a `stretch` of its level curve from first touch.
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
        stable[stable.len() - 1].signed_push.to_degrees()
    }

    /// Returns true if a push detaches at the end of the stable states. With friction, it does not if the contact sticks there.
    pub(super) fn detaches(&self) -> bool {
        let end = self.stable_end_deg().to_radians().abs();
        let history = self.history.as_ref();
        let sliding = history.and_then(|history| history.sliding_at_end(end));
        sliding.is_none_or(|sliding| sliding == Sliding::Tip)
    }

    /// Returns the error of a failed continuation or corrector.
    pub(super) fn failed(&self) -> NoState {
        let nodes = &self.path.nodes;
        let push_deg = nodes[nodes.len() - 1].signed_push.to_degrees();
        NoState::Failed { push_deg }
    }

    /// Returns the largest bending strains of `states`, `[state]`.
    pub(super) fn peaks(&self, states: &[StateAtPush]) -> Vec<PeakStrain> {
        let rods: Vec<_> = states.iter().map(|state| self.rod(state.ratio)).collect();
        let conditions =
            rods.iter().zip(states).map(|(rod, state)| InitialCondition::new(rod, state.point));
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
            push_angle_deg: state.signed_push.to_degrees(),
            contact_angle_deg: state.angle.to_degrees(),
            peak_strain: peak.strain * self.units.strain,
            peak_strain_mm: peak.arclength * self.units.length_mm,
            // From (ln D, phi) by (tau, load) to (D, phi) by (s, f): dtau/ds = 1/rho, dload/df = 1/rho^2, and f is the
            // normal component of the force.
            det: state.full.map.det() * row.pole_distance
                / (rod.radius(state.point.x).powi(3) * rod.contact_tangent().x),
            sliding: state.sliding,
            ..BranchPoint::default().with_state(Some(&self.read(state)))
        }
    }
}
