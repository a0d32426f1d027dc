//! Crossings by bisection between two samples of an edge, where Newton's method fails because the distance has an extremum nearby.
//!
//! The trials of all intervals share batches. So each interval halves its [`Bracket`] here, and not in [`Bracket::bisect`].

use crate::sheet::case::SheetCase;
use crate::sheet::edges::edge_newton::EdgeIterate;
use crate::sheet::edges::predictor::EdgeSample;
use crate::sheet::fold::first_folds;
use crate::sheet::row::Edge;
use glam::DVec2;
use whiskmap_mechanics::numerics::Bracket;
use whiskmap_mechanics::shooting::SecondVariation;
use whiskmap_mechanics::shooting::batch::Batch;

/// Number of halvings: more than the bits of a mantissa.
const MOST_EDGE_HALVINGS: usize = 64;

/// Number of halvings after which a bisection tests whether the distance leaps over the target, as the first fold does from contact to
/// contact. The change of a square root has then fallen to a 64th. It leaps if it still changes by more than [`LEAP`], in parts of the
/// largest miss.
const HALVINGS_BEFORE_LEAP: usize = 12;
const LEAP: f64 = 0.25;

/// Bisection of the interval between two samples of an edge.
pub struct EdgeBisection {
    edge: Edge,
    /// Points `(tau, load)` of the samples.
    samples: [DVec2; 2],
    /// Wanted `ln D`.
    target: f64,
    /// Place of the next trial: the part of the line between the samples, from 0 to 1.
    part: f64,
    /// Parts that bracket the target.
    parts: Bracket,
    /// Misses in `ln D` at the ends of the bracket, and the largest magnitude of any miss.
    ends: [f64; 2],
    largest: f64,
    /// Number of halvings that are left.
    left: usize,
    found: Option<EdgeIterate>,
}

impl EdgeBisection {
    /// Creates the bisection for the `ln D` `target`. If both samples are on the same side of the target, the closer sample is the result.
    pub fn new(edge: Edge, samples: [EdgeSample; 2], target: f64) -> Self {
        let ends = samples.map(|sample| sample.ln_distance - target);
        let parts = Bracket::new([0.0, 1.0], ends);
        let sizes = ends.map(f64::abs);
        let is_between = (ends[0] <= 0.0) != (ends[1] <= 0.0);
        let closer = f64::from(u8::from(sizes[0] > sizes[1]));
        Self {
            edge,
            samples: samples.map(|sample| DVec2::new(sample.tau, sample.load)),
            target,
            part: if is_between { parts.middle() } else { closer },
            parts,
            ends,
            largest: sizes[0].max(sizes[1]),
            left: if is_between { MOST_EDGE_HALVINGS } else { 0 },
            found: None,
        }
    }

    /// Returns `(tau, load)` of the next trial, on the line between the samples.
    fn trial(&self) -> DVec2 {
        let [from, to] = self.samples;
        from + self.part * (to - from)
    }

    /// Halves the bracket at a trial. Returns false if the bisection ends, without a result if there is no point at the trial or the
    /// distance leaps over the target.
    fn halve(&mut self, trial: Option<(DVec2, SecondVariation)>) -> bool {
        let Some((point, here)) = trial else {
            return false;
        };
        let miss = libm::log(here.map.pole.length()) - self.target;
        if self.left == 0 {
            self.found =
                Some(EdgeIterate { point, here, residual: miss.abs(), has_converged: true });
            return false;
        }
        self.parts.shrink(self.part, miss);
        self.largest = self.largest.max(miss.abs());
        self.ends[usize::from((miss <= 0.0) != (self.ends[0] <= 0.0))] = miss;
        self.part = self.parts.middle();
        self.left -= 1;
        let leaps = (self.ends[1] - self.ends[0]).abs() > LEAP * self.largest;
        !leaps || self.left + HALVINGS_BEFORE_LEAP > MOST_EDGE_HALVINGS
    }
}

/// Returns the point of each interval of an edge at which `ln D` is the target, `[interval]`. If both ends are on the same side of the
/// target, the closer end is returned. An entry is `None` where a fold is missing, or the distance leaps over the target.
pub fn bisect(case: SheetCase, mut all: Vec<EdgeBisection>) -> Vec<Option<EdgeIterate>> {
    for edge in [Edge::Fold, Edge::Tip] {
        let open = all.iter_mut().filter(|search| search.edge == edge);
        let mut open: Vec<&mut EdgeBisection> = open.collect();
        while !open.is_empty() {
            let trials: Vec<DVec2> = open.iter().map(|search| search.trial()).collect();
            let points = match edge {
                Edge::Fold => folds(case, &trials),
                Edge::Tip => {
                    let shot = Batch::new(case.method).shoot_at(case.rod, trials.iter().copied());
                    trials.into_iter().zip(shot).map(Some).collect()
                }
            };
            let mut points = points.into_iter();
            open.retain_mut(|search| search.halve(points.next().flatten()));
        }
    }
    all.into_iter().map(|search| search.found).collect()
}

/// Returns the fold at the contact of each trial. Bisections for several distances between the same samples share their trials as long as
/// all of them are on the same side.
fn folds(case: SheetCase, trials: &[DVec2]) -> Vec<Option<(DVec2, SecondVariation)>> {
    let mut contacts: Vec<f64> = trials.iter().map(|trial| trial.x).collect();
    contacts.sort_by(f64::total_cmp);
    contacts.dedup();
    let folds = first_folds(case, &contacts);
    let fold = |trial: &DVec2| {
        let contact = contacts.binary_search_by(|other| other.total_cmp(&trial.x));
        let fold = folds[contact.ok()?]?;
        Some((DVec2::new(trial.x, fold.load), fold.variation))
    };
    trials.iter().map(fold).collect()
}
