//! The ranges: what makes a scene valid everywhere after.
//!
//! Ranges are wide; they keep units from being mixed up and f32 from overflowing, and they hold wherever
//! the geometry of first touch is one-to-one. Lengths are measured in lengths of the whisker.

use toml::Spanned;

use super::axis::{self, Axis};
use super::deviations;
use super::error::Fault;
use super::file::{GridTable, OutputTable, SceneTable, WhiskerTable};
use super::grid::{FARTHEST, Grid, NEAREST};
use super::limits::Limits;
use super::profile;
use super::setup::Setup;
use super::shape::{self, refuse_faint};
use super::whisker::{Pole, Whisker};

/// As many as 16,384 x 16,384; a stored cell takes about 60 bytes.
const MOST_CELLS: u128 = 1 << 28;

/// Rubber on concrete; the whiskers of rats on steel have about 0.5.
const MOST_FRICTION: f64 = 2.0;

/// Measured ratios lie between 0.7 and 1.4.
const STIFFEST_TIP: f64 = 20.0;

/// A whisker that is twice as long as it looks.
const MOST_STRETCH: f64 = 2.0;

/// File systems allow 255 bytes; the output adds its own endings.
const LONGEST_NAME: usize = 200;

/// The scene that the tables describe; `stem` names its output where it does not itself.
pub(super) fn setup(table: &SceneTable, text: &str, stem: &str) -> Result<Setup, Fault> {
    let title = title(&table.title)?;
    let length_mm =
        Limits::between(1e-3, 1e5).check("whisker.length_mm", &table.whisker.length_mm)?;
    let grid = grid(&table.grid, length_mm)?;
    refuse_two_of_a_kind(&table.whisker, &table.grid)?;
    let whisker = whisker(&table.whisker, length_mm, &grid)?;
    let radius = table.pole.as_ref().map(|pole| &pole.radius_mm);
    let friction = table.contact.as_ref().map(|contact| &contact.friction);
    let rough = Limits::between(0.0, MOST_FRICTION);
    let pole = Pole {
        radius_mm: pole_limits(&whisker, &grid).check_or(0.0, "pole.radius_mm", radius)?,
        friction: rough.check_or(0.0, "contact.friction", friction)?,
    };
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
    })
}

/// An axis may replace a linear taper or a parabola, not what stands in their place.
fn refuse_two_of_a_kind(whisker: &WhiskerTable, grid: &Spanned<GridTable>) -> Result<(), Fault> {
    let axes = grid.get_ref();
    if let (Some(axis), Some(_)) = (&axes.taper, &whisker.profile) {
        let must = "must be left out: the radii are those of whisker.profile";
        return Err(Fault::new("grid.taper", axis.span(), must));
    }
    let curvature = whisker.curvature.as_ref().map(Spanned::get_ref);
    let spiral = curvature.and_then(|own| own.euler_spiral.as_ref());
    if let (Some(axis), Some(_)) = (&axes.curvature_per_mm, spiral) {
        let must = "must be left out: the whisker is an Euler spiral";
        return Err(Fault::new("grid.curvature_per_mm", axis.span(), must));
    }
    Ok(())
}

fn title(title: &Spanned<String>) -> Result<String, Fault> {
    let text = title.get_ref();
    if text.trim().is_empty() || text.contains(char::is_control) {
        let must = "must be one line of text";
        return Err(Fault::new("title", title.span(), must));
    }
    Ok(text.clone())
}

/// The whisker of the file; the largest taper and curvature of the `grid` count where there are such axes.
fn whisker(table: &WhiskerTable, length_mm: f64, grid: &Grid) -> Result<Whisker, Fault> {
    let radii = profile::radii(table, length_mm, grid.taper.as_deref())?;
    let youngs_modulus_gpa = Limits::between(1e-6, 1e4)
        .check("whisker.youngs_modulus_gpa", &table.youngs_modulus_gpa)?;
    let (curvature, euler_spiral) = match &table.curvature {
        Some(table) => shape::shape(table, length_mm, largest(&grid.curvature_per_mm))?,
        None => (None, None),
    };
    let ratio = table.modulus_gradient.as_ref().map(|own| &own.tip_to_base);
    let key = "whisker.modulus_gradient.tip_to_base";
    let modulus_tip_to_base =
        Limits::between(1.0 / STIFFEST_TIP, STIFFEST_TIP).check_or(1.0, key, ratio)?;
    let own_taper = 1.0 - radii.tip_radius_um / radii.base_radius_um;
    let pointed = 1.0 / largest(&grid.taper).unwrap_or(own_taper);
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

fn largest(axis: &Option<Vec<f64>>) -> Option<f64> {
    axis.as_ref()?.last().copied()
}

fn grid(table: &Spanned<GridTable>, length_mm: f64) -> Result<Grid, Fault> {
    let axes = table.get_ref();
    let turn = Limits::between(-360.0, 360.0);
    let push_angle_deg = axis::values(&axes.push_angle_deg, "grid.push_angle_deg", &turn)?;
    let near = ("length_mm / 1000", length_mm / NEAREST);
    let far = ("10 * length_mm", FARTHEST * length_mm);
    let reach = Limits::between(near, far);
    let distance_mm = axis::values(&axes.distance_mm, "grid.distance_mm", &reach)?;
    let optional = |axis: &Option<Spanned<Axis>>, key, limits| {
        let values = |axis| axis::values(axis, key, &limits);
        axis.as_ref().map(values).transpose()
    };
    let taper = optional(&axes.taper, "grid.taper", Limits::between(0.0, 1.0))?;
    let key = "grid.curvature_per_mm";
    let limits = shape::parabola_limits(length_mm);
    let curvature_per_mm = optional(&axes.curvature_per_mm, key, limits)?;
    if let (Some(values), Some(axis)) = (&curvature_per_mm, &axes.curvature_per_mm) {
        refuse_faint(values, length_mm, key, axis.span())?;
    }

    let counts = [
        push_angle_deg.len(),
        distance_mm.len(),
        taper.as_ref().map_or(1, Vec::len),
        curvature_per_mm.as_ref().map_or(1, Vec::len),
    ];
    let cells: u128 = counts.iter().map(|&count| count as u128).product();
    if cells > MOST_CELLS {
        let must = format!("must have at most {MOST_CELLS} cells over all axes, has {cells}");
        return Err(Fault::new("grid", table.span(), must));
    }
    Ok(Grid {
        push_angle_deg,
        distance_mm,
        taper,
        curvature_per_mm,
    })
}

/// Where the pole's rim touches the whisker at rest, the centre is `D` away from the base, and `D^2` grows along the
/// whisker `1 -+ r kappa` times as fast as the chord's square (the sign is the side). So with `r` below the
/// whisker's smallest radius of curvature, first touch is one-to-one and the base stays outside the pole.
fn pole_limits(whisker: &Whisker, grid: &Grid) -> Limits {
    let steepest = largest(&grid.curvature_per_mm).map(|a| 2.0 * a);
    let sharpest = 1.0 / steepest.unwrap_or(whisker.sharpest_bend_per_mm());
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
