//! The states of a map in `f64`, and how far they are from those of twice as many steps.

use glam::DVec2;
use rayon::prelude::*;
use whiskmap::integrate::{Engine, Hit, Outcome, Shot};
use whiskmap::refine::{self, End, Refined};
use whiskmap::rod::{Effects, Rod, Side};
use whiskmap::scene::Scene;
use whiskmap::sheet::Sheet;
use whiskmap::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap::shooting::{Resolution, ShootingMap};

/// The cells of one whisker that have a guess, on both sides.
pub struct Shots {
    pub effects: Effects,
    pub sheets: Vec<Sheet>,
    pub shots: Vec<Shot>,
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
            shots.extend(refine::shots(sheet, index, &scene.grid.push_angle_deg));
        }
        Self {
            effects,
            sheets,
            shots,
        }
    }

    pub fn rods(&self) -> Vec<Rod> {
        self.sheets.iter().map(|sheet| sheet.rod.clone()).collect()
    }

    /// What the refinement starts from without an engine.
    pub fn guesses(&self) -> Vec<Hit> {
        self.shots.iter().map(Hit::untouched).collect()
    }

    pub fn shoot(&self, engine: &mut dyn Engine) -> Vec<Hit> {
        let rods = self.rods();
        engine.shoot(self.effects, &rods, &self.shots).unwrap()
    }

    /// What the refinement makes of `hits`.
    pub fn refined(&self, hits: &[Hit]) -> Vec<Refined> {
        let starts = hits.iter().zip(&self.shots).map(|(hit, shot)| {
            if hit.outcome == Outcome::Converged {
                (hit.tau, hit.load)
            } else {
                (shot.tau, shot.load)
            }
        });
        let starts: Vec<(f64, f64)> = starts.collect();
        let sheets: Vec<&Sheet> = self.sheets.iter().collect();
        refine::refine(
            Method::fine().with_effects(self.effects),
            &sheets,
            &self.shots,
            &starts,
        )
    }

    /// The trajectories that end at these states.
    pub fn conditions(&self, cells: &[Refined]) -> Vec<InitialCondition<'_>> {
        let solved = cells.iter().zip(&self.shots);
        solved
            .filter(|(cell, _)| cell.end == End::Solved)
            .map(|(cell, shot)| InitialCondition {
                rod: &self.sheets[shot.rod as usize].rod,
                tau: cell.state.tau,
                load: cell.state.load,
            })
            .collect()
    }

    /// The converged `hits`, and how far from the wanted place, in whisker lengths, their poles really are.
    pub fn misses(&self, hits: &[Hit]) -> Vec<(InitialCondition<'_>, f64)> {
        let found = hits.iter().zip(&self.shots);
        let found = found.filter(|(hit, _)| hit.outcome == Outcome::Converged);
        let (wanted, conditions): (Vec<DVec2>, Vec<InitialCondition>) = found
            .map(|(hit, shot)| {
                let rod = &self.sheets[shot.rod as usize].rod;
                let (tau, load) = (hit.tau, hit.load);
                (shot.pole, InitialCondition { rod, tau, load })
            })
            .unzip();
        let method = Method::fine().with_effects(self.effects);
        let shot = Batch::new(method).shoot::<ShootingMap>(&conditions);
        let missed = shot.iter().zip(wanted);
        let missed = missed.map(|(map, pole)| map.pole.distance(pole));
        conditions.iter().copied().zip(missed).collect()
    }
}

/// How far the poles of `conditions` move, in whisker lengths, when the steps of `resolution` are halved.
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
