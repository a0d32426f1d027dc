//! Which values of a parameter make the whisker detach in a given way at a given push angle.
//!
//! The range that the scene accepts is scanned; where pushes begin to end in another way, and where their push angle
//! turns back, is found between the samples; what is asked for then lies between two of all these places, and is
//! bisected. Every solution is an end that was computed: a jump across the push angle is none.

mod samples;
mod search;
mod turn;

use crate::rod::Side;
use crate::scene::{Parameter, Scene, SceneError, digits};
use crate::trace::DetachmentKind;
use search::Search;

/// How far the push angle of a solution may be from the one asked for, in degrees: exact ends are known to 1e-11.
const TOLERANCE_DEG: f64 = 1e-9;

/// Values closer than this, relative to them, are one solution, or leave no choice.
const EQUAL: f64 = 1e-9;

/// The end that is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Distance from the base to the contact at first touch.
    pub distance_mm: f64,
    /// Side of the whisker that the pole is on.
    pub side: Side,
    /// How the push ends.
    pub kind: DetachmentKind,
    /// Where it ends: positive CB, negative CF.
    pub push_angle_deg: f64,
}

/// The end of a push at a value of the parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    /// Value of the parameter.
    pub value: f64,
    /// How the push ends.
    pub kind: DetachmentKind,
    /// Where it ends.
    pub push_angle_deg: Option<f64>,
}

/// What a parameter can do.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// Growing values, each of which makes the whisker detach as asked; none where all push angles are the same.
    pub values: Vec<f64>,
    /// The least and the greatest value that were tried: all that the scene accepts.
    pub range: [f64; 2],
    /// Ends all over that range, at growing values.
    pub ends: Vec<End>,
}

/// Why there is nothing to try.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoDesign {
    /// An axis stands in the parameter's place.
    #[error("grid.{0}: must be left out, as one number of one whisker is varied")]
    Sweep(&'static str),
    /// The scene does not give the parameter.
    #[error("{}: must be one of {given}, which the scene has; it has no {}", .parameter.name(), .parameter.key())]
    Lacking {
        /// What was asked for.
        parameter: Parameter,
        /// What the scene does give.
        given: String,
    },
    /// The scene accepts its own value alone.
    #[error("{}: the scene accepts no value but {} for {}, its other numbers being what they are", .parameter.name(), digits(*.value), .parameter.key())]
    Fixed {
        /// What was asked for.
        parameter: Parameter,
        /// Its own value.
        value: f64,
    },
    /// No first touch at the distance.
    #[error(transparent)]
    Distance(#[from] SceneError),
}

impl Design {
    /// Whether the range spans so much that the logarithm of the parameter says more.
    #[must_use]
    pub fn is_wide(&self) -> bool {
        samples::is_wide(self.range)
    }

    /// The least and the greatest push angle of ends of a kind.
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

/// Every value of `parameter` that makes the whisker of `scene` detach as asked; its grid does not matter.
///
/// ```
/// use whiskmap::design::{Target, design};
/// use whiskmap::{rod::Side, trace::DetachmentKind};
/// use whiskmap::scene::{Parameter, Scene};
///
/// let cone = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml")?;
/// let target = Target { distance_mm: 15.66, side: Side::Cb, kind: DetachmentKind::SlipOff, push_angle_deg: 20.0 };
/// let design = design(&cone, Parameter::TipRadiusUm, &target)?;
/// let [tip_radius_um] = design.values[..] else { panic!("{design:?}") };
/// assert!((tip_radius_um - 4.063).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the scene sweeps whiskers, does not give the parameter, or accepts one value only, or no pole at the distance.
pub fn design(scene: &Scene, parameter: Parameter, target: &Target) -> Result<Design, NoDesign> {
    if let Some(axis) = scene.grid.sweep.first() {
        return Err(NoDesign::Sweep(axis.parameter.axis()));
    }
    let Some(value) = parameter.value(scene) else {
        let given = Parameter::given(scene);
        return Err(NoDesign::Lacking { parameter, given });
    };
    // Other distances would limit what is accepted.
    let scene = &scene
        .to_builder()
        .distance_mm([target.distance_mm])
        .build()?;
    let range = parameter.range(scene);
    if range[1] - range[0] <= 3.0 * EQUAL * value.abs() {
        return Err(NoDesign::Fixed { parameter, value });
    }
    let search = Search {
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
