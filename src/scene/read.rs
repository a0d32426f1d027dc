//! From a file, or text, to a checked scene.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use super::file::SceneTable;
use super::{Scene, SceneError, check, rows};

/// A scene is a page of text, radii are a short table; anything longer was picked by mistake.
const MOST_BYTES: u64 = 1 << 20;

impl Scene {
    /// Reads and checks a scene file; `-` is standard input. Where the file does not name its output, the
    /// file's own stem does, or `scene` for standard input.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, is longer than 1 MiB, is not UTF-8, or for the reasons of [`Scene::parse`].
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        if path == Path::new("-") {
            return Self::from_source(io::stdin().lock(), "<stdin>", Path::new(""), "scene");
        }
        let origin = path.to_string_lossy();
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let file = File::open(path).map_err(|why| unreadable(&origin, &why))?;
        Self::from_source(file, &origin, folder_of(path), &stem)
    }

    /// Checks a scene. `origin` is what messages call the text, `default_name` the stem of the output files
    /// where the scene does not give one. A CSV file that the scene names is looked for beside `origin`, and its rows
    /// take the place of its name in [`Scene::text`].
    ///
    /// # Errors
    ///
    /// If the text is not TOML, has a key too many or too few, or a value that is out of its range or at odds
    /// with another one.
    pub fn parse(text: &str, origin: &str, default_name: &str) -> Result<Self, SceneError> {
        Self::checked(text, origin, folder_of(Path::new(origin)), default_name)
    }

    fn checked(
        text: &str,
        origin: &str,
        folder: &Path,
        default_name: &str,
    ) -> Result<Self, SceneError> {
        let mut table: SceneTable = toml::from_str(text)
            .map_err(|why| SceneError::at(origin, text, why.span(), why.message()))?;
        let scene = rows::read(&mut table, text, folder).and_then(|inlined| {
            check::scene(&table, inlined.as_deref().unwrap_or(text), default_name)
        });
        scene.map_err(|fault| fault.in_scene(origin, text))
    }

    fn from_source(
        source: impl Read,
        origin: &str,
        folder: &Path,
        default_name: &str,
    ) -> Result<Self, SceneError> {
        let bytes = bounded(source).map_err(|why| unreadable(origin, &why))?;
        let text = String::from_utf8(bytes).map_err(|why| {
            let start = why.utf8_error().valid_up_to();
            let byte = why.as_bytes()[start];
            // The first bad byte and its stand-in begin at the same place.
            let shown = String::from_utf8_lossy(why.as_bytes());
            let span = start..start + char::REPLACEMENT_CHARACTER.len_utf8();
            SceneError::at(
                origin,
                &shown,
                Some(span),
                format!("not UTF-8 text: byte 0x{byte:02X}"),
            )
        })?;
        Self::checked(&text, origin, folder, default_name)
    }
}

fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

/// All of a source that is no longer than a page or a table is.
pub(super) fn bounded(source: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    source.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(io::Error::new(
            io::ErrorKind::FileTooLarge,
            "longer than 1 MiB",
        ));
    }
    Ok(bytes)
}

fn unreadable(origin: &str, why: &io::Error) -> SceneError {
    SceneError::whole(origin, format!("cannot be read: {why}"))
}
