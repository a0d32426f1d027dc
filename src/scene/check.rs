//! The ranges: what makes a scene valid everywhere after.
//!
//! Ranges are wide; they keep units from being mixed up and f32 from overflowing, and they hold wherever
//! the geometry of first touch is one-to-one. Lengths are measured in lengths of the whisker.

use toml::Spanned;

use super::axis;
use super::error::Fault;
use super::file::{GridTable, Number, OutputTable, SceneTable, WhiskerTable};
use super::limits::Limits;
use super::profile::{self, Radii};
use super::shape::{self, Shape, refuse_faint};
use super::{FARTHEST, Grid, NEAREST, Pole, Scene, Whisker};

/// As many as 16,384 x 16,384; a stored cell takes about 60 bytes.
const MOST_CELLS: u128 = 1 << 28;

/// Rubber on concrete; the whiskers of rats on steel have about 0.5.
const MOST_FRICTION: f64 = 2.0;

/// Measured ratios lie between 0.7 and 1.4.
const STIFFEST_TIP: f64 = 20.0;

/// A whisker that is twice as long as it looks.
const MOST_STRETCH: f64 = 2.0;

/// File systems allow 255 bytes; the output adds its own endings.
const LONGEST_NAME: usize = 100;

/// The scene that the tables describe.
pub(super) fn scene(table: &SceneTable, text: &str, default_name: &str) -> Result<Scene, Fault> {
    let title = title(&table.title)?;
    let length_mm =
        Limits::between(1e-3, 1e5).check("whisker.length_mm", &table.whisker.length_mm)?;
    let grid = grid(&table.grid, length_mm)?;
    let sharpest = grid.taper.as_ref().and_then(|axis| axis.last());
    let steepest = grid.curvature_per_mm.as_ref().and_then(|axis| axis.last());
    refuse_two_of_a_kind(&table.whisker, &table.grid)?;
    let whisker = whisker(
        &table.whisker,
        length_mm,
        steepest.copied(),
        sharpest.copied(),
    )?;
    let radius_mm = match &table.pole {
        Some(pole) => {
            let own = whisker.sharpest_bend_per_mm();
            let sharpest_per_mm = steepest.map_or(own, |a| 2.0 * a);
            pole_radius(&pole.radius_mm, sharpest_per_mm, &grid.distance_mm)?
        }
        None => 0.0,
    };
    let friction = match &table.contact {
        Some(contact) => {
            Limits::between(0.0, MOST_FRICTION).check("contact.friction", &contact.friction)?
        }
        None => 0.0,
    };
    Ok(Scene {
        title,
        whisker,
        pole: Pole {
            radius_mm,
            friction,
        },
        grid,
        name: name(table.output.as_ref(), default_name)?,
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
    let spiral = whisker
        .curvature
        .as_ref()
        .and_then(|curvature| curvature.get_ref().euler_spiral.as_ref());
    if let (Some(axis), Some(_)) = (&axes.curvature_per_mm, spiral) {
        let must = "must be left out: the whisker is an Euler spiral";
        return Err(Fault::new("grid.curvature_per_mm", axis.span(), must));
    }
    Ok(())
}

fn title(title: &Spanned<String>) -> Result<String, Fault> {
    let text = title.get_ref();
    if text.trim().is_empty() || text.contains(char::is_control) {
        return Err(Fault::new(
            "title",
            title.span(),
            "must be one line of text",
        ));
    }
    Ok(text.clone())
}

/// The whisker of the file; `steepest` is the largest `A` of a curvature axis, `sharpest` the largest taper of one.
fn whisker(
    table: &WhiskerTable,
    length_mm: f64,
    steepest: Option<f64>,
    sharpest: Option<f64>,
) -> Result<Whisker, Fault> {
    let Radii {
        base_radius_um,
        tip_radius_um,
        profile,
    } = profile::radii(table, length_mm)?;
    let youngs_modulus_gpa = Limits::between(1e-6, 1e4)
        .check("whisker.youngs_modulus_gpa", &table.youngs_modulus_gpa)?;
    let shape = match &table.curvature {
        Some(table) => shape::shape(table, length_mm, steepest)?,
        None => Shape::default(),
    };
    let modulus_tip_to_base = match &table.modulus_gradient {
        Some(gradient) => Limits::between(1.0 / STIFFEST_TIP, STIFFEST_TIP).check(
            "whisker.modulus_gradient.tip_to_base",
            &gradient.tip_to_base,
        )?,
        None => 1.0,
    };
    let arc_stretch = match &table.projection {
        Some(projection) => {
            let taper = sharpest.unwrap_or(1.0 - tip_radius_um / base_radius_um);
            let pointed = 1.0 / taper;
            let end = if pointed < MOST_STRETCH {
                ("1 / taper, where the radius at the tip is 0", pointed)
            } else {
                ("twice as long", MOST_STRETCH)
            };
            Limits::between(1.0, end)
                .check("whisker.projection.arc_stretch", &projection.arc_stretch)?
        }
        None => 1.0,
    };
    Ok(Whisker {
        length_mm,
        base_radius_um,
        tip_radius_um,
        youngs_modulus_gpa,
        curvature: shape.parabola,
        euler_spiral: shape.euler_spiral,
        profile,
        modulus_tip_to_base,
        arc_stretch,
    })
}

fn grid(table: &Spanned<GridTable>, length_mm: f64) -> Result<Grid, Fault> {
    let axes = table.get_ref();
    let push_angle_deg = axis::values(
        &axes.push_angle_deg,
        "grid.push_angle_deg",
        &Limits::between(-360.0, 360.0),
    )?;
    let near = ("length_mm / 1000", length_mm / NEAREST);
    let far = ("10 * length_mm", FARTHEST * length_mm);
    let distance_mm = axis::values(
        &axes.distance_mm,
        "grid.distance_mm",
        &Limits::between(near, far),
    )?;
    let taper = match &axes.taper {
        Some(axis) => Some(axis::values(
            axis,
            "grid.taper",
            &Limits::between(0.0, 1.0),
        )?),
        None => None,
    };
    let curvature_per_mm = match &axes.curvature_per_mm {
        Some(axis) => {
            let key = "grid.curvature_per_mm";
            let values = axis::values(axis, key, &shape::parabola_limits(length_mm))?;
            refuse_faint(&values, length_mm, key, axis.span())?;
            Some(values)
        }
        None => None,
    };

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
fn pole_radius(number: &Number, sharpest_per_mm: f64, distance_mm: &[f64]) -> Result<f64, Fault> {
    let sharpest = 1.0 / sharpest_per_mm;
    let nearest = distance_mm.first().copied().unwrap_or(f64::INFINITY);
    let end = if sharpest < nearest {
        ("the whisker's smallest radius of curvature", sharpest)
    } else {
        ("the smallest distance", nearest)
    };
    Limits::below(0.0, end).check("pole.radius_mm", number)
}

fn name(output: Option<&OutputTable>, default_name: &str) -> Result<String, Fault> {
    let given = output.and_then(|output| output.name.as_ref());
    let name = given.map_or(default_name, |name| name.get_ref());
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    let fits = (1..=LONGEST_NAME).contains(&name.len());
    if fits && name.chars().all(plain) && !name.starts_with('.') {
        return Ok(name.to_owned());
    }
    let must = format!(
        "must be 1 to {LONGEST_NAME} ASCII letters, digits, - _ . and not begin with a dot"
    );
    Err(match given {
        Some(name) => Fault::new("output.name", name.span(), must),
        None => Fault::absent(
            "output.name",
            format!("is left out and the file's own name, {name:?}, does not do: {must}"),
        ),
    })
}
