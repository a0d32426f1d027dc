//! Command `whiskmap status`.

use super::failure::{Failure, message};
use clap::Args;
use rayon::prelude::*;
use std::io::Write;
use std::ops::Range;
use std::path::PathBuf;
use whiskmap::classify::Regime;
use whiskmap::plan::Digits;
use whiskmap::store::{BlockState, CheckDepth, StoreError, TemporaryFiles, ZarrStore};
use whiskmap::terminal::StandardOutput;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap map scenes/morphology.toml --format zarr
  whiskmap status outputs/morphology.zarr
  whiskmap status outputs/morphology.zarr --verify
  whiskmap status outputs/morphology.zarr --repair

The exit code is 0 only if every block is finished and no file is damaged. Without --verify, only identity, length and index \
of each file are checked. After --repair, `whiskmap map --resume` recomputes the removed blocks.")]
pub struct StatusArgs {
    /// Store written by `whiskmap map --format zarr`
    store: PathBuf,
    /// Decode every file, and compare metadata and coordinates with the scene
    #[arg(long)]
    verify: bool,
    /// Verify, remove damaged blocks, and rewrite damaged metadata
    #[arg(long)]
    repair: bool,
}

/// Blocks of a store by their state.
#[derive(Default)]
struct StoreBlocks {
    done: usize,
    missing: Vec<Range<usize>>,
    damaged: Vec<usize>,
    faults: Vec<StoreError>,
    regimes: [u64; Regime::ALL.len()],
}

/// Number of blocks that are checked in parallel.
const TOGETHER: usize = 4096;

impl StoreBlocks {
    fn in_store(store: &ZarrStore, depth: CheckDepth) -> Self {
        let mut found = Self::default();
        let all = store.block_count();
        for first in (0..all).step_by(TOGETHER) {
            let blocks = (first..all.min(first + TOGETHER)).into_par_iter();
            let states: Vec<_> = blocks
                .map(|block| match store.state(block, depth) {
                    BlockState::Done => {
                        store.regimes(block).map_err(|fault| BlockState::Damaged(vec![fault]))
                    }
                    state => Err(state),
                })
                .collect();
            for (block, state) in (first..).zip(states) {
                found.add(block, state);
            }
        }
        found
    }

    fn add(&mut self, block: usize, state: Result<[u64; Regime::ALL.len()], BlockState>) {
        match state {
            Ok(regimes) => {
                self.done += 1;
                for (sum, cells) in self.regimes.iter_mut().zip(regimes) {
                    *sum += cells;
                }
            }
            Err(BlockState::Damaged(faults) | BlockState::Unreadable(faults)) => {
                self.damaged.push(block);
                self.faults.extend(faults);
            }
            Err(_) => match self.missing.last_mut() {
                Some(run) if run.end == block => run.end += 1,
                _ => self.missing.push(block..block + 1),
            },
        }
    }
}

pub fn run(args: &StatusArgs, temporary: &TemporaryFiles) -> Result<(), Failure> {
    let store = ZarrStore::open(&args.store).map_err(unreadable)?;
    let is_thorough = args.verify || args.repair;
    let depth = if is_thorough { CheckDepth::Values } else { CheckDepth::Structure };
    let metadata = match store.metadata_faults() {
        // Without --verify, a store of another version is not a failure.
        Err(StoreError::OtherVersion(..)) if !is_thorough => Vec::new(),
        faults => faults?,
    };
    let found = StoreBlocks::in_store(&store, depth);
    for fault in metadata.iter().chain(&found.faults) {
        message(&format!("error: {fault}"));
    }
    report(&store, &found)?;
    if args.repair {
        repair(&store, &found, metadata.len(), temporary)?;
    }
    let missing = found.missing.iter().map(ExactSizeIterator::len).sum();
    let (damaged, metadata) = (found.damaged.len(), metadata.len());
    let is_sound = missing == 0 && damaged == 0 && (metadata == 0 || args.repair);
    if is_sound {
        return Ok(());
    }
    Err(Failure::Incomplete { store: args.store.clone(), missing, damaged, metadata })
}

/// Returns the failure of a store that cannot be opened, with what may repair its root.
fn unreadable(why: StoreError) -> Failure {
    match why {
        StoreError::NotAStore(..) | StoreError::Damaged(..) => Failure::Input(format!(
            "{why}; if `map` wrote the folder, `map SCENE --resume` with the same options rewrites its zarr.json"
        )),
        why => why.into(),
    }
}

fn report(store: &ZarrStore, found: &StoreBlocks) -> Result<(), Failure> {
    let grid = &store.scene.grid;
    let cells = grid.panel_cells() * grid.whisker_count();
    let mut out = StandardOutput::open();
    writeln!(out, "{}", store.scene.title)?;
    writeln!(out, "{:>12}  of {} blocks", found.done, store.block_count())?;
    writeln!(out, "{:>12}  of {cells} cells", found.regimes.iter().sum::<u64>())?;
    for (regime, cells) in Regime::ALL.iter().zip(found.regimes) {
        if cells > 0 {
            writeln!(out, "{cells:>12}  {}", regime.name())?;
        }
    }
    if store.digits != Digits::ALL {
        writeln!(out, "rounded to digits: {}", store.digits)?;
    }
    if !found.missing.is_empty() {
        writeln!(out, "missing blocks: {}", ranges(&found.missing))?;
    }
    if !found.damaged.is_empty() {
        let damaged: Vec<_> = found.damaged.iter().map(|&block| block..block + 1).collect();
        writeln!(out, "damaged blocks: {}", ranges(&damaged))?;
    }
    Ok(())
}

/// Removes damaged blocks, rewrites metadata, and prints the numbers of both.
fn repair(
    store: &ZarrStore,
    found: &StoreBlocks,
    metadata: usize,
    temporary: &TemporaryFiles,
) -> Result<(), Failure> {
    store.restore_metadata(temporary)?;
    let mut removed = 0;
    for block in &found.damaged {
        removed += usize::from(store.remove_damaged(*block)?);
    }
    store.sync()?;
    let mut out = StandardOutput::open();
    writeln!(out, "metadata rewritten: {metadata}")?;
    writeln!(out, "blocks removed: {removed}")?;
    Ok(())
}

/// Formats runs of numbers, such as `0-3, 7`.
fn ranges(runs: &[Range<usize>]) -> String {
    let runs = runs.iter().map(|run| match run.len() {
        1 => run.start.to_string(),
        _ => format!("{}-{}", run.start, run.end - 1),
    });
    runs.collect::<Vec<_>>().join(", ")
}
