//! Sample of the states and detachments of a scene, with its corners.

use crate::refine::states;
use crate::scene::{Scene, SceneData, SweptWhisker};
use crate::sheet::{Edge, Sheet};
use glam::DVec2;
use rayon::prelude::*;
use whiskmap_mechanics::rod::{Effects, Rod, Side};
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap_mechanics::shooting::{Resolution, ShootingMap};

/// Maximum number of values of each axis: its ends, and some between. Detachments need more distances, above all near the reach of the
/// whisker.
const PUSHES: usize = 12;
const DISTANCES: usize = 64;
const WHISKERS: usize = 4;

/// Sample of a scene: states to integrate at several resolutions.
pub struct SceneSample {
    effects: Effects,
    /// Rods with points of their sheets.
    rods: Vec<(Rod, Vec<Point>)>,
}

/// A state, or with an edge, a detachment.
struct Point {
    tau: f64,
    load: f64,
    edge: Option<Edge>,
}

impl SceneSample {
    /// Returns a sample of `scene`, with states at a coarse resolution.
    pub fn new(scene: &Scene, sides: &[Side]) -> Self {
        let whiskers = whiskers(scene);
        let pairs: Vec<_> = whiskers
            .iter()
            .flat_map(|swept| sides.iter().map(move |side| (swept, *side)))
            .map(|(swept, side)| (swept.rod(side), side, swept.whisker.length_mm))
            .collect();
        let effects = Effects::of(pairs.iter().map(|(rod, ..)| rod));
        let distances_mm = spread(&scene.grid.distance_mm, DISTANCES);
        let pushes = spread(&scene.grid.push_angle_deg, PUSHES);
        let rods = pairs
            .into_par_iter()
            .map(|(rod, side, length_mm)| {
                let method = Method::fine().with_effects(effects);
                let distances: Vec<f64> = distances_mm.iter().map(|d| d / length_mm).collect();
                let sheet = Sheet::new(method.coarsely(), &rod, side, &distances);
                let solved = states(method.coarsely(), &sheet, &pushes).into_iter();
                let solved = solved.map(|(_, state)| Point {
                    tau: state.point.x,
                    load: state.point.y,
                    edge: None,
                });
                // A push that ends at first touch does so at every resolution.
                let crossings = sheet.crossings.iter().flatten();
                let ends = crossings
                    .filter(|end| end.is_sound() && !end.is_at_touch())
                    .map(|end| Point { tau: end.tau, load: end.load, edge: Some(end.edge) });
                let points = solved.chain(ends).collect();
                (rod, points)
            })
            .collect();
        Self { effects, rods }
    }

    /// Returns the largest push-angle error of the sample at `resolution` against twice as many steps, in radians.
    pub fn error(&self, resolution: Resolution) -> f64 {
        let points: Vec<(&Rod, &Point)> = self
            .rods
            .iter()
            .flat_map(|(rod, points)| points.iter().map(move |point| (rod, point)))
            .collect();
        let condition =
            |&(rod, &Point { tau, load, .. }): &(_, &Point)| InitialCondition { rod, tau, load };
        let conditions: Vec<InitialCondition> = points.iter().map(condition).collect();
        let [rough, fine] = [resolution, resolution.doubled()].map(|resolution| {
            let method = Method::new(resolution).with_effects(self.effects);
            Batch::new(method).shoot::<ShootingMap>(&conditions)
        });
        let pairs = rough.iter().zip(&fine);
        let errors = pairs.zip(&points).map(|((rough, fine), (_, point))| {
            let moved = rough.residual(fine.pole);
            match point.edge {
                Some(edge) => shift(rough, moved, point, edge),
                None => moved.length(),
            }
        });
        errors.fold(0.0, worse)
    }
}

/// Returns the shift of the push angle of a detachment whose pole has `moved`, along its `edge` at constant distance: the change of the
/// pole's direction, less its change with the distance. On a fold, contact and load change both in the same proportion.
fn shift(rough: &ShootingMap, moved: DVec2, end: &Point, edge: Edge) -> f64 {
    let by_contact = rough.by_tau * end.tau;
    let by_load = rough.by_load * end.load;
    let along = if edge == Edge::Tip || by_load.x.abs() > by_contact.x.abs() {
        by_load
    } else {
        by_contact
    };
    (moved.y - moved.x * along.y / along.x).abs()
}

/// Returns the larger number; NaN is infinite.
fn worse(a: f64, b: f64) -> f64 {
    if b.is_nan() { f64::INFINITY } else { a.max(b) }
}

/// Returns the whiskers at some values of the sweep's axes: at their ends alone if there are more than two axes. All whiskers of a table count.
fn whiskers(scene: &Scene) -> Vec<SweptWhisker> {
    let mut few = SceneData::clone(scene);
    let most = if few.grid.sweep.len() > 2 { 2 } else { WHISKERS };
    for axis in &mut few.grid.sweep {
        // Whiskers of a table are in no order.
        if axis.variable.parameter().is_some() {
            axis.values = spread(&axis.values, most);
        }
    }
    few.whiskers().flatten().collect()
}

/// Returns at most `most` values, with the first and the last.
fn spread(values: &[f64], most: usize) -> Vec<f64> {
    let (last, count) = (values.len() - 1, values.len().min(most));
    (0..count).map(|i| values[i * last / (count - 1).max(1)]).collect()
}
