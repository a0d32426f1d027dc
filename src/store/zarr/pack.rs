//! Packing and writing of panels as the files of a block.

use super::array::ZarrArray;
use super::files::{on_threads, write};
use super::metadata::CELLS;
use super::{ZarrStore, shard};
use crate::classify::Regime;
use crate::map::Panel;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::store::{StoreError, TemporaryFiles};
use rayon::prelude::*;
use serde_json::Map;
use std::borrow::Cow;
use std::path::Path;

/// Values of one panel, or of its first bands, packed.
#[derive(Debug)]
pub struct PackedPanel {
    /// Chunks of each array of the store, in their order: `[array][chunk][byte]`. The array of the `counts` has none yet.
    chunks: Vec<Vec<Vec<u8>>>,
    /// Number of cells of each regime, `[regime]`.
    counts: [u32; Regime::ALL.len()],
}

impl PackedPanel {
    /// Returns the number of cells that are packed.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.counts.iter().map(|count| *count as usize).sum()
    }

    /// Appends the next band of the panel.
    pub fn append(&mut self, band: Self) {
        for (chunks, of_band) in self.chunks.iter_mut().zip(band.chunks) {
            chunks.extend(of_band);
        }
        for (count, of_band) in self.counts.iter_mut().zip(band.counts) {
            *count += of_band;
        }
    }
}

impl ZarrStore {
    /// Compresses the values of one panel into the chunks of each array. A panel may come in bands of whole chunks
    /// ([`rows_of_band`](crate::plan::rows_of_band)), which are packed one by one and appended.
    #[must_use]
    pub fn pack(&self, panel: &Panel) -> PackedPanel {
        let counts = Regime::ALL.map(|regime| {
            let codes = panel.regime.iter();
            codes.filter(|code| **code == regime.code()).count() as u32
        });
        let arrays = self.arrays.par_iter();
        let packed = arrays.map(|array| match array.name.as_str() {
            CELLS => Vec::new(),
            name => array.pack(&values(name, panel)),
        });
        PackedPanel { chunks: packed.collect(), counts }
    }

    /// Packs `panels` of a run of `plan`, and returns how many bytes they take without headers.
    #[must_use]
    pub fn sample(scene: &Scene, plan: &Plan, panels: &[Panel]) -> u64 {
        let stored = (plan.channels.with("regime"), plan.digits);
        let store = Self::new(Path::new(""), Map::new(), scene.clone(), stored);
        let packed = panels.iter().map(|panel| store.pack(panel));
        let chunks = packed.flat_map(|panel| panel.chunks.into_iter().flatten());
        chunks.map(|chunk| chunk.len() as u64).sum()
    }

    /// Writes the panels of a block into the store. [`ZarrStore::sync`] ends a run.
    ///
    /// # Errors
    /// The disk is full, the folder is not writable, or the store is no longer at its path.
    pub fn write(
        &self,
        block: usize,
        panels: &[PackedPanel],
        temporary: &TemporaryFiles,
    ) -> Result<(), StoreError> {
        self.check_place()?;
        let put = |(index, array): &(usize, &ZarrArray)| {
            let file = self.file(array, block);
            let room = self.blocks.slots();
            let missing = (panels.len() < room).then(|| array.pack_fill(room));
            let missing = missing.unwrap_or_default();
            let counted = panels.iter().filter(|_| array.name == CELLS);
            let packed = counted.map(|panel| array.pack(bytemuck::cast_slice(&panel.counts)));
            let counts: Vec<Vec<Vec<u8>>> = packed.collect();
            let mut slots = vec![&missing; room];
            for (place, panel) in panels.iter().enumerate() {
                let packed = counts.get(place).unwrap_or(&panel.chunks[*index]);
                slots[self.blocks.slot(block, place)] = packed;
            }
            let chunks = slots.into_iter().flatten().map(Vec::as_slice);
            let identity = self.expected(array, &file).identity;
            write(&file, &shard::assemble(identity, chunks), temporary)
        };
        let arrays: Vec<(usize, &ZarrArray)> = self.arrays.iter().enumerate().collect();
        let Some((last, others)) = arrays.split_last() else {
            return Ok(());
        };
        let written = on_threads(others, put);
        written.into_iter().collect::<Result<(), _>>()?;
        put(last)
    }
}

/// The values of a panel for the array `name`, as bytes.
fn values<'a>(name: &str, panel: &'a Panel) -> Cow<'a, [u8]> {
    match name {
        "regime" | "status" => {
            let codes: &[u32] = bytemuck::cast_slice(panel.bytes(name));
            codes.iter().map(|code| *code as u8).collect()
        }
        _ => panel.bytes(name).into(),
    }
}
