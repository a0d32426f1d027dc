//! Samples of a sheet: contact nodes, edges and net, with their certificate.

use crate::sheet::case::SheetCase;
use crate::sheet::edges::Edges;
use crate::sheet::fold::contact_nodes::{ContactNodes, NARROW_SPACING, SPACING};
use crate::sheet::net::{GuessPanel, Panels};
use crate::sheet::row::Row;

/// Largest negative load, relative to the fold load, that counts as unloaded. At the soft tip of a strongly curved cone, rounding of
/// first touch (1e-13 of the length) is a load of 1e-8.
const UNLOADED: f64 = 1e-6;

/// Samples of a sheet: contact nodes, edges and net.
#[derive(Clone, Debug)]
pub struct SheetSamples {
    pub contacts: ContactNodes,
    pub edges: Edges,
    /// Panels that show the sheet at the contacts of its rows: no fold and no crossing is hidden between the samples. `None` if the samples are
    /// not certified.
    pub panels: Option<Panels<GuessPanel>>,
}

impl SheetSamples {
    /// Samples the sheet of `rows`, the `nearest` of which is nearest to the base, with panels to the first of two `errors`, or to the second if
    /// those do not show all folds. If the samples are not certified, it samples again at a narrow spacing, with panels by fine trajectories.
    /// Returns `None` if some contact has no fold, or no stable state at first touch.
    pub fn new(case: SheetCase, nearest: &Row, rows: &[Row], errors: [f64; 2]) -> Option<Self> {
        let nodes = |case, spacing| ContactNodes::new(case, nearest, spacing);
        let sampled = |contacts: ContactNodes, by, folds: Option<ContactNodes>| {
            let edges = Edges::new(case, &contacts);
            let folds = folds.as_ref().unwrap_or(&contacts);
            let shows_folds = |panel: &GuessPanel| panel.shows_folds(case.rod, folds);
            let show_folds = |panels: &Panels<GuessPanel>| {
                let all = panels.of_all_rows();
                all.is_some_and(|all| all.iter().all(shows_folds))
            };
            let panels = |error| Panels::for_guesses(by, folds, rows, error);
            let found = || errors.into_iter().map(panels).find(show_folds);
            Self {
                panels: edges.are_certified().then(found).flatten(),
                contacts,
                edges,
            }
        };
        let contacts = nodes(case, SPACING);
        match contacts.map(|contacts| sampled(contacts, case.coarsely(), None)) {
            Some(samples) if samples.panels.is_some() => Some(samples),
            samples => {
                // Near the tip of a perfect cone, coarse trajectories have other folds: which ones are first is shown by fine ones.
                let fine = case.finely();
                let both = nodes(case, NARROW_SPACING).zip(nodes(fine, NARROW_SPACING));
                let again = both.map(|(contacts, folds)| sampled(contacts, fine, Some(folds)));
                again.or(samples)
            }
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
