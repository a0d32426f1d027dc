//! Exact derivatives of detachments and states by the numbers of a scene.
//!
//! A known state is integrated once more in dual numbers, and the implicit function theorem gives its derivatives. Nothing is
//! differenced, and no sheet is computed. Parameters that only scale are differentiated in closed form.
//!
//! ```
//! use whiskmap::Side;
//! use whiskmap::scene::{Parameter, Scene};
//! use whiskmap::sensitivity::{Variable, detachments};
//!
//! let cone = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml")?;
//! let variables = [Variable::from(Parameter::Taper), Variable::DistanceMm];
//! let ends = detachments(&cone.whisker, &cone.pole, Side::Cb, &[15.66], &variables);
//! let [by_taper, by_distance] = ends[0].by[..] else { panic!("{ends:?}") };
//! assert!(by_taper?.push_angle_deg < 0.0 && by_distance?.push_angle_deg < 0.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod differentiated;
mod effect;
mod largest;
mod linearised;
mod quantities;
mod variable;
mod whisker;

pub use effect::{VariableEffect, effects};
pub use largest::{LargestLoad, largest};
pub use quantities::Derivatives;
pub use variable::Variable;

use crate::scene::{Parameter, Pole, Whisker};
use crate::sheet::{Crossing, Sheet};
use crate::trace::{
    self, Branch, BranchPoint, Detachment, EndDetail, FINER, NoState, PushedWhisker, StableBranch,
    SweptSide, crossings,
};
use differentiated::Differentiated;
use std::sync::atomic::AtomicBool;
use whiskmap_mechanics::rod::Side;
use whiskmap_mechanics::shooting::Resolution;

/// A detachment with its derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct DetachmentDerivatives {
    /// End of the push. [`detachments`] leaves out the largest strain.
    pub end: Detachment,
    /// Derivatives of the end by each variable, `[variable]`, or the reason why there are none.
    pub by: Vec<Result<Derivatives, NoDerivative>>,
}

/// A state of a branch with its derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct StateDerivatives {
    /// State of the branch.
    pub point: BranchPoint,
    /// Derivatives of the state by each variable, `[variable]`, with the other variables and the push angle fixed, or the reason why there
    /// are none.
    pub by: Vec<Result<Derivatives, NoDerivative>>,
}

/// Reason why a derivative does not exist.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoDerivative {
    /// The whisker has no such number, such as the taper of measured radii.
    #[error("the whisker has no such number")]
    NotGiven,
    /// The push does not end: the pole is out of reach, or the end is unknown.
    #[error("no detachment")]
    NoDetachment,
    /// The push ends at first touch, with the tip of the resting whisker at the pole.
    #[error("the push ends at first touch")]
    AtTouch,
    /// The fold meets the tip, so that slip-off turns into pull-off.
    #[error("slip-off turns into pull-off here")]
    Corner,
    /// The contact sticks or slides toward the base: its state depends on the whole push.
    #[error(
        "the contact does not slide toward the tip, so that the state depends on the whole push"
    )]
    Course,
    /// The quantity is a largest strain, whose place moves along the whisker.
    #[error("largest strains are not differentiated")]
    Strain,
    /// The equations of the state are singular: a state at a fold, or two folds that merge.
    #[error("the equations are singular here")]
    Singular,
}

/// Computes the detachments of `whisker` on one `side` at each of `distances_mm`, which must increase, with their derivatives by each of
/// `variables`: `[distance]`.
#[must_use]
pub fn detachments(
    whisker: &Whisker,
    pole: &Pole,
    side: Side,
    distances_mm: &[f64],
    variables: &[Variable],
) -> Vec<DetachmentDerivatives> {
    let pushed = PushedWhisker { whisker, pole, side, distances_mm };
    detachments_of(Resolution::FINE, &[pushed], EndDetail::Snaps, variables).concat()
}

/// Computes the detachments of some `sides` of a sweep with all details, `[side][distance]`, as [`detachments_of`] does. Rows of a table without
/// a whisker have ends without values.
#[must_use]
pub fn detachments_of_sides(
    resolution: Resolution,
    sides: &[SweptSide],
    distances_mm: &[f64],
    variables: &[Variable],
) -> Vec<Vec<DetachmentDerivatives>> {
    let never = AtomicBool::new(false);
    let found = detachments_of_sides_until(resolution, sides, distances_mm, variables, &never);
    found.unwrap_or_default()
}

/// Computes the detachments of some `sides` of a sweep as [`detachments_of_sides`] does. If `cancel` is true, the function soon returns `None`.
#[must_use]
pub fn detachments_of_sides_until(
    resolution: Resolution,
    sides: &[SweptSide],
    distances_mm: &[f64],
    variables: &[Variable],
    cancel: &AtomicBool,
) -> Option<Vec<Vec<DetachmentDerivatives>>> {
    let pushed = sides.iter().filter_map(|SweptSide { swept, side }| {
        let swept = swept.ok()?;
        Some(PushedWhisker {
            whisker: &swept.whisker,
            pole: &swept.pole,
            side: *side,
            distances_mm,
        })
    });
    let pushed: Vec<PushedWhisker> = pushed.collect();
    let found = until(resolution, &pushed, EndDetail::All, variables, cancel)?;
    let mut found = found.into_iter();
    let without = |end| DetachmentDerivatives {
        end,
        by: vec![Err(NoDerivative::NoDetachment); variables.len()],
    };
    let of_side = |SweptSide { swept, side }: &SweptSide| match swept {
        Ok(_) => found.next().unwrap_or_default(),
        Err(_) => {
            let ends = Detachment::without_whisker(*side, distances_mm).into_iter();
            ends.map(without).collect()
        }
    };
    Some(sides.iter().map(of_side).collect())
}

/// Computes the detachments of several `pushed` whiskers, with this `detail` and their derivatives by `variables`: `[pushed][distance]`. Their
/// trajectories share batches. Results do not depend on the other whiskers.
#[must_use]
pub fn detachments_of(
    resolution: Resolution,
    pushed: &[PushedWhisker],
    detail: EndDetail,
    variables: &[Variable],
) -> Vec<Vec<DetachmentDerivatives>> {
    let found = until(resolution, pushed, detail, variables, &AtomicBool::new(false));
    found.unwrap_or_default()
}

/// Computes detachments as [`detachments_of`] does. If `cancel` is true, the function soon returns `None`.
fn until(
    resolution: Resolution,
    pushed: &[PushedWhisker],
    detail: EndDetail,
    variables: &[Variable],
    cancel: &AtomicBool,
) -> Option<Vec<Vec<DetachmentDerivatives>>> {
    let differentiated = pushed.iter().map(|pushed| {
        let PushedWhisker { whisker, pole, side, .. } = *pushed;
        Differentiated::new(resolution, whisker, pole, side, variables)
    });
    let differentiated: Vec<Differentiated> = differentiated.collect();
    let of_end =
        |index: usize, end: Detachment, crossing: Option<Crossing>| DetachmentDerivatives {
            by: differentiated[index].at_crossing(crossing.as_ref(), end.distance_mm),
            end,
        };
    trace::detachments(resolution, pushed, detail, cancel, of_end)
}

/// Returns the derivatives of the push angle at the detachments of `sheet`, whose rows have these distances, by each of `parameters`, in
/// degrees per unit of the parameter: `[row][parameter]`. NaN where there is none.
pub(crate) fn of_rows(
    resolution: Resolution,
    sheet: &Sheet,
    (whisker, pole): (&Whisker, &Pole),
    distances_mm: &[f64],
    parameters: &[Parameter],
) -> Vec<Vec<(Parameter, f32)>> {
    let variables: Vec<Variable> = parameters.iter().copied().map(Variable::from).collect();
    let differentiated = Differentiated::new(resolution, whisker, pole, sheet.side, &variables);
    let of_row = |(crossing, distance): (Result<Crossing, _>, &f64)| {
        let by = differentiated.at_crossing(crossing.ok().as_ref(), *distance);
        let push = |by: Result<Derivatives, _>| by.map_or(f32::NAN, |by| by.push_angle_deg as f32);
        let parameters = parameters.iter().copied();
        parameters.zip(by.into_iter().map(push)).collect()
    };
    crossings(sheet).into_iter().zip(distances_mm).map(of_row).collect()
}

/// Computes `count` points of the branch of `whisker` at `pole` as [`Branch::points`] does, with their derivatives by each of `variables`:
/// `[point]`. First touch is at `distance_mm` from the base.
///
/// # Errors
/// The whisker at rest does not reach the pole, or the continuation fails.
pub fn branch(
    whisker: &Whisker,
    pole: &Pole,
    side: Side,
    distance_mm: f64,
    count: usize,
    variables: &[Variable],
) -> Result<Vec<StateDerivatives>, NoState> {
    let differentiated = Differentiated::new(FINER, whisker, pole, side, variables);
    let states = Branch::new(whisker, pole, side, distance_mm)?
        .states(count, &AtomicBool::new(false))?
        .into_iter()
        .map(|(state, point)| StateDerivatives {
            by: differentiated.of_state(&state, distance_mm),
            point,
        });
    Ok(states.collect())
}

/// Computes the stable state of `whisker` after a push of `push_angle_deg` from first touch at `distance_mm`, with its derivatives by each
/// of `variables`. The sign of the push angle selects the side.
///
/// ```
/// use whiskmap::scene::Scene;
/// use whiskmap::sensitivity::{Variable, state};
///
/// let cone = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml")?;
/// let found = state(&cone.whisker, &cone.pole, 15.66, 10.0, &[Variable::PushAngleDeg])?;
/// assert!(found.by[0]?.force_un > 0.0); // stiffness in uN per degree
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If there is no such state. The error contains how the whisker left the pole.
pub fn state(
    whisker: &Whisker,
    pole: &Pole,
    distance_mm: f64,
    push_angle_deg: f64,
    variables: &[Variable],
) -> Result<StateDerivatives, NoState> {
    let side = Side::of_push(push_angle_deg);
    let branch = StableBranch::new(whisker, pole, side, distance_mm)?;
    let state = branch.state(push_angle_deg.to_radians())?;
    let differentiated = Differentiated::new(FINER, whisker, pole, side, variables);
    Ok(StateDerivatives {
        by: differentiated.of_state(&state, distance_mm),
        point: branch.point_of(&state),
    })
}
