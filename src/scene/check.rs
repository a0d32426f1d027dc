//! The ranges: what makes a scene valid everywhere after.
//!
//! Ranges are wide; they keep units from being mixed up and f32 from overflowing, and they hold wherever
//! the geometry of first touch is one-to-one. Lengths are measured in lengths of the whisker.

use toml::Spanned;

use super::axis;
use super::deviations;
use super::error::Fault;
use super::file::{OutputTable, SceneTable, WhiskerTable};
use super::grid::{FARTHEST, Grid, NEAREST};
use super::limits::{Limits, MOST_STRETCH, STIFFEST_TIP, digits, friction_limits};
use super::parameter::Parameter;
use super::profile;
use super::setup::Setup;
use super::shape;
use super::sweep;
use super::warnings::{LENGTH_MM, LENGTH_UNITS, MODULUS_GPA, MODULUS_UNITS, other_unit};
use super::whisker::{Curvature, Pole, Whisker};

/// More than any disk holds: a stored cell takes about 20 bytes.
const MOST_CELLS: u128 = 1 << 44;

/// The longest title, in characters: many times what fits on a picture.
pub const LONGEST_TITLE: usize = 1000;

/// File systems allow 255 bytes; the output adds its own endings.
const LONGEST_NAME: usize = 200;

/// The scene that the tables describe; `stem` names its output where it does not itself.
pub(super) fn setup(table: &mut SceneTable, text: &str, stem: &str) -> Result<Setup, Fault> {
    let title = title(&table.title)?;
    let lengths_mm = sweep::lengths_mm(table)?;
    let grid = grid(table, lengths_mm)?;
    sweep::refuse_at_odds(table)?;
    let mut refused = Vec::new();
    let mut corners = 0;
    for place in sweep::corners(&grid) {
        table.put(&place);
        refused.extend(whisker_and_pole(table, &grid).err().zip(Some(place)));
        corners += 1;
    }
    if let Some(fault) = sweep::located(refused, corners) {
        return Err(fault);
    }
    table.put(&grid.place(0));
    let (mut whisker, pole) = whisker_and_pole(table, &grid)?;
    if grid.axis(Parameter::ParabolaPerMm).is_none() {
        whisker.curvature = whisker.curvature.filter(Curvature::bends);
    }
    let uncertainty = table.uncertainty.as_ref();
    let uncertainty = uncertainty.map(|own| deviations::deviations(own, text, &whisker));
    Ok(Setup {
        title,
        uncertainty: uncertainty.transpose()?,
        whisker,
        pole,
        grid,
        name: name(table.output.as_ref(), stem)?,
        text: text.to_owned(),
        note: None,
    })
}

/// The whisker and the pole of the file; a straight parabola keeps its vertex.
fn whisker_and_pole(table: &SceneTable, grid: &Grid) -> Result<(Whisker, Pole), Fault> {
    let whisker = whisker(&table.whisker)?;
    let radius = table.pole.as_ref().map(|pole| &pole.radius_mm);
    let friction = table.contact.as_ref().map(|contact| &contact.friction);
    let pole = Pole {
        radius_mm: pole_limits(&whisker, grid).check_or(0.0, "pole.radius_mm", radius)?,
        friction: friction_limits().check_or(0.0, "contact.friction", friction)?,
    };
    Ok((whisker, pole))
}

fn title(title: &Spanned<String>) -> Result<String, Fault> {
    let text = title.get_ref();
    if text.trim().is_empty() || text.contains(char::is_control) {
        let must = "must be one line of text";
        return Err(Fault::new("title", title.span(), must));
    }
    let length = text.chars().count();
    if length > LONGEST_TITLE {
        let must = format!("must have at most {LONGEST_TITLE} characters, has {length}");
        return Err(Fault::new("title", title.span(), must));
    }
    Ok(text.clone())
}

fn whisker(table: &WhiskerTable) -> Result<Whisker, Fault> {
    let length_mm = sweep::length_limits().check("whisker.length_mm", &table.length_mm)?;
    let radii = profile::radii(table, length_mm)?;
    let youngs_modulus = &table.youngs_modulus_gpa;
    let unit = other_unit(*youngs_modulus.get_ref(), MODULUS_GPA, &MODULUS_UNITS);
    let unit = unit.map(|unit| format!("is it in {unit}?"));
    let youngs_modulus_gpa = Limits::between(1e-6, 1e4)
        .remarks(unit)
        .check("whisker.youngs_modulus_gpa", youngs_modulus)?;
    let (curvature, euler_spiral) = match &table.curvature {
        Some(table) => shape::shape(table, length_mm)?,
        None => (None, None),
    };
    let ratio = table.modulus_gradient.as_ref().map(|own| &own.tip_to_base);
    let key = "whisker.modulus_gradient.tip_to_base";
    let modulus_tip_to_base =
        Limits::between(1.0 / STIFFEST_TIP, STIFFEST_TIP).check_or(1.0, key, ratio)?;
    let own_taper = 1.0 - radii.tip_radius_um / radii.base_radius_um;
    let pointed = 1.0 / own_taper;
    let gradient = modulus_tip_to_base - 1.0;
    let [softest, stiffest] = [1.0 / STIFFEST_TIP, STIFFEST_TIP].map(|tip| (tip - 1.0) / gradient);
    let mut end = ("twice as long", MOST_STRETCH);
    for other in [
        ("1 / taper, where the radius at the tip is 0", pointed),
        (
            "0.95 / (1 - tip_to_base), where the modulus at the tip is 0.05 of the base's",
            softest,
        ),
        (
            "19 / (tip_to_base - 1), where the modulus at the tip is 20 times the base's",
            stiffest,
        ),
    ] {
        if (1.0..end.1).contains(&other.1) {
            end = other;
        }
    }
    let stretch = table.projection.as_ref().map(|own| &own.arc_stretch);
    let arc_stretch =
        Limits::between(1.0, end).check_or(1.0, "whisker.projection.arc_stretch", stretch)?;
    Ok(Whisker {
        length_mm,
        base_radius_um: radii.base_radius_um,
        tip_radius_um: radii.tip_radius_um,
        youngs_modulus_gpa,
        curvature,
        euler_spiral,
        profile: radii.profile,
        modulus_tip_to_base,
        arc_stretch,
    })
}

fn grid(table: &SceneTable, [shortest, longest]: [f64; 2]) -> Result<Grid, Fault> {
    let axes = table.grid.get_ref();
    let turn = Limits::between(-360.0, 360.0);
    let push_angle_deg = axis::values(&axes.push_angle_deg, "grid.push_angle_deg", &turn)?;
    let near = ("length_mm / 1000", longest / NEAREST);
    let far = ("10 * length_mm", FARTHEST * shortest);
    let unit = other_unit(longest, LENGTH_MM, &LENGTH_UNITS);
    let unit = unit.filter(|_| !(LENGTH_MM[0]..=LENGTH_MM[1]).contains(&longest));
    let unit = unit.map(|unit| format!("is length_mm = {} in {unit}?", digits(longest)));
    let reach = Limits::between(near, far).remarks(unit);
    let distance_mm = axis::values(&axes.distance_mm, "grid.distance_mm", &reach)?;
    let sweep = sweep::axes(table, [shortest, longest])?;

    let mut counts = vec![push_angle_deg.len(), distance_mm.len()];
    counts.extend(sweep.iter().map(|axis| axis.values.len()));
    let cells = counts
        .iter()
        .try_fold(1, |cells: u128, &count| cells.checked_mul(count as u128));
    if cells.is_none_or(|cells| cells > MOST_CELLS) {
        let has = cells.map_or_else(String::new, |cells| format!(", has {cells}"));
        let must = format!("must have at most {MOST_CELLS} cells over all axes{has}");
        return Err(Fault::new("grid", table.grid.span(), must));
    }
    Ok(Grid {
        push_angle_deg,
        distance_mm,
        sweep,
    })
}

/// Where the pole's rim touches the whisker at rest, the centre is `D` away from the base, and `D^2` grows along the
/// whisker `1 -+ r kappa` times as fast as the chord's square (the sign is the side). So with `r` below the
/// whisker's smallest radius of curvature, first touch is one-to-one and the base stays outside the pole.
fn pole_limits(whisker: &Whisker, grid: &Grid) -> Limits {
    let sharpest = 1.0 / whisker.sharpest_bend_per_mm();
    let nearest = grid.distance_mm[0];
    let end = if sharpest < nearest {
        ("the whisker's smallest radius of curvature", sharpest)
    } else {
        ("the smallest distance", nearest)
    };
    Limits::below(0.0, end)
}

/// The name that the scene gives its output, or else the `stem` of its own file, which is a file's name already.
fn name(output: Option<&OutputTable>, stem: &str) -> Result<String, Fault> {
    let Some(name) = output.and_then(|output| output.name.as_ref()) else {
        return Ok(stem.to_owned());
    };
    let text = name.get_ref();
    let fits = (1..=LONGEST_NAME).contains(&text.len()) && !text.starts_with('.');
    if fits && !text.contains(|c: char| c.is_control() || "/\\".contains(c)) {
        return Ok(text.clone());
    }
    let must = format!(
        "must be the name of a file without its ending: 1 to {LONGEST_NAME} bytes, no slash, no dot first"
    );
    Err(Fault::new("output.name", name.span(), must))
}
