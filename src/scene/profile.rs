//! Radii of a whisker: base and tip of a cone, or a measured profile.

use super::builder::Numbers;
use super::error::SceneFault;
use super::limits::{NumberLimits, digits};
use super::parameter::Parameter;
use super::smooth::{MeasuredRadii, SMOOTH_KEY};

/// Key of the measured rows of radii in a scene file.
pub(super) const KEY: &str = "whisker.profile.rows";

/// Reason why a radius or a taper is refused beside measured radii.
pub(super) const IS_MEASURED: &str = "must be left out: the radii are those of whisker.profile";

/// Largest number of rows of a measured profile. A trajectory takes at least two steps from row to row.
pub(super) const MOST: usize = 256;

/// Largest distance of the last row from the tip, relative to the length: tables are rounded.
const END_SLACK: f64 = 1e-9;

/// Limits `[thinnest, thickest]` of the radius of a row, in micrometres.
const ROW_UM: [f64; 2] = Parameter::BaseRadiusUm.limits();

/// Least distance of two rows, relative to the length: `f32` can tell them apart.
const NARROWEST: f64 = 1e-6;

/// Largest ratio of the radii at the base and at any row: a thinner tip is a perfect cone, which needs no table.
const SHARPEST_TIP: f64 = 1000.0;

/// Largest ratio of the radii of a waist and of the whisker on both sides of it. The base, which is held, is a waist where rows
/// after it are thicker. A deeper waist is a hinge around which a whisker coils: at a ratio of 15, half of 63 cells stayed
/// unresolved after 20 s.
const DEEPEST_WAIST: f64 = 4.0;

/// Checked radii of a whisker: base and tip, or a measured profile.
pub(super) struct Radii {
    /// Arclength of the whisker from base to tip, in millimetres: with the cone beyond the last row.
    pub length_mm: f64,
    pub base_radius_um: f64,
    pub tip_radius_um: f64,
    /// Rows of the measured profile, `[row][arclength, radius]`, as fractions of the length and the base radius; `None` for a cone.
    pub profile: Option<Vec<[f64; 2]>>,
}

/// Checks and returns the radii of a whisker of `length_mm`.
pub(super) fn radii(
    numbers: &Numbers,
    given: Option<&MeasuredRadii>,
    length_mm: f64,
) -> Result<Radii, SceneFault> {
    let keys = [Parameter::BaseRadiusUm, Parameter::TipRadiusUm].map(Parameter::key);
    let ends = [numbers.get(Parameter::BaseRadiusUm), numbers.tip_radius_um()];
    if let Some(given) = given {
        if let Some((key, value)) = keys.iter().zip(ends).find_map(|(key, end)| Some((key, end?))) {
            return Err(SceneFault::of_value(*key, digits(value), IS_MEASURED));
        }
        check_places(&given.rows, length_mm)?;
        let Some(smooth) = given.smoothed()? else {
            check_radii(&given.rows)?;
            return measured(numbers, &given.rows, length_mm);
        };
        check_radii(&smooth.rows).map_err(|fault| {
            let degree = smooth.degree;
            let must = format!("{}, of the fit of degree {degree}: {}", fault.key, fault.must);
            SceneFault::of_value(SMOOTH_KEY, "true".to_owned(), must)
        })?;
        return measured(numbers, &smooth.rows, length_mm);
    }
    for parameter in [Parameter::ProfileScale, Parameter::TipExtensionMm] {
        if let Some(value) = numbers.get(parameter) {
            let must = "must be left out: there are no whisker.profile.rows";
            return Err(SceneFault::of_value(parameter.key(), digits(value), must));
        }
    }
    let given = |end: usize| {
        let absent = || SceneFault::new(keys[end], "is left out, and there is no whisker.profile");
        ends[end].ok_or_else(absent)
    };
    let base_radius_um = Parameter::BaseRadiusUm.number_limits().check(keys[0], given(0)?)?;
    let tip_radius_um =
        NumberLimits::between(0.0, ("base_radius_um", base_radius_um)).check(keys[1], given(1)?)?;
    Ok(Radii { length_mm, base_radius_um, tip_radius_um, profile: None })
}

/// Checks the arclengths of measured rows, and that the radii have a plausible unit.
fn check_places(rows: &[[f64; 2]], length_mm: f64) -> Result<(), SceneFault> {
    let count = match rows.len() {
        2..=MOST => None,
        few @ ..2 => Some(few.to_string()),
        _ => Some("more".to_owned()),
    };
    if let Some(count) = count {
        let must = format!("must be 2 to {MOST} rows, are {count}");
        return Err(SceneFault::new(KEY, must));
    }
    let (first, last) = (rows[0], rows[rows.len() - 1]);
    let mut before = f64::NEG_INFINITY;
    for (i, &[s, radius]) in rows.iter().enumerate() {
        let must = if !(s > before && s <= length_mm * (1.0 + END_SLACK)) {
            format!(
                "the arclength must grow from row to row, from 0 to length_mm ({length_mm}); is {}",
                digits(s)
            )
        } else if s - before < NARROWEST * length_mm {
            format!(
                "must be farther from the row before it, by at least length_mm / 1000000 ({}), is {}",
                digits(NARROWEST * length_mm),
                digits(s - before)
            )
        } else if !(ROW_UM[0]..=ROW_UM[1]).contains(&radius) {
            format!("the radius must be between 0.001 and 100000 um, is {}", digits(radius))
        } else {
            before = s;
            continue;
        };
        return Err(refused(i, must));
    }
    if first[0] != 0.0 || (last[0] - length_mm).abs() > END_SLACK * length_mm {
        let must = format!(
            "must begin at the base, at 0, and end at length_mm ({length_mm}), where a tip_extension_mm begins; \
             they go from {} to {}",
            digits(first[0]),
            digits(last[0])
        );
        return Err(SceneFault::new(KEY, must));
    }
    Ok(())
}

/// Fault of a measured row.
fn refused(row: usize, must: String) -> SceneFault {
    SceneFault::new(format!("{KEY}[{row}]"), must)
}

/// Checks the radii of measured or smoothed rows.
fn check_radii(rows: &[[f64; 2]]) -> Result<(), SceneFault> {
    let (base_radius_um, tip_radius_um) = (rows[0][1], rows[rows.len() - 1][1]);
    let limits = base_radius_um / SHARPEST_TIP..=DEEPEST_WAIST * base_radius_um;
    if let Some(i) = rows.iter().position(|[_, radius]| !limits.contains(radius)) {
        let must = format!(
            "the radius must be between a thousandth of that at the base ({}) and four times it ({}), is {}",
            digits(*limits.start()),
            digits(*limits.end()),
            digits(rows[i][1])
        );
        return Err(refused(i, must));
    }
    if tip_radius_um > base_radius_um {
        let must = format!(
            "the radius at the tip must be at most that at the base ({base_radius_um}), is {tip_radius_um}"
        );
        return Err(refused(rows.len() - 1, must));
    }
    if let Some((i, thinnest)) = deep_waist(rows) {
        let must = format!(
            "the radius must be at least {} um, is {}: a waist is at most four times as thin as the whisker on both sides of it",
            digits(thinnest),
            digits(rows[i][1])
        );
        return Err(refused(i, must));
    }
    Ok(())
}

/// The radii through checked `rows`, scaled and continued by a cone.
fn measured(numbers: &Numbers, rows: &[[f64; 2]], length_mm: f64) -> Result<Radii, SceneFault> {
    let mut profile = rows.to_vec();
    if let Some(last) = profile.last_mut() {
        last[0] = length_mm;
    }
    if let Some(extension) = numbers.get(Parameter::TipExtensionMm) {
        let extension =
            extension_limits(&profile).check(Parameter::TipExtensionMm.key(), extension)?;
        if extension > NARROWEST * length_mm {
            profile.push(beyond(&profile, extension));
        }
    }
    let scale = numbers.get(Parameter::ProfileScale).unwrap_or(1.0);
    let scale = scale_limits(&profile).check(Parameter::ProfileScale.key(), scale)?;
    let [[_, base], [length_mm, tip]] = [profile[0], profile[profile.len() - 1]];
    for [s, radius] in &mut profile {
        *s /= length_mm;
        *radius /= base;
    }
    Ok(Radii {
        length_mm,
        base_radius_um: scale * base,
        tip_radius_um: scale * tip,
        profile: Some(profile),
    })
}

/// The end `[arclength, radius]` of the cone of this length, in millimetres, that continues the last two rows.
fn beyond(rows: &[[f64; 2]], extension: f64) -> [f64; 2] {
    let [.., [from, before], [end, last]] = *rows else {
        return [extension, 0.0];
    };
    let slope = (last - before) / (end - from);
    [end + extension, slope.mul_add(extension, last)]
}

/// Returns the limits of the length of the cone beyond `rows`. The cone is at most as long as the rows. Its radius at the end is one that
/// the last row of a profile may have.
fn extension_limits(rows: &[[f64; 2]]) -> NumberLimits {
    let ([_, base], [length_mm, last]) = (rows[0], rows[rows.len() - 1]);
    let slope = beyond(rows, 1.0)[1] - last;
    let radii = rows.iter().map(|row| row[1]);
    let thinnest = radii.fold(f64::INFINITY, f64::min);
    let (why, tip) = match slope < 0.0 {
        true => ("where the radius is a thousandth of that at the base", base / SHARPEST_TIP),
        false => (
            "where the radius is that at the base, or four times the least",
            base.min(DEEPEST_WAIST * thinnest),
        ),
    };
    let most = (tip - last) / slope;
    let end = match most < length_mm {
        true => (why, most.max(0.0)),
        false => ("length_mm", length_mm),
    };
    NumberLimits::between(0.0, end)
}

/// Limits of the factor of the radii of `rows`, which keep every radius within its own limits.
fn scale_limits(rows: &[[f64; 2]]) -> NumberLimits {
    let radii = rows.iter().map(|row| row[1]);
    let thickest = radii.clone().fold(0.0, f64::max);
    let thinnest = radii.fold(f64::INFINITY, f64::min);
    let [least, most] = Parameter::ProfileScale.limits();
    NumberLimits::between(least.max(ROW_UM[0] / thinnest).min(1.0), most.min(ROW_UM[1] / thickest))
}

/// The first row that is a waist deeper than [`DEEPEST_WAIST`], and its least radius.
fn deep_waist(rows: &[[f64; 2]]) -> Option<(usize, f64)> {
    let thicker = |thickest: &mut f64, row: &[f64; 2]| {
        let before = *thickest;
        *thickest = before.max(row[1]);
        Some(before)
    };
    let before = rows.iter().scan(0.0, thicker);
    let after: Vec<f64> = rows.iter().rev().scan(0.0, thicker).collect();
    let mut beside = before.zip(after.iter().rev()).zip(rows).enumerate();
    beside.find_map(|(i, ((before, after), row))| {
        let thinnest = before.min(*after) / DEEPEST_WAIST;
        (row[1] < thinnest).then_some((i, thinnest))
    })
}
