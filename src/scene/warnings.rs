//! Warnings about numbers that a scene accepts, but that look like numbers in another unit.

use super::data::SceneData;
use super::grid::Grid;
use super::limits::{digits, rounded};
use super::parameter::Parameter;
use super::smooth::{SmoothRadii, scatter};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Radius over length. Whiskers of rats lie between 1e-4 (at the tip) and 0.01; a thicker rod is no beam.
const SLENDER: [f64; 2] = [1e-5, 0.1];

/// Expected range of Young's modulus in GPa: hair, polymers and metals up to steel. Whiskers of rats have 1 to 8.
pub(super) const MODULUS_GPA: [f64; 2] = [0.1, 250.0];

/// Scatter of measured radii over the radius at the base from which on there is a warning. With rows every 0.5 mm, it moves detachments of
/// `scenes/cone.toml` by up to 0.3 degrees.
const SCATTER: f64 = 0.005;

/// Other units of Young's modulus, in GPa.
pub(super) const MODULUS_UNITS: [(&str, f64); 4] =
    [("Pa", 1e-9), ("kPa", 1e-6), ("MPa", 1e-3), ("TPa", 1e3)];

/// Expected range of a whisker's length in mm. Whiskers of rats have 5 to 60.
pub const LENGTH_MM: [f64; 2] = [1.0, 200.0];

/// Other units of a whisker's length, in mm.
pub(super) const LENGTH_UNITS: [(&str, f64); 3] = [("um", 1e-3), ("cm", 10.0), ("m", 1e3)];

/// Other units of radii and lengths that change their ratio, and by which factor.
const SLENDER_UNITS: [(&str, f64); 2] =
    [("mm, or the length in um", 1e3), ("nm, or the length in m", 1e-3)];

/// Other units of one number that change the force, and by which factor.
const FORCE_UNITS: [(&str, f64); 6] = [
    ("the radii in mm", 1e12),
    ("the length in um", 1e6),
    ("the modulus in TPa", 1e3),
    ("the radii in nm", 1e-12),
    ("the length in m", 1e-6),
    ("the modulus in MPa", 1e-3),
];

/// Forces in uN, from below the noise of any sensor to a kilonewton.
const FORCE_UN: [f64; 2] = [1e-6, 1e9];

/// Number of rows of a table of whiskers whose warnings are printed.
const NAMED_ROWS: usize = 3;

/// Key of a number of the scene, and its least and greatest value over the sweep. Values of 0 do not count; NaN if all are 0.
struct SceneNumber {
    key: String,
    ends: [f64; 2],
}

impl SceneNumber {
    fn new(key: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        let values = values.into_iter().filter(|value| *value > 0.0);
        let ends = values
            .map(|value| [value; 2])
            .reduce(|[least, most], [value, _]| [least.min(value), most.max(value)]);
        Self { key: key.into(), ends: ends.unwrap_or([f64::NAN; 2]) }
    }
}

impl SceneData {
    /// Returns warnings about numbers that look like another unit: one line each, with key, value, unit and the expected range.
    ///
    /// The numbers are radii below 1e-5 or above 0.1 of the length, moduli outside 0.1 to 250 GPa, and forces outside 1e-6 to 1e9 uN.
    /// At least 12 measured radii are compared with their neighbours, too: a scatter of 0.5 % of the radius at the base is named. All
    /// values of sweep axes count; of measured radii the largest one does. A message names another unit only if the number in that unit
    /// is as expected. Of a table of whiskers, the first three rows with warnings are named, each with
    /// its first one.
    ///
    /// The force is `E I / L^2` with the second moment of area at the base: a cylinder bends by 1 radian under twice that
    /// force across its tip, to first order.
    ///
    /// ```
    /// use whiskmap::scene::{Parameter, Scene};
    ///
    /// let cone = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml")?;
    /// assert!(cone.warnings().is_empty());
    /// let warnings = cone.with(Parameter::YoungsModulusGpa, 3000.0)?.warnings();
    /// let modulus = "whisker.youngs_modulus_gpa = 3000 GPa: expected 0.1 to 250 GPa; is it in MPa?";
    /// assert_eq!(warnings, [modulus]);
    /// # Ok::<(), whiskmap::scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        if !self.table.is_empty() {
            return self.table_warnings();
        }
        let length = self.number(Parameter::LengthMm, self.whisker.length_mm);
        let radii = self.radii();
        let radii = radii.iter().filter_map(|radius| thickness(radius, &length));
        let others = self.modulus().into_iter().chain(self.force());
        radii.chain(others).chain(self.jumps()).collect()
    }

    /// Warnings about rows of the table of whiskers.
    fn table_warnings(&self) -> Vec<String> {
        let mut seen = BTreeSet::new();
        let warned = self.whiskers().flatten().filter_map(|swept| {
            // With other axes, the sweep has each row several times.
            let name = swept.place.whisker().unwrap_or_default();
            if !seen.insert(name.to_owned()) {
                return None;
            }
            let grid = Grid { sweep: Vec::new(), ..self.grid.clone() };
            let (whisker, pole, table) = (swept.whisker, swept.pole, Arc::default());
            let alone = Self { whisker, pole, grid, table, ..self.clone() };
            let first = alone.warnings().into_iter().next();
            first.map(|warning| format!("whiskers.table: {name}: {warning}"))
        });
        let rows: Vec<String> = warned.collect();
        let others = rows.len().saturating_sub(NAMED_ROWS);
        let others = (others > 0).then(|| {
            format!("whiskers.table: rows with such warnings that are not named: {others}")
        });
        rows.into_iter().take(NAMED_ROWS).chain(others).collect()
    }

    /// A warning about measured radii that jump by more than their neighbours explain.
    fn jumps(&self) -> Option<String> {
        let Self { whisker, .. } = self;
        let (length, base) = (whisker.length_mm, whisker.base_radius_um);
        let rows = whisker.profile.iter().flatten();
        let rows: Vec<[f64; 2]> = rows.map(|[s, radius]| [length * s, base * radius]).collect();
        let scatter = scatter(&rows).filter(|scatter| *scatter >= SCATTER * base)?;
        let fit = SmoothRadii::fit(&rows).ok()?;
        let step = length / (rows.len() - 1) as f64;
        let [scatter_um, part, slope, mean, rms] = [
            scatter,
            100.0 * scatter / base,
            std::f64::consts::SQRT_2 * scatter / step,
            (base - whisker.tip_radius_um) / length,
            fit.rms_um,
        ]
        .map(|number| digits(rounded(number, 2)));
        Some(format!(
            "whisker.profile.rows: radii scatter by {scatter_um} um from row to row, {part} % of the base, more than their neighbours \
             explain; expected at most {} %. Tapers between rows are off by {slope} um/mm, of {mean} um/mm on average, and move \
             detachments. whisker.profile.smooth = true replaces the radii by a polynomial through the rows: degree {}, rms {rms} um",
            digits(100.0 * SCATTER),
            fit.degree
        ))
    }

    /// Values of `parameter` in the scene: the values of its axis, or else `value`.
    fn number(&self, parameter: Parameter, value: f64) -> SceneNumber {
        match self.grid.axis(parameter) {
            Some(values) => SceneNumber::new(parameter.axis_key(), values.iter().copied()),
            None => SceneNumber::new(parameter.key(), [value]),
        }
    }

    /// The radii of the scene, without a tip that follows from a taper.
    fn radii(&self) -> Vec<SceneNumber> {
        let whisker = &self.whisker;
        if let Some(rows) = &whisker.profile {
            // A column has one unit, and a waist may be thin.
            let thickest = rows.iter().fold(0.0, |most: f64, [_, radius]| most.max(*radius));
            let thickest_um = thickest * whisker.base_radius_um;
            return vec![SceneNumber::new("whisker.profile.rows", [thickest_um])];
        }
        let mut radii = vec![self.number(Parameter::BaseRadiusUm, whisker.base_radius_um)];
        if self.grid.axis(Parameter::Taper).is_none() {
            radii.push(self.number(Parameter::TipRadiusUm, whisker.tip_radius_um));
        }
        radii
    }

    fn modulus(&self) -> Option<String> {
        let gpa = self.whisker.youngs_modulus_gpa;
        let unit = unexpected(gpa, MODULUS_GPA, &MODULUS_UNITS)?;
        let hint = unit.map(|unit| format!("; is it in {unit}?")).unwrap_or_default();
        let key = Parameter::YoungsModulusGpa.key();
        let [gpa, least, most] = [gpa, MODULUS_GPA[0], MODULUS_GPA[1]].map(digits);
        Some(format!("{key} = {gpa} GPa: expected {least} to {most} GPa{hint}"))
    }

    /// The force of the first whisker at an end of the axes whose force is not as expected.
    fn force(&self) -> Option<String> {
        self.corner_whiskers().find_map(|swept| {
            let whisker = swept.whisker;
            let force_un = whisker.units().force_un;
            unexpected(force_un, FORCE_UN, &FORCE_UNITS)?;
            let others = other_units(force_un, FORCE_UN, &FORCE_UNITS).collect::<Vec<_>>().join(" or ");
            let hint = match others.as_str() {
                "" => String::new(),
                others => format!("; are {others}?"),
            };
            let numbers = [
                whisker.youngs_modulus_gpa,
                whisker.base_radius_um,
                whisker.length_mm,
            ];
            let [gpa, um, mm] = numbers.map(digits);
            let [least, most] = FORCE_UN.map(|force| format!("{force:e}"));
            Some(format!(
                "forces of about {force_un:.1e} uN (E I / L^2 of {gpa} GPa, {um} um and {mm} mm): expected {least} to {most} \
                 uN{hint}"
            ))
        })
    }
}

/// A warning about a radius out of the expected range of radius over length.
fn thickness(radius: &SceneNumber, length: &SceneNumber) -> Option<String> {
    let [thinnest_um, thickest_um] = radius.ends;
    let [shortest_mm, longest_mm] = length.ends;
    let extremes = [(thinnest_um, longest_mm), (thickest_um, shortest_mm)];
    extremes.into_iter().find_map(|(um, mm)| {
        let ratio = um * 1e-3 / mm;
        let other = unexpected(ratio, SLENDER, &SLENDER_UNITS)?;
        let hint = other.map(|other| format!("; is it in {other}?")).unwrap_or_default();
        let [um, mm, least, most] = [um, mm, SLENDER[0], SLENDER[1]].map(digits);
        Some(format!(
            "{} = {um} um: expected {least} to {most} of {} = {mm} mm, is {ratio:.1e}{hint}",
            radius.key, length.key
        ))
    })
}

/// The other unit in which a `value` out of the `expected` range would be in it, if any; `None` for a value in it.
fn unexpected(
    value: f64,
    expected: [f64; 2],
    units: &[(&'static str, f64)],
) -> Option<Option<&'static str>> {
    let [least, most] = expected;
    let is_beyond = value < least || value > most;
    is_beyond.then(|| other_unit(value, expected, units))
}

/// Returns the first of the `units` with which `value` is within `expected`; each has its size in the unit of the value. `None` without
/// such a unit.
pub(super) fn other_unit(
    value: f64,
    expected: [f64; 2],
    units: &[(&'static str, f64)],
) -> Option<&'static str> {
    other_units(value, expected, units).next()
}

/// The `units` with which `value` is within `expected`.
fn other_units(
    value: f64,
    [least, most]: [f64; 2],
    units: &[(&'static str, f64)],
) -> impl Iterator<Item = &'static str> {
    let fitting = units.iter().filter(move |(_, size)| (least..=most).contains(&(value * size)));
    fitting.map(|(unit, _)| *unit)
}
