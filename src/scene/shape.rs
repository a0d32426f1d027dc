//! The whisker's shape at rest: a parabola or an Euler spiral along which the distance from the base grows.

use std::f64::consts::SQRT_2;
use std::ops::Range;

use glam::DVec2;
use toml::Spanned;

use super::error::Fault;
use super::file::{CurvatureTable, SpiralTable};
use super::limits::{Limits, Number};
use super::whisker::{Curvature, EulerSpiral};

/// The largest curvature, in radians per length of the whisker: that of the largest parabola.
const SHARPEST: f64 = 20.0;

/// Where the angle between an Euler spiral and the chord from the base is looked at. In between it changes by less than
/// a tenth of [`LEAST_COS`].
const LOOKS: u32 = 8192;

/// The least cosine of that angle: the distance from the base grows everywhere.
const LEAST_COS: f64 = 0.05;

/// The parabola, which may be straight, or the Euler spiral of the table.
pub(super) fn shape(
    table: &Spanned<CurvatureTable>,
    length_mm: f64,
) -> Result<(Option<Curvature>, Option<EulerSpiral>), Fault> {
    let fields = table.get_ref();
    match (&fields.parabola_per_mm, &fields.euler_spiral) {
        (Some(number), None) => {
            let parabola = parabola(number, fields.vertex_mm.as_ref(), length_mm)?;
            Ok((Some(parabola), None))
        }
        (None, Some(spiral)) if fields.vertex_mm.is_none() => {
            Ok((None, euler_spiral(spiral, length_mm)?))
        }
        _ => Err(Fault::new(
            "whisker.curvature",
            table.span(),
            "must have either parabola_per_mm, and vertex_mm if need be, or euler_spiral",
        )),
    }
}

/// The chord from the base to a point of `y = A (x - v)^2` has `chord^2 = x^2 (1 + A^2 (x - 2v)^2)`. With
/// `u = x - 2v` half its derivative is `x (1 + A^2 (2u^2 + 2uv))`, whose bracket is least, `1 - A^2 v^2 / 2`,
/// at `x = 3v/2`. So the chord grows along the whole curve if `v <= 0` or `A v < sqrt 2`.
fn parabola(
    number: &Number,
    vertex_mm: Option<&Number>,
    length_mm: f64,
) -> Result<Curvature, Fault> {
    let key = "whisker.curvature.parabola_per_mm";
    let parabola_per_mm = parabola_limits(length_mm).check(key, number)?;
    refuse_faint(&[parabola_per_mm], length_mm, key, number.span())?;

    let vertex_mm = match vertex_mm {
        Some(number) => {
            let turning = SQRT_2 / parabola_per_mm;
            let far = 10.0 * length_mm;
            let end = if turning < far {
                ("sqrt(2) / the largest parabola coefficient", turning)
            } else {
                ("10 * length_mm", far)
            };
            Limits::below(("-10 * length_mm", -far), end)
                .remarks(["farther out, the chord from the base would not grow along the whisker"])
                .check("whisker.curvature.vertex_mm", number)?
        }
        None => 0.0,
    };
    Ok(Curvature {
        parabola_per_mm,
        vertex_mm,
    })
}

pub(super) fn parabola_limits(length_mm: f64) -> Limits {
    Limits::between(0.0, ("10 / length_mm", 10.0 / length_mm))
        .remarks(["a whisker bent toward the other side is the same one mirrored"])
}

/// Coefficients next to 0 would underflow in f32 without bending anything.
pub(super) fn refuse_faint(
    parabolas_per_mm: &[f64],
    length_mm: f64,
    key: &str,
    span: Range<usize>,
) -> Result<(), Fault> {
    let least = 1e-9 / length_mm;
    if parabolas_per_mm.iter().any(|a| *a > 0.0 && *a < least) {
        let must = format!("must be 0 (straight) or at least 1e-9 / length_mm ({least:e})");
        return Err(Fault::new(key, span, must));
    }
    Ok(())
}

/// Curvatures of both signs; a spiral without any is straight.
fn euler_spiral(table: &SpiralTable, length_mm: f64) -> Result<Option<EulerSpiral>, Fault> {
    let key = "whisker.curvature.euler_spiral";
    let sharpest = SHARPEST / length_mm;
    let per_mm = Limits::between(("-20 / length_mm", -sharpest), ("20 / length_mm", sharpest))
        .check(&format!("{key}.per_mm"), &table.per_mm)?;
    let until = |at_tip: f64| (at_tip - per_mm) / length_mm;
    let per_mm2 = Limits::between(
        ("what bends the tip by -20 / length_mm", until(-sharpest)),
        ("what bends it by 20 / length_mm", until(sharpest)),
    )
    .check(&format!("{key}.per_mm2"), &table.per_mm2)?;
    if per_mm == 0.0 && per_mm2 == 0.0 {
        return Ok(None);
    }
    if !chord_grows(per_mm * length_mm, per_mm2 * length_mm * length_mm) {
        let must = "must bend the whisker less: the distance from its base must grow all along it";
        let key = format!("{key}.per_mm2");
        return Err(Fault::new(key, table.per_mm2.span(), must));
    }
    Ok(Some(EulerSpiral { per_mm, per_mm2 }))
}

/// Whether the distance from the base grows along a spiral of curvature `k0 + k1 s`, by the midpoint rule.
fn chord_grows(k0: f64, k1: f64) -> bool {
    let step = 1.0 / f64::from(LOOKS);
    let mut point = DVec2::ZERO;
    (0..LOOKS).all(|i| {
        let s = step * (f64::from(i) + 0.5);
        let tangent = DVec2::from_angle(s * (k0 + 0.5 * k1 * s));
        point += step * tangent;
        point.dot(tangent) > LEAST_COS * point.length()
    })
}
