//! States and detachments from all over a scene, its corners among them.

use crate::refine::states;
use crate::rod::Effects;
use crate::rod::Side;
use crate::scene::{Grid, Scene, Setup, Whisker};
use crate::sheet::{Edge, Sheet};
use crate::shooting::First;
use crate::shooting::Nystrom8;
use crate::shooting::Resolution;
use crate::shooting::ShootingMap;
use crate::shooting::batch::InitialCondition;
use crate::shooting::batch::Method;
use crate::shooting::batch::shoot;
use rayon::prelude::*;

/// Values of an axis that take part: its ends, and some between. The ends of pushes get better with more distances, near
/// the reach of the whisker above all.
const PUSHES: usize = 12;
const DISTANCES: usize = 64;
const WHISKERS: usize = 4;

/// States to integrate once and again.
pub struct Sample {
    effects: Effects,
    states: Vec<InitialCondition>,
    /// Where pushes end.
    ends: Vec<(InitialCondition, Edge)>,
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
        let (states, ends): (Vec<_>, Vec<_>) = pairs
            .par_iter()
            .filter_map(|&(rod, side)| {
                let method = Method::fine(effects).coarsely();
                // Where the coarse steps find no fold, the fine ones may.
                let sheet = Sheet::new(method, &rod, side, &distances)
                    .or_else(|| Sheet::new(Method::fine(effects), &rod, side, &distances))?;
                let condition = |tau, load| InitialCondition { rod, tau, load };
                let solved = states(method, &sheet, &pushes).into_iter();
                // What ends at first touch does so at every resolution.
                let crossings = sheet.crossings.iter().flatten();
                let crossings = crossings.filter(|end| !end.is_at_touch());
                let ends = crossings.map(|end| (condition(end.tau, end.load), end.edge));
                let states = solved.map(|(_, state)| condition(state.tau, state.load));
                Some((states.collect::<Vec<_>>(), ends.collect::<Vec<_>>()))
            })
            .unzip();
        Self {
            effects,
            states: states.concat(),
            ends: ends.concat(),
        }
    }

    /// The largest error at `resolution`, in radians, as twice as many steps see it.
    pub fn error(&self, resolution: Resolution) -> f64 {
        let shot = |resolution, conditions: &[InitialCondition]| {
            let effects = self.effects;
            let method = Method {
                effects,
                resolution,
            };
            shoot::<Nystrom8, First>(method, conditions)
        };
        let pairs = |conditions: &[InitialCondition]| {
            let finer = shot(resolution.doubled(), conditions);
            shot(resolution, conditions).into_iter().zip(finer)
        };
        let states = pairs(&self.states).map(|(rough, fine)| rough.residual(fine.pole).length());
        let conditions: Vec<InitialCondition> =
            self.ends.iter().map(|(condition, _)| *condition).collect();
        let ends = pairs(&conditions)
            .zip(&self.ends)
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
