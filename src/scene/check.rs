//! Checks of a scene: the ranges in which all later modules are valid.
//!
//! Ranges are wide; they keep units from being mixed up and f32 from overflowing, and they hold wherever
//! the geometry of first touch is one-to-one. Lengths are measured in lengths of the whisker.

use super::builder::{Numbers, SceneBuilder};
use super::data::SceneData;
use super::deviations;
use super::error::SceneFault;
use super::grid::{FARTHEST, Grid, NEAREST, SweepAxis, SweepVariable};
use super::limits::{NumberLimits, digits};
use super::parameter::{MOST_STRETCH, Parameter, STIFFEST_TIP};
use super::profile;
use super::shape;
use super::smooth::MeasuredRadii;
use super::sweep;
use super::toml::{SceneText, YIELD_KEY};
use super::warnings::{LENGTH_MM, LENGTH_UNITS, MODULUS_GPA, MODULUS_UNITS, other_unit};
use super::whisker::{Curvature, Pole, Whisker};
use crate::traced::TracedShape;
use std::sync::Arc;

/// Most cells of a scene: more than any disk holds, as a stored cell takes about 20 bytes.
const MOST_CELLS: u128 = 1 << 44;

/// Largest number of characters of a title: many times what fits on a picture.
pub const LONGEST_TITLE: usize = 1000;

/// Largest yield strain: at 1, the whisker's surface would be stretched to twice its length.
const MOST_YIELD_STRAIN: f64 = 1.0;

/// Longest name of outputs in bytes: file systems allow 255, and outputs add endings.
const LONGEST_NAME: usize = 200;

impl SceneBuilder {
    /// Checks the description and returns the data of the scene, with `text` as its TOML.
    pub(super) fn checked(&self, text: SceneText) -> Result<SceneData, SceneFault> {
        check_title(&self.title)?;
        let Some(rows) = &self.table else {
            return self.data(text);
        };
        let (table, first) = self.table_whiskers(rows)?;
        let mut data = first.data(text)?;
        let names = rows.iter().map(|row| row.name.clone());
        let axis = SweepAxis {
            variable: SweepVariable::Whisker(names.collect()),
            values: (1..=rows.len()).map(|row| row as f64).collect(),
        };
        data.table = table.into();
        data.grid.sweep.insert(0, axis);
        check_size(&data.grid)?;
        Ok(data)
    }

    /// Checks the whiskers of a scene without a table, and returns the first one, its pole, and the grid.
    pub(super) fn first(&self) -> Result<(Whisker, Pole, Grid), SceneFault> {
        self.yield_strain.map(check_yield_strain).transpose()?;
        if let Some(traced) = self.traced.as_ref().filter(|_| self.is_length_traced) {
            shape::check_unit(traced)?;
        }
        let lengths_mm = sweep::lengths_mm(self)?;
        let grid = grid(self, lengths_mm)?;
        sweep::refuse_at_odds(self)?;
        let at = |numbers: &Numbers| {
            let whisker = Whisker {
                yield_strain: self.yield_strain,
                ..whisker(numbers, self.measured.as_ref(), self.traced.as_deref())?
            };
            let pole = pole(numbers, &whisker, &grid)?;
            Ok((whisker, pole))
        };
        sweep::check_corners(&grid, |place| at(&self.numbers.at(place)).map(drop))?;
        let (mut whisker, pole) = at(&self.numbers.at(&grid.place(0)))?;
        if grid.axis(Parameter::ParabolaPerMm).is_none() {
            whisker.curvature = whisker.curvature.filter(Curvature::is_given);
        }
        Ok((whisker, pole, grid))
    }

    /// Checks a scene without a table and returns its data.
    fn data(&self, text: SceneText) -> Result<SceneData, SceneFault> {
        let (whisker, pole, grid) = self.first()?;
        check_name(self.name.as_deref())?;
        Ok(SceneData {
            title: self.title.clone(),
            uncertainty: deviations::checked(self)?,
            surface: self.surface.map(|surface| surface.checked(&whisker)).transpose()?,
            whisker,
            pole,
            grid,
            table: Arc::default(),
            name: self.name.as_ref().unwrap_or(&self.stem).clone(),
            text,
        })
    }
}

fn check_yield_strain(strain: f64) -> Result<f64, SceneFault> {
    match 0.0 < strain && strain <= MOST_YIELD_STRAIN {
        true => Ok(strain),
        false => {
            let must = format!("must be more than 0 and at most {MOST_YIELD_STRAIN}");
            Err(SceneFault::of_value(YIELD_KEY, digits(strain), must))
        }
    }
}

fn check_title(title: &str) -> Result<(), SceneFault> {
    let length = title.chars().count();
    let must = if title.trim().is_empty() || title.contains(char::is_control) {
        "must be one line of text".to_owned()
    } else if length > LONGEST_TITLE {
        format!("must have at most {LONGEST_TITLE} characters, has {length}")
    } else {
        return Ok(());
    };
    Err(SceneFault::new("title", must))
}

/// Returns the given number of a parameter, or else its neutral one, if it lies within the limits.
fn check_number(
    numbers: &Numbers,
    parameter: Parameter,
    limits: NumberLimits,
) -> Result<f64, SceneFault> {
    let absent = || SceneFault::new(parameter.key(), "is left out");
    let value = numbers.get(parameter).or(parameter.neutral());
    limits.check(parameter.key(), value.ok_or_else(absent)?)
}

fn whisker(
    numbers: &Numbers,
    measured: Option<&MeasuredRadii>,
    traced: Option<&TracedShape>,
) -> Result<Whisker, SceneFault> {
    let check = |parameter, limits| check_number(numbers, parameter, limits);
    let length_mm = check(Parameter::LengthMm, Parameter::LengthMm.number_limits())?;
    let radii = profile::radii(numbers, measured, length_mm)?;
    let length_mm = radii.length_mm;
    let modulus = numbers.get(Parameter::YoungsModulusGpa);
    let unit = modulus.and_then(|gpa| other_unit(gpa, MODULUS_GPA, &MODULUS_UNITS));
    let unit = unit.map(|unit| format!("is it in {unit}?"));
    let modulus = Parameter::YoungsModulusGpa;
    let youngs_modulus_gpa = check(modulus, modulus.number_limits().remarks(unit))?;
    let (curvature, euler_spiral) = shape::shape(numbers, length_mm)?;
    let traced = traced.map(|traced| shape::traced(numbers, &traced.curvature)).transpose()?;
    let ratio = Parameter::ModulusTipToBase;
    let modulus_tip_to_base = check(ratio, ratio.number_limits())?;
    let own_taper = 1.0 - radii.tip_radius_um / radii.base_radius_um;
    let pointed = 1.0 / own_taper;
    let gradient = modulus_tip_to_base - 1.0;
    let [softest, stiffest] = [1.0 / STIFFEST_TIP, STIFFEST_TIP].map(|tip| (tip - 1.0) / gradient);
    let mut end = ("twice as long", MOST_STRETCH);
    for other in [
        ("1 / taper, where the radius at the tip is 0", pointed),
        ("0.95 / (1 - tip_to_base), where the modulus at the tip is 0.05 of the base's", softest),
        ("19 / (tip_to_base - 1), where the modulus at the tip is 20 times the base's", stiffest),
    ] {
        if (1.0..end.1).contains(&other.1) {
            end = other;
        }
    }
    let arc_stretch = check(Parameter::ArcStretch, NumberLimits::between(1.0, end))?;
    let stiffness = Parameter::FollicleStiffness;
    let given = numbers.get(stiffness);
    let follicle_stiffness_nnm_per_rad =
        given.map(|number| stiffness.number_limits().check(stiffness.key(), number)).transpose()?;
    Ok(Whisker {
        length_mm,
        base_radius_um: radii.base_radius_um,
        tip_radius_um: radii.tip_radius_um,
        youngs_modulus_gpa,
        curvature,
        euler_spiral,
        traced,
        profile: radii.profile,
        profile_scale: numbers.get(Parameter::ProfileScale).unwrap_or(1.0),
        modulus_tip_to_base,
        arc_stretch,
        follicle_stiffness_nnm_per_rad,
        yield_strain: None,
    })
}

fn grid(scene: &SceneBuilder, [shortest, longest]: [f64; 2]) -> Result<Grid, SceneFault> {
    let turn = NumberLimits::between(-360.0, 360.0);
    let push_angle_deg = scene.push_angle_deg.checked("grid.push_angle_deg", &turn)?;
    let near = ("length_mm / 1000", longest / NEAREST);
    let far = ("10 * length_mm", FARTHEST * shortest);
    let likely_unit = other_unit(longest, LENGTH_MM, &LENGTH_UNITS);
    let unit = likely_unit.filter(|_| !(LENGTH_MM[0]..=LENGTH_MM[1]).contains(&longest));
    let remark = unit.map(|unit| format!("is length_mm = {} in {unit}?", digits(longest)));
    let reach = NumberLimits::between(near, far).remarks(remark);
    let distance_mm = scene.distance_mm.checked("grid.distance_mm", &reach)?;
    let sweep = sweep::axes(scene, [shortest, longest])?;
    let grid = Grid { push_angle_deg, distance_mm, sweep };
    check_size(&grid)?;
    Ok(grid)
}

/// Checks the number of cells of a grid.
fn check_size(grid: &Grid) -> Result<(), SceneFault> {
    let sweep = grid.sweep.iter().map(|axis| axis.values.len());
    let mut counts = [grid.push_angle_deg.len(), grid.distance_mm.len()].into_iter().chain(sweep);
    let cells = counts.try_fold(1, |cells: u128, count| cells.checked_mul(count as u128));
    if cells.is_none_or(|cells| cells > MOST_CELLS) {
        let has = cells.map_or_else(String::new, |cells| format!(", has {cells}"));
        let must = format!("must have at most {MOST_CELLS} cells over all axes{has}");
        return Err(SceneFault::new("grid", must));
    }
    Ok(())
}

/// Checks the pole. Where its rim touches the whisker at rest, the centre is at a distance `D` from the base. Along the whisker, `D^2`
/// grows `1 -+ r kappa` times as fast as the chord's square (the sign is the side). So with `r` below the whisker's smallest radius of
/// curvature, first touch is one-to-one and the base stays outside the pole.
fn pole(numbers: &Numbers, whisker: &Whisker, grid: &Grid) -> Result<Pole, SceneFault> {
    let sharpest = 1.0 / whisker.sharpest_bend_per_mm();
    let nearest = grid.distance_mm[0];
    let end = if sharpest < nearest {
        ("the whisker's smallest radius of curvature", sharpest)
    } else {
        ("the smallest distance", nearest)
    };
    let check = |parameter, limits| check_number(numbers, parameter, limits);
    Ok(Pole {
        radius_mm: check(Parameter::PoleRadiusMm, NumberLimits::below(0.0, end))?,
        friction: check(Parameter::Friction, Parameter::Friction.number_limits())?,
    })
}

/// Checks the name that the scene gives its outputs.
fn check_name(name: Option<&str>) -> Result<(), SceneFault> {
    let fits = |name: &str| {
        (1..=LONGEST_NAME).contains(&name.len())
            && !name.starts_with('.')
            && !name.contains(|c: char| c.is_control() || "/\\".contains(c))
    };
    if name.is_none_or(fits) {
        return Ok(());
    }
    let must = format!(
        "must be the name of a file without its ending: 1 to {LONGEST_NAME} bytes, no slash, no dot first"
    );
    Err(SceneFault::new("output.name", must))
}
