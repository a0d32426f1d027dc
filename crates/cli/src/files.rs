//! Inputs and outputs of a command. All are declared here, so that no output destroys an input or another output.

use super::failure::Failure;
use super::scene::read_scene;
use same_file::Handle;
use std::fs::Metadata;
use std::io;
use std::path::{Path, PathBuf};
use whiskmap::scene::Scene;
use whiskmap::store::{Output, TemporaryFiles, TemporaryFolder, resolved};

/// Path that stands for standard input or output.
pub const STDOUT: &str = "-";

/// Inputs and outputs of one command. Inputs are declared before outputs are opened.
#[derive(Debug)]
pub struct Files {
    temporary: TemporaryFiles,
    /// True if an input is standard input.
    reads_stdin: bool,
    /// Path of each input for messages, and the open file or folder.
    inputs: Vec<(PathBuf, Handle)>,
    /// Option and path of each output for messages, and the absolute path behind all links.
    outputs: Vec<(String, PathBuf)>,
}

impl Files {
    /// Creates an empty list of inputs and outputs; `temporary` has the files of outputs until they are finished.
    pub const fn new(temporary: TemporaryFiles) -> Self {
        Self { temporary, reads_stdin: false, inputs: Vec::new(), outputs: Vec::new() }
    }

    /// Returns the temporary files of the outputs.
    pub const fn temporary(&self) -> &TemporaryFiles {
        &self.temporary
    }

    /// Declares and reads a scene, as [`read_scene`] does, and declares its files.
    pub fn scene(&mut self, path: &Path) -> Result<Scene, Failure> {
        self.inputs("SCENE", [path])?;
        let scene = read_scene(path)?;
        for file in scene.csv_files() {
            self.declare(file)?;
        }
        Ok(scene)
    }

    /// Declares the inputs of the command-line option `option`, before any input is read: files, stores, or standard input.
    ///
    /// # Errors
    /// If standard input is an input twice, or standard output is redirected to an input.
    pub fn inputs(
        &mut self,
        option: &str,
        paths: impl IntoIterator<Item = impl AsRef<Path>>,
    ) -> Result<(), Failure> {
        for path in paths {
            let path = path.as_ref();
            let is_stdin = path == Path::new(STDOUT);
            if is_stdin && self.reads_stdin {
                let why = "standard input is another input, and can be read once; name a file";
                return Err(Failure::Input(format!("{option} -: {why}")));
            }
            self.reads_stdin |= is_stdin;
            self.declare(path)?;
        }
        Ok(())
    }

    /// Declares an input, unless standard output, to which every command writes a summary, is redirected to it.
    fn declare(&mut self, path: &Path) -> Result<(), Failure> {
        let input = stored(path, Handle::stdin);
        if input.is_some() && input == stored(Path::new(STDOUT), Handle::stdout) {
            let input = path.display();
            let why = format!("standard output: is the input {input}; name another file");
            return Err(Failure::Input(why));
        }
        self.inputs.extend(input.map(|input| (path.to_owned(), input)));
        Ok(())
    }

    /// Opens the output file of the command-line option `option`. A file to which standard output is redirected is standard output.
    ///
    /// # Errors
    /// If the output is an input, is inside one, is another output, or cannot be written.
    pub fn output(&mut self, option: &str, path: &Path) -> Result<Output, Failure> {
        let stdout = Path::new(STDOUT);
        let redirected = stored(stdout, Handle::stdout);
        let is_redirected = redirected.is_some() && redirected == stored(path, Handle::stdout);
        if path == stdout || is_redirected {
            self.claim(option, path, stdout)?;
            return Ok(Output::stdout());
        }
        self.file(option, path)
    }

    /// Opens an output file like [`Files::output`], but replaces a file to which standard output is redirected. The files of a map need it: the
    /// EXR file is not written in order, and the summary goes to standard output, too.
    pub fn file(&mut self, option: &str, path: &Path) -> Result<Output, Failure> {
        let advice = "name a file that can be written";
        let output = Output::create(path, &self.temporary);
        let output = output.map_err(impossible(option, path, advice))?;
        if let Some(target) = output.target() {
            self.claim(option, path, target)?;
            TemporaryFiles::remove_leftovers(target.parent().unwrap_or(target));
        }
        Ok(output)
    }

    /// Declares the store of `option`, a folder that need not exist.
    ///
    /// # Errors
    /// If the store is an input, is inside one, or is a file.
    pub fn store(&mut self, option: &str, path: &Path) -> Result<(), Failure> {
        check_folder(option, path)?;
        let target = resolved(path).map_err(impossible(option, path, FOLDER_ADVICE))?;
        self.claim(option, path, &target)
    }

    /// Creates a temporary folder for the new store of `option`.
    pub fn new_store(&self, option: &str, path: &Path) -> Result<TemporaryFolder, Failure> {
        let made = TemporaryFolder::create(path, &self.temporary);
        made.map_err(impossible(option, path, "give a name in a folder that can be written"))
    }

    /// Creates the folder of `option`, and checks that files can be created in it.
    pub fn folder(&self, option: &str, path: &Path) -> Result<(), Failure> {
        check_folder(option, path)?;
        let made = std::fs::create_dir_all(path).and_then(|()| self.temporary.prepare(path));
        made.map_err(impossible(option, path, FOLDER_ADVICE))
    }

    /// Creates the folder `outputs`, and returns the path of the file of this `name` in it, for an output without a path.
    pub fn unnamed(&self, name: &str) -> Result<PathBuf, Failure> {
        let folder = Path::new("outputs");
        self.folder("--output", folder)?;
        Ok(folder.join(name))
    }

    /// Adds an output, unless its `target` or one of the folders that hold it is an input, or another output has the target.
    fn claim(&mut self, option: &str, path: &Path, target: &Path) -> Result<(), Failure> {
        let output = format!("{option} {}", path.display());
        for part in target.ancestors() {
            let part_file = stored(part, Handle::stdout);
            let is_part = |(_, input): &&(PathBuf, Handle)| Some(input) == part_file.as_ref();
            if let Some((input, _)) = self.inputs.iter().find(is_part) {
                let is = if part == target { "is" } else { "is in" };
                let input = input.display();
                let why = format!("{output}: {is} the input {input}; name another file");
                return Err(Failure::Input(why));
            }
        }
        let is_same = |(_, other): &&(String, PathBuf)| is_same_name(other, target);
        if let Some((other, _)) = self.outputs.iter().find(is_same) {
            let why = format!("{other} and {output}: must be two files");
            return Err(Failure::Input(why));
        }
        self.outputs.push((output, target.to_owned()));
        Ok(())
    }
}

/// Opens the file or the folder at `path`, or the file of `stream` at `-`, to compare it with others. Returns `None` for a device or a
/// pipe.
fn stored(path: &Path, stream: fn() -> io::Result<Handle>) -> Option<Handle> {
    let is_stored = |about: Metadata| about.is_file() || about.is_dir();
    if path == Path::new(STDOUT) {
        let stream = stream().ok()?;
        let is_file = stream.as_file().metadata().is_ok_and(is_stored);
        return is_file.then_some(stream);
    }
    let is_file = path.metadata().is_ok_and(is_stored);
    is_file.then(|| Handle::from_path(path).ok()).flatten()
}

/// Returns true if two absolute paths name one new file. On Windows and macOS, names that differ in case are usually one file.
fn is_same_name(one: &Path, other: &Path) -> bool {
    let differ_in_case = cfg!(any(windows, target_vendor = "apple"))
        && one.as_os_str().eq_ignore_ascii_case(other.as_os_str());
    one == other || differ_in_case
}

const FOLDER_ADVICE: &str = "give a folder that can be written";

/// Checks that the `path` of `option` is a folder or can become one.
pub fn check_folder(option: &str, path: &Path) -> Result<(), Failure> {
    if path == Path::new(STDOUT) {
        let why =
            format!("{option} -: must be a folder, but - is standard output; {FOLDER_ADVICE}");
        return Err(Failure::Input(why));
    }
    match path.ancestors().find(|part| part.exists()) {
        Some(file) if !file.is_dir() => Err(Failure::Input(format!(
            "{option} {}: must be a folder, but {} is not one; {FOLDER_ADVICE}",
            path.display(),
            file.display()
        ))),
        _ => Ok(()),
    }
}

/// Returns a converter of errors from writing the file at `path`.
pub fn unwritten(path: &Path) -> impl FnOnce(io::Error) -> Failure {
    move |cause| {
        if path == Path::new(STDOUT) {
            return Failure::Output(cause);
        }
        let path = path.to_owned();
        Failure::Write { path, cause }
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
    use io::ErrorKind as Kind;
    // Without a stable kind: a circle of links and, on Windows, a file that another program keeps for itself
    // (ERROR_CANT_RESOLVE_FILENAME, ERROR_SHARING_VIOLATION, ERROR_LOCK_VIOLATION).
    #[cfg(unix)]
    const CODES: &[i32] = &[libc::ELOOP];
    #[cfg(not(unix))]
    const CODES: &[i32] = &[1921, 32, 33];
    let has_code = error.raw_os_error().is_some_and(|code| CODES.contains(&code));
    has_code
        || matches!(
            error.kind(),
            Kind::AlreadyExists
                | Kind::ExecutableFileBusy
                | Kind::InvalidFilename
                | Kind::InvalidInput
                | Kind::IsADirectory
                | Kind::NotADirectory
                | Kind::NotFound
                | Kind::PermissionDenied
                | Kind::ReadOnlyFilesystem
                | Kind::Unsupported
        )
}
