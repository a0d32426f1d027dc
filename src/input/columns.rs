//! Names of own columns in place of those that a table must have.

use super::names::{did_you_mean, shortened};
use super::quantity::Quantity;
use super::table::{CsvError, CsvTable};
use std::fmt;
use std::str::FromStr;

/// Own name of a column in place of the expected one: `push_angle_deg=angle`.
///
/// The expected name may be shortened at an underscore: `push=angle` is the first column of the table whose name begins with `push_`.
///
/// ```
/// use whiskmap::input::CsvTable;
/// use whiskmap::measured::MeasuredPoints;
///
/// let table = CsvTable::parse("side,d,angle\ncb,15.66,15.6\n", "points.csv")?;
/// let columns = ["push=angle".parse()?, "distance=d".parse()?];
/// let points = MeasuredPoints::of(&table.renamed(&columns, &MeasuredPoints::COLUMNS)?)?;
/// assert_eq!(points.points[0].angle_deg, 15.6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ColumnName {
    /// Name of the column that the table must have, or its beginning up to an underscore.
    pub expected: String,
    /// Name that the column has in the file.
    pub in_file: String,
}

impl FromStr for ColumnName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let pair =
            text.split_once('=').map(|(expected, in_file)| [expected, in_file].map(str::trim));
        match pair {
            Some([expected, in_file]) if !expected.is_empty() && !in_file.is_empty() => Ok(Self {
                expected: expected.to_owned(),
                in_file: in_file.to_owned(),
            }),
            _ => Err("must be NAME=COLUMN, the name that the command expects and the column of the file, such as distance_mm=d".to_owned()),
        }
    }
}

impl fmt::Display for ColumnName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", shortened(&self.expected), shortened(&self.in_file))
    }
}

/// Returns the unit at the end of the name of a column `in_file` if the `expected` column has another unit of the same quantity.
fn other_unit(in_file: &str, expected: &str) -> Option<&'static str> {
    let (end, quantity) = (in_file.rsplit('_').next()?, Quantity::of(expected));
    let is_end = |unit: &&str| unit.eq_ignore_ascii_case(end);
    let unit = quantity.units().find(is_end).filter(|_| in_file.contains('_'))?;
    (Some(unit) != quantity.unit()).then_some(unit)
}

impl CsvTable {
    /// Returns the CSV table with column names of the file replaced by the expected ones, which must be among the `known` names of its
    /// columns.
    ///
    /// # Errors
    /// If an expected name is not known, a column of the file is missing or there twice, or a name is given or would be there twice.
    pub fn renamed(self, columns: &[ColumnName], known: &[&str]) -> Result<Self, CsvError> {
        let mut renamed: Vec<(usize, &str)> = Vec::with_capacity(columns.len());
        let (origin, line) = (self.origin.clone(), self.header_line());
        for column in columns {
            let refused = |what: String| {
                let what = format!("columns {column}: {what}");
                Err(CsvError::at(&origin, line, what))
            };
            let ColumnName { expected, in_file } = column;
            let is_short = |name: &&str| {
                let rest = name.strip_prefix(expected.as_str());
                rest.is_some_and(|rest| rest.starts_with('_'))
            };
            let whole = known.iter().find(|name| *name == expected);
            let Some(&name) = whole.or_else(|| known.iter().find(|name| is_short(name))) else {
                let hint = did_you_mean(expected, known.iter().copied());
                let expected = shortened(expected);
                let all = known.join(", ");
                return refused(format!("`{expected}` is not known; must be one of {all}{hint}"));
            };
            if let Some(unit) = other_unit(in_file, name) {
                let own = Quantity::of(name).unit().unwrap_or_default();
                return refused(format!(
                    "the column is in {unit}; values must be in {own}: convert them"
                ));
            }
            if renamed.iter().any(|(_, other)| *other == name) {
                return refused(format!("`{name}` is given twice"));
            }
            let places = |name: &str| {
                let names = self.names().enumerate();
                names.filter(|(_, other)| *other == name).map(|(place, _)| place).collect()
            };
            let found: Vec<usize> = places(in_file);
            let [place] = found[..] else {
                let hint = did_you_mean(in_file, self.names());
                let all = self.names().collect::<Vec<_>>().join(", ");
                let times = match found.len() {
                    0 => "is no column of the file",
                    _ => "must be one column of the file, and is several",
                };
                return refused(format!(
                    "`{}` {times}; found {}{hint}",
                    shortened(in_file),
                    shortened(&all)
                ));
            };
            if renamed.iter().any(|(other, _)| *other == place) {
                return refused(format!("`{}` is given twice", shortened(in_file)));
            }
            if in_file != name && !places(name).is_empty() {
                return refused(format!(
                    "the file has a column `{name}`, too; leave one of both out"
                ));
            }
            renamed.push((place, name));
        }
        Ok(self.with_names(&renamed))
    }
}
