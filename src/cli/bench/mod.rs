//! `whiskmap bench`.

mod plot;
mod tables;

use super::failure::{Failure, say};
use super::files::{Files, STDOUT, write};
use super::outputs::open;
use clap::Args;
use plot::plot;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use tables::tables;
use whiskmap::bench::{self, Effort};

/// Options of `bench`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap bench scenes/cone.toml
  whiskmap bench scenes/cone.toml --quick --json bench.json --plot bench.svg

A sample of the scene's states, at most 128 x 128 cells and two values per sweep axis, is solved by every engine: the CPU \
with one number at a time, with vectors on one thread and on all, from 3 to 30 steps of order 8 at the fold, fewer below; \
each GPU adapter in f32 and, where it can, in f64, by differences from references along each row; the references are made \
before, and cells that it hands over do not count. \
Errors are judged with four times the default steps: the push angle that a state really belongs to, the arc length \
of its contact in whisker lengths, and its force. * marks the rows that no other beats in time and in the worst error of \
the angle. Times, also of the stages, are medians of at least 5 runs after one that does not count; +- is the slowest less \
the fastest run, and ! marks rows where that is more than 20 %.

Then every engine computes whole maps of the scene, at most 1024 x 1024 cells (--quick: 256 x 256) and two values per sweep axis, \
in turn, packed but not written. host is the CPU time per cell of all threads, those of a software adapter included; for devices \
is the part of the stages, guesses and refinement, that a device could still take over. Stages are wall milliseconds; points are \
the base points of rows, which only a GPU engine needs. device and packing run beside the other stages, and waiting is for the device. \
The verdict compares the CPU engine with the fastest GPU engine.")]
pub struct Options {
    /// Scene file; - reads it from standard input
    scene: PathBuf,
    /// Everything measured, as JSON; - is standard output, in place of the tables
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Picture of error against time, PNG or SVG by its ending
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// A smaller sample and fewer runs
    #[arg(long)]
    quick: bool,
}

/// Runs `bench`.
pub fn run(options: &Options, files: &mut Files) -> Result<(), Failure> {
    let scene = files.scene(&options.scene)?;
    let json = options.json.as_deref();
    let (output, picture) = open(files, "--json", json, options.plot.as_deref())?;
    let effort = if options.quick {
        Effort::QUICK
    } else {
        Effort::FULL
    };
    let watched = std::io::stderr().is_terminal();
    let report = bench::run(&scene, effort, &mut |next| {
        if watched {
            say(&format!("measuring {next}"));
        }
    })?;
    let report = report.ok_or_else(|| {
        Failure::Input(
            "grid: no cell of the sample has a state; give push angles and distances that keep the contact".to_owned(),
        )
    })?;
    if let Some((output, path)) = output.zip(json) {
        let text = serde_json::to_string_pretty(&report).unwrap_or_default() + "\n";
        write(output, path, &text)?;
    }
    if let Some(picture) = picture {
        let title = format!("What accuracy costs: {}", report.scene);
        picture.save(title, plot(&report.rows))?;
    }
    if json != Some(Path::new(STDOUT)) {
        tables(&report)?;
    }
    Ok(())
}
