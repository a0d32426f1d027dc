//! Designs: values of a parameter with which a push reaches a target: a push angle at detachment, or a largest load.
//!
//! The search scans the range that the scene accepts. Between samples it finds changes of the kind of detachment, and turns of
//! the target's quantity. Between neighbours of all these values, it finds push angles by Newton's method with exact derivatives, and loads by
//! bisection. Every solution is computed: a jump across the target is no
//! solution.

mod samples;
mod search;
mod target;
mod turn;

pub use samples::is_wide;
pub use target::{DesignGoal, DesignTarget};

use crate::scene::{Parameter, Scene, SceneError, digits};
use crate::trace::DetachmentKind;
use search::DesignSearch;
use std::sync::atomic::{AtomicBool, Ordering};

/// Relative difference of values below which they are one solution, or a range leaves no choice.
const EQUAL: f64 = 1e-9;

/// End of a push at one value of the design's parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DesignEnd {
    /// Value of the design's parameter, in its unit.
    pub value: f64,
    /// Kind of the end: how the push ends at this value.
    pub kind: DetachmentKind,
    /// Value of the goal's quantity at this value of the parameter, in its unit; `None` without a detachment.
    pub reached: Option<f64>,
}

/// Solutions of a design, and the ends over the whole range of the parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// Solutions of the design, in the unit of the parameter, growing: `[solution]`. Empty if no value reaches the target, or if every
    /// value reaches the same.
    pub values: Vec<f64>,
    /// Range of the parameter `[least, greatest]` that the scene accepts, in its unit.
    pub range: [f64; 2],
    /// Ends of pushes at values over [`Design::range`], `[value]`, in growing order of the values.
    pub ends: Vec<DesignEnd>,
}

/// Error of a design.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DesignError {
    /// The scene sweeps whiskers along this axis, but a design needs one whisker.
    #[error("grid.{0}: must be left out, as one number of one whisker is varied")]
    Sweep(&'static str),
    /// The scene does not give the parameter of the design.
    #[error("{}: must be one of {given}, which the scene has; it has no {}", .parameter.name(), .parameter.key())]
    Lacking {
        /// Parameter of the design that the scene does not give.
        parameter: Parameter,
        /// Names of the parameters that the scene gives.
        given: String,
    },
    /// The scene accepts no other value of the design's parameter.
    #[error("{}: the scene accepts no value but {} for {}, with all other numbers fixed", .parameter.name(), digits(*.value), .parameter.key())]
    Fixed {
        /// Parameter of the design that has only one accepted value.
        parameter: Parameter,
        /// The only value of the parameter that the scene accepts, in its unit.
        value: f64,
    },
    /// The scene accepts no pole at the distance of the design.
    #[error(transparent)]
    Distance(#[from] SceneError),
    /// The design was cancelled.
    #[error("cancelled")]
    Cancelled,
}

impl Design {
    /// Returns the part `[least, greatest]` of the range that a chart shows, in the unit of the parameter: in a wide range, up to ten times
    /// below and above the solutions.
    #[must_use]
    pub fn shown(&self) -> [f64; 2] {
        match (self.values.first(), self.values.last()) {
            (Some(first), Some(last)) if is_wide(self.range) => {
                let [low, high] = self.range;
                [low.max(first / 10.0), high.min(last * 10.0)]
            }
            _ => self.range,
        }
    }

    /// Returns the range `[least, greatest]` of the goal's quantity over ends of a kind, in its unit; `None` without such an end.
    #[must_use]
    pub fn reached(&self, kind: DetachmentKind) -> Option<[f64; 2]> {
        let ends = self.ends.iter().filter(|end| end.kind == kind);
        let values = ends.filter_map(|end| end.reached);
        values.fold(None, |reached, value| {
            let [low, high] = reached.unwrap_or([value; 2]);
            Some([value.min(low), value.max(high)])
        })
    }
}

/// Finds every value of `parameter` with which the whisker of `scene` detaches as `target` says. The grid is not used.
///
/// ```
/// use whiskmap::design::{DesignGoal, DesignTarget, design};
/// use whiskmap::Side;
/// use whiskmap::scene::{Parameter, Scene};
///
/// let cone = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml")?;
/// let target = DesignTarget { distance_mm: 15.66, side: Side::Cb, goal: DesignGoal::SlipOff, value: 20.0 };
/// let design = design(&cone, Parameter::TipRadiusUm, &target)?;
/// let [tip_radius_um] = design.values[..] else { panic!("{design:?}") };
/// assert!((tip_radius_um - 4.063).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the scene sweeps whiskers, does not give the parameter, or accepts one value only, or no pole at the distance.
pub fn design(
    scene: &Scene,
    parameter: Parameter,
    target: &DesignTarget,
) -> Result<Design, DesignError> {
    design_until(scene, parameter, target, &AtomicBool::new(false))
}

/// Finds every value of `parameter` as [`design`] does. If `cancel` is true, the function soon returns an error.
///
/// # Errors
/// Fails as [`design`] does, and if it is cancelled.
pub fn design_until(
    scene: &Scene,
    parameter: Parameter,
    target: &DesignTarget,
    cancel: &AtomicBool,
) -> Result<Design, DesignError> {
    if let Some(axis) = scene.grid.sweep.first() {
        return Err(DesignError::Sweep(axis.variable.name()));
    }
    let Some(value) = parameter.value(scene) else {
        let given = Parameter::given(scene);
        return Err(DesignError::Lacking { parameter, given });
    };
    let scene = &with_one_pole(scene, target)?;
    let range = parameter.range(scene);
    if range[1] - range[0] <= 3.0 * EQUAL * value.abs() {
        return Err(DesignError::Fixed { parameter, value });
    }
    let search = DesignSearch {
        scene,
        parameter,
        target,
        cancel,
    };
    let ends = search.scan(range);
    let mut values: Vec<f64> = ends
        .chunk_by(|a, b| a.kind == b.kind)
        .filter(|piece| target.accepts(piece[0].kind))
        .flat_map(|piece| search.solutions(piece))
        .collect();
    if cancel.load(Ordering::Relaxed) {
        return Err(DesignError::Cancelled);
    }
    values.sort_by(f64::total_cmp);
    values.dedup_by(|b, a| (*b - *a).abs() <= EQUAL * a.abs());
    let mut design = Design {
        values,
        range,
        ends,
    };
    let kinds = [DetachmentKind::SlipOff, DetachmentKind::PullOff].into_iter();
    let reached = kinds
        .filter(|kind| target.accepts(*kind))
        .filter_map(|kind| design.reached(kind))
        .reduce(|[low, high], [least, most]| [low.min(least), high.max(most)]);
    if reached.is_some_and(|[low, high]| high - low <= target.tolerance()) {
        design.values.clear();
    }
    Ok(design)
}

/// Computes the ends of pushes at values of `parameter` over a part of its range, in its unit, `[value]`, as [`Design::ends`] are.
///
/// # Errors
/// If the scene accepts no pole at the distance of the target.
pub fn ends_between(
    scene: &Scene,
    parameter: Parameter,
    target: &DesignTarget,
    range: [f64; 2],
) -> Result<Vec<DesignEnd>, DesignError> {
    let search = DesignSearch {
        scene: &with_one_pole(scene, target)?,
        parameter,
        target,
        cancel: &AtomicBool::new(false),
    };
    Ok(search.scan(range))
}

/// The scene with the pole of the target alone: other distances would limit what is accepted.
fn with_one_pole(scene: &Scene, target: &DesignTarget) -> Result<Scene, SceneError> {
    scene.to_builder().distance_mm([target.distance_mm]).build()
}
