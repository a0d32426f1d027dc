//! Designs: values of parameters with which a push reaches as many targets: a push angle at detachment, or a largest load.
//!
//! With one parameter, the search scans the range that the scene accepts. Between samples it finds changes of the kind of detachment, and turns of
//! the target's quantity. Between neighbours of all these values, it finds push angles by Newton's method with exact derivatives, and loads by
//! bisection. With several parameters, Newton's method starts from many places within their limits ([`designs`]). Every solution is
//! computed: a jump across the target is no solution.

mod samples;
mod search;
mod target;
mod together;
mod turn;
mod varied;

pub use samples::is_wide;
pub use target::{DesignGoal, DesignTarget, MOST_PUSH_DEG};
pub use together::{DesignNearest, Designs, designs, designs_until};
pub use varied::{DesignVariable, DesignVaried};

use crate::input::each_once;
use crate::scene::{Parameter, Scene, SceneError, digits};
use crate::sensitivity::Variable;
use crate::trace::DetachmentKind;
use search::DesignSearch;
use std::sync::atomic::{AtomicBool, Ordering};
use varied::DesignScene;

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
    /// Solutions of the design outside [`Design::spans`], in the unit of the parameter, growing: `[solution]`.
    pub values: Vec<f64>,
    /// Ranges over which every value reaches the target, because its quantity does not depend on the parameter there:
    /// `[span][least, greatest]`, growing, in the unit of the parameter.
    pub spans: Vec<[f64; 2]>,
    /// Range of the parameter `[least, greatest]` that the scene accepts, in its unit.
    pub range: [f64; 2],
    /// Ends of pushes at values over [`Design::range`], `[value]`, in growing order of the values.
    pub ends: Vec<DesignEnd>,
}

/// Error of a design.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DesignError {
    /// The scene sweeps whiskers along the axis of this key, but a design needs one whisker.
    #[error("{0}: must be left out, as numbers of one whisker are varied")]
    Sweep(&'static str),
    /// The scene does not give the parameter of the design.
    #[error("{}: must be one of {given}, which the scene has; it has no {}", .parameter.name(), .parameter.key())]
    Lacking {
        /// Parameter of the design that the scene does not give.
        parameter: Parameter,
        /// Names of the parameters that the scene gives.
        given: String,
    },
    /// The number is no parameter of a scene, and not the distance.
    #[error("{0}: must be a parameter of the scene, or distance_mm")]
    NotVaried(Variable),
    /// Two varied numbers are one number of the scene.
    #[error("{}", given_twice(*.0, *.1))]
    Twice(Variable, Variable),
    /// The taper is to stay, but no radius varies, or the taper does.
    #[error("taper: it can be kept where base_radius_um or tip_radius_um varies alone")]
    NoTaper,
    /// The design has not as many targets as varied numbers.
    #[error("{variables} varied numbers need as many targets, of one push; there are {targets}")]
    Targets {
        /// Number of varied numbers.
        variables: usize,
        /// Number of targets, all at one distance and side, each of another quantity.
        targets: usize,
    },
    /// The scene and the limits of a varied number allow no value but this.
    #[error("{variable}: the scene accepts no value but {} for {}, with all other numbers fixed", digits(*.value), key(*.variable))]
    Fixed {
        /// Varied number that has only one accepted value.
        variable: Variable,
        /// The only value of the number that the scene accepts, in its unit.
        value: f64,
    },
    /// The scene accepts no value within the limits of a varied number.
    #[error("{variable}: must lie between {} and {}, which the scene accepts; the limits are {} to {}",
        digits(.range[0]), digits(.range[1]), digits(.limits[0]), digits(.limits[1]))]
    Limits {
        /// Varied number with the limits.
        variable: Variable,
        /// Range of values that the scene accepts, in the unit of the number.
        range: [f64; 2],
        /// Limits of the number, in its unit.
        limits: [f64; 2],
    },
    /// The scene accepts no pole at the distance of the design.
    #[error(transparent)]
    Distance(#[from] SceneError),
    /// The design was cancelled.
    #[error("cancelled")]
    Cancelled,
}

/// Returns the key of a varied number in a scene file.
fn key(variable: Variable) -> String {
    match variable {
        Variable::Parameter(parameter) => parameter.key().to_owned(),
        variable => variable.name(),
    }
}

/// Returns the message about two varied numbers that are one number of the scene.
fn given_twice(one: Variable, other: Variable) -> String {
    if one == other {
        format!("{one}: is given twice")
    } else {
        format!("{one} and {other}: give one of them, because one determines the other")
    }
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

/// Finds every value of the one `varied` number with which the whisker of `scene` detaches as `target` says. The grid is not used.
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
/// If the scene sweeps whiskers, does not give the number, or accepts one value only, or no pole at the distance.
pub fn design(
    scene: &Scene,
    varied: impl Into<DesignVaried>,
    target: &DesignTarget,
) -> Result<Design, DesignError> {
    design_until(scene, varied, target, &|_| {}, &AtomicBool::new(false))
}

/// Finds every value of the one `varied` number as [`design`] does. `on_progress(n)` is called after `n` more pushes are computed, from several
/// threads. If `cancel` is true, the function soon returns an error.
///
/// # Errors
/// Fails as [`design`] does, and if it is cancelled.
pub fn design_until(
    scene: &Scene,
    varied: impl Into<DesignVaried>,
    target: &DesignTarget,
    on_progress: &(dyn Fn(usize) + Sync),
    cancel: &AtomicBool,
) -> Result<Design, DesignError> {
    let varied = &varied.into();
    let (scene, _, ranges) = &checked(scene, varied, &[*target])?;
    let search = DesignSearch {
        scene: &DesignScene { scene, varied, distance_mm: target.distance_mm },
        target,
        on_progress,
        cancel,
    };
    let range = ranges[0];
    let ends = search.scan(range);
    let pieces = ends.chunk_by(|a, b| a.kind == b.kind);
    let is_same = |a: f64, b: f64| (b - a).abs() <= EQUAL * a.abs();
    let mut values: Vec<f64> = Vec::new();
    let mut spans: Vec<[f64; 2]> = Vec::new();
    for piece in pieces.filter(|piece| target.accepts(piece[0].kind)) {
        let level = search.spans(piece, range);
        values.extend(search.solutions(piece, &level));
        for span in level {
            // A load may stay where the kind of detachment changes.
            match spans.last_mut().filter(|last| is_same(last[1], span[0])) {
                Some(last) => last[1] = span[1],
                None => spans.push(span),
            }
        }
    }
    if cancel.load(Ordering::Relaxed) {
        return Err(DesignError::Cancelled);
    }
    values.sort_by(f64::total_cmp);
    values.dedup_by(|b, a| is_same(*a, *b));
    Ok(Design { values, spans, range, ends })
}

/// Computes the ends of pushes at values of the one `varied` number over a part of its range, in its unit, `[value]`, as [`Design::ends`] are.
/// `on_progress(n)` is called after `n` more pushes are computed, from several threads.
///
/// # Errors
/// Fails as [`design`] does.
pub fn ends_between(
    scene: &Scene,
    varied: impl Into<DesignVaried>,
    target: &DesignTarget,
    range: [f64; 2],
    on_progress: &(dyn Fn(usize) + Sync),
) -> Result<Vec<DesignEnd>, DesignError> {
    let varied = &varied.into();
    let (scene, ..) = &checked(scene, varied, &[*target])?;
    let search = DesignSearch {
        scene: &DesignScene { scene, varied, distance_mm: target.distance_mm },
        target,
        on_progress,
        cancel: &AtomicBool::new(false),
    };
    Ok(search.scan(range))
}

/// Scene with one pole, and the values and ranges of the varied numbers, `[variable]`.
type CheckedDesign = (Scene, Vec<f64>, Vec<[f64; 2]>);

/// Checks what a design varies, and that its `targets` are as many and of one push.
fn checked(
    scene: &Scene,
    varied: &DesignVaried,
    targets: &[DesignTarget],
) -> Result<CheckedDesign, DesignError> {
    if let Some(axis) = scene.grid.sweep.first() {
        return Err(DesignError::Sweep(axis.variable.key()));
    }
    let count = varied.variables.len();
    let first = targets.first();
    let is_one_push = |target: &&DesignTarget| {
        first.is_some_and(|first| {
            (target.distance_mm, target.side) == (first.distance_mm, first.side)
        })
    };
    let goals = targets.iter().filter(is_one_push).map(|target| target.goal);
    let goals = each_once(&goals.collect::<Vec<_>>()).len();
    if goals != count || targets.len() != count || count == 0 {
        let (variables, targets) = (count, goals);
        return Err(DesignError::Targets { variables, targets });
    }
    let distance_mm = first.map_or(f64::NAN, |target| target.distance_mm);
    for (i, design_variable) in varied.variables.iter().enumerate() {
        let given = match design_variable.variable {
            Variable::Parameter(parameter) if parameter.value(scene).is_none() => {
                let given = Parameter::given(scene);
                return Err(DesignError::Lacking { parameter, given });
            }
            Variable::Parameter(_) | Variable::DistanceMm => key(design_variable.variable),
            other => return Err(DesignError::NotVaried(other)),
        };
        let mut others = varied.variables[..i].iter();
        if let Some(other) = others.find(|other| key(other.variable) == given) {
            return Err(DesignError::Twice(other.variable, design_variable.variable));
        }
    }
    let varies = |parameter: Parameter| {
        let mut all = varied.variables.iter();
        all.any(|design_variable| design_variable.variable == parameter.into())
    };
    let [base, tip] = [Parameter::BaseRadiusUm, Parameter::TipRadiusUm].map(varies);
    if varied.keeps_taper && (base == tip || varies(Parameter::Taper)) {
        return Err(DesignError::NoTaper);
    }
    let unvaried = DesignScene { scene, varied, distance_mm };
    let scene_values: Vec<f64> = (0..count).filter_map(|i| unvaried.scene_value(i)).collect();
    let scene = unvaried.at(&scene_values)?;
    let at_one_pole = DesignScene { scene: &scene, varied, distance_mm };
    let mut ranges = Vec::with_capacity(count);
    for (i, range) in at_one_pole.ranges(&scene_values).into_iter().enumerate() {
        let DesignVariable { variable, limits } = varied.variables[i];
        let range = range.map_err(|range| DesignError::Limits {
            variable,
            range,
            limits: limits.unwrap_or(range),
        })?;
        if range[1] - range[0] <= 3.0 * EQUAL * scene_values[i].abs() {
            let value = scene_values[i];
            return Err(DesignError::Fixed { variable, value });
        }
        ranges.push(range);
    }
    Ok((scene, scene_values, ranges))
}
