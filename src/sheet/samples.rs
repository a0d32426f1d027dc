//! Samples of a sheet: contact nodes, edges and net, with their certificate.

use crate::sheet::case::SheetCase;
use crate::sheet::edges::Edges;
use crate::sheet::fold::contact_nodes::{ContactNodes, Folds, NARROW_SPACING, SPACING};
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
    /// Samples the sheet of `rows`, the `nearest` of which is nearest to the base, with panels to the first of the `errors` with which they show all folds.
    /// If the samples are not certified, it samples again at a narrow spacing, by fine trajectories, with a march at every contact.
    /// Returns `None` if some contact has no fold, or no stable state at first touch.
    pub fn new(case: SheetCase, nearest: &Row, rows: &[Row], errors: &[f64]) -> Option<Self> {
        let nodes = |case, spacing, folds| ContactNodes::new(case, nearest, spacing, folds);
        let sampled = |contacts: ContactNodes, by, folds: Option<ContactNodes>| {
            let edges = Edges::new(case, &contacts);
            let folds = folds.as_ref().unwrap_or(&contacts);
            let shows_folds = |panel: &GuessPanel| panel.shows_folds(case.rod, folds);
            let show_folds = |panels: &Panels<GuessPanel>| {
                let all = panels.of_all_rows();
                all.is_some_and(|all| all.iter().all(shows_folds))
                    && folds.are_first(case, nearest, |tau| panels.cover(case.rod, tau))
            };
            let panels = |error| Panels::for_guesses(by, folds, rows, error);
            let found = || errors.iter().copied().map(panels).find(show_folds);
            Self { panels: edges.are_certified().then(found).flatten(), contacts, edges }
        };
        let coarse = |folds| {
            let contacts = nodes(case, SPACING, folds)?;
            Some(sampled(contacts, case.coarsely(), None))
        };
        // A contact without a fold has none at other spacings, either.
        let first = coarse(Folds::Predicted)?;
        if first.panels.is_some() {
            return Some(first);
        }
        // Near the tip of a perfect cone, coarse trajectories have other folds: which ones are first is shown by fine ones.
        let fine = case.finely();
        let contacts = nodes(case, NARROW_SPACING, Folds::Marched);
        let both = contacts.zip(nodes(fine, NARROW_SPACING, Folds::Marched));
        let again = both.map(|(contacts, folds)| sampled(contacts, fine, Some(folds)));
        again.or_else(|| coarse(Folds::Marched))
    }

    /// Returns true if a `load`, positive toward the pole, lies between first touch and the fold of the contact at `tau`.
    pub fn is_below_fold(&self, tau: f64, load: f64) -> bool {
        load >= 0.0 && self.contacts.is_below_folds(tau, load) || {
            let part = load / self.contacts.fold_load(tau);
            part > -UNLOADED && part < 1.0 + 1e-4
        }
    }
}
