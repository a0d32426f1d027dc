//! Command `whiskmap bench`.

mod plot;
mod tables;

use super::failure::{Failure, message};
use super::files::{Files, STDOUT};
use super::outputs::{PlotArgs, write};
use clap::Args;
use plot::chart;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use tables::tables;
use whiskmap::bench::{self, Effort, Peers};

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap bench scenes/cone.toml
  whiskmap bench scenes/cone.toml --quick --json bench.json --plot bench.svg
  whiskmap bench scenes/cone.toml --plot bench.svg --peers outputs/peers.json

Every engine solves a sample of the scene's states: at most 512 push angles, 128 distances (--quick: 256 and 64) and two values per sweep \
axis. The CPU computes scalars, vectors on one thread and vectors on all threads, with 3 to 30 steps of order 8 at the fold, fewer \
below. The spectral engine evaluates expansions with five bounds on the residual. Their one-time cost has a table of its own, with the number \
of states per whisker side from which on it pays. Each GPU adapter evaluates expansions of rows in f32 and, if supported, in f64. The time for \
nets, and cells that an engine cannot certify, do not count. Errors are differences from four times the default steps: of the \
push angle, of the contact's arclength in whisker lengths, and of its force. * marks rows that no other row beats in time and \
worst push-angle error. Times are medians of at least 5 runs after one that does not count. The spread is the difference \
of the slowest and the fastest run over the median, in percent or from 10 times on as a multiple; ! marks rows in which it is more than 20 %.

Plain trajectories are integrated by the CPU on all threads and by each GPU adapter, at the default steps: their rate with transfers, and the \
largest distance of a pole from that of the CPU, in whisker lengths.

Then the CPU engine, the spectral engine and the GPUs compute whole maps in turn, packed but not written: at most 1024 x 1024 cells (--quick: 256 x 256) and two \
values per sweep axis. host is the CPU time per cell of all threads, including those of a software adapter. for devices is the \
part of the stages, guesses and refinement, that a device could still compute. Stages are wall milliseconds. rows are the \
expansions of rows, which the spectral engine and a GPU need. device and packing overlap the other stages; waiting is for the device. The \
verdicts compare the two engines on the CPU, and each GPU with the faster one of them.")]
pub struct BenchArgs {
    /// Scene file; - is standard input
    scene: PathBuf,
    /// Write all measurements to FILE, as JSON; - is standard output, without the tables
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    #[command(flatten)]
    picture: PlotArgs,
    /// Plot the programs of FILE as well, which benches/peers/run.sh writes; - is standard input
    #[arg(long, value_name = "FILE", requires = "plot")]
    peers: Option<PathBuf>,
    /// Use a smaller sample and fewer runs
    #[arg(long)]
    quick: bool,
}

pub fn run(args: &BenchArgs, files: &mut Files) -> Result<(), Failure> {
    files.inputs("--peers", &args.peers)?;
    let scene = files.scene(&args.scene)?;
    let peers = args.peers.as_deref().map(Peers::read).transpose()?;
    let json = args.json.as_deref();
    let output = json.map(|path| files.output("--json", path)).transpose()?;
    let picture = args.picture.open(files)?;
    let effort = if args.quick { Effort::QUICK } else { Effort::FULL };
    let watched = std::io::stderr().is_terminal();
    let report = bench::run(&scene, effort, &mut |next| {
        if watched {
            message(&format!("measuring {next}"));
        }
    })?;
    let report = report.ok_or_else(|| {
        Failure::Input(
            "grid: no cell of the sample has a state; give push angles and distances that keep the contact".to_owned(),
        )
    })?;
    if let Some(output) = output {
        let text = serde_json::to_string_pretty(&report).unwrap_or_default() + "\n";
        write(output, text.as_bytes())?;
    }
    if let Some(picture) = picture {
        let chart = chart(&report.scene, &report.rows, peers.as_ref());
        picture.chart(&chart)?;
    }
    if json != Some(Path::new(STDOUT)) {
        tables(&report)?;
    }
    Ok(())
}
