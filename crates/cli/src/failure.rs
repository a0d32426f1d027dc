//! Failures of commands, their messages and exit codes.

use super::Arguments;
use clap::Parser;
use std::ffi::OsString;
use std::fmt::Display;
use std::io::{self, IsTerminal, Write};
use std::path::PathBuf;
use whiskmap::bench::PeersError;
use whiskmap::compare::CompareError;
use whiskmap::engine::EngineError;
use whiskmap::engine::gpu::DRIVER_CALL;
use whiskmap::fit;
use whiskmap::input::CsvError;
use whiskmap::paper::FigureError;
use whiskmap::plan::PlanError;
use whiskmap::render::{EncodeError, RenderError, SizeError};
use whiskmap::scene::SceneError;
use whiskmap::store;
use whiskmap::terminal::escaped;
use whiskmap::texture::TextureError;
use whiskmap::trace::NoState;
use whiskmap::whisk::WhiskError;

/// Exit code for invalid input.
pub const INVALID_INPUT: u8 = 2;

/// Failure of a command, with its message and exit code.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    #[error("{0}")]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Points(#[from] CsvError),
    #[error(transparent)]
    Fit(#[from] fit::FitError),
    /// The best values of a fit are not a fit; the text names the output that is therefore not written.
    #[error("{0}{1}")]
    NotAFit(fit::NotAFit, String),
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// An argument is invalid, alone or with this machine or these files.
    #[error("{0}")]
    Input(String),
    #[error(transparent)]
    Peers(#[from] PeersError),
    #[error(transparent)]
    Engine(#[from] EngineError),
    #[error(transparent)]
    Store(#[from] store::StoreError),
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// Two maps differ by more than is allowed, in these channels.
    #[error("the maps differ by more than --within allows in {0}")]
    Different(String),
    #[error(transparent)]
    Render(RenderError),
    #[error(transparent)]
    Encode(#[from] EncodeError),
    #[error(transparent)]
    State(NoState),
    #[error(transparent)]
    Course(WhiskError),
    #[error(transparent)]
    Figure(FigureError),
    #[error(transparent)]
    Texture(TextureError),
    /// Every result of the command is unresolved.
    #[error("all {all} {what} are unresolved: see {see}")]
    Unresolved { all: u64, what: &'static str, see: &'static str },
    /// The command `design` found no value.
    #[error("{0}")]
    NoValue(String),
    /// A store has missing or damaged files.
    #[error("{} is incomplete: {}", store.display(), faults(*missing, *damaged, *metadata))]
    Incomplete { store: PathBuf, missing: usize, damaged: usize, metadata: usize },
    /// Checks of the command `verify` fail.
    #[error("{failed} of {all} checks fail")]
    Checks { failed: usize, all: usize },
    #[error("cannot write {}: {cause}", path.display())]
    Write { path: PathBuf, cause: io::Error },
    #[error("cannot start threads ({count}): {cause}; set a smaller number by RAYON_NUM_THREADS")]
    Threads { count: usize, cause: String },
    /// Standard output is closed or full.
    #[error("standard output: {0}")]
    Output(#[from] io::Error),
}

impl Failure {
    fn code(&self) -> u8 {
        let is_input = match self {
            Self::Scene(_) | Self::Points(_) | Self::Plan(_) | Self::Peers(_) | Self::Input(_) => {
                true
            }
            Self::Fit(error) => !matches!(error, fit::FitError::NotConverged(_)),
            Self::Store(store::StoreError::Encode(..))
            | Self::Render(
                RenderError::Scale { .. } | RenderError::Codes(_) | RenderError::TooManyAxes(_),
            ) => true,
            Self::Compare(CompareError::Mismatch(_)) => true,
            Self::Store(error)
            | Self::Compare(CompareError::Store(error))
            | Self::Render(RenderError::Store(error)) => error.is_unreadable(),
            _ => false,
        };
        if is_input { INVALID_INPUT } else { 1 }
    }

    /// Returns true if the reader of an output has closed it.
    pub fn is_broken_pipe(&self) -> bool {
        match self {
            Self::Output(error) | Self::Write { cause: error, .. } => {
                error.kind() == io::ErrorKind::BrokenPipe
            }
            _ => false,
        }
    }

    /// Prints the message of the failure and returns the exit code.
    pub fn report(&self) -> u8 {
        match self {
            // A reader that stops early, like `head`, is not a failure.
            _ if self.is_broken_pipe() => return 0,
            // The message has several lines, and colours.
            Self::Scene(error) => drop(writeln!(io::stderr(), "{}", error.render(color()))),
            _ => message(&format!("error: {self}")),
        }
        self.code()
    }
}

impl From<RenderError> for Failure {
    fn from(why: RenderError) -> Self {
        match why {
            RenderError::Size(why) => why.into(),
            why => Self::Render(why),
        }
    }
}

impl From<SizeError> for Failure {
    fn from(why: SizeError) -> Self {
        Self::Input(format!("--size: {why}"))
    }
}

/// Returns the faults of a store that occur, with their counts, and the command that removes them.
fn faults(missing: usize, damaged: usize, metadata: usize) -> String {
    let kinds = [
        (missing, ["block is", "blocks are"], "missing"),
        (damaged, ["block is", "blocks are"], "damaged"),
        (metadata, ["file of metadata is", "files of metadata are"], "damaged"),
    ];
    let present = kinds.into_iter().filter(|(count, ..)| *count > 0);
    let faults: Vec<String> = present
        .map(|(count, [one, several], state)| {
            let what = if count == 1 { one } else { several };
            format!("{count} {what} {state}")
        })
        .collect();
    let cure = match missing + damaged {
        0 => "`whiskmap status --repair` writes them again",
        _ => "`whiskmap map --format zarr --resume` with the scene computes the rest",
    };
    format!("{}; {cure}", faults.join(", "))
}

/// Prints a line on standard error, with its control characters escaped, and ignores a closed one.
pub fn message(line: &str) {
    let _ = writeln!(io::stderr(), "{}", escaped(line));
}

/// Prints a line on standard error for each of the `warnings`.
pub fn warnings(warnings: impl IntoIterator<Item = impl Display>) {
    for warning in warnings {
        message(&format!("warning: {warning}"));
    }
}

/// Prints a line on standard error for each of the `notes`.
pub fn notes(notes: impl IntoIterator<Item = impl Display>) {
    for note in notes {
        message(&format!("note: {note}"));
    }
}

/// Prints an error of clap about `arguments`. clap quotes arguments as they are, so this function parses them again with control characters
/// escaped.
pub fn refuse(arguments: &[OsString], wrong: &clap::Error) {
    let shown = arguments.iter().map(|argument| escaped(&argument.to_string_lossy()));
    match Arguments::try_parse_from(shown) {
        // A closed standard error hides the message, not the code.
        Err(wrong) => drop(wrong.print()),
        Ok(_) => message(&format!("error: {}", wrong.kind())),
    }
}

/// Warns if some of `all` results are unresolved; `see` names the output that marks them.
///
/// # Errors
/// If all of them are unresolved.
pub fn check_resolved(
    unresolved: u64,
    all: u64,
    what: &'static str,
    see: &'static str,
) -> Result<(), Failure> {
    if unresolved == 0 {
        return Ok(());
    }
    if unresolved == all {
        return Err(Failure::Unresolved { all, what, see });
    }
    message(&format!("warning: {unresolved} of {all} {what} are unresolved: see {see}"));
    Ok(())
}

/// Silences panics of threads named [`DRIVER_CALL`], which are returned as errors.
pub fn keep_expected_panics_silent() {
    let before = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        if std::thread::current().name() != Some(DRIVER_CALL) {
            before(info);
        }
    }));
}

/// Returns true if messages are coloured: on a terminal, unless `NO_COLOR` is set.
fn color() -> bool {
    io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty())
}
