//! Rows of radii in a scene file: a list, or the name of a CSV file.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Deserializer, Error as _, SeqAccess, Visitor};

use crate::input::{CsvError, CsvTable};
use crate::scene::profile::MOST;

/// `rows` of `[whisker.profile]`: `[arc_length_mm, radius_um]` each, or the name of a CSV file with these columns.
pub(super) enum ListedRows {
    Named(String),
    Listed(Vec<RowPair>),
}

/// Row of a measured profile: arclength in millimetres and radius in micrometres.
pub(super) struct RowPair(pub [f64; 2]);

impl<'de> Deserialize<'de> for RowPair {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let numbers = Vec::<f64>::deserialize(deserializer)?;
        let pair = <[f64; 2]>::try_from(numbers);
        let refuse =
            |numbers: Vec<f64>| D::Error::invalid_length(numbers.len(), &"a list of 2 numbers");
        pair.map(Self).map_err(refuse)
    }
}

impl<'de> Deserialize<'de> for ListedRows {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either;

        impl<'de> Visitor<'de> for Either {
            type Value = ListedRows;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the name of a CSV file or a list of [arc_length_mm, radius_um]")
            }

            fn visit_str<E>(self, name: &str) -> Result<ListedRows, E> {
                Ok(ListedRows::Named(name.to_owned()))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<ListedRows, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(seq)).map(ListedRows::Listed)
            }
        }

        deserializer.deserialize_any(Either)
    }
}

/// Rows of radii from a CSV file.
pub(super) struct CsvRows {
    pub path: PathBuf,
    /// Arclength in millimetres and radius in micrometres: `[row][arclength, radius]`. There is at most one row more than a scene may have.
    pub values: Vec<[f64; 2]>,
    /// Line numbers of the rows in the CSV file, from 1: `[row]`.
    pub lines: Vec<usize>,
    /// Message that names unused columns of the CSV file; `None` without such columns.
    pub note: Option<String>,
}

impl CsvRows {
    /// Reads rows of radii from the regular file `name` in `folder`. Without a folder, it refuses, because the text of a scene must not
    /// name files.
    pub fn read(name: &str, folder: Option<&Path>) -> Result<Self, String> {
        let Some(folder) = folder else {
            return Err("must be a list of rows: only a scene file may name a CSV file".to_owned());
        };
        let path = folder.join(name);
        // A pipe without a writer would never open.
        if fs::metadata(&path).is_ok_and(|about| !about.is_file()) {
            return Err("must name a regular file".to_owned());
        }
        Self::from_csv(path).map_err(|why| why.to_string())
    }

    fn from_csv(path: PathBuf) -> Result<Self, CsvError> {
        let table = CsvTable::read(&path)?;
        let note = table.require(&[&["arc_length_mm"], &["radius_um"]], &[])?;
        let column = |name| table.numbers(name, "a number", f64::is_finite);
        let arc_length_mm = column("arc_length_mm")?.unwrap_or_default();
        let radius_um = column("radius_um")?.unwrap_or_default();
        let rows = arc_length_mm.into_iter().zip(radius_um);
        Ok(Self {
            path,
            values: rows.take(MOST + 1).map(|(s, radius)| [s, radius]).collect(),
            lines: table.lines().collect(),
            note,
        })
    }
}
