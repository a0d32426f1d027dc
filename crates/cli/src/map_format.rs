//! Option `--format`: the format of a stored map.

use clap::ValueEnum;
use whiskmap::map::Panel;
use whiskmap::plan::{Plan, PlanError};
use whiskmap::scene::Scene;
use whiskmap::store::{MapWriter, ZarrStore};

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MapFormat {
    /// One OpenEXR file, and a picture of it
    Exr,
    /// A Zarr store, for any number of axes, runs and machines
    Zarr,
}

impl MapFormat {
    /// Returns the formats that can hold a map of `scene`.
    pub fn of(scene: &Scene) -> Vec<Self> {
        let mut formats = vec![Self::Exr, Self::Zarr];
        formats.retain(|format| *format == Self::Zarr || scene.grid.sweep.len() <= 2);
        formats
    }

    /// Returns the plan of a map of `scene` in this format.
    pub fn plan(self, scene: &Scene) -> Result<Plan, PlanError> {
        match (self, scene.whisker_count()) {
            (Self::Exr, _) | (_, 1) => Plan::in_bands(scene),
            (Self::Zarr, _) => {
                let whiskers = ZarrStore::blocks(&scene.grid).map(|block| block.len());
                // One block is written while the next one is computed.
                let most = whiskers.max().unwrap_or(1);
                Plan::in_blocks(scene, scene.whisker_count().min(2 * most))
            }
        }
    }

    /// Packs some panels of `scene`. Returns the number of bytes.
    pub fn pack(self, scene: &Scene, plan: &Plan, panels: &[Panel]) -> u64 {
        match self {
            Self::Exr => MapWriter::sample(&scene.grid, plan, panels),
            Self::Zarr => ZarrStore::sample(scene, plan, panels),
        }
    }
}
