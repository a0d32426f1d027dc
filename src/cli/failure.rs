//! What ends a command early, and the exit code for it.

use std::io::{self, IsTerminal, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use whiskmap::engine::EngineError;
use whiskmap::engine::gpu::DRIVER_CALL;
use whiskmap::fit;
use whiskmap::input::CsvError;
use whiskmap::plan::PlanError;
use whiskmap::render;
use whiskmap::scene::SceneError;
use whiskmap::store;
use whiskmap::trace::NoState;

/// An error of a command.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// The scene is not valid.
    #[error("{0}")]
    Scene(#[from] SceneError),
    /// The measured points are not valid.
    #[error(transparent)]
    Points(#[from] CsvError),
    /// There is no fit.
    #[error(transparent)]
    Fit(#[from] fit::Error),
    /// The best values are not a fit, and what is not written therefore.
    #[error("{0}{1}")]
    NotAFit(fit::NotAFit, String),
    /// The scene is too large.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// Arguments that cannot be right together with this machine or these files.
    #[error("{0}")]
    Input(String),
    /// The engine cannot be had.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// A stored map could not be read or written.
    #[error(transparent)]
    Store(#[from] store::Error),
    /// A picture could not be drawn.
    #[error(transparent)]
    Render(#[from] render::Error),
    /// A solution branch could not be followed.
    #[error(transparent)]
    State(NoState),
    /// Nothing that was asked for has an answer.
    #[error("all {all} {what} are unresolved: see {see}")]
    Unresolved {
        all: u64,
        what: &'static str,
        see: &'static str,
    },
    /// No value does what was asked for.
    #[error("{0}")]
    NoValue(String),
    /// A store that lacks something.
    #[error(
        "{} is not complete: {missing} blocks are missing, {damaged} are damaged, and {metadata} files of metadata", store.display()
    )]
    Incomplete {
        store: PathBuf,
        missing: usize,
        damaged: usize,
        metadata: usize,
    },
    /// Numbers are not what they should be.
    #[error("{failed} of {all} checks fail")]
    Checks { failed: usize, all: usize },
    /// A file could not be written.
    #[error("cannot write {}: {cause}", path.display())]
    Write { path: PathBuf, cause: io::Error },
    /// Standard output is gone or full.
    #[error("standard output: {0}")]
    Output(#[from] io::Error),
}

impl Failure {
    fn code(&self) -> u8 {
        let is_input = match self {
            Self::Scene(_) | Self::Points(_) | Self::Plan(_) | Self::Input(_) => true,
            Self::Fit(error) => !matches!(error, fit::Error::NotConverged(_)),
            Self::Store(store::Error::Encode(..))
            | Self::Render(render::Error::Scale(_) | render::Error::TooManyAxes(_)) => true,
            Self::Store(error) | Self::Render(render::Error::Store(error)) => error.is_unreadable(),
            _ => false,
        };
        if is_input { 2 } else { 1 }
    }

    /// Whether the reader of an output has closed it.
    pub fn is_broken_pipe(&self) -> bool {
        match self {
            Self::Output(error) | Self::Write { cause: error, .. } => {
                error.kind() == io::ErrorKind::BrokenPipe
            }
            _ => false,
        }
    }

    /// Prints the message and gives the exit code.
    pub fn report(&self) -> ExitCode {
        match self {
            // A reader that has seen enough, like `head`, is no failure of ours.
            _ if self.is_broken_pipe() => return ExitCode::SUCCESS,
            Self::Scene(error) => say(&error.render(color())),
            _ => say(&format!("error: {self}")),
        }
        ExitCode::from(self.code())
    }
}

/// A line on standard error, if anybody listens.
pub fn say(line: &str) {
    let _ = writeln!(io::stderr(), "{line}");
}

/// Says how many of `all` answers are unresolved, if any are, and where to `see` which.
///
/// # Errors
/// Where all of them are.
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
    say(&format!(
        "warning: {unresolved} of {all} {what} are unresolved: see {see}"
    ));
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

/// Whether messages may be coloured: on a terminal, unless `NO_COLOR` is set.
fn color() -> bool {
    io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty())
}
