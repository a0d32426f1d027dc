//! Samples of a sheet: contact nodes, lattice and edges, with their certificate.

use crate::sheet::case::SheetCase;
use crate::sheet::edges::Edges;
use crate::sheet::fold::contact_nodes::{ContactNodes, NARROW_SPACING, SPACING};
use crate::sheet::lattice::Lattice;
use crate::sheet::row::Row;

/// Largest negative load, relative to the fold load, that counts as unloaded. At the soft tip of a strongly curved cone, rounding of
/// first touch (1e-13 of the length) is a load of 1e-8.
const UNLOADED: f64 = 1e-6;

/// Samples of a sheet: contact nodes, lattice and edges.
#[derive(Clone, Debug)]
pub struct SheetSamples {
    pub contacts: ContactNodes,
    pub lattice: Lattice,
    pub edges: Edges,
    /// True if the samples show the whole sheet: no fold and no crossing is hidden between them.
    pub is_certified: bool,
}

impl SheetSamples {
    /// Samples the sheet from the tip down to the row `nearest` to the base. If the samples are not certified, it samples again at a
    /// narrow spacing. Returns `None` if some contact has no fold, or no stable state at first touch.
    pub fn new(case: SheetCase, nearest: &Row) -> Option<Self> {
        let sampled = |spacing| {
            let contacts = ContactNodes::new(case, nearest, spacing)?;
            let lattice = Lattice::new(case.coarsely(), &contacts);
            let edges = Edges::new(case, &contacts, &lattice);
            Some(Self {
                is_certified: lattice.is_certified() && edges.are_certified(),
                contacts,
                lattice,
                edges,
            })
        };
        match sampled(SPACING) {
            Some(samples) if samples.is_certified => Some(samples),
            samples => sampled(NARROW_SPACING).or(samples),
        }
    }

    /// Returns true if a `load`, positive toward the pole, lies between first touch and the fold of the contact at `tau`.
    pub fn is_below_fold(&self, tau: f64, load: f64) -> bool {
        load >= 0.0 && self.contacts.is_below_folds(tau, load) || {
            let part = load / self.contacts.fold_load(tau);
            part > -UNLOADED && part < 1.0 + 1e-4
        }
    }
}
