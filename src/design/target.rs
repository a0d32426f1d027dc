//! Targets of designs: push angles of detachments, and the largest loads of pushes.

use crate::input::Quantity;
use crate::scene::Scene;
use crate::sensitivity::{NoDerivative, Variable, detachments_of, largest};
use crate::trace::{
    self, Detachment, DetachmentKind, EndDetail, PushLoad, PushedWhisker, StableBranch,
};
use rayon::prelude::*;
use std::cell::OnceCell;
use std::sync::atomic::AtomicBool;
use whiskmap_mechanics::rod::Side;
use whiskmap_mechanics::shooting::Resolution;

/// Largest difference of the push angles of a solution and the target, in degrees: exact ends are known to 1e-11.
const TOLERANCE_DEG: f64 = 1e-9;

/// Largest difference of the loads of a solution and the target, relative to the target. Where a load is largest at the fold, it is known to
/// the root of the rounding error, as only the push angle is stationary there.
const TOLERANCE: f64 = 1e-6;

/// Largest size of the push angle of a target, in degrees: nine turns of the base, up to which pushes are followed.
pub const MOST_PUSH_DEG: f64 = 9.0 * 360.0;

/// Target of a design: where the pole is, and the value that a push must reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DesignTarget {
    /// Distance from the base to the contact at first touch, in millimetres. It does not count if the design varies it, or gives it as a part of
    /// the length.
    pub distance_mm: f64,
    /// Side of the whisker that the pole is on.
    pub side: Side,
    /// Quantity that the design gives a value.
    pub goal: DesignGoal,
    /// Value of the quantity, in its unit; a push angle is positive CB and negative CF.
    pub value: f64,
}

/// Quantity of a push that a design gives a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DesignGoal {
    /// Push angle at which the whisker slips off, in degrees.
    SlipOff,
    /// Push angle at which the whisker is pulled off, in degrees.
    PullOff,
    /// Largest whole contact force, with friction, from first touch to the detachment, in uN.
    MaxForce,
    /// Largest moment at the base from first touch to the detachment, in nN m.
    MaxMoment,
    /// Largest bending strain from first touch to the detachment, dimensionless.
    MaxStrain,
}

impl DesignGoal {
    /// Returns the kind of detachment that the goal requires; `None` if any detachment counts.
    #[must_use]
    pub const fn kind(self) -> Option<DetachmentKind> {
        match self {
            Self::SlipOff => Some(DetachmentKind::SlipOff),
            Self::PullOff => Some(DetachmentKind::PullOff),
            Self::MaxForce | Self::MaxMoment | Self::MaxStrain => None,
        }
    }

    /// Returns the quantity of the goal, with its unit.
    #[must_use]
    pub const fn quantity(self) -> Quantity {
        match self {
            Self::SlipOff | Self::PullOff => Quantity::AngleDeg,
            Self::MaxForce => Quantity::ForceUn,
            Self::MaxMoment => Quantity::MomentNnm,
            Self::MaxStrain => Quantity::Number,
        }
    }

    /// Returns the name of the goal's quantity in charts and messages.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::SlipOff | Self::PullOff => "push angle at detachment",
            Self::MaxForce => "largest force",
            Self::MaxMoment => "largest moment at the base",
            Self::MaxStrain => "largest bending strain",
        }
    }

    /// Returns the number of significant digits of a solution for the goal, by the tolerance of the goal.
    #[must_use]
    pub const fn digits(self) -> usize {
        match self {
            Self::SlipOff | Self::PullOff => 10,
            Self::MaxForce | Self::MaxMoment | Self::MaxStrain => 6,
        }
    }

    /// Returns the load of the goal; `None` for push angles.
    #[must_use]
    pub const fn load(self) -> Option<PushLoad> {
        match self {
            Self::SlipOff | Self::PullOff => None,
            Self::MaxForce => Some(PushLoad::ContactForce),
            Self::MaxMoment => Some(PushLoad::BaseMoment),
            Self::MaxStrain => Some(PushLoad::Strain),
        }
    }
}

impl DesignTarget {
    /// Returns true if a design may end with this kind of detachment.
    #[must_use]
    pub fn accepts(&self, kind: DetachmentKind) -> bool {
        match self.goal.kind() {
            Some(wanted) => kind == wanted,
            None => matches!(kind, DetachmentKind::SlipOff | DetachmentKind::PullOff),
        }
    }

    /// The largest difference of a solution from the target, in the unit of the goal.
    pub(super) fn tolerance(&self) -> f64 {
        match self.goal.load() {
            None => TOLERANCE_DEG,
            Some(_) => TOLERANCE * self.value.abs(),
        }
    }

    /// Returns the exact derivatives of the goal's quantity for a push of `scene` at its only distance, in the directions of variables with
    /// factors: `[variable]`. `None` without derivatives, and for strains.
    pub(super) fn gradient(
        &self,
        scene: &Scene,
        directions: &[Vec<(Variable, f64)>],
    ) -> Option<Vec<f64>> {
        let (whisker, pole, side) = (&scene.whisker, &scene.pole, self.side);
        let distance_mm = *scene.grid.distance_mm.first()?;
        let all = directions.iter().flatten();
        let variables: Vec<Variable> = all.map(|(variable, _)| *variable).collect();
        let by: Vec<Result<f64, NoDerivative>> = match self.goal.load() {
            None => {
                let pushed = PushedWhisker { whisker, pole, side, distances_mm: &[distance_mm] };
                let detail = EndDetail::State;
                let ends = detachments_of(Resolution::FINE, &[pushed], detail, &variables);
                let push = ends.into_iter().flatten().next()?.by.into_iter();
                push.map(|by| by.map(|by| by.push_angle_deg)).collect()
            }
            Some(load) => largest(whisker, pole, side, distance_mm, load, &variables).ok()?.by,
        };
        let mut by = by.into_iter();
        let mut along = |direction: &Vec<(Variable, f64)>| {
            let parts = direction.iter().map(|(_, factor)| {
                let derivative = by.next()?.ok()?;
                Some(factor * derivative)
            });
            parts.collect::<Vec<_>>().into_iter().sum::<Option<f64>>()
        };
        directions.iter().map(&mut along).collect()
    }

    /// Computes how a push at the only distance of each of `scenes` ends, and the value of the goal's quantity, in its unit: `[scene]`. The
    /// value is `None` without a detachment.
    pub(super) fn reached(&self, scenes: &[&Scene]) -> Vec<(DetachmentKind, Option<f64>)> {
        let pushes = ComputedPush::of(scenes, self.side).into_par_iter();
        let reached = pushes.map(|push| push.reached(self.goal, exactly));
        reached.collect()
    }
}

/// Largest size of a load of a push.
pub(super) type LargestOf = fn(&StableBranch, PushLoad) -> f64;

/// Computed push of a scene at its only distance: its end, and its stable states once a load needs them.
pub(super) struct ComputedPush<'a> {
    scene: &'a Scene,
    side: Side,
    end: Option<Detachment>,
    branch: OnceCell<Option<StableBranch>>,
}

impl<'a> ComputedPush<'a> {
    /// Computes the ends of pushes of `scenes` on one side, `[scene]`.
    pub fn of(scenes: &[&'a Scene], side: Side) -> Vec<Self> {
        let pushed = scenes.iter().map(|scene| PushedWhisker {
            whisker: &scene.whisker,
            pole: &scene.pole,
            side,
            distances_mm: &scene.grid.distance_mm,
        });
        let pushed: Vec<PushedWhisker> = pushed.collect();
        let (detail, never) = (EndDetail::State, AtomicBool::new(false));
        let ends = trace::detachments(Resolution::FINE, &pushed, detail, &never, |_, end, _| end);
        let pushes = scenes.iter().zip(ends.unwrap_or_default()).map(|(scene, mut ends)| Self {
            scene,
            side,
            end: ends.pop(),
            branch: OnceCell::new(),
        });
        pushes.collect()
    }

    /// Returns how the push ends, and the value of the goal's quantity, in its unit; `None` without a detachment.
    pub fn reached(&self, goal: DesignGoal, largest: LargestOf) -> (DetachmentKind, Option<f64>) {
        let Some(end) = &self.end else {
            return (DetachmentKind::Unresolved, None);
        };
        let (kind, detaches) = (end.kind, end.push_angle_deg);
        let (Some(load), Some(_)) = (goal.load(), detaches) else {
            return (kind, detaches);
        };
        let branch = self.branch.get_or_init(|| {
            let (whisker, pole) = (&self.scene.whisker, &self.scene.pole);
            StableBranch::new(whisker, pole, self.side, self.scene.grid.distance_mm[0]).ok()
        });
        match branch {
            Some(branch) => (kind, Some(largest(branch, load))),
            None => (DetachmentKind::Unresolved, None),
        }
    }
}

/// Returns the largest size of a load of a push.
pub(super) fn exactly(branch: &StableBranch, load: PushLoad) -> f64 {
    branch.peak(load).size
}
