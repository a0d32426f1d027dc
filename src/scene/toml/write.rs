//! Writing of scenes as TOML, and editing of their text.

use std::fmt::{self, Write};
use std::sync::Arc;

use toml_edit::ser::to_document;
use toml_edit::{Array, DocumentMut, InlineTable, Item, TableLike, TomlError, Value};

use crate::scene::FrameDeviations;
use crate::scene::SweepVariable;
use crate::scene::axis::{AxisScale, AxisValues};
use crate::scene::deviations::ROWS;
use crate::scene::error::SceneError;
use crate::scene::limits::rounded;
use crate::scene::parameter::Parameter;
use crate::scene::profile::KEY as ROWS_KEY;
use crate::scene::shape::{CURVATURE_KEY, DEGREE_KEY, POINTS_KEY};
use crate::scene::smooth::SMOOTH_KEY;
use crate::scene::{Scene, SceneBuilder};
use crate::traced::TracedShape;

use super::pairs::{PairsCsv, pair_array};
use super::whiskers::row_array;
use super::{TAPER_KEY, YIELD_KEY, place_in};

/// Significant digits with which every `f64` is parsed exactly, and of a number that follows from others: the last ones would be rounding.
const EXACT_DIGITS: usize = 17;
const DERIVED_DIGITS: usize = 15;

/// TOML text of a scene: the source text of a scene that was read; otherwise it is written from the numbers when it is displayed.
///
/// Texts are equal if their characters are.
#[derive(Clone, Debug)]
pub struct SceneText(TextSource);

#[derive(Clone, Debug)]
enum TextSource {
    Text(Arc<str>),
    Numbers(Arc<SceneBuilder>),
}

impl SceneText {
    /// Creates the text of a scene that was read from `text`.
    #[must_use]
    pub fn of_source(text: &str) -> Self {
        Self(TextSource::Text(text.into()))
    }

    pub(in crate::scene) fn of_numbers(builder: Arc<SceneBuilder>) -> Self {
        Self(TextSource::Numbers(builder))
    }
}

impl PartialEq for SceneText {
    fn eq(&self, other: &Self) -> bool {
        self.to_string() == other.to_string()
    }
}

impl fmt::Display for SceneText {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            TextSource::Text(text) => f.write_str(text),
            TextSource::Numbers(builder) => write!(f, "{}", document(builder)),
        }
    }
}

impl Scene {
    /// Returns the scene as TOML: its source text if it was read, otherwise text that [`Scene::parse`] turns into the same scene.
    #[must_use]
    pub fn to_toml(&self) -> String {
        self.text.to_string()
    }

    /// Returns true if the text of the scene has the key `whisker.taper` in place of the radius at the tip.
    ///
    /// ```
    /// use whiskmap::scene::Scene;
    ///
    /// let cone = include_str!("../../../scenes/cone.toml");
    /// assert!(!Scene::parse(cone, "cone.toml")?.has_taper_key());
    /// # Ok::<(), whiskmap::scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn has_taper_key(&self) -> bool {
        place_in(&self.to_toml(), TAPER_KEY).is_some()
    }

    /// Returns the TOML text of this scene with other values of some parameters, in their units. Comments and layout stay. A taper becomes the
    /// radius at the tip, with 15 digits, unless the text has the key `whisker.taper`, which then has the taper.
    ///
    /// # Errors
    /// If a value is not allowed, as in [`Scene::with_parameters`].
    pub fn to_toml_with(&self, values: &[(Parameter, f64)]) -> Result<String, SceneError> {
        let changed = self.with_parameters(values)?;
        let mut document: DocumentMut = self
            .to_toml()
            .parse()
            .map_err(|why: TomlError| SceneError::whole(&self.name, why.message()))?;
        let is_tapered = self.has_taper_key();
        for (parameter, _) in values {
            let (parameter, digits) = match parameter {
                Parameter::Taper | Parameter::TipRadiusUm if is_tapered => continue,
                Parameter::Taper => (Parameter::TipRadiusUm, DERIVED_DIGITS),
                parameter => (*parameter, EXACT_DIGITS),
            };
            if let Some(value) = parameter.value(&changed) {
                let value = rounded(value, digits);
                put(document.as_table_mut(), parameter.key(), value);
            }
        }
        // It changes with either radius.
        if is_tapered {
            let [taper, before] =
                [&changed, self].map(|scene| rounded(scene.whisker.taper(), DERIVED_DIGITS));
            if taper != before {
                put(document.as_table_mut(), TAPER_KEY, taper);
            }
        }
        Ok(document.to_string())
    }
}

fn document(scene: &SceneBuilder) -> DocumentMut {
    let mut document = DocumentMut::new();
    let root = document.as_table_mut();
    put(root, "title", scene.title.as_str());
    for parameter in Parameter::ALL {
        if let Some(value) = scene.numbers.get(parameter) {
            put(root, parameter.key(), value);
        }
    }
    if let Some(strain) = scene.yield_strain {
        put(root, YIELD_KEY, strain);
    }
    if let Some(measured) = &scene.measured {
        put(root, ROWS_KEY, pair_array(&measured.rows));
        if measured.smooth {
            put(root, SMOOTH_KEY, true);
        }
    }
    if let Some(traced) = &scene.traced {
        put(root, POINTS_KEY, pair_array(&traced.points_mm));
        put_fit(root, traced);
    }
    put(root, "grid.push_angle_deg", &scene.push_angle_deg);
    put(root, "grid.distance_mm", &scene.distance_mm);
    for (parameter, values) in &scene.sweep {
        put(root, parameter.axis_key(), values);
    }
    if let Some(rows) = &scene.table {
        put(root, SweepVariable::TABLE, row_array(rows));
    }
    if let Some(name) = &scene.name {
        put(root, "output.name", name.as_str());
    }
    if let Some(deviations) = &scene.uncertainty {
        for (parameter, deviation) in &deviations.parameters {
            put(root, &format!("uncertainty.{}", parameter.name()), *deviation);
        }
        if let Some(deviation) = deviations.profile_radius_um {
            put(root, &format!("uncertainty.{ROWS}"), deviation);
        }
        let frames = FrameDeviations::NAMES.into_iter();
        for (name, deviation) in frames.zip(deviations.frames.values()) {
            if let Some(deviation) = deviation {
                put(root, &format!("uncertainty.{name}"), deviation);
            }
        }
    }
    // Its fields are plain numbers.
    if let Some(Ok(surface)) = scene.surface.map(|surface| to_document(&surface)) {
        root.insert("surface", surface.into_table().into());
    }
    document
}

/// Sets degree and coefficients of a traced curvature.
fn put_fit(root: &mut dyn TableLike, traced: &TracedShape) {
    put(root, DEGREE_KEY, traced.degree as i64);
    put(root, CURVATURE_KEY, Array::from_iter(traced.coefficients()));
}

impl SceneBuilder {
    /// Returns the `text` of this scene with the pairs of CSV `files` in place of their names, and with the fit to traced points.
    pub(super) fn standalone(&self, text: &str, files: &[PairsCsv]) -> String {
        let mut standalone = text.to_owned();
        for csv in files {
            let points = self.traced.as_ref().map(|traced| &traced.points_mm);
            let pairs = if csv.key == ROWS_KEY {
                self.measured.as_ref().map(|radii| &radii.rows)
            } else {
                points
            };
            if let Some((pairs, span)) = pairs.zip(place_in(&standalone, csv.key)) {
                standalone.replace_range(span, &pairs_text(pairs));
            }
        }
        let of_whiskers =
            self.table.as_ref().filter(|_| files.iter().any(|csv| csv.key == SweepVariable::TABLE));
        if self.traced.is_none() && of_whiskers.is_none() {
            return standalone;
        }
        // The text was read as TOML.
        let Ok(mut document) = standalone.parse::<DocumentMut>() else {
            return standalone;
        };
        let root = document.as_table_mut();
        if let Some(rows) = of_whiskers {
            put(root, SweepVariable::TABLE, row_array(rows));
        }
        let Some(traced) = &self.traced else {
            return document.to_string();
        };
        put_fit(root, traced);
        let length = Parameter::LengthMm;
        if let Some(length_mm) = self.numbers.get(length)
            && place_in(text, length.key()).is_none()
        {
            put(root, length.key(), length_mm);
        }
        document.to_string()
    }
}

/// Sets the value of a key with dots, and keeps what is around a value that is there.
fn put(mut table: &mut dyn TableLike, key: &str, value: impl Into<Value>) {
    let (tables, last) = key.rsplit_once('.').unwrap_or(("", key));
    for name in tables.split('.').filter(|name| !name.is_empty()) {
        let entry = table.entry(name).or_insert_with(toml_edit::table);
        match entry.as_table_like_mut() {
            Some(inner) => table = inner,
            // A checked scene has a table there.
            None => return,
        }
    }
    let mut value = value.into();
    if let Some(before) = table.get(last).and_then(Item::as_value) {
        *value.decor_mut() = before.decor().clone();
    }
    table.insert(last, value.into());
}

impl From<&AxisValues> for Value {
    fn from(values: &AxisValues) -> Self {
        match values {
            AxisValues::List(list) => Array::from_iter(list.iter().copied()).into(),
            AxisValues::Range { from, to, count, scale } => {
                let mut table = InlineTable::new();
                table.insert("from", (*from).into());
                if let Some(to) = *to {
                    table.insert("to", to.into());
                }
                table.insert("count", i64::try_from(*count).unwrap_or(i64::MAX).into());
                if *scale == AxisScale::Log {
                    table.insert("scale", "log".into());
                }
                table.into()
            }
        }
    }
}

/// Returns pairs of numbers as a list in TOML, one pair on a line.
fn pairs_text(pairs: &[[f64; 2]]) -> String {
    let mut list = String::from("[\n");
    for [first, second] in pairs {
        // Writing to a String cannot fail.
        let _ = writeln!(list, "    [{first:?}, {second:?}],");
    }
    list.push(']');
    list
}
