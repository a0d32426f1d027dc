//! Derivatives of the largest loads of pushes.

use super::differentiated::Differentiated;
use super::{Derivatives, DetachmentDerivatives, NoDerivative, Variable, detachments};
use crate::scene::{Pole, Whisker};
use crate::trace::{FINER, NoState, PushLoad, PushPeak, StableBranch};
use whiskmap_mechanics::rod::Side;

/// Largest size of a load during a push, with its derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct LargestLoad {
    /// Largest size of the load, with its place.
    pub peak: PushPeak,
    /// Derivatives of the largest size by each variable, in the unit of the load per unit of the variable, `[variable]`, or the reason why
    /// there is no derivative.
    pub by: Vec<Result<f64, NoDerivative>>,
}

/// Computes the largest size of `load` in a push of `whisker` on `side`, from first touch at `distance_mm` to the end, with its derivatives by each of
/// `variables`.
///
/// The largest size is the size at the end, or a maximum before the end. At a maximum the derivative by the push angle is 0, so that the
/// derivatives at a fixed push angle are the derivatives of the maximum. Strains have no derivatives.
///
/// # Errors
/// The whisker at rest does not reach the pole, or the continuation fails.
pub fn largest(
    whisker: &Whisker,
    pole: &Pole,
    side: Side,
    distance_mm: f64,
    load: PushLoad,
    variables: &[Variable],
) -> Result<LargestLoad, NoState> {
    let branch = StableBranch::new(whisker, pole, side, distance_mm)?;
    let end = || detachments(whisker, pole, side, &[distance_mm], variables).pop();
    largest_along(&branch, (whisker, pole), distance_mm, load, variables, end)
}

/// Computes the largest size of `load` along a `branch` as [`largest`] does; `end` returns the detachment with its derivatives.
pub(super) fn largest_along(
    branch: &StableBranch,
    (whisker, pole): (&Whisker, &Pole),
    distance_mm: f64,
    load: PushLoad,
    variables: &[Variable],
    end: impl FnOnce() -> Option<DetachmentDerivatives>,
) -> Result<LargestLoad, NoState> {
    let peak = branch.peak(load);
    let none = |why| (0.0, vec![Err(why); variables.len()]);
    let (moment, by) = match peak.before_end_deg {
        None => end().map_or_else(
            || none(NoDerivative::NoDetachment),
            |detachment| (detachment.end.base_moment_nnm.unwrap_or_default(), detachment.by),
        ),
        Some(push_deg) => {
            let state = branch.state(push_deg.to_radians())?;
            let side = Side::of_push(push_deg);
            let differentiated = Differentiated::new(FINER, whisker, pole, side, variables);
            let by = differentiated.of_state(&state, distance_mm);
            (branch.read(&state).base_moment_nnm, by)
        }
    };
    let quantity = |by: Derivatives| match load {
        PushLoad::ContactForce => Ok(by.contact_force_un),
        PushLoad::BaseMoment => Ok(moment.signum() * by.base_moment_nnm),
        PushLoad::Strain => Err(NoDerivative::Strain),
    };
    let by = by.into_iter().map(|by| by.and_then(quantity));
    Ok(LargestLoad { peak, by: by.collect() })
}
