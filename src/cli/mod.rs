//! The command line: the only place that prints, and that knows exit codes.
//!
//! Answers go to standard output, everything said along the way to standard error. Exit code 2 is for input
//! that cannot be right, 1 for what fails while running, 128 and the signal's number for an interrupt.

mod bench;
mod branch;
mod columns;
mod curve;
mod data;
mod design;
mod devices;
mod disk;
mod engine;
mod estimate;
mod extract;
mod failure;
mod files;
mod fit;
mod map;
mod numbers;
mod outputs;
mod parameter;
mod picture;
mod plan;
mod pole;
mod progress;
mod render;
mod reproduce;
mod scene;
mod selection;
mod shape;
mod sharded;
mod side;
mod signals;
mod status;
mod stdout;
mod submit;
mod summary;
mod theory;
mod tolerance;
mod uncertainty;
mod verify;

use clap::{Parser, Subcommand};
use failure::Failure;
use files::Files;
use std::io::{self, Write};
use std::process::ExitCode;
use whiskmap::store::TemporaryFiles;

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
  whiskmap map scenes/morphology.toml --format zarr --shard 0/8   an eighth of a store that many processes fill
  whiskmap status outputs/morphology.zarr          what it has, and what it lacks
  whiskmap submit scenes/morphology.toml --shards 8 > sweep.sbatch     the same as a job array for Slurm
  whiskmap extract outputs/morphology.zarr --at taper=0.5 -o slice.csv
  whiskmap plan scenes/cone.toml                   what that would take, without doing it
  whiskmap render outputs/cone.exr --channel force_un
  whiskmap curve scenes/cone.toml --plot curve.png where the whisker detaches, distance by distance
  whiskmap curve scenes/cone.toml --data scenes/cone_points.csv --plot points.svg
  whiskmap fit scenes/cone.toml --data scenes/cone_points.csv --free tip_radius_um
  whiskmap branch scenes/cone.toml --distance 15.66 stable and unstable states in front of one pole
  whiskmap shape scenes/cone.toml --distance 15.66 --push-angle 10 --plot shape.svg
  whiskmap curve scenes/uncertain.toml --samples 500 --plot bands.png   with the uncertainty of its numbers
  whiskmap design scenes/robot.toml --distance 60 --slip-off 30deg --for taper   the taper that slips off there
  whiskmap reproduce                               the theory of the paper's Figs. 1 to 5
  whiskmap verify                                  every number that is known otherwise
  whiskmap bench scenes/cone.toml                  what accuracy costs in time, engine by engine
  whiskmap devices                                 GPU adapters, by number and name";

#[derive(Debug, Subcommand)]
enum Command {
    /// Compute the regime map of a scene, as EXR and PNG
    Map(map::Options),
    /// Say what a map of a scene would take: effects, cells, memory, seconds
    Plan(plan::Options),
    /// Take a part of a map or a store, as a table, an array or a map
    Extract(extract::Options),
    /// Say what a store has, and what it lacks
    Status(status::Options),
    /// Write a job array for Slurm that fills a store
    Submit(submit::Options),
    /// Draw a stored map again, its regimes or any channel
    Render(render::Options),
    /// Compute the exact detachment curve of a scene, as CSV, PNG or SVG
    Curve(curve::Options),
    /// Fit parameters of a scene to measured detachments
    Fit(fit::Options),
    /// Follow the solution branch in front of one pole, through the fold and beyond
    Branch(branch::Options),
    /// Compute the shape of the whisker in one state
    Shape(shape::Options),
    /// Find the values of a number of the scene at which the whisker detaches at a given push angle
    Design(design::Options),
    /// Draw the theory of the paper's Figs. 1 to 5, with a table for each panel
    Reproduce(reproduce::Options),
    /// Compare with every number that is published, exact, or from an independent solver
    Verify,
    /// Measure what accuracy costs in time on every engine of this machine
    Bench(bench::Options),
    /// List the GPU adapters
    Devices,
}

/// Runs the command that the process was called with.
pub fn main() -> ExitCode {
    let result = match Arguments::try_parse() {
        Ok(arguments) => stdout::check()
            .map_err(Failure::Output)
            .and_then(|()| start(&arguments)),
        Err(wrong) if wrong.use_stderr() => wrong.exit(),
        Err(help) => stdout::check()
            .and_then(|()| help.print())
            .map_err(Failure::Output),
    };
    match result.and_then(|()| Ok(io::stdout().flush()?)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}

/// Installs handlers and makes threads, then runs the command.
fn start(arguments: &Arguments) -> Result<(), Failure> {
    failure::keep_expected_panics_silent();
    let temporary = TemporaryFiles::default();
    signals::handle(temporary.clone());
    let threads = match &arguments.command {
        Command::Map(options) => options.threads,
        _ => None,
    };
    // All of a command runs on a thread of the pool: from outside, every piece of parallel work would wake one up first.
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or_default() as usize)
        .stack_size(STACK)
        .build();
    let pool = pool.map_err(|error| {
        Failure::Input(match threads {
            Some(threads) => format!("--threads {threads}: {error}"),
            None => format!("threads for the processor's cores: {error}"),
        })
    })?;
    let mut files = Files::new(temporary);
    pool.install(|| run(&arguments.command, &mut files))
}

/// Stack of a thread, that of a main thread: drivers of GPUs compile on it.
const STACK: usize = 8 << 20;

fn run(command: &Command, files: &mut Files) -> Result<(), Failure> {
    match command {
        Command::Map(options) => map::run(options, files),
        Command::Plan(options) => plan::run(options),
        Command::Extract(options) => extract::run(options, files),
        Command::Status(options) => status::run(options, files.temporary()),
        Command::Submit(options) => submit::run(options),
        Command::Render(options) => render::run(options, files),
        Command::Curve(options) => curve::run(options, files),
        Command::Fit(options) => fit::run(options, files),
        Command::Branch(options) => branch::run(options, files),
        Command::Shape(options) => shape::run(options, files),
        Command::Design(options) => design::run(options, files),
        Command::Reproduce(options) => reproduce::run(options, files),
        Command::Verify => verify::run(),
        Command::Bench(options) => bench::run(options, files),
        Command::Devices => devices::run(),
    }
}
