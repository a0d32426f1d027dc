//! States and detachments from all over a scene, its corners among them.

use crate::refine::states;
use crate::rod::{Effects, Rod, Side};
use crate::scene::{Grid, Scene, Setup, Whisker};
use crate::sheet::{Crossing, Edge, Sheet};
use crate::shooting::batch::{Batch, InitialCondition, Method};
use crate::shooting::{Resolution, ShootingMap};
use rayon::prelude::*;

/// Values of an axis that take part: its ends, and some between. The ends of pushes get better with more distances, near
/// the reach of the whisker above all.
const PUSHES: usize = 12;
const DISTANCES: usize = 64;
const WHISKERS: usize = 4;

/// States to integrate once and again.
pub struct Sample {
    effects: Effects,
    rods: Vec<Sampled>,
}

/// States of one rod, `(tau, load)`.
struct Sampled {
    rod: Rod,
    states: Vec<(f64, f64)>,
    /// Where pushes end.
    ends: Vec<((f64, f64), Edge)>,
}

impl Sampled {
    fn condition(&self, (tau, load): (f64, f64)) -> InitialCondition<'_> {
        let rod = &self.rod;
        InitialCondition { rod, tau, load }
    }
}

impl Sample {
    /// A sample of `scene`; its states are known as well as coarse steps know them.
    pub fn new(scene: &Scene, sides: &[Side]) -> Self {
        let whiskers = whiskers(scene);
        let pairs: Vec<_> = whiskers
            .iter()
            .flat_map(|whisker| sides.iter().map(move |side| (whisker, *side)))
            .map(|(whisker, side)| (whisker.rod(&scene.pole, side), side))
            .collect();
        let effects = Effects::of(pairs.iter().map(|(rod, _)| rod));
        let distances: Vec<f64> = spread(&scene.grid.distance_mm, DISTANCES)
            .iter()
            .map(|d| d / scene.whisker.length_mm)
            .collect();
        let pushes = spread(&scene.grid.push_angle_deg, PUSHES);
        let rods = pairs
            .into_par_iter()
            .filter_map(|(rod, side)| {
                let method = Method::fine().with_effects(effects);
                // Where the coarse steps find no fold, the fine ones may.
                let sheet = Sheet::new(method.coarsely(), &rod, side, &distances)
                    .or_else(|| Sheet::new(method, &rod, side, &distances))?;
                let solved = states(method.coarsely(), &sheet, &pushes).into_iter();
                // What ends at first touch does so at every resolution.
                let crossings = sheet.crossings.iter().flatten();
                let crossings = crossings.filter(|end| !end.is_at_touch());
                let end = |end: &Crossing| ((end.tau, end.load), end.edge);
                Some(Sampled {
                    states: solved.map(|(_, state)| (state.tau, state.load)).collect(),
                    ends: crossings.map(end).collect(),
                    rod,
                })
            })
            .collect();
        Self { effects, rods }
    }

    /// The largest error at `resolution`, in radians, as twice as many steps see it.
    pub fn error(&self, resolution: Resolution) -> f64 {
        let method = Method::new(resolution).with_effects(self.effects);
        let finer = method.with_resolution(resolution.doubled());
        let pairs = |conditions: &[InitialCondition]| {
            let [rough, finer] =
                [method, finer].map(|m| Batch::new(m).shoot::<ShootingMap>(conditions));
            rough.into_iter().zip(finer)
        };
        let rods = || self.rods.iter();
        let states: Vec<InitialCondition> = rods()
            .flat_map(|sampled| sampled.states.iter().map(|state| sampled.condition(*state)))
            .collect();
        let ends: Vec<(InitialCondition, Edge)> = rods()
            .flat_map(|sampled| {
                let ends = sampled.ends.iter();
                ends.map(|(end, edge)| (sampled.condition(*end), *edge))
            })
            .collect();
        let states = pairs(&states).map(|(rough, fine)| rough.residual(fine.pole).length());
        let conditions: Vec<InitialCondition> = ends.iter().map(|(end, _)| *end).collect();
        let ends = pairs(&conditions)
            .zip(&ends)
            .map(|((rough, fine), (condition, edge))| shift(&rough, &fine, condition, *edge));
        states.chain(ends).fold(0.0, worse)
    }
}

/// How far the end of a push moves along its edge, where the distance is held: the direction of the pole, less what it
/// changes with the distance. On a fold contact and load change both in the same proportion.
fn shift(rough: &ShootingMap, fine: &ShootingMap, condition: &InitialCondition, edge: Edge) -> f64 {
    let moved = rough.residual(fine.pole);
    let by_contact = rough.by_tau * condition.tau;
    let by_load = rough.by_load * condition.load;
    let along = if edge == Edge::Tip || by_load.x.abs() > by_contact.x.abs() {
        by_load
    } else {
        by_contact
    };
    (moved.y - moved.x * along.y / along.x).abs()
}

/// The larger; a number that is none is worse than any.
fn worse(a: f64, b: f64) -> f64 {
    if b.is_nan() { f64::INFINITY } else { a.max(b) }
}

/// The whiskers at some values of the sweep's axes.
fn whiskers(scene: &Scene) -> Vec<Whisker> {
    let few = |axis: &Option<Vec<f64>>| axis.as_ref().map(|values| spread(values, WHISKERS));
    let few = Setup {
        grid: Grid {
            taper: few(&scene.grid.taper),
            curvature_per_mm: few(&scene.grid.curvature_per_mm),
            ..scene.grid.clone()
        },
        ..Setup::clone(scene)
    };
    few.whiskers().map(|(_, whisker)| whisker).collect()
}

/// At most `most` values, the first and the last among them.
fn spread(values: &[f64], most: usize) -> Vec<f64> {
    let (last, count) = (values.len() - 1, values.len().min(most));
    (0..count)
        .map(|i| values[i * last / (count - 1).max(1)])
        .collect()
}
