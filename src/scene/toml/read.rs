//! Reading of scene files and texts into checked scenes.

use std::collections::BTreeMap;
use std::io::{self, Read};
use std::iter;
use std::path::Path;
use std::sync::Arc;

use serde::Deserialize;
use toml_edit::Document;
use toml_edit::de::Deserializer;

use crate::input::{TEXT_MIB, bounded, did_you_mean, open, shortened};
use crate::scene::axis::{AxisValues, NOT_GROWING};
use crate::scene::builder::{Deviations, FrameDeviations, Numbers};
use crate::scene::deviations;
use crate::scene::error::{DECIMAL_POINTS, SceneError, SceneFault, has_tight_comma};
use crate::scene::limits::digits;
use crate::scene::parameter::Parameter;
use crate::scene::shape::{CURVATURE_KEY, DEGREE_KEY};
use crate::scene::{Scene, SceneBuilder};
use crate::traced::{MOST_DEGREE, TracedShape};

use super::pairs::PairsCsv;
use super::{SceneFile, SceneText, TAPER_KEY, place_in, places_of};

impl Scene {
    /// Reads and checks a scene file; `-` is standard input. Where the file does not name its output, the
    /// file's own stem does, or `scene` for standard input. A CSV file that the scene names is looked for beside the scene
    /// file, and its rows take the place of its name in [`SceneData::text`](super::super::SceneData::text).
    ///
    /// # Errors
    /// If the file cannot be read, is longer than 1 MiB, is not UTF-8, or for the reasons of [`Scene::parse`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        let path = path.as_ref();
        if path == Path::new("-") {
            return from_source(io::stdin().lock(), "<stdin>", Path::new("scene"));
        }
        let origin = path.to_string_lossy();
        let file = open(path).map_err(|why| unreadable(&origin, &why))?;
        from_source(file, &origin, path)
    }

    /// Returns the checked scene that the TOML `text` describes; opens no file. Messages call the text `origin`, whose stem is the name of
    /// the output where the scene gives none.
    ///
    /// # Errors
    /// If the text is not TOML, names a CSV file, or has a key too many or too few. If a value is out of its range or contradicts another
    /// one.
    pub fn parse(text: &str, origin: &str) -> Result<Self, SceneError> {
        checked(text, origin, Path::new(origin), None)
    }
}

fn from_source(source: impl Read, origin: &str, path: &Path) -> Result<Scene, SceneError> {
    let bytes = bounded(source, TEXT_MIB).map_err(|why| unreadable(origin, &why))?;
    let text = String::from_utf8(bytes).map_err(|why| {
        let start = why.utf8_error().valid_up_to();
        let byte = why.as_bytes()[start];
        // The first bad byte and its stand-in begin at the same place.
        let shown = String::from_utf8_lossy(why.as_bytes());
        let span = start..start + char::REPLACEMENT_CHARACTER.len_utf8();
        let message = format!("not UTF-8 text: byte 0x{byte:02X}");
        SceneError::at(origin, &shown, Some(span), message)
    })?;
    let folder = path.parent().unwrap_or(Path::new(""));
    checked(&text, origin, path, Some(folder))
}

fn unreadable(origin: &str, why: &io::Error) -> SceneError {
    SceneError::whole(origin, format!("cannot be read: {why}"))
}

/// Checks the text of a scene, which may name CSV files in `folder`.
fn checked(
    text: &str,
    origin: &str,
    path: &Path,
    folder: Option<&Path>,
) -> Result<Scene, SceneError> {
    let refused = |why: toml_edit::de::Error| SceneError::of_toml(origin, text, &why, places_of);
    let document = Document::parse(text).map_err(|why| refused(why.into()))?;
    let file = SceneFile::deserialize(Deserializer::from(document)).map_err(refused)?;
    let mut files = Vec::new();
    let built = build(file, text, folder, &mut files);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    built
        .and_then(|mut builder| {
            builder.stem = stem.into_owned();
            let standalone = builder.standalone(text, &files);
            Ok(Scene {
                data: builder.checked(SceneText::of_source(&standalone))?,
                builder: Arc::new(builder),
                notes: files.iter().filter_map(|csv| csv.note.clone()).collect(),
                csv_files: files.iter().map(|csv| csv.path.clone()).collect(),
            })
        })
        .map_err(|fault| located(fault, &files, origin, text))
}

/// The description that a scene file gives. The CSV files that it names are added to `files`.
fn build(
    mut file: SceneFile,
    text: &str,
    folder: Option<&Path>,
    files: &mut Vec<PairsCsv>,
) -> Result<SceneBuilder, SceneFault> {
    let mut numbers = Numbers::default();
    // A taper determines the radius at the tip, whose key is its own.
    let parameters = Parameter::ALL.into_iter();
    for parameter in parameters.filter(|parameter| *parameter != Parameter::Taper) {
        if let Some(number) = parameter.number_in(&file) {
            numbers.set(parameter, number);
        }
    }
    let swept = Parameter::SWEPT.into_iter();
    let axes = swept.filter_map(|parameter| Some((parameter, parameter.axis_in(&mut file)?)));
    let mut sweep: Vec<(Parameter, AxisValues)> = axes.collect();
    // The derived tables have no order; the scene has the order of the text.
    sweep.sort_by_cached_key(|(parameter, _)| Some(place_in(text, parameter.axis_key())?.start));
    let mut builder = SceneBuilder {
        title: file.title,
        numbers,
        push_angle_deg: file.grid.push_angle_deg,
        distance_mm: file.grid.distance_mm,
        sweep,
        surface: file.surface,
        yield_strain: file.whisker.yield_strain,
        name: file.output.name,
        ..SceneBuilder::default()
    };
    let mut bends =
        [Parameter::ParabolaPerMm, Parameter::VertexMm, Parameter::SpiralPerMm].into_iter();
    let is_bent = bends.any(|bend| numbers.get(bend).is_some() || builder.sweeps(bend));
    if !is_bent && place_in(text, "whisker.curvature").is_some() {
        let must = "must have either parabola_per_mm, and vertex_mm if need be, or euler_spiral";
        return Err(SceneFault::new("whisker.curvature", must));
    }
    if let Some(rows) = file.whisker.profile.rows {
        let rows = rows.read(folder, files)?;
        builder = builder.profile(rows).smooth_profile(file.whisker.profile.smooth);
    }
    let rest = file.whisker.rest;
    if let Some(points) = rest.points {
        let points = points.read(folder, files)?;
        let degree = rest.degree.map(degree).transpose()?;
        let traced = TracedShape::fit(points, degree).map_err(SceneFault::of_traced)?;
        let traced = match rest.curvature {
            None => traced,
            Some(coefficients) => traced
                .with_coefficients(&coefficients)
                .map_err(|why| SceneFault::new(CURVATURE_KEY, why.must))?,
        };
        builder = builder.traced(traced);
    }
    if let Some(rows) = file.whiskers.table {
        builder.table = Some(rows.read(folder, files)?.into());
    }
    if let Some(taper) = file.whisker.taper {
        let tip_radius_um = tip_of_taper(taper, &builder)?;
        builder.numbers.set(Parameter::TipRadiusUm, tip_radius_um);
    }
    builder.uncertainty = file.uncertainty.as_ref().map(uncertainty).transpose()?;
    Ok(builder)
}

/// Returns the radius at the tip that `whisker.taper` gives, in micrometres. Refuses a taper beside what gives other radii at the tip.
fn tip_of_taper(taper: f64, scene: &SceneBuilder) -> Result<f64, SceneFault> {
    let taper = Parameter::taper_limits(taper).check(TAPER_KEY, taper)?;
    let must = if scene.measured.is_some() {
        "the radii are those of whisker.profile"
    } else if scene.number(Parameter::TipRadiusUm).is_some() {
        "whisker.tip_radius_um gives the radius at the tip"
    } else if scene.sweeps(Parameter::Taper) {
        "grid.taper gives every whisker of the sweep its tip"
    } else if scene.sweeps(Parameter::TipRadiusUm) {
        "grid.tip_radius_um gives every whisker of the sweep its tip"
    } else if scene.sweeps(Parameter::BaseRadiusUm) {
        "grid.base_radius_um varies the base; give whisker.tip_radius_um to keep the tip, or grid.taper with one value to \
         keep the taper"
    } else if scene.has_bases_of_rows() {
        "whiskers.table has the column base_radius_um"
    } else {
        let base = Parameter::BaseRadiusUm;
        let absent = || SceneFault::new(base.key(), "is left out, and there is no whisker.profile");
        let base_radius_um = scene.number(base).ok_or_else(absent)?;
        return Ok(base_radius_um * (1.0 - taper));
    };
    let must = format!("must be left out: {must}");
    Err(SceneFault::of_value(TAPER_KEY, digits(taper), must))
}

/// The checked degree of a traced curvature.
fn degree(given: i64) -> Result<usize, SceneFault> {
    let degree = usize::try_from(given).ok();
    let allowed = degree.filter(|degree| *degree <= MOST_DEGREE);
    allowed.ok_or_else(|| {
        let must = format!("must be between 0 and {MOST_DEGREE}");
        SceneFault::of_value(DEGREE_KEY, given.to_string(), must)
    })
}

/// The standard deviations of `[uncertainty]`.
fn uncertainty(table: &BTreeMap<String, f64>) -> Result<Deviations, SceneFault> {
    let mut uncertainty = Deviations::default();
    for (name, &deviation) in table {
        match Parameter::named(name) {
            Some(parameter) => uncertainty.parameters.push((parameter, deviation)),
            None if name == deviations::ROWS => uncertainty.profile_radius_um = Some(deviation),
            None if uncertainty.frames.set(name, deviation) => {}
            None => {
                let known = Parameter::ALL
                    .map(Parameter::name)
                    .into_iter()
                    .chain([deviations::ROWS])
                    .chain(FrameDeviations::NAMES);
                let hint = did_you_mean(name, known);
                let names = deviations::names();
                let must = format!("is not known; must be one of {names}{hint}");
                let key = format!("uncertainty.{}", shortened(name));
                return Err(SceneFault::of_value(key, digits(deviation), must));
            }
        }
    }
    Ok(uncertainty)
}

/// Adds the place in the text to a fault, and the value as the text has it. Pairs of a CSV file are named by their lines.
fn located(mut fault: SceneFault, files: &[PairsCsv], origin: &str, text: &str) -> SceneError {
    let of_file = files.iter().find_map(|csv| {
        let pair = fault.key.strip_prefix(csv.key)?.strip_prefix('[')?;
        let pair: usize = pair.strip_suffix(']')?.parse().ok()?;
        Some((csv.key, *csv.lines.get(pair)?))
    });
    if let Some((key, line)) = of_file {
        let must = format!("line {line}: {}", fault.must);
        fault = SceneFault::new(key, must);
    }
    let notes = files.iter().filter(|csv| csv.key == fault.key);
    for note in notes.filter_map(|csv| csv.note.as_ref()) {
        fault.must = format!("{}; {note}", fault.must);
    }
    let span = place_in(text, &fault.key);
    let value = span.clone().and_then(|span| text.get(span));
    fault.value = value.filter(|value| is_short(value)).map(str::to_owned);
    if let (Some(span), Some(value)) = (&span, &fault.value)
        && fault.must.starts_with(NOT_GROWING)
        && !fault.must.contains('.')
        && value.parse::<u64>().is_ok()
        && has_tight_comma(text.get(span.start.saturating_sub(2)..span.end).unwrap_or_default())
    {
        // `10,5` was meant as one number.
        fault.must.push_str(DECIMAL_POINTS);
    }
    // A missing value has the place of its table.
    let table = |key: &String| Some(key.rsplit_once('.')?.0.to_owned());
    let tables = iter::successors(table(&fault.key), table);
    let span = span.or_else(|| tables.into_iter().find_map(|table| place_in(text, &table)));
    SceneError::of_fault(origin, text, fault).with_span(span)
}

/// Returns true for a value that fits into a sentence. A list, a table or a long text is shown by the marked line alone.
fn is_short(value: &str) -> bool {
    value.len() <= 40 && !value.contains('\n') && !value.starts_with(['[', '{'])
}
