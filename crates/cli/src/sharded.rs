//! Command `whiskmap map --format zarr`: computation of some blocks of a store.

use super::disk;
use super::failure::{Failure, message};
use super::files::Files;
use super::map_format::MapFormat;
use super::solver::compute;
use super::summary::report;
use clap::Args;
use rayon::prelude::*;
use std::iter::Sum;
use std::mem;
use std::panic::resume_unwind;
use std::path::Path;
use std::str::FromStr;
use std::thread::{self, ScopedJoinHandle};
use std::time::Instant;
use whiskmap::engine::Engine;
use whiskmap::map::{Panel, Summary};
use whiskmap::plan::Plan;
use whiskmap::scene::Scene;
use whiskmap::store::{
    BlockState, CheckDepth, MapDescription, PackedPanel, StoreError, TemporaryFiles, ZarrStore,
};

/// Shard of a store: the blocks of one of `count` processes, every `count`-th block.
#[derive(Clone, Copy, Debug)]
pub struct Shard {
    pub index: usize,
    pub count: usize,
}

impl Shard {
    fn has(self, block: usize) -> bool {
        block % self.count == self.index
    }
}

/// Share of a store that one of several processes computes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShardShare {
    pub blocks: usize,
    pub whiskers: usize,
}

impl Sum for ShardShare {
    fn sum<I: Iterator<Item = Self>>(shares: I) -> Self {
        shares.fold(Self::default(), |sum, share| Self {
            blocks: sum.blocks + share.blocks,
            whiskers: sum.whiskers + share.whiskers,
        })
    }
}

/// Returns the shares of `count` shards of a store of `scene`, `[shard]`.
///
/// # Errors
/// If there are more shards than blocks.
pub fn shares(scene: &Scene, count: usize) -> Result<Vec<ShardShare>, Failure> {
    let blocks = ZarrStore::blocks(&scene.grid);
    if count > blocks.len() {
        return Err(Failure::Input(format!(
            "--shards {count}: must be at most {}, the number of blocks of this sweep",
            blocks.len()
        )));
    }
    let mut shares = vec![ShardShare::default(); count];
    for (block, whiskers) in blocks.enumerate() {
        let share = &mut shares[block % count];
        share.blocks += 1;
        share.whiskers += whiskers.len();
    }
    Ok(shares)
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(index, count)| {
            let [index, count] = [index, count].map(|number| number.parse().ok());
            Some((index?, count?))
        });
        match numbers {
            Some((index, count)) if index < count => Ok(Self { index, count }),
            _ => Err("must be I/N with I from 0 to N-1, such as 0/8".to_owned()),
        }
    }
}

#[derive(Debug, Args)]
pub struct RunArgs {
    /// Resume an interrupted sweep: compute only missing and damaged blocks of the store
    #[arg(long)]
    pub resume: bool,
    /// Compute one of N parts of a store, from 0/N to N-1/N
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Shard>,
    /// Refuse a table of whiskers that has a row without a whisker
    #[arg(long)]
    pub strict: bool,
    /// Start even if the disk seems to have too little space
    #[arg(long)]
    pub force: bool,
}

/// Computes the blocks of this run for the store at `path`, and writes each as soon as it is finished.
pub fn fill(
    path: &Path,
    args: &RunArgs,
    files: &mut Files,
    scene: &Scene,
    mut plan: Plan,
    about: &MapDescription<'_>,
    (engine, why): (&mut Option<Box<dyn Engine>>, &str),
) -> Result<(), Failure> {
    files.store("--output", path)?;
    let temporary = files.temporary();
    let start = Instant::now();
    let may_exist = args.resume || args.shard.is_some();
    let store = ZarrStore::join(path, scene, about, may_exist)?;
    let is_ours = |block: &usize| args.shard.is_none_or(|shard| shard.has(*block));
    let mut blocks: Vec<usize> = (0..store.block_count()).filter(is_ours).collect();
    if args.resume {
        blocks = unfinished(&store, blocks)?;
    }
    plan.parts = blocks.iter().map(|block| store.whiskers(*block)).collect();
    if !args.force {
        let folder = path.parent().unwrap_or(path);
        disk::check(folder, MapFormat::Zarr, scene, &plan)?;
    }
    for file in store.begin(temporary)? {
        message(&format!("warning: {} was damaged: rewritten", file.display()));
    }
    message(&format!(
        "engine: {} ({}); blocks: {} of {}",
        about.engine.engine,
        why,
        blocks.len(),
        store.block_count()
    ));
    let summary = write_blocks(path, &store, scene, &plan, &blocks, engine, temporary)?;
    store.sync()?;
    report(scene, &summary, start, &[path.to_owned()])
}

/// Computes the panels of `blocks` of the store, and writes each block as soon as its last panel is finished.
fn write_blocks(
    path: &Path,
    store: &ZarrStore,
    scene: &Scene,
    plan: &Plan,
    blocks: &[usize],
    engine: &mut Option<Box<dyn Engine>>,
    temporary: &TemporaryFiles,
) -> Result<Summary, Failure> {
    let cells_of_panel = plan.cells / plan.whiskers;
    let mut due = blocks.iter().zip(&plan.parts);
    let mut next = due.next();
    let mut packed: Vec<PackedPanel> = Vec::new();
    thread::scope(|scope| {
        let mut writing = None;
        let keep = |panels: &mut Vec<Panel>| {
            let bands = panels.par_iter().map(|panel| store.pack(panel));
            for band in bands.collect::<Vec<_>>() {
                match packed.last_mut().filter(|last| last.cells() < cells_of_panel) {
                    Some(begun) => begun.append(band),
                    None => packed.push(band),
                }
            }
            let is_whole = packed.last().is_some_and(|last| last.cells() == cells_of_panel);
            if let Some((&block, whiskers)) = next
                && is_whole
                && packed.len() == whiskers.len()
            {
                // The disk takes longer than the next panels, so it has a thread of its own.
                let panels = mem::take(&mut packed);
                let write = move || store.write(block, &panels, temporary);
                let thread = thread::Builder::new()
                    .spawn_scoped(scope, write)
                    .map_err(|why| StoreError::Write(path.to_owned(), why))?;
                written(writing.replace(thread))?;
                next = due.next();
            }
            Ok(())
        };
        let summary = compute(scene, plan, engine, keep)?;
        written(writing)?;
        Ok(summary)
    })
}

/// Waits until a thread has written its block.
fn written(thread: Option<ScopedJoinHandle<'_, Result<(), StoreError>>>) -> Result<(), StoreError> {
    thread.map_or(Ok(()), |thread| {
        let ended = thread.join();
        ended.unwrap_or_else(|panic| resume_unwind(panic))
    })
}

/// Returns the missing and damaged ones of `blocks`, and warns of each damaged file.
///
/// # Errors
/// If a file cannot be read, because it may be complete.
fn unfinished(store: &ZarrStore, blocks: Vec<usize>) -> Result<Vec<usize>, Failure> {
    let states: Vec<BlockState> =
        blocks.par_iter().map(|block| store.state(*block, CheckDepth::Values)).collect();
    let mut unfinished = Vec::new();
    for (block, state) in blocks.into_iter().zip(states) {
        match state {
            BlockState::Done => continue,
            BlockState::Damaged(faults) => {
                for fault in faults {
                    message(&format!("warning: {fault}: its block is recomputed"));
                }
            }
            BlockState::Unreadable(faults) => {
                faults.into_iter().next().map_or(Ok(()), Err)?;
            }
            _ => {}
        }
        unfinished.push(block);
    }
    Ok(unfinished)
}
