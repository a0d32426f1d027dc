//! Nets whose trajectories a device integrates, while the threads complete the panels before them.

use crate::engine::{Nodes, WhiskerSide, Worker};
use crate::sheet::net::ValueDraft;
use crate::stopwatch::Stopwatch;
use rayon::prelude::*;
use std::sync::Arc;
use std::time::Duration;
use whiskmap_mechanics::shooting::PlainState;
use whiskmap_mechanics::shooting::batch::Method;

/// Whisker sides whose nets are in the making. In each round, the engine integrates the trajectories that the panels of all sides need next.
pub struct PendingNets {
    sides: Vec<WhiskerSide>,
    drafts: Vec<Option<ValueDraft>>,
    method: Method,
    /// The trajectories that the engine integrates; `None` if all panels are made.
    submitted: Option<Arc<Nodes>>,
}

impl PendingNets {
    /// Begins nets with a residual of at most `most` whisker lengths for `sides`: submits the first trajectories to the engine of `worker`.
    pub fn new(sides: Vec<WhiskerSide>, method: Method, most: f64, worker: &mut Worker) -> Self {
        let drafts = sides.par_iter().map(|side| side.draft(most)).collect();
        let mut nets = Self { sides, drafts, method, submitted: None };
        nets.submit(worker);
        nets
    }

    /// Submits the trajectories that are needed next, if any.
    fn submit(&mut self, worker: &mut Worker) {
        let drafts = self.drafts.par_iter_mut().zip(&self.sides);
        let points = drafts.map(|(draft, side)| match draft {
            Some(draft) => draft.nodes(&side.sheet),
            None => Vec::new(),
        });
        let nodes = Arc::new(Nodes {
            method: self.method,
            points: points.collect(),
            rods: self.sides.iter().map(|side| side.sheet.rod.clone()).collect(),
        });
        self.submitted = (nodes.count() > 0).then_some(nodes);
        if let Some(nodes) = &self.submitted {
            worker.submit_nodes(nodes);
        }
    }

    /// Completes all nets. Returns the sides with their nets, and the time of waiting for the engine. If the engine failed, the sides
    /// have no nets, because the CPU engine needs none.
    pub fn finish(mut self, worker: &mut Worker) -> (Arc<[WhiskerSide]>, Duration) {
        let mut waited = Duration::ZERO;
        while let Some(nodes) = self.submitted.take() {
            let begun = Stopwatch::start();
            let states = worker.collect_states(&nodes);
            waited += begun.elapsed();
            let Some(states) = states else {
                return (self.sides.into(), waited);
            };
            let mut rest = &states[..];
            let parts = nodes.points.iter().map(|points| {
                let (side_states, others) = rest.split_at(points.len());
                rest = others;
                side_states
            });
            let parts: Vec<&[PlainState]> = parts.collect();
            let sides = self.drafts.par_iter_mut().zip(&self.sides);
            sides.zip(parts).for_each(|((draft, side), states)| {
                if let Some(draft) = draft {
                    draft.take(&side.sheet, states);
                }
            });
            self.submit(worker);
        }
        let all = self.sides.into_iter().zip(self.drafts);
        let all = all.map(|(mut side, draft)| {
            side.sheet.set_net(draft.and_then(ValueDraft::finish));
            side
        });
        (all.collect(), waited)
    }
}
