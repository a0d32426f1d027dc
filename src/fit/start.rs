//! Start of a fit: values of the free parameters with which the resting whisker reaches every measured point.

use crate::input::CsvError;
use crate::measured::MeasuredPoints;
use crate::scene::{Parameter, Scene};

/// Ratio of neighbouring values that are tried.
const RATIO: f64 = 1.05;

/// Most values that are tried on each side of the scene's value. The last one is 2.1 times as large: a longer way is an error of the points.
const MOST_TRIES: i32 = 15;

/// Parameter whose start value differs from the scene's value, because the scene's whisker does not reach a measured point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovedStart {
    /// Free parameter that was moved.
    pub parameter: Parameter,
    /// Value of the parameter at which the fit starts, in its unit.
    pub value: f64,
    /// Line of the first measured point that the scene's whisker does not reach, from 1.
    pub line: usize,
    /// Distance of that point, in mm.
    pub distance_mm: f64,
}

/// Returns the scene at which a fit starts, and the parameter that was moved; `None` if the scene's own whisker reaches all points.
///
/// One free parameter is moved, by the least factor `1.05^n` with which the whisker reaches every point, and by one such factor more: at the reach
/// itself, a push angle has no derivative.
///
/// # Errors
/// The first point that is out of reach, if no such value of one free parameter is enough.
pub(super) fn within_reach(
    scene: &Scene,
    points: &MeasuredPoints,
    free: &[Parameter],
) -> Result<(Scene, Option<MovedStart>), CsvError> {
    let Err(why) = reach(scene, points) else {
        return Ok((scene.clone(), None));
    };
    let Some(first) = points.first_out_of_reach_of(&points.whiskers_in(scene)?) else {
        return Err(why);
    };
    for tries in 1..=MOST_TRIES {
        for parameter in free {
            let Some(scene_value) = parameter.value(scene) else {
                continue;
            };
            for power in [tries, -tries] {
                let at = |power: i32| scene_value * RATIO.powi(power);
                let moved = |power: i32| {
                    let moved = scene.with_parameters(&[(*parameter, at(power))]).ok()?;
                    reach(&moved, points).is_ok().then_some(moved)
                };
                let (Some(least), farther) = (moved(power), power + power.signum()) else {
                    continue;
                };
                let (start, value) = match moved(farther) {
                    Some(more) => (more, at(farther)),
                    None => (least, at(power)),
                };
                let moved = MovedStart {
                    parameter: *parameter,
                    value,
                    line: first.line,
                    distance_mm: first.distance_mm,
                };
                return Ok((start, Some(moved)));
            }
        }
    }
    Err(why)
}

/// Checks that the scene's resting whiskers touch their poles at the distances of all points.
fn reach(scene: &Scene, points: &MeasuredPoints) -> Result<(), CsvError> {
    points.check_reach_of(&points.whiskers_in(scene)?)
}
