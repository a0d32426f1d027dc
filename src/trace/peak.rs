//! Largest loads during a push.

use super::{StableBranch, StateAtPush};
use crate::sheet::CurveNode;

/// Largest relative excess of a maximum over the value at the end with which the end counts as the maximum.
const AT_END: f64 = 1e-9;

/// Number of states between two others in a round of the search for a maximum: about as many as a block of trajectories has.
const BETWEEN: usize = 15;

/// Number of rounds of the search. The last states are 1e-8 of the interval apart, in which a smooth function is flat to rounding.
const ROUNDS: usize = 9;

/// Load of a whisker, of which a push has a largest size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PushLoad {
    /// Whole contact force, with friction, in uN.
    ContactForce,
    /// Moment at the base, in nN m.
    BaseMoment,
    /// Bending strain at the surface, dimensionless.
    Strain,
}

impl PushLoad {
    /// All loads.
    pub const ALL: [Self; 3] = [Self::ContactForce, Self::BaseMoment, Self::Strain];
}

/// Largest size of a load during a push.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PushPeak {
    /// Largest size of the load, in its unit; NaN if no state is known.
    pub size: f64,
    /// Push angle of the largest size, in degrees; `None` at the end of the push.
    pub before_end_deg: Option<f64>,
}

impl StableBranch {
    /// Returns the largest size of `load` from first touch to the end of the stable states. The nodes of the continuation enclose the
    /// maximum, and ever closer states between them find it. A larger maximum between two other nodes can be missed.
    #[must_use]
    pub fn peak(&self, load: PushLoad) -> PushPeak {
        let path = &self.path;
        let nodes = path.stable();
        let sizes = self.sizes(nodes, load);
        let Some(best) = best(&sizes) else {
            return PushPeak { size: f64::NAN, before_end_deg: None };
        };
        let (last, mut found) = (sizes[sizes.len() - 1], (sizes[best], nodes[best]));
        let lengths = path.lengths();
        let mut ends =
            [best.saturating_sub(1), (best + 1).min(sizes.len() - 1)].map(|end| lengths[end]);
        for _ in 0..ROUNDS {
            let step = (ends[1] - ends[0]) / (BETWEEN + 1) as f64;
            let targets = (1..=BETWEEN).map(|i| step.mul_add(i as f64, ends[0]));
            let targets: Vec<f64> = targets.collect();
            let between = path.at_lengths(&lengths, &targets);
            let states = targets.into_iter().zip(between);
            let states = states.filter_map(|(length, state)| Some((length, state?)));
            let (places, states): (Vec<f64>, Vec<CurveNode>) = states.unzip();
            let sizes = self.sizes(&states, load);
            let Some(best) = self::best(&sizes) else {
                break;
            };
            if sizes[best] > found.0 {
                found = (sizes[best], states[best]);
            }
            ends = [places[best] - step, places[best] + step];
        }
        // Next to the end, the push angle of a maximum is known to the root of the rounding errors.
        let (size, node) = found;
        let is_before = size > last * (1.0 + AT_END);
        PushPeak { size, before_end_deg: is_before.then(|| node.signed_push.to_degrees()) }
    }

    /// Returns the largest size of `load` at the stable nodes of the continuation, some percent below the size of [`Self::peak`]; NaN if no state is known.
    #[must_use]
    pub fn rough_peak(&self, load: PushLoad) -> f64 {
        let sizes = self.sizes(self.path.stable(), load);
        best(&sizes).map_or(f64::NAN, |best| sizes[best])
    }

    /// Returns the sizes of a load at `nodes`, `[node]`; NaN where the contact's course is not found.
    fn sizes(&self, nodes: &[CurveNode], load: PushLoad) -> Vec<f64> {
        let states = self.each_pushed(nodes);
        let known: Vec<StateAtPush> = states.iter().flatten().copied().collect();
        let size = |state: &StateAtPush| match load {
            PushLoad::BaseMoment => self.read(state).base_moment_nnm.abs(),
            _ => self.read(state).contact_force_un,
        };
        let sizes: Vec<f64> = match load {
            PushLoad::Strain => {
                let peaks = self.peaks(&known).into_iter();
                peaks.map(|peak| peak.strain * self.units.strain).collect()
            }
            _ => known.iter().map(size).collect(),
        };
        let mut sizes = sizes.into_iter();
        let size = |state: &Result<_, _>| state.as_ref().ok().and_then(|_| sizes.next());
        states.iter().map(size).map(|size| size.unwrap_or(f64::NAN)).collect()
    }
}

/// Returns the index of the largest known size.
fn best(sizes: &[f64]) -> Option<usize> {
    let known = (0..sizes.len()).filter(|i| !sizes[*i].is_nan());
    known.max_by(|a, b| sizes[*a].total_cmp(&sizes[*b]))
}
