//! Option `--units`: tables in other units.

use super::failure::Failure;
use serde::Serialize;
use std::io;
use whiskmap::input::{Quantity, did_you_mean, each_once};

/// Units of the columns of a table, at most one of each kind.
#[derive(Clone, Debug, Default)]
pub struct ColumnUnits(Vec<&'static str>);

impl ColumnUnits {
    /// Checks the names of units that the option `--units` gives.
    ///
    /// # Errors
    /// If a name is not one of a unit, or two units are of one kind.
    pub fn new(names: &[String]) -> Result<Self, Failure> {
        let mut units: Vec<&'static str> = Vec::new();
        let names: Vec<&str> = names.iter().map(|name| name.trim()).collect();
        for name in each_once(&names) {
            let refused = |must: String| Failure::Input(format!("--units {name}: {must}"));
            let mut kinds = Quantity::KINDS.into_iter();
            let found = kinds.find_map(|kind| {
                let unit = kind.units().find(|unit| *unit == name && unit.is_ascii())?;
                Some((kind, unit))
            });
            let Some((kind, unit)) = found else {
                let all = Quantity::KINDS.into_iter().flat_map(Quantity::units);
                let all: Vec<_> = all.filter(|unit| unit.is_ascii()).collect();
                let hint = did_you_mean(name, all.iter().copied());
                return Err(refused(format!("must be one of {}{hint}", all.join(", "))));
            };
            if let Some(other) = units.iter().find(|given| kind.units().any(|of| of == **given)) {
                return Err(refused(format!(
                    "{other} is a unit of the same quantity; give one of them"
                )));
            }
            units.push(unit);
        }
        Ok(Self(units))
    }

    /// Returns true if columns keep their units.
    pub const fn are_own(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns header and cells of `rows`, `[line][column]`, in these units. The name of a column ends in its unit.
    pub fn converted<R: Serialize>(
        &self,
        rows: impl IntoIterator<Item = R>,
    ) -> io::Result<Vec<Vec<String>>> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        for row in rows {
            writer.serialize(row)?;
        }
        let text = writer.into_inner().map_err(csv::IntoInnerError::into_error)?;
        let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(&*text);
        let mut lines = reader
            .records()
            .map(|line| Ok(line?.iter().map(str::to_owned).collect()))
            .collect::<io::Result<Vec<Vec<String>>>>()?;
        let Some((header, cells)) = lines.split_first_mut() else {
            return Ok(lines);
        };
        for (column, name) in header.iter_mut().enumerate() {
            let Some(unit) = self.unit(name) else {
                continue;
            };
            let quantity = Quantity::of(name);
            for cell in cells.iter_mut().map(|line| &mut line[column]) {
                let number = cell.parse().ok();
                if let Some(number) = number.and_then(|number| quantity.convert(number, unit)) {
                    *cell = format!("{number:?}");
                }
            }
            *name = self.named(name);
        }
        Ok(lines)
    }

    /// Returns the name of a `column` with its unit at the end.
    pub fn named(&self, column: &str) -> String {
        let unit = self.unit(column).zip(column.rsplit_once('_'));
        unit.map_or_else(
            || column.to_owned(),
            |(unit, (stem, _))| format!("{stem}_{}", unit.to_lowercase()),
        )
    }

    /// Returns the unit of a `column` that differs from its own; `None` if it keeps its own.
    fn unit(&self, column: &str) -> Option<&'static str> {
        let quantity = Quantity::of(column);
        self.0.iter().copied().find(|unit| quantity.units().any(|of| of == *unit))
    }
}
