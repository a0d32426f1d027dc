//! The command line: the only module that prints, and that chooses exit codes.
//!
//! Results go to standard output, messages to standard error. Exit code 2 is for invalid input, 1 for failures while running,
//! 128 + the signal's number for interrupts.

mod adapter;
mod arguments;
mod bench;
mod branch;
mod compare;
mod course;
mod curve;
mod data;
mod derivatives;
mod design;
mod devices;
mod digits;
mod disk;
mod engine;
mod estimate;
mod explore;
mod extract;
mod failure;
mod files;
mod fit;
mod force;
mod import;
mod locate;
mod manual;
mod map;
mod map_format;
mod marks;
mod outputs;
mod overview;
mod plan;
mod pole;
mod progress;
mod render;
mod reproduce;
mod scene;
mod selection;
mod sensitivity;
mod shape;
mod sharded;
mod signals;
mod size;
mod slurm;
mod solver;
mod source;
mod status;
mod submit;
mod summary;
mod texture;
mod tolerance;
mod uncertainty;
mod units;
mod verify;
mod whisk;

use clap::{Parser, Subcommand};
use failure::Failure;
use files::Files;
use std::ffi::OsString;
use std::io::{self, Write};
use std::num::NonZero;
use whiskmap::store::TemporaryFiles;

/// Compute where a whisker pushed against a pole stays in contact, slips off or is pulled off
#[derive(Debug, Parser)]
#[command(name = "whiskmap", version, bin_name = "whiskmap", arg_required_else_help = true)]
#[command(help_template = overview::template(), after_help = overview::EXAMPLES)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
#[command(defer = true)]
enum Command {
    /// Compute the regime map of a scene, as EXR and PNG or as a Zarr store
    Map(map::MapArgs),
    /// Estimate the cost of a map: effects, cells, memory, seconds, bytes
    Plan(plan::PlanArgs),
    /// Extract a part of a map or a store, as a table, an array, a map or a store
    Extract(extract::ExtractArgs),
    /// List finished, missing and damaged blocks of a store
    Status(status::StatusArgs),
    /// Write a job array for Slurm that fills a store
    Submit(submit::SubmitArgs),
    /// Compare two maps or stores of one scene, channel by channel
    Compare(compare::CompareArgs),
    /// Write a page on which a scene is explored in the browser, and open it
    Explore(explore::ExploreArgs),
    /// Draw a stored map: its regimes or any channel
    Render(render::RenderArgs),
    /// Compute the exact detachment curve of a scene, as CSV or a picture
    Curve(curve::CurveArgs),
    /// Fit parameters of a scene to measured detachments
    Fit(fit::FitArgs),
    /// Compute the solution branch at one pole, through the fold and beyond
    Branch(branch::BranchArgs),
    /// Compute the shape of the whisker in one state
    Shape(shape::ShapeArgs),
    /// Differentiate the push angle at detachment by every number of a scene
    Sensitivity(sensitivity::SensitivityArgs),
    /// Compute touches, forces and detachments of a whisker that whisks against a pole
    Whisk(whisk::WhiskArgs),
    /// Compute stuck and slipping phases of a whisker behind a rough surface
    Texture(texture::TextureArgs),
    /// Convert the files of a whisker tracker to frames, shapes or detachments
    Import(import::ImportArgs),
    /// Compute contact forces from the change of curvature in the frames of a film
    Force(force::ForceArgs),
    /// Find the contacts that belong to moment and force at the base
    Locate(locate::LocateArgs),
    /// Find the values of a parameter that give an angle at detachment, or a largest load
    Design(design::DesignArgs),
    /// Draw the theory of the paper's Figs. 1 to 7, with a table for each panel
    Reproduce(reproduce::ReproduceArgs),
    /// Compare with published, exact and independently computed values
    Verify,
    /// Measure error against time on every engine of this machine
    Bench(bench::BenchArgs),
    /// List the GPU adapters
    Devices,
    /// Print the completions of commands and options for a shell
    Completions(manual::CompletionsArgs),
    /// Print the manual page of the program or of a command
    Man(manual::ManArgs),
}

/// Parses the arguments of a command line, of which the first is the name of the program. Runs the command and returns the exit code.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let given: Vec<OsString> = arguments.into_iter().collect();
    let result = match Arguments::try_parse_from(&given) {
        Ok(arguments) => start(&arguments.command),
        Err(wrong) if wrong.use_stderr() => {
            failure::refuse(&given, &wrong);
            return failure::INVALID_INPUT;
        }
        Err(help) => help.print().map_err(Failure::Output),
    };
    match result.and_then(|()| Ok(io::stdout().flush()?)) {
        Ok(()) => 0,
        Err(failure) => failure.report(),
    }
}

/// Stack of a thread in bytes, as large as the stack of a main thread: GPU drivers compile on it.
const STACK: usize = 8 << 20;

/// Installs handlers, starts the threads and runs `command` on one of the threads.
fn start(command: &Command) -> Result<(), Failure> {
    failure::keep_expected_panics_silent();
    let (threads, advice) = match command {
        Command::Map(args) => (args.threads, args.advice()),
        Command::Plan(args) => (args.map.threads, ""),
        _ => (None, ""),
    };
    let temporary = TemporaryFiles::default();
    signals::handle(temporary.clone(), advice).map_err(unstarted(1))?;
    // The command runs on a thread of the pool: from outside, every parallel call would first wake up a thread.
    let count = thread_count(threads)?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(count)
        .stack_size(STACK)
        .build()
        .map_err(unstarted(count))?;
    let mut files = Files::new(temporary);
    pool.install(|| run(command, &mut files))
}

/// Returns a converter of errors from starting `count` threads.
fn unstarted<E: ToString>(count: usize) -> impl FnOnce(E) -> Failure {
    move |cause| Failure::Threads { count, cause: cause.to_string() }
}

/// Environment variable with the number of threads, as of other programs that use rayon; without it, and if it is 0, all cores are used.
const THREADS: &str = "RAYON_NUM_THREADS";

/// Returns the number of threads to start: the number in `--threads`, in the environment, or of the processor's cores.
///
/// # Errors
/// If the environment variable has a number that `--threads` does not accept.
fn thread_count(option: Option<u32>) -> Result<usize, Failure> {
    let cores = || std::thread::available_parallelism().map_or(1, NonZero::get);
    if let Some(count) = option {
        return Ok(count as usize);
    }
    let text = std::env::var(THREADS).unwrap_or_default();
    if matches!(&*text, "" | "0") {
        return Ok(cores());
    }
    let count = arguments::whole(arguments::THREADS)(&text)
        .map_err(|why| Failure::Input(format!("{THREADS}={text}: {why}")))?;
    Ok(count as usize)
}

fn run(command: &Command, files: &mut Files) -> Result<(), Failure> {
    match command {
        Command::Map(args) => map::run(args, files),
        Command::Plan(args) => plan::run(args, files),
        Command::Extract(args) => extract::run(args, files),
        Command::Status(args) => status::run(args, files.temporary()),
        Command::Submit(args) => submit::run(args, files),
        Command::Compare(args) => compare::run(args, files),
        Command::Explore(args) => explore::run(args, files),
        Command::Render(args) => render::run(args, files),
        Command::Curve(args) => curve::run(args, files),
        Command::Fit(args) => fit::run(args, files),
        Command::Branch(args) => branch::run(args, files),
        Command::Shape(args) => shape::run(args, files),
        Command::Sensitivity(args) => sensitivity::run(args, files),
        Command::Whisk(args) => whisk::run(args, files),
        Command::Texture(args) => texture::run(args, files),
        Command::Import(args) => import::run(args, files),
        Command::Force(args) => force::run(args, files),
        Command::Locate(args) => locate::run(args, files),
        Command::Design(args) => design::run(args, files),
        Command::Reproduce(args) => reproduce::run(args, files),
        Command::Verify => verify::run(),
        Command::Bench(args) => bench::run(args, files),
        Command::Devices => devices::run(),
        Command::Completions(args) => manual::completions(args),
        Command::Man(args) => manual::man(args),
    }
}
