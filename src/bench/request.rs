//! The cells of whisker sides as requests to an engine, with the targets of their states.

use super::task::{Task, whisker_sides};
use crate::classify::Outcome;
use crate::engine::{Cells, RowBatch, SideColumns, WhiskerSide};
use crate::plan::{Channel, Channels};
use crate::scene::Scene;
use crate::sheet::Sheet;
use crate::sheet::net::ValueNet;
use std::sync::Arc;
use whiskmap_mechanics::shooting::batch::Method;

/// Request to an engine for all cells of one whisker side.
pub struct SideRequest {
    pub batch: RowBatch,
    /// Index of the target of each cell, if it has one.
    targets: Vec<Option<usize>>,
}

/// Solved targets, `[target]`: the index of each, and `(tau, load)` of its state, dimensionless.
pub type Points = Vec<(usize, (f64, f64))>;

impl SideRequest {
    /// Returns a request for each whisker side of `scene`, `[side]`, with the net that `with_net` adds to it.
    pub fn all(
        scene: &Scene,
        task: &Task,
        with_net: impl Fn(WhiskerSide) -> WhiskerSide,
    ) -> Vec<Self> {
        let method = Method::fine().with_effects(task.effects);
        let sides = whisker_sides(scene).into_iter().zip(&task.rods).enumerate();
        let requests = sides.map(|(index, ((swept, side), rod))| {
            let distances = scene.grid.distance_mm.iter();
            let distances: Vec<f64> = distances.map(|d| d / swept.whisker.length_mm).collect();
            let sheet = Sheet::new(method, rod, side, &distances);
            let columns = SideColumns::new(&scene.grid.push_angle_deg, side);
            let rows = sheet.rows.iter();
            let signed_pushes = || (0..columns.len()).map(|column| columns.signed_push(column));
            let poles = rows.flat_map(|row| signed_pushes().map(|push| row.pole(push)));
            let targets = poles.map(|pole| task.target(index as u32, pole)).collect();
            let rows = (0..distances.len()).map(|row| (0, row));
            let side = WhiskerSide::new(Arc::new(columns), swept.whisker.units(), sheet);
            let side = with_net(side);
            let mut batch = RowBatch::new(method, [side].into(), rows);
            batch.channels = Channels::STANDARD.with(Channel::PeakStrain.name());
            Self { batch, targets }
        });
        requests.collect()
    }

    /// Returns the targets of the request that `cells` solve, `[target]`.
    pub fn solved(&self, cells: &Cells) -> Points {
        let found = cells.outcome.iter().zip(&cells.points).zip(&self.targets);
        let points = found.filter_map(|((outcome, point), target)| {
            let target = target.filter(|_| *outcome == Outcome::Solved)?;
            Some((target, (point.x, point.y)))
        });
        points.collect()
    }
}

/// Returns the largest number of loads of a net of the `requests`.
pub fn loads(requests: &[SideRequest]) -> usize {
    let sides = requests.iter().flat_map(|request| request.batch.sides.iter());
    let nets = sides.filter_map(|side| side.sheet.net());
    nets.map(ValueNet::loads).max().unwrap_or(0)
}
