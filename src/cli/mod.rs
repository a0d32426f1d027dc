//! The command line: the only place that prints, and that knows exit codes.
//!
//! Answers go to standard output, everything said along the way to standard error. Exit code 2 is for input
//! that cannot be right, 1 for what fails while running.

mod devices;
mod engine;
mod failure;
mod map;
mod progress;
mod render;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Where does a whisker pushed against a pole stay in contact, where does it slip off, where is it pulled off?
#[derive(Debug, Parser)]
#[command(version, arg_required_else_help = true, after_help = EXAMPLES)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
Examples:
  whiskmap map scenes/cone.toml                    regime map as outputs/cone.exr and outputs/cone.png
  whiskmap map scenes/cone.toml --engine gpu       the same, shot by the GPU
  whiskmap render outputs/cone.exr --channel force_un
  whiskmap devices                                 adapters, and which one `auto` takes";

#[derive(Debug, Subcommand)]
enum Command {
    /// Compute the regime map of a scene, as EXR and PNG
    Map(map::Options),
    /// Draw a stored map again, its regimes or any channel
    Render(render::Options),
    /// List the GPU adapters
    Devices,
}

/// Runs the command that the process was called with.
#[must_use]
pub fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let result = match &arguments.command {
        Command::Map(options) => map::run(options),
        Command::Render(options) => render::run(options),
        Command::Devices => devices::run(),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
