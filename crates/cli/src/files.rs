//! Inputs and outputs of a command. All are declared here, so that no output destroys an input or another output.

use super::failure::{Failure, message};
use super::output_file::{OutputFile, STDOUT, unwritten};
use std::io;
use std::path::{Path, PathBuf};
use whiskmap::scene::{Scene, digits, rounded};
use whiskmap::store::{FileId, Output, TemporaryFiles};
use whiskmap::traced::TracedShape;

/// Inputs and outputs of one command. Inputs are declared before outputs are opened.
#[derive(Debug)]
pub struct Files {
    temporary: TemporaryFiles,
    inputs: Vec<(PathBuf, FileId)>,
    /// Option and path of each output for messages, and the path.
    outputs: Vec<(String, PathBuf, FileId)>,
}

impl Files {
    /// Creates an empty list of inputs and outputs; `temporary` has the files of outputs until they are finished.
    pub const fn new(temporary: TemporaryFiles) -> Self {
        Self {
            temporary,
            inputs: Vec::new(),
            outputs: Vec::new(),
        }
    }

    /// Returns the temporary files of the outputs.
    pub const fn temporary(&self) -> &TemporaryFiles {
        &self.temporary
    }

    /// Reads a scene, as [`read_scene`] does, and declares its files.
    pub fn scene(&mut self, path: &Path) -> Result<Scene, Failure> {
        let scene = read_scene(path)?;
        self.input(path);
        for file in scene.csv_files() {
            self.input(file);
        }
        Ok(scene)
    }

    /// Declares an input: a file, a store, or standard input.
    pub fn input(&mut self, path: &Path) {
        let id = if path == Path::new(STDOUT) {
            FileId::of_stdin()
        } else {
            FileId::of(path)
        };
        self.inputs.extend(id.map(|id| (path.to_owned(), id)));
    }

    /// Opens the output file of the command-line option `option`.
    ///
    /// # Errors
    /// If the output is an input, is inside one, is another output, or cannot be written.
    pub fn output(&mut self, option: &str, path: &Path) -> Result<OutputFile, Failure> {
        let output = if path == Path::new(STDOUT) {
            Output::stdout()
        } else {
            let advice = "name a file that can be written";
            let output = Output::create(path, &self.temporary);
            output.map_err(impossible(option, path, advice))?
        };
        output.remove_leftovers();
        let folders = output.target().map(FileId::of_folders);
        self.claim(option, path, output.id(), &folders.unwrap_or_default())?;
        let path = path.to_owned();
        Ok(OutputFile { output, path })
    }

    /// Declares the store of `option`, a folder that need not exist.
    ///
    /// # Errors
    /// If the store is an input, is inside one, or is a file.
    pub fn store(&mut self, option: &str, path: &Path) -> Result<(), Failure> {
        check_folder(option, path)?;
        self.claim(option, path, FileId::of(path), &FileId::of_folders(path))
    }

    /// Creates the folder of `option`, and checks that files can be created in it.
    pub fn folder(&self, option: &str, path: &Path) -> Result<(), Failure> {
        check_folder(option, path)?;
        let made = std::fs::create_dir_all(path).and_then(|()| self.temporary.prepare(path));
        made.map_err(impossible(option, path, FOLDER_ADVICE))
    }

    /// Adds an output, unless the output or one of its `folders` is an input, or the output is another output.
    fn claim(
        &mut self,
        option: &str,
        path: &Path,
        id: Option<FileId>,
        folders: &[FileId],
    ) -> Result<(), Failure> {
        let Some(id) = id else {
            return Ok(());
        };
        let own = format!("{option} {}", path.display());
        for (input, of_input) in &self.inputs {
            let is = match of_input {
                same if *same == id && FileId::is_confirmed(input, path) => "is",
                folder if folders.contains(folder) => "is in",
                _ => continue,
            };
            let input = input.display();
            let why = format!("{own}: {is} the input {input}; name another file");
            return Err(Failure::Input(why));
        }
        let is_same = |(_, place, other): &&(String, PathBuf, FileId)| {
            *other == id && FileId::is_confirmed(place, path)
        };
        if let Some((other, ..)) = self.outputs.iter().find(is_same) {
            let why = format!("{other} and {own}: must be two files");
            return Err(Failure::Input(why));
        }
        self.outputs.push((own, path.to_owned(), id));
        Ok(())
    }
}

/// Reads a scene; prints notes about unused columns and warnings about values that look like another unit.
pub fn read_scene(path: &Path) -> Result<Scene, Failure> {
    let scene = Scene::read(path)?;
    for note in scene.notes() {
        message(&format!("note: {note}"));
    }
    if let Some(traced) = scene.traced() {
        let length_mm = scene.whisker.length_mm;
        message(&format!(
            "note: whisker.rest: {}",
            fitted(traced, length_mm)
        ));
    }
    for warning in scene.warnings() {
        message(&format!("warning: {warning}"));
    }
    Ok(scene)
}

/// Describes the fit to traced points of a whisker with this length.
fn fitted(traced: &TracedShape, length_mm: f64) -> String {
    let TracedShape {
        degree,
        rms_mm,
        points_mm,
        ..
    } = traced;
    let chosen = if traced.is_degree_chosen {
        ", chosen by cross-validation"
    } else {
        ""
    };
    let own = rounded(traced.length_mm, 6);
    let scaled = if length_mm == traced.length_mm {
        String::new()
    } else {
        format!(", at the scale of length_mm = {}", digits(length_mm))
    };
    format!(
        "curvature of degree {degree}{chosen}; {} points, rms distance {} mm, length {own} mm{scaled}",
        points_mm.len(),
        digits(rounded(*rms_mm, 3))
    )
}

const FOLDER_ADVICE: &str = "give a folder that can be written";

/// Checks that the `path` of `option` is a folder or can become one.
pub fn check_folder(option: &str, path: &Path) -> Result<(), Failure> {
    if path == Path::new(STDOUT) {
        let why =
            format!("{option} -: must be a folder, but - is standard output; {FOLDER_ADVICE}");
        return Err(Failure::Input(why));
    }
    match path.ancestors().find(|own| own.exists()) {
        Some(file) if !file.is_dir() => Err(Failure::Input(format!(
            "{option} {}: must be a folder, but {} is not one; {FOLDER_ADVICE}",
            path.display(),
            file.display()
        ))),
        _ => Ok(()),
    }
}

/// Failure of an output at its first check: invalid input if the path is wrong, a failure while running otherwise.
fn impossible(option: &str, path: &Path, advice: &str) -> impl FnOnce(io::Error) -> Failure {
    move |error| match is_of_path(&error) {
        true => Failure::Input(format!("{option} {}: {error}; {advice}", path.display())),
        false => unwritten(path)(error),
    }
}

/// Returns true for an error that another path would not have.
fn is_of_path(error: &io::Error) -> bool {
    use io::ErrorKind::{
        AlreadyExists, CrossesDevices, ExecutableFileBusy, InvalidFilename, InvalidInput,
        IsADirectory, NotADirectory, NotFound, PermissionDenied, ReadOnlyFilesystem, Unsupported,
    };
    // Errors without a stable kind: a circle of links and, on Windows, a file that another program keeps for itself
    // (ERROR_CANT_RESOLVE_FILENAME, ERROR_SHARING_VIOLATION, ERROR_LOCK_VIOLATION).
    let others: &[i32] = &[
        #[cfg(unix)]
        libc::ELOOP,
        #[cfg(windows)]
        1921,
        #[cfg(windows)]
        32,
        #[cfg(windows)]
        33,
    ];
    if error
        .raw_os_error()
        .is_some_and(|code| others.contains(&code))
    {
        return true;
    }
    matches!(
        error.kind(),
        AlreadyExists
            | CrossesDevices
            | ExecutableFileBusy
            | InvalidFilename
            | InvalidInput
            | IsADirectory
            | NotADirectory
            | NotFound
            | PermissionDenied
            | ReadOnlyFilesystem
            | Unsupported
    )
}
