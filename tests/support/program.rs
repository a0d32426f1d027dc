//! Runs of the program in a temporary folder, and their output.
#![allow(clippy::panic, reason = "a test fails by panicking")]

use assert_cmd::Command;
use std::fs;
use std::path::{MAIN_SEPARATOR, Path, PathBuf};
use std::process::Output;
use tempfile::TempDir;

/// Scene with all regimes except two, which takes a fraction of a second.
pub const SCENE: &str = r#"title = "A small map"
[whisker]
length_mm = 20
base_radius_um = 30.0
tip_radius_um = 1.5
youngs_modulus_gpa = 3.0
[whisker.curvature]
parabola_per_mm = 0.02
[pole]
radius_mm = 0.25
[grid]
push_angle_deg = { from = -70, to = 70, count = 24 }
distance_mm = { from = 2, to = 20, count = 24 }
"#;

/// Temporary folder in which the program runs.
pub struct Place(TempDir);

impl Place {
    /// Creates a folder with `text` as `scene.toml`.
    pub fn with(text: &str) -> Self {
        let place = Self(tempfile::tempdir().unwrap());
        place.write("scene.toml", text);
        place
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    /// Returns a command that runs the program.
    pub fn command(&self, arguments: &[&str]) -> Command {
        Command::from_std(self.plain_command(arguments))
    }

    /// Returns a command of the standard library, whose streams can be set.
    pub fn plain_command(&self, arguments: &[&str]) -> std::process::Command {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_whiskmap"));
        command
            .args(arguments)
            .current_dir(self.0.path())
            // The program must not print the errors of libraries that need this variable.
            .env_remove("XDG_RUNTIME_DIR");
        #[cfg(unix)]
        isolate(&mut command);
        command
    }

    /// Runs the program; it must not panic.
    pub fn run(&self, arguments: &[&str]) -> Run {
        Run::of(&self.command(arguments).output().unwrap())
    }

    /// Runs the program, which must succeed.
    #[track_caller]
    pub fn good(&self, arguments: &[&str]) -> Run {
        let run = self.run(arguments);
        assert_eq!(run.code, Some(0), "{arguments:?}: {run:?}");
        run
    }

    /// Runs the program, which must succeed without messages.
    #[track_caller]
    pub fn quiet(&self, arguments: &[&str]) -> Run {
        let run = self.good(arguments);
        assert_eq!(run.err, "", "{arguments:?}: {run:?}");
        run
    }

    /// Runs `map`, which must succeed.
    #[track_caller]
    pub fn map(&self, arguments: &[&str]) -> Run {
        self.good(&[&["map", "--engine", "cpu"], arguments].concat())
    }

    pub fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    pub fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }
}

/// Most CPU time of a run in seconds. A run that no test ends, because a signal does not reach it, ends by itself.
#[cfg(unix)]
const CPU_SECONDS: u64 = 1200;

/// Gives a program the default actions of signals, also those that `nohup` and shells ignore for background jobs, and limits its CPU time.
#[cfg(unix)]
#[allow(unsafe_code, reason = "only the child itself can set its signals")]
fn isolate(command: &mut std::process::Command) {
    use std::os::unix::process::CommandExt;
    let set = || {
        let limit = libc::rlimit { rlim_cur: CPU_SECONDS, rlim_max: CPU_SECONDS };
        // SAFETY: both calls may be made between `fork` and `exec`, and read nothing but their arguments.
        unsafe {
            for signal in [libc::SIGHUP, libc::SIGINT, libc::SIGQUIT, libc::SIGTERM] {
                libc::signal(signal, libc::SIG_DFL);
            }
            libc::setrlimit(libc::RLIMIT_CPU, &raw const limit);
        }
        Ok(())
    };
    // SAFETY: `set` allocates nothing and takes no lock.
    unsafe { command.pre_exec(set) };
}

/// Splits `line` into words at whitespace.
pub fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

/// Returns the system's message for a file that is missing in a folder.
pub fn no_file() -> String {
    fs::metadata("nowhere").unwrap_err().to_string()
}

/// Returns the system's message for a file whose folder is missing.
pub fn no_folder() -> String {
    fs::metadata("nowhere/file").unwrap_err().to_string()
}

/// Returns the sorted names of the entries of a folder; none without a folder.
pub fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .into_iter()
        .flatten()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// Exit code and output of a run.
#[derive(Debug)]
pub struct Run {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

impl Run {
    pub fn of(output: &Output) -> Self {
        let run = Self {
            code: output.status.code(),
            out: String::from_utf8(output.stdout.clone()).unwrap(),
            err: String::from_utf8(output.stderr.clone()).unwrap(),
        };
        assert!(!run.err.contains("panicked"), "{run:?}");
        run
    }

    /// Returns the number before `what` in the summary.
    pub fn count(&self, what: &str) -> u64 {
        let line = self.out.lines().find(|line| line.trim_end().ends_with(what));
        let number = line.and_then(|line| line.split_whitespace().next());
        number.unwrap_or_else(|| panic!("no {what}: {self:?}")).parse().unwrap()
    }

    /// Checks that no cell is unresolved, and that no cell contradicts its row.
    pub fn assert_settled(&self) {
        assert_eq!(self.count("unresolved"), 0, "{self:?}");
        let disagreements = "disagreements between cells and boundaries";
        assert_eq!(self.count(disagreements), 0, "{self:?}");
    }

    /// Returns standard error with slashes in paths, which Windows separates by backslashes.
    pub fn messages(&self) -> String {
        self.err.replace(MAIN_SEPARATOR, "/")
    }

    /// Checks the exit code, and that standard error contains `said`, where paths have slashes.
    pub fn assert_said(&self, code: i32, said: &str) {
        assert_eq!(self.code, Some(code), "{self:?}");
        assert!(self.messages().contains(said), "{self:?}");
    }

    /// Checks for invalid input: exit code 2, no standard output, one message with all `parts`, where paths have slashes.
    pub fn assert_refused(&self, parts: &[&str]) {
        assert_eq!(self.code, Some(2), "{self:?}");
        assert_eq!(self.out, "", "{self:?}");
        assert!(self.err.starts_with("error: "), "{self:?}");
        assert_eq!(self.err.matches("error: ").count(), 1, "{self:?}");
        assert!(!self.err.contains('\u{1b}'), "colours in a pipe: {self:?}");
        let messages = self.messages();
        for part in parts {
            assert!(messages.contains(part), "no {part:?} in {self:?}");
        }
    }
}
