//! `whiskmap status`.

use super::failure::{Failure, say};
use clap::Args;
use std::io::Write;
use std::path::PathBuf;
use whiskmap::classify::Regime;
use whiskmap::store::ZarrStore;

/// Options of `status`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap status outputs/sweep.zarr
  whiskmap status outputs/sweep.zarr --verify

The exit code is 0 only when every block is there and, with --verify, sound. A damaged file may be removed: the next run \
with --resume makes it again.")]
pub struct Options {
    /// Store written by `whiskmap map --format zarr`
    store: PathBuf,
    /// Decode every file
    #[arg(long)]
    verify: bool,
}

/// Runs `status`.
pub fn run(options: &Options) -> Result<(), Failure> {
    let store = ZarrStore::open(&options.store)?;
    let all = store.block_count();
    let (done, missing): (Vec<usize>, Vec<usize>) =
        (0..all).partition(|block| store.is_done(*block));
    let mut damaged = 0;
    let mut regimes = [0; Regime::ALL.len()];
    for block in &done {
        let faults = if options.verify {
            store.verify(*block)
        } else {
            Vec::new()
        };
        for fault in &faults {
            say(&format!("error: {fault}"));
        }
        let cells = store.regimes(*block);
        if let (true, Err(fault)) = (faults.is_empty(), &cells) {
            say(&format!("error: {fault}"));
        }
        damaged += usize::from(!faults.is_empty() || cells.is_err());
        for (sum, cells) in regimes.iter_mut().zip(cells.unwrap_or_default()) {
            *sum += cells;
        }
    }
    let panel = store.grid().push_angle_deg.len() * store.grid().distance_mm.len();
    let cells = panel * store.grid().whisker_count();
    let mut out = std::io::stdout().lock();
    writeln!(out, "{}", store.title())?;
    writeln!(out, "{:>12}  of {all} blocks", done.len())?;
    writeln!(out, "{:>12}  of {cells} cells", regimes.iter().sum::<u64>())?;
    for (regime, cells) in Regime::ALL.iter().zip(regimes) {
        if cells > 0 {
            writeln!(out, "{cells:>12}  {}", regime.name())?;
        }
    }
    if !missing.is_empty() {
        writeln!(out, "missing blocks: {}", ranges(&missing))?;
    }
    if missing.is_empty() && damaged == 0 {
        return Ok(());
    }
    Err(Failure::Incomplete {
        store: options.store.clone(),
        missing: missing.len(),
        damaged,
    })
}

/// Growing numbers with their runs drawn together.
fn ranges(numbers: &[usize]) -> String {
    let runs = numbers.chunk_by(|one, next| one + 1 == *next);
    let runs = runs.map(|run| match run {
        [first, .., last] => format!("{first}-{last}"),
        only => only[0].to_string(),
    });
    runs.collect::<Vec<_>>().join(", ")
}
