//! Reader of all CSV files: a header, and columns by their names.

use super::lines::{CsvLine, lines, normalised, separator};
use super::names::{did_you_mean, misnamed, shortened};
use super::source::{TABLE_MIB, bounded, decoded, open, read};
use crate::terminal::escaped;
use std::fs::File;
use std::io;
use std::path::Path;

/// Name of standard input in messages.
pub(crate) const STDIN: &str = "<stdin>";

/// Error in a CSV file: one line with the file, the line, the value and what is allowed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {what}")]
pub struct CsvError {
    place: String,
    what: String,
    lacks_columns: bool,
}

impl CsvError {
    /// Creates an error about the whole CSV file `origin`.
    pub(crate) fn whole(origin: &str, what: impl Into<String>) -> Self {
        Self { place: escaped(origin), what: what.into(), lacks_columns: false }
    }

    /// Creates an error about a line of the CSV file `origin`.
    pub(crate) fn at(origin: &str, line: usize, what: impl Into<String>) -> Self {
        Self::whole(&format!("{origin}:{line}"), what)
    }

    /// Returns the error of a CSV file that lacks columns.
    pub(crate) fn of_columns(self) -> Self {
        Self { lacks_columns: true, ..self }
    }

    /// Returns true if the CSV file lacks a column that it must have, or has it under another name ([`CsvTable::renamed`]).
    #[must_use]
    pub const fn lacks_columns(&self) -> bool {
        self.lacks_columns
    }
}

/// Cells of measurements that stand for a missing value, in either case.
const MISSING: [&str; 8] = ["", "NaN", "-NaN", "NA", "N/A", "#N/A", "null", "none"];

/// CSV file as text: a header, and at least one row below it.
///
/// Columns are separated by `;`, tabs or `,`: the one that a first line such as `sep=;` declares, or that the header has most
/// of. Blank lines, rows of empty cells and lines that begin with `#` are left out. Where the separator is no comma, a column may have decimal commas.
///
/// ```
/// use whiskmap::input::CsvTable;
///
/// let table = CsvTable::parse("radius_um;day\n1,5;Monday\n", "radii.csv")?;
/// let note = table.require(&[&["radius_um"]], &[])?;
/// assert_eq!(note.as_deref(), Some("radii.csv:1: columns that are not used: day"));
/// let radii = table.numbers("radius_um", "a positive number", |radius| radius > 0.0)?;
/// assert_eq!(radii, Some(vec![1.5]));
/// # Ok::<(), whiskmap::input::CsvError>(())
/// ```
#[derive(Clone, Debug)]
pub struct CsvTable {
    /// Name of the CSV file in messages.
    pub origin: String,
    separator: char,
    header: CsvLine,
    rows: Vec<CsvLine>,
}

impl CsvTable {
    /// Reads a CSV file in UTF-8, or in UTF-16 with a byte order mark.
    ///
    /// # Errors
    /// If the file cannot be read, is longer than 32 MiB, is no such text, or for the reasons of [`CsvTable::parse`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, CsvError> {
        let path = path.as_ref();
        Self::read_file(open(path), path)
    }

    /// Reads the CSV file that is open as `file`; messages call it `path`.
    pub(crate) fn read_file(file: io::Result<File>, path: &Path) -> Result<Self, CsvError> {
        let bytes = file.and_then(|file| bounded(file, TABLE_MIB));
        Self::decode(bytes, &path.to_string_lossy())
    }

    /// Reads a CSV file from standard input.
    ///
    /// # Errors
    /// Fails as [`CsvTable::read`] does.
    pub fn read_stdin() -> Result<Self, CsvError> {
        Self::decode(bounded(io::stdin().lock(), TABLE_MIB), STDIN)
    }

    fn decode(bytes: io::Result<Vec<u8>>, origin: &str) -> Result<Self, CsvError> {
        let bytes = bytes.map_err(unreadable(origin))?;
        Self::parse(&text_of(&bytes, origin)?, origin)
    }

    /// Splits the text of a CSV file into cells. Messages call the file `origin`.
    ///
    /// # Errors
    /// If there is no row, a quote is not closed, or a row has fewer cells than the header has names, or more that are not empty.
    pub fn parse(text: &str, origin: &str) -> Result<Self, CsvError> {
        let mut split = CsvLines::split(text, origin)?;
        if split.lines.len() < 2 {
            let what = "has no rows: must have a header and at least one row below it";
            return Err(CsvError::whole(origin, what));
        }
        let header = split.lines.remove(0);
        split.table(header, origin)
    }

    /// Checks the header of a CSV file: it must have one name of each group of `needed`, once, each `optional` name at most once, and no name that is
    /// most likely meant as an `optional` one that it lacks. Returns a note about other columns, if there are any.
    ///
    /// # Errors
    /// What the header has, and what it needs.
    pub fn require(
        &self,
        needed: &[&[&str]],
        optional: &[&str],
    ) -> Result<Option<String>, CsvError> {
        let found = || self.header.cells.iter().filter(|name| !name.is_empty());
        let count = |names: &[&str]| found().filter(|name| names.contains(name)).count();
        let known = || needed.iter().copied().flatten().chain(optional).copied();
        let is_unknown = |name: &&str| known().all(|other| other != *name);
        let is_absent = |name: &&str| found().all(|other| other != *name);
        let is_right = needed.iter().all(|group| count(group) == 1)
            && optional.iter().all(|name| count(&[name]) <= 1);
        let unused: Vec<&str> = found().filter(is_unknown).collect();
        let mut hints = unused.iter().take(MOST_HINTS).filter_map(|name| {
            let hint = did_you_mean(name, known().filter(is_absent));
            (!hint.is_empty()).then(|| format!("; `{}` is not known{hint}", shortened(name)))
        });
        let hint = hints.next().unwrap_or_default();
        let line = self.header.number;
        if let Some(twice) = known().find(|name| count(&[name]) > 1) {
            let what =
                format!("has the column {twice} {} times: must have it once", count(&[twice]));
            return Err(CsvError::at(&self.origin, line, what));
        }
        if !is_right {
            let groups: Vec<String> = needed.iter().map(|group| group.join(" or ")).collect();
            let found: Vec<&str> = found().collect();
            let what = format!(
                "found {}; needed {}, each once{hint}",
                shortened(&found.join(", ")),
                groups.join(", ")
            );
            return Err(CsvError::at(&self.origin, line, what).of_columns());
        }
        let lacking = optional.iter().copied().filter(is_absent);
        if let Some(what) = misnamed(unused.iter().copied().take(MOST_HINTS), lacking) {
            return Err(CsvError::at(&self.origin, line, what));
        }
        let unused = (!unused.is_empty()).then(|| shortened(&unused.join(", ")));
        let note =
            |unused| format!("{}:{line}: columns that are not used: {unused}{hint}", self.origin);
        Ok(unused.map(note))
    }

    /// Returns the line number of the header, from 1.
    pub(crate) const fn header_line(&self) -> usize {
        self.header.number
    }

    /// Yields the names of the columns, `[column]`.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> + Clone {
        self.header.cells.iter()
    }

    /// Returns the table with other names of the columns at these places.
    pub(super) fn with_names(mut self, renamed: &[(usize, &str)]) -> Self {
        let new = |place: usize| renamed.iter().find(|(column, _)| *column == place);
        let names = self.names().enumerate();
        let names = names.map(|(place, old)| new(place).map_or(old, |(_, name)| *name));
        self.header.cells = names.collect::<Vec<_>>().into();
        self
    }

    /// Reads a CSV file as [`CsvTable::read`] does; `-` is standard input.
    ///
    /// # Errors
    /// Fails as [`CsvTable::read`] does.
    pub fn input(path: impl AsRef<Path>) -> Result<Self, CsvError> {
        match path.as_ref() {
            stdin if stdin == Path::new("-") => Self::read_stdin(),
            path => Self::read(path),
        }
    }

    /// Returns true if the CSV file has a column of this name.
    #[must_use]
    pub fn has(&self, column: &str) -> bool {
        self.header.cells.iter().any(|name| name == column)
    }

    /// Returns the line number of each row of the CSV file, from 1.
    pub fn lines(&self) -> impl Iterator<Item = usize> + '_ {
        self.rows.iter().map(|row| row.number)
    }

    /// Returns the values of a column of the CSV file, row by row; `None` without such a column.
    ///
    /// # Errors
    /// The first cell for which `value` returns `None`, and what it `must` be.
    pub fn values<T>(
        &self,
        column: &str,
        must: &str,
        value: impl Fn(&str) -> Option<T>,
    ) -> Result<Option<Vec<T>>, CsvError> {
        let Some(place) = self.header.cells.iter().position(|name| name == column) else {
            return Ok(None);
        };
        let values = self.rows.iter().map(|row| {
            let cell = row.cells.get(place).unwrap_or_default();
            value(cell).ok_or_else(|| {
                let what = match cell {
                    "" => format!("{column} is empty: must be {must}"),
                    cell => format!("{column} = {}: must be {must}", shortened(cell)),
                };
                CsvError::at(&self.origin, row.number, what)
            })
        });
        values.collect::<Result<_, _>>().map(Some)
    }

    /// Returns the numbers of a column of the CSV file, row by row; `None` without such a column. A column with a decimal comma has no
    /// decimal points.
    ///
    /// # Errors
    /// The first cell that is no number, or not one that `is_allowed`, and what it `must` be.
    pub fn numbers(
        &self,
        column: &str,
        must: &str,
        is_allowed: impl Fn(f64) -> bool,
    ) -> Result<Option<Vec<f64>>, CsvError> {
        self.parsed(column, must, |cell| cell.parse().ok().filter(|number| is_allowed(*number)))
    }

    /// Returns the numbers of a column of measurements, row by row, as [`CsvTable::numbers`] does. A missing value, an empty cell, `NaN`,
    /// `NA`, `N/A`, `#N/A`, `null` or `none` in either case, is NaN.
    ///
    /// # Errors
    /// Fails as [`CsvTable::numbers`] does, but for missing values.
    pub fn measurements(
        &self,
        column: &str,
        must: &str,
        is_allowed: impl Fn(f64) -> bool,
    ) -> Result<Option<Vec<f64>>, CsvError> {
        let must = format!("{must}, or empty where it is missing");
        self.parsed(column, &must, |cell| match cell {
            cell if is_missing(cell) => Some(f64::NAN),
            cell => cell.parse().ok().filter(|number| is_allowed(*number)),
        })
    }

    /// Returns the values of a column of numbers, row by row; `value` parses a cell with a decimal point.
    fn parsed<T>(
        &self,
        column: &str,
        must: &str,
        value: impl Fn(&str) -> Option<T>,
    ) -> Result<Option<Vec<T>>, CsvError> {
        let with_point = |cell: &str| match cell.contains('.') {
            true => None,
            false => Some(cell.replacen(',', ".", 1)),
        };
        let has_commas = || {
            let cells = self.values(column, "", |cell| Some(cell.contains(',')));
            cells.is_ok_and(|cells| cells.is_some_and(|cells| cells.contains(&true)))
        };
        if self.separator != ',' && has_commas() {
            let must = format!("{must}; this column has decimal commas");
            return self.values(column, &must, |cell| value(&with_point(cell)?));
        }
        let is_quoted = self.separator == ',' && has_commas();
        let must = format!("{must}{}", if is_quoted { DECIMAL_COMMAS } else { "" });
        self.values(column, &must, value)
    }

    /// Returns the column `time_s` of the CSV file: times in s that grow, row by row. Without such a column there are no times.
    ///
    /// # Errors
    /// The first cell that is no number or out of its range, or the first line whose time does not grow.
    pub(crate) fn times_s(&self) -> Result<Vec<f64>, CsvError> {
        let must = format!("a number between -{MOST_SECONDS:e} and {MOST_SECONDS:e}");
        let times =
            self.numbers("time_s", &must, |time| time.abs() <= MOST_SECONDS)?.unwrap_or_default();
        let mut pairs = times.windows(2).zip(self.lines().skip(1));
        match pairs.find(|(pair, _)| pair[1] <= pair[0]) {
            None => Ok(times),
            Some((pair, line)) => {
                let [before, time] = [pair[0], pair[1]];
                let what =
                    format!("time_s = {time}: must be more than {before} of the line before");
                Err(CsvError::at(&self.origin, line, what))
            }
        }
    }
}

/// Lines of a CSV file whose header is not its first line.
#[derive(Debug)]
pub(crate) struct CsvLines {
    separator: char,
    pub lines: Vec<CsvLine>,
}

impl CsvLines {
    /// Splits the text of a CSV file into the lines of its cells. Messages call the file `origin`.
    ///
    /// # Errors
    /// If a quote is not closed.
    pub fn split(text: &str, origin: &str) -> Result<Self, CsvError> {
        let text = normalised(text);
        let separator = separator(&text);
        let lines =
            lines(&text, separator).map_err(|(line, what)| CsvError::at(origin, line, what))?;
        Ok(Self { separator, lines })
    }

    /// Returns the table of the lines below this `header`.
    ///
    /// # Errors
    /// If a row has fewer cells than the header has names, or more that are not empty.
    pub fn table(self, header: CsvLine, origin: &str) -> Result<CsvTable, CsvError> {
        let columns = header.cells.len();
        let named = filled(&header);
        let is_wrong = |row: &&CsvLine| row.cells.len() < named || filled(row) > columns;
        if let Some(row) = self.lines.iter().find(is_wrong) {
            let has = row.cells.len();
            let ending = if has == 1 { "" } else { "s" };
            let mut pairs = row.cells.iter().zip(row.cells.iter().skip(1));
            let mut has_comma = || {
                pairs.any(|(whole, rest)| {
                    let is_digit = |c: char| c.is_ascii_digit();
                    whole.ends_with(is_digit) && !rest.is_empty() && rest.chars().all(is_digit)
                })
            };
            let hint = match has > columns && self.separator == ',' && has_comma() {
                true => DECIMAL_COMMAS,
                false => "",
            };
            let what = format!("has {has} cell{ending}: must have {columns}, one a column{hint}");
            return Err(CsvError::at(origin, row.number, what));
        }
        Ok(CsvTable {
            origin: origin.to_owned(),
            separator: self.separator,
            header,
            rows: self.lines,
        })
    }
}

/// Returns a converter of errors from reading the file `origin`.
fn unreadable(origin: &str) -> impl FnOnce(io::Error) -> CsvError {
    move |why| CsvError::whole(origin, format!("cannot be read: {why}"))
}

/// Reads a file of at most `most_mib` MiB; `-` is standard input.
///
/// # Errors
/// If it cannot be read, or is longer.
pub(crate) fn read_bytes(path: &Path, most_mib: u64) -> Result<Vec<u8>, CsvError> {
    read(path, most_mib).map_err(unreadable(&path.to_string_lossy()))
}

/// Returns the text of the file `origin` with these `bytes`, in UTF-8, or in UTF-16 with a byte order mark.
///
/// # Errors
/// If it is no such text.
pub(crate) fn text_of(bytes: &[u8], origin: &str) -> Result<String, CsvError> {
    decoded(bytes).map_err(|(line, what)| CsvError::at(origin, line, what))
}

/// Largest size of a time, in s: 30,000 years, so that a clock may begin at any date.
pub(crate) const MOST_SECONDS: f64 = 1e12;

/// Largest number of unknown names for which a known one is looked for.
const MOST_HINTS: usize = 100;

/// The end of a message about numbers with commas where commas separate columns.
const DECIMAL_COMMAS: &str = "; where numbers have decimal commas, separate columns by `;`";

/// Returns true if a cell of measurements stands for a missing value.
pub(crate) fn is_missing(cell: &str) -> bool {
    let mut markers = MISSING.iter();
    markers.any(|marker| cell.eq_ignore_ascii_case(marker))
}

/// Number of cells of a line, without empty cells at its end.
fn filled(line: &CsvLine) -> usize {
    let empty = line.cells.iter().rev().take_while(|cell| cell.is_empty());
    line.cells.len() - empty.count()
}
