//! The whisker's shape at rest: a parabola, an Euler spiral or a traced shape along which the distance from the base grows.

use std::f64::consts::SQRT_2;

use glam::DVec2;

use super::builder::Numbers;
use super::error::{SceneError, SceneFault};
use super::limits::{NumberLimits, digits, rounded};
use super::parameter::Parameter;
use super::warnings::LENGTH_MM;
use super::whisker::{Curvature, EulerSpiral};
use crate::traced::{TracedError, TracedShape};
use whiskmap_mechanics::rod::CurvaturePolynomial;

/// Key of the points of a traced shape in a scene file.
pub(super) const POINTS_KEY: &str = "whisker.rest.points";

/// Key of the degree of a traced curvature in a scene file.
pub(super) const DEGREE_KEY: &str = "whisker.rest.degree";

/// Key of the fitted coefficients of a traced curvature in a scene file.
pub(super) const CURVATURE_KEY: &str = "whisker.rest.curvature";

/// Reason why a parabola or a spiral is refused beside a traced shape.
pub(super) const IS_TRACED: &str = "must be left out: the shape at rest is that of whisker.rest";

/// Largest curvature of a spiral, in radians per length of the whisker: the same as of the largest parabola.
const SHARPEST: f64 = 20.0;

/// Number of points at which the angle between an Euler spiral and the chord from the base is computed. In between, its cosine
/// changes by less than a tenth of [`LEAST_COS`].
const CHORDS: u32 = 8192;

/// Least cosine of the angle between spiral and chord: with it, the distance from the base grows everywhere.
const LEAST_COS: f64 = 0.05;

/// Returns the resting shape of the given numbers: the parabola, which may be straight, or the Euler spiral.
pub(super) fn shape(
    numbers: &Numbers,
    length_mm: f64,
) -> Result<(Option<Curvature>, Option<EulerSpiral>), SceneFault> {
    let get = |parameter| numbers.get(parameter);
    let bend = [Parameter::ParabolaPerMm, Parameter::VertexMm].map(get);
    let spiral = [Parameter::SpiralPerMm, Parameter::SpiralPerMm2];
    match (bend, spiral.map(get)) {
        ([None, None], [None, None]) => Ok((None, None)),
        ([Some(parabola_per_mm), vertex_mm], [None, None]) => {
            let parabola = parabola(parabola_per_mm, vertex_mm, length_mm)?;
            Ok((Some(parabola), None))
        }
        ([None, None], [Some(per_mm), Some(per_mm2)]) => {
            Ok((None, euler_spiral([per_mm, per_mm2], length_mm)?))
        }
        ([None, None], [per_mm, _]) => {
            let missing = spiral[usize::from(per_mm.is_some())];
            Err(SceneFault::new(missing.key(), "is left out"))
        }
        _ => Err(SceneFault::new(
            "whisker.curvature",
            "must have either parabola_per_mm, and vertex_mm if need be, or euler_spiral",
        )),
    }
}

/// The chord from the base to a point of `y = A (x - v)^2` has `chord^2 = x^2 (1 + A^2 (x - 2v)^2)`. With
/// `u = x - 2v` half its derivative is `x (1 + A^2 (2u^2 + 2uv))`, whose bracket is least, `1 - A^2 v^2 / 2`,
/// at `x = 3v/2`. So the chord grows along the whole curve if `v <= 0` or `A v < sqrt 2`.
fn parabola(
    parabola_per_mm: f64,
    vertex_mm: Option<f64>,
    length_mm: f64,
) -> Result<Curvature, SceneFault> {
    let key = Parameter::ParabolaPerMm.key();
    parabola_limits(length_mm).check(key, parabola_per_mm)?;
    refuse_faint(parabola_per_mm, length_mm)?;
    if let Some(vertex_mm) = vertex_mm {
        let turning = SQRT_2 / parabola_per_mm;
        let far = 10.0 * length_mm;
        let end = if turning < far {
            ("sqrt(2) / the largest parabola coefficient", turning)
        } else {
            ("10 * length_mm", far)
        };
        NumberLimits::below(("-10 * length_mm", -far), end)
            .remarks(["farther out, the chord from the base would not grow along the whisker"])
            .check(Parameter::VertexMm.key(), vertex_mm)?;
    }
    Ok(Curvature { parabola_per_mm, vertex_mm: vertex_mm.unwrap_or(0.0) })
}

/// Returns the limits of a parabola's coefficient, in 1/mm.
pub(super) fn parabola_limits(length_mm: f64) -> NumberLimits {
    NumberLimits::between(0.0, ("10 / length_mm", 10.0 / length_mm))
        .remarks(["a whisker bent toward the other side is the same one mirrored"])
}

/// Refuses coefficients of a parabola so small that they would underflow in `f32`.
pub(super) fn refuse_faint(parabola_per_mm: f64, length_mm: f64) -> Result<(), SceneFault> {
    let least = 1e-9 / length_mm;
    if parabola_per_mm > 0.0 && parabola_per_mm < least {
        let must = format!("must be 0 (straight) or at least 1e-9 / length_mm ({least:e})");
        let key = Parameter::ParabolaPerMm.key();
        return Err(SceneFault::of_value(key, digits(parabola_per_mm), must));
    }
    Ok(())
}

/// Curvatures of both signs; a spiral without any is straight.
fn euler_spiral(
    [per_mm, per_mm2]: [f64; 2],
    length_mm: f64,
) -> Result<Option<EulerSpiral>, SceneFault> {
    let sharpest = SHARPEST / length_mm;
    NumberLimits::between(("-20 / length_mm", -sharpest), ("20 / length_mm", sharpest))
        .check(Parameter::SpiralPerMm.key(), per_mm)?;
    let until = |at_tip: f64| (at_tip - per_mm) / length_mm;
    let key = Parameter::SpiralPerMm2.key();
    NumberLimits::between(
        ("what bends the tip by -20 / length_mm", until(-sharpest)),
        ("what bends it by 20 / length_mm", until(sharpest)),
    )
    .check(key, per_mm2)?;
    if per_mm == 0.0 && per_mm2 == 0.0 {
        return Ok(None);
    }
    let (k0, k1) = (per_mm * length_mm, per_mm2 * length_mm * length_mm);
    if !chord_grows(|s| s * (k0 + 0.5 * k1 * s)) {
        let must = "must bend the whisker less: the distance from its base must grow all along it";
        return Err(SceneFault::of_value(key, digits(per_mm2), must));
    }
    Ok(Some(EulerSpiral { per_mm, per_mm2 }))
}

/// Refuses traced points whose length is none of a whisker in millimetres, if the scene does not give the length.
pub(super) fn check_unit(traced: &TracedShape) -> Result<(), SceneFault> {
    let [least, most] = LENGTH_MM;
    let length_mm = traced.length_mm;
    if (least..=most).contains(&length_mm) {
        return Ok(());
    }
    let must = format!(
        "must be in mm: the curve through them is {} mm long, and a length outside {} to {} mm must be given by whisker.length_mm. \
         `whiskmap import --mm-per-pixel` converts pixels",
        digits(rounded(length_mm, 6)),
        digits(least),
        digits(most)
    );
    Err(SceneFault::new(POINTS_KEY, must))
}

/// Checks and returns the curvature of a traced shape.
pub(super) fn traced(
    numbers: &Numbers,
    curvature: &CurvaturePolynomial,
) -> Result<CurvaturePolynomial, SceneFault> {
    for parameter in [
        Parameter::ParabolaPerMm,
        Parameter::VertexMm,
        Parameter::SpiralPerMm,
        Parameter::SpiralPerMm2,
    ] {
        if let Some(value) = numbers.get(parameter) {
            return Err(SceneFault::of_value(parameter.key(), digits(value), IS_TRACED));
        }
    }
    let sharpest = curvature.sharpest();
    let must = if sharpest > SHARPEST {
        format!(
            "must bend less: the largest curvature of the fitted curve is {sharpest:.3} over its length, more than {SHARPEST}"
        )
    } else if !chord_grows(|s| curvature.angle(s)) {
        "must bend less: the distance from the base must grow all along the fitted curve".to_owned()
    } else {
        return Ok(*curvature);
    };
    Err(SceneFault::new(POINTS_KEY, must))
}

/// Returns true if the distance from the base grows along a curve whose tangent has the `angle` at an arclength in whisker lengths, by
/// the midpoint rule.
fn chord_grows(angle: impl Fn(f64) -> f64) -> bool {
    let step = 1.0 / f64::from(CHORDS);
    let mut point = DVec2::ZERO;
    (0..CHORDS).all(|i| {
        let s = step * (f64::from(i) + 0.5);
        let tangent = DVec2::from_angle(angle(s));
        point += step * tangent;
        point.dot(tangent) > LEAST_COS * point.length()
    })
}

impl From<TracedError> for SceneError {
    fn from(why: TracedError) -> Self {
        Self::of_fault("", "", SceneFault::of_traced(why))
    }
}

impl SceneFault {
    /// Creates a fault of traced points.
    pub fn of_traced(why: TracedError) -> Self {
        let key = match why.point {
            Some(point) => format!("{POINTS_KEY}[{point}]"),
            None => POINTS_KEY.to_owned(),
        };
        Self::new(key, why.must)
    }
}
