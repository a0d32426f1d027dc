//! Tables of whiskers in a scene file: a list of rows, or the name of a CSV file.

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

use serde::de::value::SeqAccessDeserializer;
use serde::de::{SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use toml_edit::{Array, InlineTable, Value};

use super::pairs::{PairKind, Pairs, PairsCsv, named_file, pair_array, points, rows};
use crate::input::{CsvError, CsvTable, did_you_mean, misnamed, shortened};
use crate::scene::error::SceneFault;
use crate::scene::grid::SweepVariable;
use crate::scene::limits::digits;
use crate::scene::parameter::Parameter;
use crate::scene::substitutes::Substitute;
use crate::scene::table::WhiskerRow;

/// Key of the table of whiskers in a scene file.
const KEY: &str = SweepVariable::TABLE;

/// Column with the names of the whiskers.
const NAME: &str = "name";

/// Column with yield strains, which are no parameters: they change no state.
pub(in crate::scene) const YIELD_STRAIN: &str = "yield_strain";

/// Column with measured radii: in a CSV file, the name of a CSV file.
const PROFILE: &str = Substitute::Profile.column();

/// Column with traced points: in a CSV file, the name of a CSV file.
const REST_POINTS: &str = Substitute::Rest.column();

/// Table of whiskers as a scene file has it.
pub(in crate::scene) enum WhiskerRows {
    Listed(Vec<RowTable>),
    Named(String),
}

/// Row of a list of whiskers.
#[derive(Deserialize)]
pub(in crate::scene) struct RowTable {
    name: String,
    #[serde(default, deserialize_with = "rows")]
    profile: Option<Pairs>,
    #[serde(default, deserialize_with = "points")]
    rest_points: Option<Pairs>,
    #[serde(flatten)]
    numbers: BTreeMap<String, f64>,
}

/// Reads a table of whiskers, which its table must have.
pub(super) fn whisker_rows<'de, D: Deserializer<'de>>(
    value: D,
) -> Result<Option<WhiskerRows>, D::Error> {
    value.deserialize_any(RowsVisitor).map(Some)
}

struct RowsVisitor;

impl<'de> Visitor<'de> for RowsVisitor {
    type Value = WhiskerRows;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the name of a CSV file or a list of { name, length_mm, ... }")
    }

    fn visit_str<E>(self, name: &str) -> Result<WhiskerRows, E> {
        Ok(WhiskerRows::Named(name.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<WhiskerRows, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(list)).map(WhiskerRows::Listed)
    }
}

impl WhiskerRows {
    /// Returns the listed rows, or reads the rows of the named regular file in `folder`. All files are added to `files`. Without a folder,
    /// names of files are refused.
    pub(super) fn read(
        self,
        folder: Option<&Path>,
        files: &mut Vec<PairsCsv>,
    ) -> Result<Vec<WhiskerRow>, SceneFault> {
        match self {
            Self::Listed(list) => {
                let list = list.into_iter().enumerate();
                list.map(|(index, row)| row.read(index, folder, files)).collect()
            }
            Self::Named(name) => {
                let (file, path) = named_file(KEY, "rows", &name, folder)?;
                let table = CsvTable::read_file(file, &path).map_err(refused)?;
                read_csv(&table, path, files)
            }
        }
    }
}

impl RowTable {
    fn read(
        self,
        index: usize,
        folder: Option<&Path>,
        files: &mut Vec<PairsCsv>,
    ) -> Result<WhiskerRow, SceneFault> {
        let of_row = |fault: SceneFault| {
            let must = format!("{}: {}", fault.key, fault.must);
            SceneFault::new(format!("{KEY}[{index}]"), must)
        };
        let mut row = WhiskerRow::new(self.name);
        for (name, value) in self.numbers {
            if name == YIELD_STRAIN {
                row = row.yield_strain(value);
                continue;
            }
            let Some(parameter) = Parameter::of_column(&name) else {
                let hint = did_you_mean(&name, WhiskerRow::columns());
                let known = WhiskerRow::columns().collect::<Vec<_>>().join(", ");
                let must = format!("is not known; must be one of {known}{hint}");
                return Err(of_row(SceneFault::of_value(shortened(&name), digits(value), must)));
            };
            row = row.set(parameter, value);
        }
        if let Some(pairs) = self.profile {
            row = row.profile(read_pairs(pairs, folder, files).map_err(of_row)?);
        }
        if let Some(pairs) = self.rest_points {
            row = row.rest_points(read_pairs(pairs, folder, files).map_err(of_row)?);
        }
        Ok(row)
    }
}

/// Reads the pairs of a row. Their file counts as one of the table.
fn read_pairs(
    pairs: Pairs,
    folder: Option<&Path>,
    files: &mut Vec<PairsCsv>,
) -> Result<Vec<[f64; 2]>, SceneFault> {
    let mut named = Vec::new();
    let pairs = pairs.read(folder, &mut named)?;
    files.extend(named.into_iter().map(|csv| PairsCsv { key: KEY, lines: Vec::new(), ..csv }));
    Ok(pairs)
}

fn refused(why: CsvError) -> SceneFault {
    SceneFault::new(KEY, why.to_string())
}

impl WhiskerRow {
    /// Returns the names of all columns of a table of whiskers. A parameter has its own name, and the name of its sweep axis.
    pub fn columns() -> impl Iterator<Item = &'static str> + Clone {
        let others = [NAME, YIELD_STRAIN, PROFILE, REST_POINTS].into_iter();
        let parameters = Parameter::ALL.into_iter().flat_map(column_names);
        others.chain(parameters)
    }

    /// Returns what is wrong with a table of whiskers with columns of these names: one of them is no name of a column, but most likely meant as
    /// a column that the table lacks. `None` without such a name.
    ///
    /// ```
    /// use whiskmap::scene::WhiskerRow;
    ///
    /// let misnamed = WhiskerRow::misnamed(&["name", "tip_radius"]);
    /// assert_eq!(misnamed.as_deref(), Some("has the column tip_radius; did you mean `tip_radius_um`?"));
    /// let misnamed = WhiskerRow::misnamed(&["name", "Yield_strain"]);
    /// assert_eq!(misnamed.as_deref(), Some("has the column Yield_strain; did you mean `yield_strain`?"));
    /// assert_eq!(WhiskerRow::misnamed(&["name", "taper", "tip_radius", "notes"]), None);
    /// ```
    #[must_use]
    pub fn misnamed(names: &[&str]) -> Option<String> {
        let is_unknown = |name: &&str| Self::columns().all(|known| known != *name);
        let unknown = names.iter().copied().filter(is_unknown);
        let expected = Self::expected(names).into_iter();
        misnamed(unknown, expected.filter(|name| !names.contains(name)))
    }

    /// Returns the names of the columns that a table with columns of these `names` has or lacks. It does not lack a number that others of its columns
    /// give.
    fn expected(names: &[&str]) -> Vec<&'static str> {
        let has = |name: &str| names.contains(&name);
        let is_given = |parameter: &Parameter| {
            let substitutes = parameter.substitutes().iter();
            let mut others = substitutes.map(|part| part.column());
            column_names(*parameter).any(has) || others.any(has)
        };
        let given = Parameter::ALL.into_iter().filter(is_given);
        let replaced: Vec<&str> = given.flat_map(column_names).collect();
        let is_expected = |name: &&str| has(name) || !replaced.contains(name);
        Self::columns().filter(is_expected).collect()
    }
}

/// Returns the names of a column of the parameter: its own, and the name of its sweep axis if that is another one.
fn column_names(parameter: Parameter) -> impl Iterator<Item = &'static str> + Clone {
    let axis = Some(parameter.axis()).filter(|axis| *axis != parameter.name());
    [parameter.name()].into_iter().chain(axis)
}

/// Sets the pairs of a row.
type SetPairs = fn(WhiskerRow, Vec<[f64; 2]>) -> WhiskerRow;

/// Reads the rows of a CSV file. The files that it names are beside it.
fn read_csv(
    table: &CsvTable,
    path: PathBuf,
    files: &mut Vec<PairsCsv>,
) -> Result<Vec<WhiskerRow>, SceneFault> {
    let names: Vec<&str> = table.names().collect();
    let expected = WhiskerRow::expected(&names).into_iter();
    let optional: Vec<&str> = expected.filter(|name| *name != NAME).collect();
    let note = table.require(&[&[NAME]], &optional).map_err(refused)?;
    let text = |column: &str| {
        let cells = table.values(column, "", |cell| Some(cell.to_owned()));
        cells.map(Option::unwrap_or_default).map_err(refused)
    };
    let mut list: Vec<WhiskerRow> = text(NAME)?.into_iter().map(WhiskerRow::new).collect();
    let numbers = |column: &str| {
        let numbers = table.measurements(column, "a number", f64::is_finite);
        numbers.map_err(refused).map(Option::unwrap_or_default)
    };
    for parameter in Parameter::ALL {
        for column in column_names(parameter) {
            for (row, number) in list.iter_mut().zip(numbers(column)?) {
                *row = std::mem::take(row).set(parameter, number);
            }
        }
    }
    for (row, strain) in list.iter_mut().zip(numbers(YIELD_STRAIN)?) {
        *row = std::mem::take(row).yield_strain(strain);
    }
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    files.push(PairsCsv { key: KEY, path, lines: table.lines().collect(), note });
    let kinds: [(_, _, SetPairs); 2] = [
        (PROFILE, PairKind::ROWS, WhiskerRow::profile),
        (REST_POINTS, PairKind::POINTS, WhiskerRow::rest_points),
    ];
    for (column, kind, set) in kinds {
        for (index, (row, name)) in list.iter_mut().zip(text(column)?).enumerate() {
            if name.is_empty() {
                continue;
            }
            let pairs = read_pairs(kind.named(name), Some(&folder), files).map_err(|fault| {
                SceneFault::new(format!("{KEY}[{index}]"), format!("{column}: {}", fault.must))
            })?;
            *row = set(std::mem::take(row), pairs);
        }
    }
    Ok(list)
}

/// Returns the rows as a list in TOML, a row on a line.
pub(super) fn row_array(rows: &[WhiskerRow]) -> Array {
    let list = rows.iter().map(|row| {
        let mut table = InlineTable::new();
        table.insert(NAME, row.name.as_str().into());
        for (parameter, value) in &row.numbers {
            table.insert(parameter.name(), (*value).into());
        }
        if let Some(strain) = row.yield_strain {
            table.insert(YIELD_STRAIN, strain.into());
        }
        if let Some(rows) = &row.profile {
            table.insert(PROFILE, pair_array(rows).into());
        }
        if let Some(rest) = &row.rest {
            table.insert(REST_POINTS, pair_array(&rest.points_mm).into());
        }
        Value::from(table).decorated("\n    ", "")
    });
    let mut array = Array::new();
    list.for_each(|row| array.push_formatted(row));
    array.set_trailing_comma(true);
    array.set_trailing("\n");
    array
}
