//! From a file, or text, to a checked scene.

use std::fs::File;
use std::io::{self, Read};
use std::ops::Deref;
use std::path::{Path, PathBuf};

use serde::Serialize;
use toml_edit::ser::ValueSerializer;
use toml_edit::{DocumentMut, Item, TableLike, TomlError};

use crate::input::bounded;

use super::check;
use super::error::SceneError;
use super::file::SceneTable;
use super::rows;
use super::setup::Setup;
use super::source::NamedFiles;

/// A scene that has passed every check. It reads like its [`Setup`], and only [`Scene::with`] changes it.
///
/// ```
/// use whiskmap::scene::Scene;
///
/// let cone = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml")?;
/// let thick = cone.with("pole.radius_mm", 0.5)?;
/// assert_eq!((cone.pole.radius_mm, thick.pole.radius_mm), (0.25, 0.5));
/// assert!(cone.with("pole.radius_mm", -1).is_err());
/// # Ok::<(), whiskmap::scene::SceneError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    setup: Setup,
    rows_file: Option<PathBuf>,
}

impl Deref for Scene {
    type Target = Setup;

    fn deref(&self) -> &Setup {
        &self.setup
    }
}

impl Scene {
    /// Reads and checks a scene file; `-` is standard input. Where the file does not name its output, the
    /// file's own stem does, or `scene` for standard input. A CSV file that the scene names is looked for beside the scene
    /// file, and its rows take the place of its name in [`Setup::text`].
    ///
    /// # Errors
    ///
    /// If the file cannot be read, is longer than 1 MiB, is not UTF-8, or for the reasons of [`Scene::parse`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        let path = path.as_ref();
        if path == Path::new("-") {
            return Self::from_source(io::stdin().lock(), "<stdin>", Path::new("scene"));
        }
        let origin = path.to_string_lossy();
        let file = File::open(path).map_err(|why| unreadable(&origin, &why))?;
        Self::from_source(file, &origin, path)
    }

    /// Checks the text of a scene and opens no file. Messages call the text `origin`, whose stem is the name of the output
    /// where the scene gives none.
    ///
    /// # Errors
    ///
    /// If the text is not TOML, names a CSV file, has a key too many or too few, or a value that is out of its range or at
    /// odds with another one.
    pub fn parse(text: &str, origin: &str) -> Result<Self, SceneError> {
        Self::checked(text, origin, Path::new(origin), NamedFiles::Forbidden)
    }

    /// The CSV file that the radii were read from, if the scene names one.
    #[must_use]
    pub fn rows_file(&self) -> Option<&Path> {
        self.rows_file.as_deref()
    }

    /// The same scene with `value` at `key`, such as `"grid.distance_mm"`, as if its file had said so.
    ///
    /// # Errors
    ///
    /// If the scene would be refused with it.
    pub fn with(&self, key: &str, value: impl Serialize) -> Result<Self, SceneError> {
        self.with_each([(key, value)])
    }

    /// The same with several at once.
    pub(super) fn with_each<'a>(
        &self,
        values: impl IntoIterator<Item = (&'a str, impl Serialize)>,
    ) -> Result<Self, SceneError> {
        let mut document: DocumentMut = self
            .text
            .parse()
            .map_err(|why: TomlError| SceneError::whole(&self.name, why.message()))?;
        let mut origin = "";
        for (key, value) in values {
            origin = key;
            let refuse = |why: String| SceneError::whole(key, why);
            let serializer = ValueSerializer::new();
            let value = value.serialize(serializer);
            let mut value = value.map_err(|why| refuse(why.to_string()))?;
            let (tables, last) = key.rsplit_once('.').unwrap_or(("", key));
            let mut table: &mut dyn TableLike = document.as_table_mut();
            for name in tables.split('.').filter(|name| !name.is_empty()) {
                let entry = table.entry(name).or_insert_with(toml_edit::table);
                let inner = entry.as_table_like_mut();
                table = inner.ok_or_else(|| refuse(format!("{name} is a value, not a table")))?;
            }
            if let Some(before) = table.get(last).and_then(Item::as_value) {
                *value.decor_mut() = before.decor().clone();
            }
            table.insert(last, value.into());
        }
        let path = format!("{}.toml", self.name);
        let text = document.to_string();
        Self::checked(&text, origin, Path::new(&path), NamedFiles::Forbidden)
    }

    /// The same scene with at most `lines` push angles and distances, and at most `values` of each sweep axis, from all over
    /// the axis. Its text stays that of the whole.
    #[must_use]
    pub fn thinned(&self, lines: usize, values: usize) -> Self {
        self.thinned_to([lines, lines], values)
    }

    /// The same with at most so many push angles, and distances.
    #[must_use]
    pub fn thinned_to(&self, [push_angles, distances]: [usize; 2], values: usize) -> Self {
        let mut thinned = self.clone();
        let grid = &mut thinned.setup.grid;
        thin(&mut grid.push_angle_deg, push_angles);
        thin(&mut grid.distance_mm, distances);
        for axis in &mut grid.sweep {
            thin(&mut axis.values, values);
        }
        thinned
    }

    fn checked(
        text: &str,
        origin: &str,
        path: &Path,
        files: NamedFiles,
    ) -> Result<Self, SceneError> {
        let mut table: SceneTable =
            toml::from_str(text).map_err(|why| SceneError::of_toml(origin, text, &why))?;
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let profile = table.whisker.profile.as_mut();
        let rows_file = profile
            .as_ref()
            .and_then(|own| files.path_of(own.rows.get_ref().name()?));
        let inlined = profile.map_or(Ok(None), |own| rows::read(&mut own.rows, text, files));
        let setup = inlined.and_then(|inlined| {
            let own = inlined.as_ref().map_or(text, |inlined| &inlined.text);
            let setup = check::setup(&mut table, own, &stem)?;
            let note = inlined.and_then(|inlined| inlined.note);
            Ok(Setup { note, ..setup })
        });
        setup
            .map(|setup| Self { setup, rows_file })
            .map_err(|fault| fault.in_scene(origin, text))
    }

    fn from_source(source: impl Read, origin: &str, path: &Path) -> Result<Self, SceneError> {
        let bytes = bounded(source).map_err(|why| unreadable(origin, &why))?;
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
        Self::checked(&text, origin, path, NamedFiles::In(folder))
    }
}

fn unreadable(origin: &str, why: &io::Error) -> SceneError {
    SceneError::whole(origin, format!("cannot be read: {why}"))
}

/// Keeps the middles of at most `most` equal parts.
fn thin(values: &mut Vec<f64>, most: usize) {
    let (all, kept) = (values.len(), values.len().min(most));
    *values = (0..kept)
        .map(|i| values[(2 * i + 1) * all / (2 * kept)])
        .collect();
}
