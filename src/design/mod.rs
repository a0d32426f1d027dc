//! Designs: values of a parameter with which a whisker detaches in a given way at a given push angle.
//!
//! The search scans the range that the scene accepts. Between samples it finds changes of the kind of detachment, and turns of
//! the push angle. It bisects between neighbours of all these values. Every solution is a computed end: a jump of the push angle
//! across the target is no solution.

mod samples;
mod search;
mod turn;

use crate::rod::Side;
use crate::scene::{Parameter, Scene, SceneError, digits};
use crate::trace::DetachmentKind;
use search::DesignSearch;

/// Largest difference of the push angles of a solution and the target, in degrees: exact ends are known to 1e-11.
const TOLERANCE_DEG: f64 = 1e-9;

/// Relative difference of values below which they are one solution, or a range leaves no choice.
const EQUAL: f64 = 1e-9;

/// Target of a design: the detachment to reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DesignTarget {
    /// Distance from the base to the contact at first touch, in millimetres.
    pub distance_mm: f64,
    /// Side of the whisker that the pole is on.
    pub side: Side,
    /// Kind of the target detachment: how the push ends.
    pub kind: DetachmentKind,
    /// Push angle of the target detachment, in degrees: positive CB, negative CF.
    pub push_angle_deg: f64,
}

/// End of a push at one value of the design's parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DesignEnd {
    /// Value of the design's parameter, in its unit.
    pub value: f64,
    /// Kind of the end: how the push ends at this value.
    pub kind: DetachmentKind,
    /// Push angle of the detachment at this value of the parameter, in degrees; `None` without a detachment.
    pub push_angle_deg: Option<f64>,
}

/// Solutions of a design, and the ends over the whole range of the parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// Solutions of the design, in the unit of the parameter, growing: `[solution]`. Empty if no value reaches the target, or if every
    /// value has the same push angle.
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
        /// The only value of the parameter that the scene accepts.
        value: f64,
    },
    /// The scene accepts no pole at the distance of the design.
    #[error(transparent)]
    Distance(#[from] SceneError),
}

impl Design {
    /// Returns true if the parameter's range is so wide that a logarithmic axis suits it.
    #[must_use]
    pub fn is_wide(&self) -> bool {
        samples::is_wide(self.range)
    }

    /// Returns the least and the greatest push angle of ends of a kind, in degrees; `None` without such an end.
    #[must_use]
    pub fn reached_deg(&self, kind: DetachmentKind) -> Option<[f64; 2]> {
        let ends = self.ends.iter().filter(|end| end.kind == kind);
        let pushes = ends.filter_map(|end| end.push_angle_deg);
        pushes.fold(None, |reached, push| {
            let [low, high] = reached.unwrap_or([push; 2]);
            Some([push.min(low), push.max(high)])
        })
    }
}

/// Finds every value of `parameter` with which the whisker of `scene` detaches as `target` says. The grid is not used.
///
/// ```
/// use whiskmap::design::{DesignTarget, design};
/// use whiskmap::{rod::Side, trace::DetachmentKind};
/// use whiskmap::scene::{Parameter, Scene};
///
/// let cone = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml")?;
/// let target = DesignTarget { distance_mm: 15.66, side: Side::Cb, kind: DetachmentKind::SlipOff, push_angle_deg: 20.0 };
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
    if let Some(axis) = scene.grid.sweep.first() {
        return Err(DesignError::Sweep(axis.parameter.axis()));
    }
    let Some(value) = parameter.value(scene) else {
        let given = Parameter::given(scene);
        return Err(DesignError::Lacking { parameter, given });
    };
    // Other distances would limit what is accepted.
    let scene = &scene
        .to_builder()
        .distance_mm([target.distance_mm])
        .build()?;
    let range = parameter.range(scene);
    if range[1] - range[0] <= 3.0 * EQUAL * value.abs() {
        return Err(DesignError::Fixed { parameter, value });
    }
    let search = DesignSearch {
        scene,
        parameter,
        target,
    };
    let ends = search.scan(range);
    let mut values: Vec<f64> = ends
        .chunk_by(|a, b| a.kind == b.kind)
        .filter(|piece| piece[0].kind == target.kind)
        .flat_map(|piece| search.solutions(piece))
        .collect();
    values.sort_by(f64::total_cmp);
    values.dedup_by(|b, a| (*b - *a).abs() <= EQUAL * a.abs());
    let mut design = Design {
        values,
        range,
        ends,
    };
    let reached = design.reached_deg(target.kind);
    if reached.is_some_and(|[low, high]| high - low <= TOLERANCE_DEG) {
        design.values.clear();
    }
    Ok(design)
}
