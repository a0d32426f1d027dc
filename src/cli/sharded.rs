//! `whiskmap map --format zarr`: a run fills some blocks of a store.

use super::estimate::Format;
use super::failure::{Failure, check_resolved, say};
use super::progress::Progress;
use super::summary::print;
use super::{disk, signals};
use rayon::prelude::*;
use std::path::Path;
use std::str::FromStr;
use std::time::Instant;
use whiskmap::engine::Engine;
use whiskmap::map::{self, Panel};
use whiskmap::plan::Plan;
use whiskmap::scene::Scene;
use whiskmap::store::{
    self, BlockState, CheckDepth, Description, PackedPanel, TemporaryFiles, ZarrStore,
};

/// The blocks that one of `count` processes computes: every `count`-th.
#[derive(Clone, Copy, Debug)]
pub struct Shard {
    index: usize,
    count: usize,
}

impl Shard {
    fn has(self, block: usize) -> bool {
        block % self.count == self.index
    }
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

/// What a run does to a store.
pub struct Run<'a> {
    /// The part of it that the run computes; all without it.
    pub shard: Option<Shard>,
    /// Whether blocks that are there are left as they are.
    pub resume: bool,
    /// Whether it starts although the disk seems to have too little room.
    pub force: bool,
    /// What solves cells in place of the refinement.
    pub engine: Option<&'a mut dyn Engine>,
    /// Why it was taken.
    pub why: String,
}

impl Run<'_> {
    /// Computes the blocks that are due, and writes each when it is done.
    pub fn fill(
        self,
        path: &Path,
        scene: &Scene,
        mut plan: Plan,
        about: &Description<'_>,
        temporary: &TemporaryFiles,
    ) -> Result<(), Failure> {
        let start = Instant::now();
        let may_exist = self.resume || self.shard.is_some();
        let store = ZarrStore::join(path, scene, about, may_exist)?;
        let is_ours = |block: &usize| self.shard.is_none_or(|shard| shard.has(*block));
        let mut blocks: Vec<usize> = (0..store.block_count()).filter(is_ours).collect();
        if self.resume {
            blocks = unfinished(&store, blocks)?;
        }
        plan.parts = blocks.iter().map(|block| store.whiskers(*block)).collect();
        let panel = scene.grid.push_angle_deg.len() * scene.grid.distance_mm.len();
        let whiskers: usize = plan.parts.iter().map(ExactSizeIterator::len).sum();
        if !self.force {
            let folder = path.parent().unwrap_or(path);
            disk::check(folder, Format::Zarr, scene, &plan, panel * whiskers)?;
        }
        for file in store.begin(temporary)? {
            say(&format!(
                "warning: {} was damaged: written again",
                file.display()
            ));
        }
        say(&format!(
            "engine: {} ({}); blocks: {} of {}",
            about.engine.engine,
            self.why,
            blocks.len(),
            store.block_count()
        ));
        signals::advise("finished blocks stay: go on by the same command with --resume");

        let bar = Progress::over(panel * whiskers, "cells");
        let mut due = blocks
            .iter()
            .map(|block| (*block, store.whiskers(*block).len()));
        let mut next = due.next();
        let mut packed: Vec<PackedPanel> = Vec::new();
        let mut keep = |panels: Vec<Panel>| {
            let panels = panels.par_iter();
            let panels = panels.map(|panel| store.pack(panel));
            packed.extend(panels.collect::<Result<Vec<_>, _>>()?);
            if let Some((block, whiskers)) = next
                && packed.len() == whiskers
            {
                store.write(block, &packed, temporary)?;
                packed.clear();
                next = due.next();
            }
            Ok::<(), store::Error>(())
        };
        let mut settled = |cells| bar.inc(cells);
        let result = map::run(scene, &plan, self.engine, &mut settled, &mut keep);
        bar.finish();
        let summary = result?;
        if let Some(failure) = &summary.engine_failure {
            say(&format!("warning: {failure}; the CPU went on in its stead"));
        }
        print(
            scene,
            &summary,
            start.elapsed().as_secs_f64(),
            &[path.to_owned()],
        )?;
        let see = "the channel `status`";
        check_resolved(summary.unresolved(), summary.cells(), "cells", see)
    }
}

/// The `blocks` that are missing or damaged, each damaged file with a warning. A file that cannot be read may be whole: it ends
/// the run.
fn unfinished(store: &ZarrStore, blocks: Vec<usize>) -> Result<Vec<usize>, Failure> {
    let states: Vec<BlockState> = blocks
        .par_iter()
        .map(|block| store.state(*block, CheckDepth::Checksums))
        .collect();
    let mut unfinished = Vec::new();
    for (block, state) in blocks.into_iter().zip(states) {
        match state {
            BlockState::Done => continue,
            BlockState::Missing => {}
            BlockState::Damaged(faults) => {
                for fault in faults {
                    say(&format!("warning: {fault}: its block is computed again"));
                }
            }
            BlockState::Unreadable(faults) => {
                faults.into_iter().next().map_or(Ok(()), Err)?;
            }
        }
        unfinished.push(block);
    }
    Ok(unfinished)
}
