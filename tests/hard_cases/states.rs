//! States of a map, and their difference from states with halved steps.

use whiskmap::classify::Status;
use whiskmap::map::Panel;
use whiskmap::mechanics::rod::{Effects, Rod, Side};
use whiskmap::mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap::mechanics::shooting::{Resolution, ShootingMap};
use whiskmap::scene::Scene;

/// Contacts and loads of one whisker, on both sides. They are rounded to `f32`: the errors of steps are those next to the states.
pub struct States {
    pub effects: Effects,
    rods: [Rod; 2],
    /// Side of the state, `tau` and load.
    states: Vec<(usize, f64, f64)>,
}

impl States {
    /// The states of a map whose contact slides toward the tip or has no friction.
    pub fn of(scene: &Scene, panel: &Panel) -> Self {
        let rods = Side::BOTH.map(|side| scene.whisker.rod(&scene.pole, side));
        let units = scene.whisker.units();
        let [arc_length_mm, _, force_un, ..] = &panel.state;
        let pushes = scene.grid.push_angle_deg.iter().cycle();
        let cells = pushes.zip(&panel.status).zip(arc_length_mm.iter().zip(force_un));
        let states = cells.filter_map(|((push, status), (arc_length_mm, force_un))| {
            let side = Side::BOTH.iter().position(|side| *side == Side::of_push(*push))?;
            let rod = &rods[side];
            let s = f64::from(*arc_length_mm) / scene.whisker.length_mm;
            let tau = match rod.taper {
                0.0 => s,
                taper => -(-taper * s).ln_1p() / taper,
            };
            let load = f64::from(*force_un) / units.force_un / rod.radius(tau).powi(2);
            let is_there = *status == Status::Solved.code() && load > 0.0 && tau.is_finite();
            is_there.then_some((side, tau, Side::BOTH[side].sign() * load))
        });
        let states = states.collect();
        Self { effects: Effects::of(&rods), rods, states }
    }

    pub fn conditions(&self) -> Vec<InitialCondition<'_>> {
        let states = self.states.iter();
        let condition = |&(side, tau, load): &(usize, f64, f64)| {
            InitialCondition::new(&self.rods[side], (tau, load))
        };
        states.map(condition).collect()
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
        Batch::new(method).shoot::<ShootingMap>(conditions).into_iter()
    };
    let moved = |(a, b): (ShootingMap, ShootingMap)| a.pole.distance(b.pole);
    poles(resolution).zip(poles(resolution.doubled())).map(moved).collect()
}
