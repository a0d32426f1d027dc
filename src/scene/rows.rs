//! Whiskers of a table: each row is checked as a scene of its own.

use std::collections::HashMap;

use super::builder::SceneBuilder;
use super::error::SceneFault;
use super::grid::SweepVariable;
use super::parameter::Parameter;
use super::table::{TableWhisker, WhiskerRow};
use crate::input::shortened;

/// Largest number of rows of a table of whiskers.
const MOST_ROWS: usize = 65_536;

impl SceneBuilder {
    /// Sets the table of whiskers, which is the first sweep axis. A number of a row replaces the number of the scene.
    #[must_use]
    pub fn whiskers(mut self, rows: impl Into<Vec<WhiskerRow>>) -> Self {
        self.table = Some(rows.into().into());
        self.refused = None;
        self
    }

    /// Returns the builder of the whisker of a row, without the table.
    pub(super) fn of_row(&self, row: &WhiskerRow) -> Result<Self, SceneFault> {
        let mut one = Self { table: None, ..self.clone() };
        for &(parameter, value) in &row.numbers {
            if !value.is_nan() {
                one.numbers.set(parameter, value);
            } else if row.replaces(parameter) {
                one.numbers.clear(parameter);
            } else {
                let missing = format!("{} is missing", parameter.name());
                return Err(SceneFault::new(SweepVariable::TABLE, missing));
            }
        }
        if let Some(rows) = &row.profile {
            one = one.profile(rows.clone());
        }
        if let Some(rest) = &row.rest {
            one = one.with_traced(rest.shape.clone()?);
        }
        if let Some(strain) = row.yield_strain {
            one.yield_strain = Some(strain).filter(|strain| !strain.is_nan());
        }
        one.with_tip_of_taper()
    }

    /// Returns the whiskers of the table, `[row]`, and the builder of the first row that has one.
    pub(super) fn table_whiskers(
        &self,
        rows: &[WhiskerRow],
    ) -> Result<(Vec<TableWhisker>, Self), SceneFault> {
        check_names(rows)?;
        self.refuse_axes_of_columns()?;
        let mut first = None;
        let whiskers = rows.iter().map(|row| {
            let one = self.of_row(row);
            let found = one.and_then(|one| {
                let (whisker, pole, _) = one.first()?;
                first.get_or_insert(one);
                Ok((whisker, pole))
            });
            TableWhisker { name: row.name.clone(), found: found.map_err(|fault| reason(&fault)) }
        });
        let whiskers: Vec<TableWhisker> = whiskers.collect();
        match first {
            Some(first) => Ok((whiskers, first)),
            None => {
                let reason = whiskers.iter().find_map(|whisker| whisker.found.as_ref().err());
                let reason = reason.map_or("", |reason| reason);
                let must = format!("must have a row with a whisker; row 1: {reason}");
                Err(SceneFault::new(SweepVariable::TABLE, must))
            }
        }
    }
}

/// Checks the number of rows and their names, which must differ.
fn check_names(rows: &[WhiskerRow]) -> Result<(), SceneFault> {
    let key = SweepVariable::TABLE;
    if !(1..=MOST_ROWS).contains(&rows.len()) {
        let must = format!("must have between 1 and {MOST_ROWS} rows, has {}", rows.len());
        return Err(SceneFault::new(key, must));
    }
    let mut places = HashMap::new();
    for (index, row) in rows.iter().enumerate() {
        let name = &row.name;
        let key = format!("{key}[{index}]");
        if name.trim().is_empty() {
            return Err(SceneFault::new(key, "the name of the whisker is missing"));
        }
        let must = if name.contains(char::is_control) {
            "the name of a whisker must be one line of text".to_owned()
        } else if let Some(first) = places.insert(name, index) {
            format!(
                "the name of a whisker must be unlike those before it; row {} is {} too",
                first + 1,
                shortened(name)
            )
        } else if let Some(twice) = given_twice(row) {
            twice
        } else {
            continue;
        };
        return Err(SceneFault::of_value(key, name.clone(), must));
    }
    Ok(())
}

/// Returns what is wrong with a row that gives a parameter twice.
fn given_twice(row: &WhiskerRow) -> Option<String> {
    let count = |parameter| row.numbers.iter().filter(|(given, _)| *given == parameter).count();
    if count(Parameter::Taper) + count(Parameter::TipRadiusUm) > 1 {
        return Some("must have either a taper or a tip_radius_um".to_owned());
    }
    let mut parameters = Parameter::ALL.into_iter();
    let twice = parameters.find(|parameter| count(*parameter) > 1)?;
    let (name, axis) = (twice.name(), twice.axis());
    Some(match name == axis {
        true => format!("must have {name} at most once"),
        false => format!("must have either {name} or {axis}, which are one"),
    })
}

/// Returns a fault as the reason why a row has no whisker.
fn reason(fault: &SceneFault) -> String {
    let SceneFault { key, value, must } = fault;
    match value {
        _ if key == SweepVariable::TABLE => must.clone(),
        Some(value) => format!("{key} = {value}: {must}"),
        None => format!("{key}: {must}"),
    }
}
