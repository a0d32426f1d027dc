//! Lists of pairs of numbers in a scene file, measured radii and traced points: a list, or the name of a CSV file.

use std::fmt;
use std::fs::File;
use std::io;
use std::marker::PhantomData;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Deserializer, Error as _, SeqAccess, Visitor};

use crate::input::{CsvError, CsvTable, open_regular};
use crate::scene::{profile, shape};

/// Kind of pairs in a scene file.
pub(super) trait PairKind {
    /// Key of the list in a scene file.
    const KEY: &'static str;
    /// Name of the pairs in messages.
    const NAME: &'static str;
    /// Columns of the CSV file.
    const COLUMNS: [&'static str; 2];
    /// Description of the value in messages.
    const EXPECTED: &'static str;
    /// Largest number of pairs that is read.
    const MOST: usize;
}

/// Rows of `[whisker.profile]`: arclength in millimetres and radius in micrometres.
pub(super) struct ProfileRows;

impl PairKind for ProfileRows {
    const KEY: &'static str = profile::KEY;
    const NAME: &'static str = "rows";
    const COLUMNS: [&'static str; 2] = ["arc_length_mm", "radius_um"];
    const EXPECTED: &'static str = "the name of a CSV file or a list of [arc_length_mm, radius_um]";
    // One more than a scene may have.
    const MOST: usize = profile::MOST + 1;
}

/// Points of `[whisker.rest]`, in millimetres.
pub(super) struct RestPoints;

impl PairKind for RestPoints {
    const KEY: &'static str = shape::POINTS_KEY;
    const NAME: &'static str = "points";
    const COLUMNS: [&'static str; 2] = ["x_mm", "y_mm"];
    const EXPECTED: &'static str = "the name of a CSV file or a list of [x_mm, y_mm]";
    const MOST: usize = usize::MAX;
}

/// Pairs of a scene file: a list of them, or the name of a CSV file with their columns.
pub(super) enum PairList<K> {
    Named(String),
    Listed(Vec<NumberPair>, PhantomData<K>),
}

/// Pair of numbers: a row of a measured profile, or a traced point.
pub(super) struct NumberPair(pub [f64; 2]);

impl<'de> Deserialize<'de> for NumberPair {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let numbers = Vec::<f64>::deserialize(deserializer)?;
        let pair = <[f64; 2]>::try_from(numbers);
        let refuse =
            |numbers: Vec<f64>| D::Error::invalid_length(numbers.len(), &"a list of 2 numbers");
        pair.map(Self).map_err(refuse)
    }
}

impl<'de, K: PairKind> Deserialize<'de> for PairList<K> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either<K>(PhantomData<K>);

        impl<'de, K: PairKind> Visitor<'de> for Either<K> {
            type Value = PairList<K>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(K::EXPECTED)
            }

            fn visit_str<E>(self, name: &str) -> Result<PairList<K>, E> {
                Ok(PairList::Named(name.to_owned()))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<PairList<K>, A::Error> {
                let pairs = Vec::deserialize(SeqAccessDeserializer::new(seq))?;
                Ok(PairList::Listed(pairs, PhantomData))
            }
        }

        deserializer.deserialize_any(Either(PhantomData))
    }
}

/// Pairs of a scene, and where they come from.
pub(super) struct GivenPairs {
    /// Pairs of numbers: `[pair][column]`, in the units of the columns.
    pub values: Vec<[f64; 2]>,
    /// CSV file of the pairs; `None` if the scene lists them.
    pub csv: Option<PairsCsv>,
}

/// CSV file of pairs.
pub(super) struct PairsCsv {
    /// Key of the list in a scene file.
    pub key: &'static str,
    pub path: PathBuf,
    /// Line numbers of the pairs in the CSV file, from 1: `[pair]`.
    pub lines: Vec<usize>,
    /// Message that names unused columns of the CSV file; `None` without such columns.
    pub note: Option<String>,
}

impl<K: PairKind> PairList<K> {
    /// Returns the listed pairs, or reads those of the regular file in `folder` that is named. Without a folder, a name is refused,
    /// because the text of a scene must not name files.
    pub fn read(self, folder: Option<&Path>) -> Result<GivenPairs, String> {
        let name = match self {
            Self::Named(name) => name,
            Self::Listed(pairs, _) => {
                let values = pairs.into_iter().map(|pair| pair.0).collect();
                return Ok(GivenPairs { values, csv: None });
            }
        };
        let Some(folder) = folder else {
            let name = K::NAME;
            return Err(format!(
                "must be a list of {name}: only a scene file may name a CSV file"
            ));
        };
        let path = folder.join(name);
        match open_regular(&path).transpose() {
            Some(file) => Self::from_csv(file, path).map_err(|why| why.to_string()),
            None => Err("must name a regular file".to_owned()),
        }
    }

    fn from_csv(file: io::Result<File>, path: PathBuf) -> Result<GivenPairs, CsvError> {
        let table = CsvTable::read_file(file, &path)?;
        let [first, second] = K::COLUMNS;
        let note = table.require(&[&[first], &[second]], &[])?;
        let column = |name| table.numbers(name, "a number", f64::is_finite);
        let pairs = column(first)?
            .unwrap_or_default()
            .into_iter()
            .zip(column(second)?.unwrap_or_default());
        Ok(GivenPairs {
            values: pairs.take(K::MOST).map(Into::into).collect(),
            csv: Some(PairsCsv {
                key: K::KEY,
                path,
                lines: table.lines().collect(),
                note,
            }),
        })
    }
}
