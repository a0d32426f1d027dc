//! Largest loads during a push.

use super::resample::interpolate;
use super::{Branch, StableBranch};
use crate::sheet::{CurveNode, ON_CURVE};
use whiskmap_mechanics::numerics::least_between;

/// Largest excess of a maximum over the value at the end, relative to this, with which it counts as that at the end.
const AT_END: f64 = 1e-9;

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
    /// maximum, and the golden section finds it between them. A larger maximum between two other nodes can be missed.
    #[must_use]
    pub fn peak(&self, load: PushLoad) -> PushPeak {
        let Branch {
            continuation,
            level,
            ..
        } = &self.0;
        let (nodes, sizes) = (&continuation.nodes, self.sizes(load));
        let Some(best) = best(&sizes) else {
            return PushPeak {
                size: f64::NAN,
                before_end_deg: None,
            };
        };
        let lengths = self.0.lengths();
        let ends = [best.saturating_sub(1), (best + 1).min(sizes.len() - 1)];
        let node = |length: f64| {
            let (near, start) = interpolate(nodes, &lengths, length);
            let CurveNode { push, angle, .. } = nodes[near];
            let corrected = level.correct(&[start], ON_CURVE).pop().flatten();
            corrected.map(|(point, full)| level.node(point, &full, push, angle))
        };
        let ends = ends.map(|end| lengths[end]);
        let [at, inside] = least_between(ends, f64::NEG_INFINITY, |length| {
            node(length).map_or(f64::NAN, |node| -self.size(&node, load))
        });
        let (last, inside) = (sizes[sizes.len() - 1], -inside);
        let size = sizes[best].max(inside);
        // Next to the end, the push angle of a maximum is known to the root of the rounding errors.
        let is_before = size > last * (1.0 + AT_END);
        let before = is_before.then(|| match inside >= sizes[best] {
            true => node(at).unwrap_or(nodes[best]),
            false => nodes[best],
        });
        PushPeak {
            size,
            before_end_deg: before.map(|node| node.push.to_degrees()),
        }
    }

    /// Returns the largest size of `load` at the nodes of the continuation, some percent below that of [`Self::peak`]; NaN if no state is known.
    #[must_use]
    pub fn rough_peak(&self, load: PushLoad) -> f64 {
        let sizes = self.sizes(load);
        best(&sizes).map_or(f64::NAN, |best| sizes[best])
    }

    /// Sizes of a load at the nodes of the continuation, `[node]`.
    fn sizes(&self, load: PushLoad) -> Vec<f64> {
        let nodes = self.0.continuation.nodes.iter();
        nodes.map(|node| self.size(node, load)).collect()
    }

    /// Returns the size of a load at a node; NaN if the contact's course to it is not found.
    fn size(&self, node: &CurveNode, load: PushLoad) -> f64 {
        let states = self.0.pushed(std::slice::from_ref(node));
        states.map_or(f64::NAN, |states| match load {
            PushLoad::ContactForce => self.0.read(&states[0]).contact_force_un,
            PushLoad::BaseMoment => self.0.read(&states[0]).base_moment_nnm.abs(),
            PushLoad::Strain => self.0.peaks(&states)[0].strain * self.0.units.strain,
        })
    }
}

/// Returns the index of the largest known size.
fn best(sizes: &[f64]) -> Option<usize> {
    let known = (0..sizes.len()).filter(|i| !sizes[*i].is_nan());
    known.max_by(|a, b| sizes[*a].total_cmp(&sizes[*b]))
}
