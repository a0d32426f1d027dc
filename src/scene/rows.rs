//! Rows of radii, as the scene lists them or as a CSV file that it names has them.

use std::fmt::{self, Write};
use std::ops::Range;
use std::path::Path;

use serde::Deserialize;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Deserializer, Error as _, SeqAccess, Visitor};
use toml::Spanned;

use crate::input::{CsvError, CsvTable};

use super::error::Fault;
use super::source::NamedFiles;

/// How messages call the rows.
pub(super) const KEY: &str = "whisker.profile.rows";

/// Rows of a profile. A trajectory takes at least two steps from row to row.
const MOST: usize = 256;

/// `rows` of `[whisker.profile]`: `[arc_length_mm, radius_um]` each, or the name of a CSV file with these columns.
pub(super) enum Rows {
    Named(String),
    Read(Vec<CsvRow>),
    Listed(Vec<Spanned<Pair>>),
}

/// Arclength in millimetres and radius in micrometres.
#[derive(Clone, Copy)]
pub(super) struct Pair([f64; 2]);

impl<'de> Deserialize<'de> for Pair {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let numbers = Vec::<f64>::deserialize(deserializer)?;
        let pair = <[f64; 2]>::try_from(numbers);
        let refuse =
            |numbers: Vec<f64>| D::Error::invalid_length(numbers.len(), &"a list of 2 numbers");
        pair.map(Self).map_err(refuse)
    }
}

/// A row and its line in the file.
pub(super) struct CsvRow {
    line: usize,
    values: [f64; 2],
}

impl Rows {
    /// Name of the CSV file that these rows name.
    pub fn name(&self) -> Option<&str> {
        match self {
            Self::Named(name) => Some(name),
            _ => None,
        }
    }

    /// Arclength in millimetres and radius in micrometres of every row.
    pub fn values(&self) -> Vec<[f64; 2]> {
        match self {
            Self::Named(_) => Vec::new(),
            Self::Read(rows) => rows.iter().map(|row| row.values).collect(),
            Self::Listed(rows) => rows.iter().map(|row| row.get_ref().0).collect(),
        }
    }

    /// Row `i` does not do what it must; `whole` is where the scene has the rows.
    pub fn refuse(&self, i: usize, whole: Range<usize>, must: &str) -> Fault {
        match self {
            Self::Listed(rows) => Fault::new(format!("{KEY}[{i}]"), rows[i].span(), must),
            Self::Read(rows) => Fault::new(KEY, whole, format!("line {}: {must}", rows[i].line)),
            Self::Named(_) => Fault::new(KEY, whole, must),
        }
    }

    /// Refuses too few rows and too many.
    pub fn check_count(&self, whole: Range<usize>) -> Result<(), Fault> {
        let count = match self.values().len() {
            2..=MOST => return Ok(()),
            few @ ..2 => few.to_string(),
            _ => "more".to_owned(),
        };
        let must = format!("must be 2 to {MOST} rows, are {count}");
        Err(Fault::new(KEY, whole, must))
    }
}

/// A scene's text with the rows of a file in place of its name, and a note about what the file has beside them.
pub(super) struct Inlined {
    pub text: String,
    pub note: Option<String>,
}

/// Reads the CSV file that `rows` may name, one of `files`, into them. Returns the scene's text with the rows in place of
/// the name, so that the text names no file.
pub(super) fn read(
    rows: &mut Spanned<Rows>,
    text: &str,
    files: NamedFiles,
) -> Result<Option<Inlined>, Fault> {
    let span = rows.span();
    let Some(name) = rows.get_ref().name() else {
        return Ok(None);
    };
    let read = files.find(name);
    let read = read.and_then(|path| from_csv(&path).map_err(|why| why.to_string()));
    let (read, note) = read.map_err(|why| Fault::new(KEY, span.clone(), why))?;
    let mut list = String::from("[\n");
    for [arc_length_mm, radius_um] in read.iter().map(|row| row.values) {
        // Writing to a String cannot fail.
        let _ = writeln!(list, "    [{arc_length_mm:?}, {radius_um:?}],");
    }
    list.push(']');
    *rows.get_mut() = Rows::Read(read);
    let mut text = text.to_owned();
    text.replace_range(span, &list);
    Ok(Some(Inlined { text, note }))
}

/// The rows of a file, one more than allowed at most, and a note about what is not used.
fn from_csv(path: &Path) -> Result<(Vec<CsvRow>, Option<String>), CsvError> {
    let table = CsvTable::read(path)?;
    let note = table.require(&[&["arc_length_mm"], &["radius_um"]], &[])?;
    let column = |name| table.numbers(name, "a number", f64::is_finite);
    let arc_length_mm = column("arc_length_mm")?.unwrap_or_default();
    let radius_um = column("radius_um")?.unwrap_or_default();
    let rows = table.lines().zip(arc_length_mm.into_iter().zip(radius_um));
    let rows = rows.map(|(line, (arc_length_mm, radius_um))| CsvRow {
        line,
        values: [arc_length_mm, radius_um],
    });
    Ok((rows.take(MOST + 1).collect(), note))
}

impl<'de> Deserialize<'de> for Rows {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either;

        impl<'de> Visitor<'de> for Either {
            type Value = Rows;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the name of a CSV file or a list of [arc_length_mm, radius_um]")
            }

            fn visit_str<E>(self, name: &str) -> Result<Rows, E> {
                Ok(Rows::Named(name.to_owned()))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Rows, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(seq)).map(Rows::Listed)
            }
        }

        deserializer.deserialize_any(Either)
    }
}
