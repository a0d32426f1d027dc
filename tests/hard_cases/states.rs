//! States of a map in `f64`, and their difference from states with halved steps.

use rayon::prelude::*;
use whiskmap::mechanics::rod::{Effects, Rod, Side};
use whiskmap::mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap::mechanics::shooting::{Resolution, ShootingMap};
use whiskmap::refine::{self, CellTarget, RefineOutcome, Refined};
use whiskmap::scene::Scene;
use whiskmap::sheet::Sheet;

/// Cells of one whisker that have a guess, on both sides.
pub struct Shots {
    pub effects: Effects,
    pub sheets: Vec<Sheet>,
    pub shots: Vec<CellTarget>,
}

impl Shots {
    pub fn new(scene: &Scene) -> Self {
        let length = scene.whisker.length_mm;
        let distances: Vec<f64> = scene.grid.distance_mm.iter().map(|d| d / length).collect();
        let rods = Side::BOTH.map(|side| scene.whisker.rod(&scene.pole, side));
        let effects = Effects::of(&rods);
        let pairs: Vec<(Side, Rod)> = Side::BOTH.into_iter().zip(rods).collect();
        let sheets: Vec<Sheet> = pairs
            .par_iter()
            .map(|(side, rod)| {
                Sheet::new(Method::fine().with_effects(effects), rod, *side, &distances)
            })
            .collect();
        let mut shots = Vec::new();
        for (index, sheet) in (0..).zip(&sheets) {
            shots.extend(refine::cell_targets(
                sheet,
                index,
                &scene.grid.push_angle_deg,
            ));
        }
        Self {
            effects,
            sheets,
            shots,
        }
    }

    /// Refined states of the cells, one per shot.
    pub fn refined(&self) -> Vec<Refined> {
        let sheets: Vec<&Sheet> = self.sheets.iter().collect();
        let method = Method::fine().with_effects(self.effects);
        refine::refine(method, &sheets, &self.shots)
    }

    /// Initial conditions of the solved `cells`.
    pub fn conditions(&self, cells: &[Refined]) -> Vec<InitialCondition<'_>> {
        let solved = cells.iter().zip(&self.shots);
        solved
            .filter(|(cell, _)| cell.outcome == RefineOutcome::Solved)
            .map(|(cell, shot)| InitialCondition {
                rod: &self.sheets[shot.rod as usize].rod,
                tau: cell.state.tau,
                load: cell.state.load,
            })
            .collect()
    }
}

/// Change of the pole of each of `conditions` if the steps of `resolution` are halved, in whisker lengths.
pub fn halving(
    effects: Effects,
    conditions: &[InitialCondition],
    resolution: Resolution,
) -> Vec<f64> {
    let poles = |resolution| {
        let method = Method::new(resolution).with_effects(effects);
        Batch::new(method)
            .shoot::<ShootingMap>(conditions)
            .into_iter()
    };
    let moved = |(a, b): (ShootingMap, ShootingMap)| a.pole.distance(b.pole);
    poles(resolution)
        .zip(poles(resolution.doubled()))
        .map(moved)
        .collect()
}
