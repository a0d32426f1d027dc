//! The states of a map in `f64`, and how far they are from those of twice as many steps.

use glam::DVec2;
use rayon::prelude::*;
use whiskmap::integrate::{Engine, Hit, Outcome, Shot};
use whiskmap::refine::{End, Refined, refine};
use whiskmap::rod::{Effects, Rod, Side};
use whiskmap::scene::Scene;
use whiskmap::sheet::Sheet;
use whiskmap::shooting::batch::{Launch, Method, land};
use whiskmap::shooting::{First, Landing, Nystrom8, Resolution};

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
            .map(|(side, rod)| Sheet::new(Method::fine(effects), rod, *side, &distances).unwrap())
            .collect();
        let mut shots = Vec::new();
        for (index, sheet) in (0..).zip(&sheets) {
            let side = sheet.side;
            let pushes = scene.grid.push_angle_deg.iter().map(|p| p * side.sign());
            let mut pushes: Vec<f64> = pushes.filter(|p| *p >= 0.0).map(f64::to_radians).collect();
            pushes.sort_by(f64::total_cmp);
            for (row, place) in sheet.rows.iter().enumerate() {
                let guesses = sheet.guesses(row, pushes.iter().copied());
                for (guess, push) in guesses.iter().zip(&pushes) {
                    shots.extend(guess.map(|guess| Shot {
                        rod: index,
                        tau: guess.tau,
                        load: guess.load,
                        pole: place.pole(side.sign() * push),
                    }));
                }
            }
        }
        Self {
            effects,
            sheets,
            shots,
        }
    }

    pub fn rods(&self) -> Vec<Rod> {
        self.sheets.iter().map(|sheet| sheet.rod).collect()
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
        refine(Method::fine(self.effects), &sheets, &self.shots, &starts)
    }

    /// The trajectories that end at these states.
    pub fn launches(&self, cells: &[Refined]) -> Vec<Launch> {
        let solved = cells.iter().zip(&self.shots);
        solved
            .filter(|(cell, _)| cell.end == End::Solved)
            .map(|(cell, shot)| Launch {
                rod: self.sheets[shot.rod as usize].rod,
                tau: cell.state.tau,
                load: cell.state.load,
            })
            .collect()
    }

    /// The converged `hits`, and how far from the wanted place, in whisker lengths, their poles really are.
    pub fn misses(&self, hits: &[Hit]) -> Vec<(Launch, f64)> {
        let found = hits.iter().zip(&self.shots);
        let found = found.filter(|(hit, _)| hit.outcome == Outcome::Converged);
        let (wanted, launches): (Vec<DVec2>, Vec<Launch>) = found
            .map(|(hit, shot)| {
                let rod = self.sheets[shot.rod as usize].rod;
                let (tau, load) = (hit.tau, hit.load);
                (shot.pole, Launch { rod, tau, load })
            })
            .unzip();
        let method = Method::fine(self.effects);
        let landed = land::<Nystrom8, First>(method, &launches);
        let missed = landed.iter().zip(wanted);
        let missed = missed.map(|(landing, pole)| landing.pole.distance(pole));
        launches.iter().copied().zip(missed).collect()
    }
}

/// How far the poles of `launches` move, in whisker lengths, when the steps of `resolution` are halved.
pub fn halving(effects: Effects, launches: &[Launch], resolution: Resolution) -> Vec<f64> {
    let poles = |resolution| {
        let method = Method {
            effects,
            resolution,
        };
        land::<Nystrom8, First>(method, launches).into_iter()
    };
    let moved = |(a, b): (Landing, Landing)| a.pole.distance(b.pole);
    poles(resolution)
        .zip(poles(resolution.doubled()))
        .map(moved)
        .collect()
}
