//! Option `--derivatives`: columns with exact derivatives.

use super::arguments::{completed, variable_names};
use super::failure::Failure;
use clap::Args;
use serde::ser::{Serialize, SerializeStruct, Serializer};
use std::str::FromStr;
use whiskmap::input::each_once;
use whiskmap::scene::Scene;
use whiskmap::sensitivity::{Derivatives, NoDerivative, Variable};

#[derive(Debug, Args)]
pub struct DerivativeArgs {
    /// Append columns with derivatives, such as d_force_d_taper, by the named variables, separated by commas; without names, by all
    /// variables of the scene
    #[arg(
        long,
        value_name = "NAMES",
        value_delimiter = ',',
        num_args = 0..,
        require_equals = true,
        value_parser = completed(Variable::from_str, variable_names(&["distance_mm", "push_angle_deg"])),
        hide_possible_values = true,
        conflicts_with = "units"
    )]
    derivatives: Option<Vec<Variable>>,
}

/// Derivatives in the columns of one table row, a group of columns for each variable.
pub struct DerivativeColumns<'a> {
    pub variables: &'a [Variable],
    /// Derivatives by each variable, `[variable]`; a column is empty without a derivative.
    pub by: Vec<Result<Derivatives, NoDerivative>>,
    /// Index of the first quantity: 1 leaves out the push angle, which states have in common.
    pub first: usize,
}

impl DerivativeArgs {
    /// Returns the variables of the columns, by default the variables of detachments and `more`: `[variable]`, empty without the option.
    pub fn variables(&self, scene: &Scene, more: &[Variable]) -> Result<Vec<Variable>, Failure> {
        let Some(named) = &self.derivatives else {
            return Ok(Vec::new());
        };
        let mut all = Variable::of_detachments(scene);
        all.extend_from_slice(more);
        if named.is_empty() {
            return Ok(all);
        }
        match named.iter().find(|variable| !all.contains(variable)) {
            None => Ok(each_once(named)),
            Some(other) => {
                let all: Vec<String> = all.iter().map(ToString::to_string).collect();
                let all = all.join(", ");
                Err(Failure::Input(format!(
                    "--derivatives {other}: must be one of {all}, which the scene has"
                )))
            }
        }
    }
}

impl Serialize for DerivativeColumns<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let count = self.variables.len() * (6 - self.first);
        let mut columns = serializer.serialize_struct("DerivativeColumns", count)?;
        for (variable, by) in self.variables.iter().zip(&self.by) {
            let values = by.as_ref().ok().map(Derivatives::columns);
            for (i, name) in variable.columns().iter().enumerate().skip(self.first) {
                columns.serialize_field(name, &values.map(|values| values[i]))?;
            }
        }
        columns.end()
    }
}
