//! Radii: base and tip of a cone, or a measured profile.

use toml::Spanned;

use super::error::Fault;
use super::file::WhiskerTable;
use super::limits::{Limits, digits};
use super::rows::{self, Rows};

/// How far, relative to the length, the last row may be from the tip: tables are rounded.
const END_SLACK: f64 = 1e-9;

/// How close two rows may be, relative to the length: `f32` can tell them apart.
const NARROWEST: f64 = 1e-6;

/// A tip that is thinner than the base over this is a perfect cone, which needs no table.
const SHARPEST_TIP: f64 = 1000.0;

/// No row is thinner, by more than this factor, than some row before it and some row after it; nor than some row after it if it is
/// the base, which is held. A deeper waist is a hinge around which a whisker coils up for turns: at a factor of 15, half of 63 cells
/// stayed unresolved after 20 s.
const DEEPEST_WAIST: f64 = 4.0;

/// What the scene says of the radii.
pub(super) struct Radii {
    pub base_radius_um: f64,
    pub tip_radius_um: f64,
    /// Rows of arclength and radius as fractions of the length and the base radius.
    pub profile: Option<Vec<[f64; 2]>>,
}

/// The radii of a whisker of `length_mm`.
pub(super) fn radii(table: &WhiskerTable, length_mm: f64) -> Result<Radii, Fault> {
    let ends = [
        ("whisker.base_radius_um", &table.base_radius_um),
        ("whisker.tip_radius_um", &table.tip_radius_um),
    ];
    if let Some(profile) = &table.profile {
        if let Some((key, Some(number))) = ends.iter().find(|(_, number)| number.is_some()) {
            let must = "must be left out: the radii are those of whisker.profile";
            return Err(Fault::new(*key, number.span(), must));
        }
        return measured(&profile.rows, length_mm);
    }
    let [base, tip] = ends.map(|(key, number)| {
        let absent = || Fault::new(key, None, "is left out, and there is no whisker.profile");
        number.as_ref().ok_or_else(absent)
    });
    let base_radius_um = Limits::between(1e-3, 1e5).check(ends[0].0, base?)?;
    let tip_radius_um =
        Limits::between(0.0, ("base_radius_um", base_radius_um)).check(ends[1].0, tip?)?;
    Ok(Radii {
        base_radius_um,
        tip_radius_um,
        profile: None,
    })
}

fn measured(rows: &Spanned<Rows>, length_mm: f64) -> Result<Radii, Fault> {
    rows.get_ref().check_count(rows.span())?;
    let refused = |i, must: &str| Err(rows.get_ref().refuse(i, rows.span(), must));
    let mut profile = rows.get_ref().values();
    let (first, last) = (profile[0], profile[profile.len() - 1]);
    let (thinnest, thickest) = (first[1] / SHARPEST_TIP, DEEPEST_WAIST * first[1]);
    let mut before = f64::NEG_INFINITY;
    for (i, &[s, radius]) in profile.iter().enumerate() {
        if !(s > before && s <= length_mm * (1.0 + END_SLACK)) {
            let must = format!(
                "the arclength must grow from row to row, from 0 to length_mm ({length_mm})"
            );
            return refused(i, &must);
        }
        if s - before < NARROWEST * length_mm {
            let must = format!(
                "must be farther from the row before it, by at least length_mm / 1000000 ({})",
                NARROWEST * length_mm
            );
            return refused(i, &must);
        }
        if !(1e-3..=1e5).contains(&radius) {
            return refused(i, "the radius must be between 0.001 and 100000 um");
        }
        if !(thinnest..=thickest).contains(&radius) {
            let must = format!(
                "the radius must be between a thousandth of that at the base ({thinnest}) and four times it ({thickest})"
            );
            return refused(i, &must);
        }
        before = s;
    }
    if first[0] != 0.0 || (last[0] - length_mm).abs() > END_SLACK * length_mm {
        let must = format!(
            "must begin at the base, at 0, and end at the tip, at length_mm ({length_mm}); \
             they go from {} to {}",
            digits(first[0]),
            digits(last[0])
        );
        return Err(Fault::new(rows::KEY, rows.span(), must));
    }
    let (base_radius_um, tip_radius_um) = (first[1], last[1]);
    if tip_radius_um > base_radius_um {
        let must =
            format!("the radius at the tip must be at most that at the base ({base_radius_um})");
        return refused(profile.len() - 1, &must);
    }
    if let Some((i, thinnest)) = deep_waist(&profile) {
        let must = format!(
            "the radius must be at least {} um: a waist is at most four times as thin as the whisker on both sides of it",
            digits(thinnest)
        );
        return refused(i, &must);
    }
    for [s, radius] in &mut profile {
        *s /= length_mm;
        *radius /= base_radius_um;
    }
    if let Some([end, _]) = profile.last_mut() {
        *end = 1.0;
    }
    Ok(Radii {
        base_radius_um,
        tip_radius_um,
        profile: Some(profile),
    })
}

/// The first row that is a waist deeper than [`DEEPEST_WAIST`], and the least radius that it may have.
fn deep_waist(rows: &[[f64; 2]]) -> Option<(usize, f64)> {
    let thickest = |rows: &[[f64; 2]]| rows.iter().fold(0.0, |most: f64, row| most.max(row[1]));
    rows.iter().enumerate().find_map(|(i, [_, radius])| {
        let beside = thickest(&rows[..i]).min(thickest(&rows[i + 1..]));
        let thinnest = beside / DEEPEST_WAIST;
        (*radius < thinnest).then_some((i, thinnest))
    })
}
