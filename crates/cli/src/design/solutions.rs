//! Solutions of `whiskmap design`, as they are printed and written into a scene.

use crate::failure::Failure;
use std::io::{self, Write};
use whiskmap::design::DesignVaried;
use whiskmap::scene::{Parameter, Scene, digits, rounded};
use whiskmap::terminal::StandardOutput;

/// Significant digits of solutions for several targets.
pub const SOLUTION_DIGITS: usize = 6;

/// Values of the varied parameters that reach the targets, with the digits that are printed.
pub struct Solutions<'a> {
    scene: &'a Scene,
    varied: &'a DesignVaried,
    most_digits: usize,
    /// Values of the solutions, `[solution][parameter]`.
    pub values: Vec<Vec<f64>>,
}

impl<'a> Solutions<'a> {
    /// Creates the solutions with at most `most_digits` significant digits of their `values`, `[solution][parameter]`.
    pub fn new(
        scene: &'a Scene,
        varied: &'a DesignVaried,
        values: Vec<Vec<f64>>,
        most_digits: usize,
    ) -> Self {
        let values = values.into_iter().map(|exact| written(scene, varied, exact, most_digits));
        Self { values: values.collect(), scene, varied, most_digits }
    }

    /// Returns the scene with the values of the solution that is nearest to the scene's own, as TOML.
    pub fn nearest_scene(&self) -> Result<String, Failure> {
        let variables = self.varied.variables.iter();
        let current: Vec<f64> =
            variables.filter_map(|variable| variable.variable.value(self.scene)).collect();
        let apart = |values: &[f64]| {
            let pairs = values.iter().zip(&current);
            let parts = pairs
                .map(|(value, current)| (value - current) / current.abs().max(f64::MIN_POSITIVE));
            parts.map(|part| part.powi(2)).sum::<f64>()
        };
        let solutions = self.values.iter();
        let nearest = solutions.min_by(|a, b| apart(a).total_cmp(&apart(b)));
        let changes = nearest.map(|values| self.changes(values));
        Ok(self.scene.to_toml_with(&changes.unwrap_or_default())?)
    }

    /// Returns the numbers of the scene with the values of a solution. Instead of a varied taper, the scene gives the radius at the tip, unless it has the
    /// key of the taper.
    fn changes(&self, values: &[f64]) -> Vec<(Parameter, f64)> {
        let mut changes = self.varied.changes(self.scene, values);
        if self.varied.keeps_taper || self.scene.has_taper_key() {
            return changes;
        }
        let base = changes.iter().find(|(parameter, _)| *parameter == Parameter::BaseRadiusUm);
        let base_radius_um = base.map_or(self.scene.whisker.base_radius_um, |(_, value)| *value);
        for change in &mut changes {
            if change.0 == Parameter::Taper {
                let tip_radius_um = base_radius_um * (1.0 - change.1);
                *change = (Parameter::TipRadiusUm, rounded(tip_radius_um, self.most_digits));
            }
        }
        changes
    }

    /// Prints one line for each solution: its values, below their names if there are several.
    pub fn print(&self) -> io::Result<()> {
        let mut out = StandardOutput::open();
        let variables = &self.varied.variables;
        if variables.len() > 1 {
            let names = variables.iter().map(|variable| variable.variable.name());
            writeln!(out, "{}", names.collect::<Vec<_>>().join(","))?;
        }
        for values in &self.values {
            let values: Vec<String> = values.iter().map(|value| digits(*value)).collect();
            writeln!(out, "{}", values.join(","))?;
        }
        Ok(())
    }
}

/// Returns the values of a solution with their significant digits, or with all digits if the scene refuses them otherwise, next to a limit.
fn written(scene: &Scene, varied: &DesignVaried, exact: Vec<f64>, digits: usize) -> Vec<f64> {
    let short: Vec<f64> = exact.iter().map(|value| rounded(*value, digits)).collect();
    match scene.with_parameters(&varied.changes(scene, &short)) {
        Ok(_) => short,
        Err(_) => exact,
    }
}
