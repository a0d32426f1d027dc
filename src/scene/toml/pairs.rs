//! Pairs of numbers in a scene file, measured rows and traced points: a list, or the name of a CSV file.

use std::fmt;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use serde::de::value::SeqAccessDeserializer;
use serde::de::{SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use toml_edit::Array;

use crate::input::{CsvError, CsvTable, open_regular};
use crate::scene::error::SceneFault;
use crate::scene::{profile, shape};

/// Kind of pairs in a scene file.
#[derive(Clone, Copy)]
pub(in crate::scene) struct PairKind {
    /// Key of the list in a scene file.
    pub key: &'static str,
    /// Name of the pairs in messages.
    name: &'static str,
    /// Columns of the CSV file.
    columns: [&'static str; 2],
    /// Largest number of pairs that is read.
    most: usize,
}

/// Reads measured rows, which their table must have.
pub(super) fn rows<'de, D: Deserializer<'de>>(pairs: D) -> Result<Option<Pairs>, D::Error> {
    pairs.deserialize_any(PairKind::ROWS).map(Some)
}

/// Reads traced points, which their table must have.
pub(super) fn points<'de, D: Deserializer<'de>>(pairs: D) -> Result<Option<Pairs>, D::Error> {
    pairs.deserialize_any(PairKind::POINTS).map(Some)
}

/// Pairs of a scene file: the list of pairs, or the name of a CSV file with their columns.
pub(in crate::scene) struct Pairs {
    kind: PairKind,
    source: PairSource,
}

enum PairSource {
    Listed(Vec<NumberPair>),
    Named(String),
}

impl<'de> Visitor<'de> for PairKind {
    type Value = Pairs;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [first, second] = self.columns;
        write!(f, "the name of a CSV file or a list of [{first}, {second}]")
    }

    fn visit_str<E>(self, name: &str) -> Result<Pairs, E> {
        Ok(self.named(name.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Pairs, A::Error> {
        let listed = Vec::deserialize(SeqAccessDeserializer::new(list))?;
        let source = PairSource::Listed(listed);
        Ok(Pairs { kind: self, source })
    }
}

/// Pair of numbers: a measured row or a traced point.
#[derive(Deserialize)]
#[serde(try_from = "Vec<f64>")]
struct NumberPair([f64; 2]);

impl TryFrom<Vec<f64>> for NumberPair {
    type Error = String;

    fn try_from(numbers: Vec<f64>) -> Result<Self, String> {
        let refuse = |numbers: Vec<f64>| {
            let count = numbers.len();
            format!("invalid length {count}, expected a list of 2 numbers")
        };
        numbers.try_into().map(Self).map_err(refuse)
    }
}

/// CSV file that a scene file names: of pairs, or of whiskers.
pub(super) struct PairsCsv {
    /// Key of the list in a scene file that the CSV file replaces.
    pub key: &'static str,
    pub path: PathBuf,
    /// Line numbers of the pairs or whiskers in the CSV file, from 1: `[pair]`.
    pub lines: Vec<usize>,
    /// Message that names unused columns of the CSV file; `None` without such columns.
    pub note: Option<String>,
}

impl Pairs {
    /// Returns the listed pairs, `[pair][column]`, or reads the pairs of the named regular file in `folder`, which is added to `files`.
    /// Without a folder, a name is refused, because the text of a scene must not name files.
    pub(super) fn read(
        self,
        folder: Option<&Path>,
        files: &mut Vec<PairsCsv>,
    ) -> Result<Vec<[f64; 2]>, SceneFault> {
        let refused = |must: String| SceneFault::new(self.kind.key, must);
        let name = match self.source {
            PairSource::Named(name) => name,
            PairSource::Listed(pairs) => return Ok(pairs.into_iter().map(|pair| pair.0).collect()),
        };
        let (file, path) = named_file(self.kind.key, self.kind.name, &name, folder)?;
        let (pairs, csv) =
            self.kind.read_csv(file, path).map_err(|why| refused(why.to_string()))?;
        files.push(csv);
        Ok(pairs)
    }
}

/// Opens the regular file `name` in `folder`, which `key` names in place of a list of `what`. Returns it with its path. Without a folder,
/// a name is refused, because the text of a scene must not name files.
pub(super) fn named_file(
    key: &str,
    what: &str,
    name: &str,
    folder: Option<&Path>,
) -> Result<(io::Result<File>, PathBuf), SceneFault> {
    let Some(folder) = folder else {
        let must = format!("must be a list of {what}: only a scene file may name a CSV file");
        return Err(SceneFault::new(key, must));
    };
    let path = folder.join(name);
    match open_regular(&path).transpose() {
        Some(file) => Ok((file, path)),
        None => Err(SceneFault::new(key, "must name a regular file")),
    }
}

/// Returns pairs of numbers as a list in TOML.
pub(super) fn pair_array(pairs: &[[f64; 2]]) -> Array {
    pairs.iter().map(|pair| Array::from_iter(*pair)).collect()
}

impl PairKind {
    /// Rows of `[whisker.profile]`: arclength in millimetres and radius in micrometres.
    pub(super) const ROWS: Self = Self {
        key: profile::KEY,
        name: "rows",
        columns: ["arc_length_mm", "radius_um"],
        // One more than a scene may have.
        most: profile::MOST + 1,
    };

    /// Points of `[whisker.rest]`, in millimetres.
    pub(super) const POINTS: Self = Self {
        key: shape::POINTS_KEY,
        name: "points",
        columns: ["x_mm", "y_mm"],
        most: usize::MAX,
    };

    /// Returns the pairs of the CSV file `name`.
    pub(super) fn named(self, name: String) -> Pairs {
        let source = PairSource::Named(name);
        Pairs { kind: self, source }
    }

    /// Reads the pairs of a CSV file: `[pair][column]`, in the units of the columns.
    fn read_csv(
        self,
        file: io::Result<File>,
        path: PathBuf,
    ) -> Result<(Vec<[f64; 2]>, PairsCsv), CsvError> {
        let table = CsvTable::read_file(file, &path)?;
        let [first, second] = self.columns;
        let note = table.require(&[&[first], &[second]], &[])?;
        let column = |name| table.numbers(name, "a number", f64::is_finite);
        let pairs =
            column(first)?.unwrap_or_default().into_iter().zip(column(second)?.unwrap_or_default());
        let csv = PairsCsv { key: self.key, path, lines: table.lines().collect(), note };
        Ok((pairs.take(self.most).map(Into::into).collect(), csv))
    }
}
