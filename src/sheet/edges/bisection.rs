//! Crossings by bisection between two samples of an edge, where Newton's method fails because the distance has an extremum nearby.

use crate::numerics::Bracket;
use crate::rod::{Rod, Side};
use crate::sheet::edges::predictor::EdgeSample;
use crate::sheet::fold::first_folds;
use crate::sheet::row::Edge;
use crate::shooting::SecondVariation;
use crate::shooting::batch::{Batch, InitialCondition, Method};
use glam::DVec2;

/// Interval between two samples of an edge, and the `ln D` to find in it.
pub struct EdgeInterval {
    pub edge: Edge,
    pub samples: [EdgeSample; 2],
    pub target: f64,
}

/// Point `(tau, load)` of an edge, and the pole and derivatives there.
pub type EdgePoint = (DVec2, SecondVariation);

/// Number of halvings: more than the bits of a mantissa.
const MOST_EDGE_HALVINGS: usize = 64;

/// Number of halvings after which a bisection tests whether the distance leaps over the target, as the first fold does from contact to
/// contact. The change of a square root has then fallen to a 64th. It leaps if it still changes by more than [`LEAP`], in parts of the
/// largest miss.
const HALVINGS_BEFORE_LEAP: usize = 12;
const LEAP: f64 = 0.25;

/// Bisection in progress on one interval of an edge.
struct EdgeBisection {
    /// Index of the interval.
    index: usize,
    /// Place of the next trial: the part of the line between the samples, from 0 to 1.
    part: f64,
    /// Parts that bracket the target.
    parts: Bracket,
    /// Misses in `ln D` at the ends of the bracket. `largest` is the largest magnitude of any miss.
    ends: [f64; 2],
    largest: f64,
    halvings: usize,
    /// True if the next trial is the result.
    is_last: bool,
}

impl EdgeBisection {
    fn new(index: usize, between: &EdgeInterval) -> Self {
        let ends = between
            .samples
            .map(|sample| sample.ln_distance - between.target);
        let parts = Bracket::new([0.0, 1.0], ends);
        let sizes = ends.map(f64::abs);
        let is_last = (ends[0] <= 0.0) == (ends[1] <= 0.0);
        Self {
            index,
            part: match is_last {
                true if sizes[0] <= sizes[1] => 0.0,
                true => 1.0,
                false => parts.middle(),
            },
            parts,
            ends,
            largest: sizes[0].max(sizes[1]),
            halvings: 0,
            is_last,
        }
    }

    /// Halves the bracket at a trial that misses the target by `miss`. Returns false if the distance leaps over the target.
    fn halve(&mut self, miss: f64) -> bool {
        self.parts.shrink(self.part, miss);
        self.largest = self.largest.max(miss.abs());
        self.ends[usize::from((miss <= 0.0) != (self.ends[0] <= 0.0))] = miss;
        self.part = self.parts.middle();
        self.halvings += 1;
        self.is_last = self.halvings == MOST_EDGE_HALVINGS;
        let leaps = (self.ends[1] - self.ends[0]).abs() > LEAP * self.largest;
        !leaps || self.halvings < HALVINGS_BEFORE_LEAP
    }
}

/// Returns the point of each interval at which `ln D` is the target, or the closer end if both are on the same side of it. An entry is
/// `None` where a fold is missing, or the distance leaps over the target.
pub fn bisect(
    method: Method,
    rod: &Rod,
    side: Side,
    all: &[EdgeInterval],
) -> Vec<Option<EdgePoint>> {
    let mut found = vec![None; all.len()];
    let mut open: Vec<EdgeBisection> = all
        .iter()
        .enumerate()
        .map(|(index, between)| EdgeBisection::new(index, between))
        .collect();
    while !open.is_empty() {
        let mut points = points(method, rod, side, all, &open).into_iter();
        open.retain_mut(|search| {
            let Some(Some(point)) = points.next() else {
                return false;
            };
            if search.is_last {
                found[search.index] = Some(point);
                return false;
            }
            let (_, here) = point;
            search.halve(libm::log(here.map.pole.length()) - all[search.index].target)
        });
    }
    found
}

/// Returns the next trial of each bisection. Bisections for several distances between the same samples share their trials as long as all
/// of them are on the same side.
fn points(
    method: Method,
    rod: &Rod,
    side: Side,
    all: &[EdgeInterval],
    open: &[EdgeBisection],
) -> Vec<Option<EdgePoint>> {
    let place = |search: &EdgeBisection| {
        let [from, to] = all[search.index].samples;
        let [from, to] = [from, to].map(|sample| DVec2::new(sample.tau, sample.load));
        from + search.part * (to - from)
    };
    let on = |edge: Edge| open.iter().filter(move |s| all[s.index].edge == edge);
    let mut contacts: Vec<f64> = on(Edge::Fold).map(|search| place(search).x).collect();
    contacts.sort_by(f64::total_cmp);
    contacts.dedup();
    let folds = first_folds(method, rod, side, &contacts);
    let conditions: Vec<InitialCondition> = on(Edge::Tip)
        .map(|search| InitialCondition {
            rod,
            tau: all[search.index].samples[0].tau,
            load: place(search).y,
        })
        .collect();
    let mut shots = Batch::new(method)
        .shoot::<SecondVariation>(&conditions)
        .into_iter();
    open.iter()
        .map(|search| match all[search.index].edge {
            Edge::Fold => {
                let tau = place(search).x;
                let contact = contacts.binary_search_by(|other| other.total_cmp(&tau));
                let fold = folds[contact.ok()?]?;
                Some((DVec2::new(tau, fold.load), fold.variation))
            }
            Edge::Tip => Some((place(search), shots.next()?)),
        })
        .collect()
}
