//! Packing and writing of panels as the files of a block.

use super::array::ZarrArray;
use super::files::write;
use super::metadata::CELLS;
use super::{ZarrStore, shard};
use crate::classify::Regime;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::store::{Panel, StoreError, TemporaryFiles};
use rayon::prelude::*;
use serde_json::Map;
use std::borrow::Cow;
use std::path::Path;

/// Values of one panel, packed: `[array][chunk][byte]`, in the order of the store's arrays.
#[derive(Debug)]
pub struct PackedPanel(Vec<Vec<Vec<u8>>>);

impl ZarrStore {
    /// Compresses the values of one panel into the chunks of each array.
    #[must_use]
    pub fn pack(&self, panel: &Panel) -> PackedPanel {
        let arrays = self.arrays.par_iter();
        let packed = arrays.map(|array| array.pack(&values(&array.name, panel)));
        PackedPanel(packed.collect())
    }

    /// Packs `panels` of a run of `plan`, and returns how many bytes they take without headers.
    #[must_use]
    pub fn sample(scene: &Scene, plan: &Plan, panels: &[Panel]) -> u64 {
        let stored = (plan.channels.with("regime"), plan.digits);
        let store = Self::new(Path::new(""), Map::new(), scene.clone(), stored);
        let packed = panels.iter().map(|panel| store.pack(panel));
        let chunks = packed.flat_map(|panel| panel.0.into_iter().flatten());
        chunks.map(|chunk| chunk.len() as u64).sum()
    }

    /// Writes the panels of a block into the store.
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
        let put = |(index, array): (usize, &ZarrArray)| {
            let file = self.file(array, block);
            let room = self.blocks.slots();
            let missing = (panels.len() < room).then(|| array.pack_fill(room));
            let missing = missing.unwrap_or_default();
            let mut slots = vec![&missing; room];
            for (place, panel) in panels.iter().enumerate() {
                slots[self.blocks.slot(block, place)] = &panel.0[index];
            }
            let chunks = slots.into_iter().flatten().map(Vec::as_slice);
            let identity = self.expected(array, &file).identity;
            write(&file, &shard::assemble(identity, chunks), temporary)
        };
        let last = self.arrays.len() - 1;
        let others = self.arrays[..last].par_iter().enumerate();
        others.try_for_each(put)?;
        put((last, &self.arrays[last]))
    }
}

/// The values of a panel for the array `name`, as bytes.
fn values<'a>(name: &str, panel: &'a Panel) -> Cow<'a, [u8]> {
    match name {
        "regime" | "status" => {
            let codes: &[u32] = bytemuck::cast_slice(panel.bytes(name));
            codes.iter().map(|code| *code as u8).collect()
        }
        CELLS => {
            let count = |regime: Regime| {
                let codes = panel.regime.iter();
                codes.filter(|code| **code == regime.code()).count() as u32
            };
            bytemuck::pod_collect_to_vec(&Regime::ALL.map(count)).into()
        }
        _ => panel.bytes(name).into(),
    }
}
