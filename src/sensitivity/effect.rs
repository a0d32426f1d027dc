//! Effects of single variables on the push angle at detachment, as rows of a table.

use super::largest::largest_along;
use super::{LargestLoad, NoDerivative, Variable, detachments};
use crate::scene::{Scene, SweptWhisker};
use crate::trace::{DetachmentKind, PushLoad, StableBranch, row};
use serde::{Serialize, Serializer};
use whiskmap_mechanics::rod::Side;

row! {
    /// Effect of one variable on a detachment.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    pub struct VariableEffect {
        pub side: Side,
        pub distance_mm: f64,
        /// End of the push: slip-off, pull-off, out-of-reach or unresolved.
        pub kind: DetachmentKind,
        /// Push angle at detachment, in degrees: positive CB, negative CF.
        pub push_angle_deg: Option<f64>,
        /// Variable by which the push angle is differentiated: a parameter or the distance, with its unit at the end of its name.
        pub variable: Variable,
        /// Value of the variable in the scene, in its unit.
        pub value: Option<f64>,
        /// Derivative of the push angle by the variable, in degrees per unit of the variable.
        pub d_push_deg: Option<f64>,
        /// Change of the push angle if the variable grows by 1 %, to first order, in degrees.
        pub push_of_1_percent_deg: Option<f64>,
        /// Largest contact force of the push, with friction, in uN.
        pub max_contact_force_un: Option<f64>,
        /// Derivative of the largest contact force by the variable, in uN per unit of the variable.
        pub d_max_contact_force_un: Option<f64>,
        /// Largest moment at the base in the push, in nN m.
        pub max_base_moment_nnm: Option<f64>,
        /// Derivative of the largest moment at the base by the variable, in nN m per unit of the variable.
        pub d_max_base_moment_nnm: Option<f64>,
        /// Largest bending strain of the push, which has no derivative.
        pub max_strain: Option<f64>,
        /// Reason why there is no derivative of the push angle; empty for a derivative.
        pub reason: Option<NoDerivative>,
    }
}

impl Serialize for Variable {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl Serialize for NoDerivative {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// Computes the effects of all variables of the scene's whisker on its detachments at one distance, CF before CB: `[variable]` of each side.
/// The grid is not used.
#[must_use]
pub fn effects(scene: &Scene, distance_mm: f64) -> Vec<VariableEffect> {
    let variables = Variable::of_detachments(scene);
    let SweptWhisker { whisker, pole, .. } = &scene.first_whisker();
    let of_side = |side: Side| {
        let ends = detachments(whisker, pole, side, &[distance_mm], &variables);
        let branch = StableBranch::new(whisker, pole, side, distance_mm).ok();
        let loads = [PushLoad::ContactForce, PushLoad::BaseMoment].map(|load| {
            let (branch, end) = (branch.as_ref()?, || ends.first().cloned());
            largest_along(branch, (whisker, pole), distance_mm, load, &variables, end).ok()
        });
        let [force, moment] = &loads;
        let strain = branch.as_ref().map(|branch| branch.peak(PushLoad::Strain));
        let known = |size: &f64| !size.is_nan();
        let size = |load: &Option<LargestLoad>| {
            let size = load.as_ref().map(|load| load.peak.size);
            size.filter(known)
        };
        let slope = |load: &Option<LargestLoad>, i: usize| load.as_ref()?.by.get(i)?.ok();
        let row = |detachment: super::DetachmentDerivatives| {
            let rows: Vec<VariableEffect> = variables
                .iter()
                .zip(detachment.by)
                .enumerate()
                .map(|(i, (&variable, by))| {
                    let value = match variable {
                        Variable::DistanceMm => Some(distance_mm),
                        _ => variable.value(scene),
                    };
                    let d_push_deg = by.ok().map(|by| by.push_angle_deg);
                    VariableEffect {
                        side,
                        distance_mm,
                        kind: detachment.end.kind,
                        push_angle_deg: detachment.end.push_angle_deg,
                        variable,
                        value,
                        d_push_deg,
                        push_of_1_percent_deg: d_push_deg
                            .zip(value)
                            .map(|(by, value)| 0.01 * value * by),
                        max_contact_force_un: size(force),
                        d_max_contact_force_un: slope(force, i),
                        max_base_moment_nnm: size(moment),
                        d_max_base_moment_nnm: slope(moment, i),
                        max_strain: strain.map(|peak| peak.size).filter(known),
                        reason: by.err(),
                    }
                })
                .collect();
            rows
        };
        ends.into_iter().flat_map(row).collect::<Vec<_>>()
    };
    Side::BOTH.into_iter().flat_map(of_side).collect()
}
