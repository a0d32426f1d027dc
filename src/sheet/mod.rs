//! The stable sheet: all stable states of one whisker on one side of a pole.
//!
//! In the plane of contact and load, the stable states form a rectangle. Its edges are touch (no load), tip, fold (first singular
//! Jacobian) and base. The image of the rectangle in (distance, direction of the pole) does not overlap itself. So the edges alone give
//! the exact boundary of a regime map ([`Sheet::crossings`]). A net of trajectories over the rectangle gives each cell of the map a
//! Newton start ([`Sheet::guesses`]), and the cells of an engine their values. Crossings and net are computed independently of each other.
//!
//! `fold/` finds the first folds of sampled contacts, `net/` represents the states and shows that there are no other folds, and `edges/`
//! computes where a row leaves the sheet. `continuation/` follows a row from state to state where these are not certified; `draft.rs`
//! puts them together.

mod case;
mod continuation;
mod draft;
mod edges;
mod fold;
pub mod net;
mod row;
mod samples;
mod span;

pub(crate) use case::SheetCase;
pub use continuation::level_curve::{CurveNode, LevelCurve, ON_CURVE, Stretch};
pub use continuation::{NODE_MISS, Path, continuations};
pub use draft::{SheetRequest, SheetUse};
pub(crate) use edges::edge_newton::{EdgeProblem, edge_newton};
pub use fold::FoldPoint;
pub(crate) use fold::coordinate::{tau_of, u_of};
pub(crate) use fold::{directions, first_folds};
pub use net::{NetRow, PUSH_MARGIN};
pub use row::{Crossing, Edge, Row, pieces};
pub(crate) use span::RowSpan;

use draft::{SheetDraft, follow};
use glam::DVec2;
use net::{GuessRow, ValueNet};
use rayon::prelude::*;
use samples::SheetSamples;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap_mechanics::rod::{Rod, Side};
use whiskmap_mechanics::shooting::ShootingMap;
use whiskmap_mechanics::shooting::batch::Method;

/// Returns the number of rows, of `rows` in total, that one batch of continuations follows: 32 to 128. Each thread gets a batch, and
/// lanes stay full although continuations end at different times. Results do not depend on it.
pub fn rows_per_batch(rows: usize) -> usize {
    rows.div_ceil(rayon::current_num_threads()).clamp(32, 128)
}

/// Relative difference of `tau` from the tip's within which a contact counts as at the tip, in addition to the residual.
const TIP_TIE: f64 = 1e-12;

/// The stable sheet of one whisker on one side of the pole, with the rows of a map.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// Whisker and pole of the sheet, in dimensionless form.
    pub rod: Rod,
    /// Whisker side of the sheet.
    pub side: Side,
    /// Position of the whisker's tip: `[tau, radius / base radius]`, dimensionless.
    pub tip: [f64; 2],
    /// Rows of the map, one for each distance: `[row]`.
    pub rows: Vec<Row>,
    /// Crossings of the sheet's edges, `[row][crossing]`. The end of a push from first touch comes first, if the row has one. The ends of
    /// every other piece follow, in the direction of growing push angles; none with [`SheetUse::FirstEnds`]. An unknown crossing
    /// ([`Crossing::unknown`]) comes last if the continuation of a piece failed.
    pub crossings: Vec<Vec<Crossing>>,
    method: Method,
    /// Samples of the whole sheet, if they are certified.
    samples: Option<Arc<SheetSamples>>,
    /// Spans of the rows that continuation has followed: `[row][piece]`.
    continued: Vec<Vec<RowSpan>>,
    /// Panels with the values of states for the rows of an engine; `None` without one.
    net: Option<ValueNet>,
}

impl Sheet {
    /// Computes the sheet of `rod` by `method` for guesses in rows at `distances` (at first touch, in whisker lengths).
    #[must_use]
    pub fn new(method: Method, rod: &Rod, side: Side, distances: &[f64]) -> Self {
        Self::one(method, rod, side, distances, SheetUse::Guesses)
    }

    /// Computes the sheet as [`Sheet::new`] does, for the crossings of its rows alone: rows may have no [`Sheet::guesses`].
    #[must_use]
    pub fn of_ends(method: Method, rod: &Rod, side: Side, distances: &[f64]) -> Self {
        Self::one(method, rod, side, distances, SheetUse::Ends)
    }

    fn one(method: Method, rod: &Rod, side: Side, distances: &[f64], serves: SheetUse) -> Self {
        let request =
            SheetRequest { rod: rod.clone(), side, distances: distances.to_vec(), serves };
        let mut drafts = [SheetDraft::new(method, request)];
        // Without a flag that cancels, all rows are followed.
        let _ = follow(&mut drafts, &AtomicBool::new(false));
        let [draft] = drafts;
        draft.sheet
    }

    /// Computes the sheets of several whisker sides by `method`, `[request]`. Rows of all of them that are followed share batches. A sheet does not
    /// depend on the others. If `cancel` is true, the function soon returns `None`.
    #[must_use]
    pub fn several(
        method: Method,
        requests: Vec<SheetRequest>,
        cancel: &AtomicBool,
    ) -> Option<Vec<Self>> {
        let drafts = requests.into_par_iter().map(|request| {
            let goes_on = !cancel.load(Ordering::Relaxed);
            goes_on.then(|| SheetDraft::new(method, request))
        });
        let mut drafts: Vec<SheetDraft> = drafts.collect::<Option<_>>()?;
        follow(&mut drafts, cancel)?;
        Some(drafts.into_iter().map(|draft| draft.sheet).collect())
    }

    /// Returns the fold with the contact at the tip, where slip-off turns into pull-off. Returns `None` if it is not found.
    #[must_use]
    pub fn fold_at_tip(method: Method, rod: &Rod, side: Side) -> Option<FoldPoint> {
        let case = SheetCase { method, rod, side };
        fold::first_folds(case, &[rod.tau_tip()]).pop()?
    }

    /// Returns true if all rows are followed by continuation, because the samples of the sheet are not certified.
    #[must_use]
    pub fn is_continued(&self) -> bool {
        self.samples.is_none()
    }

    /// Returns the method of the trajectories of the sheet.
    #[must_use]
    pub const fn method(&self) -> Method {
        self.method
    }

    /// Returns the level curve `D = const` of the row with index `row`.
    #[must_use]
    pub fn level(&self, row: usize) -> LevelCurve {
        LevelCurve::new(self.method, &self.rod, self.side, &self.rows[row])
    }

    /// Returns the level curve of the row with index `row` at the fine resolution, for contact histories: coarse trajectories do not separate limits of
    /// sliding with nearly equal loads.
    #[must_use]
    pub fn fine_level(&self, row: usize) -> LevelCurve {
        let case = self.case().finely();
        LevelCurve::new(case.method, case.rod, case.side, &self.rows[row])
    }

    /// Returns true if the resting whisker reaches the pole of `row`.
    #[must_use]
    pub fn touches(&self, row: usize) -> bool {
        self.rows[row].is_reached()
    }

    /// Returns the distance from the tip, in `tau`, within which the integration cannot distinguish a contact from one at the tip.
    #[must_use]
    pub fn tip_blur(&self) -> f64 {
        let samples = self.samples.as_ref();
        samples.map_or(0.0, |samples| 2.0 * samples.edges.tip_error)
    }

    /// Returns true if the contact at `tau` of a state with this `residual`, in whisker lengths, is at the tip.
    #[must_use]
    pub fn is_at_tip(&self, tau: f64, residual: f64) -> bool {
        let [tip, radius] = self.tip;
        (tau - tip).abs() <= self.tip_tie() + residual / radius
    }

    /// Returns the distance from the tip, in `tau`, within which a contact without a residual counts as at the tip.
    #[must_use]
    pub fn tip_tie(&self) -> f64 {
        TIP_TIE * self.tip[0] + self.tip_blur()
    }

    /// Returns the whisker side of the sheet.
    const fn case(&self) -> SheetCase<'_> {
        SheetCase { method: self.method, rod: &self.rod, side: self.side }
    }

    /// Returns the end of a `row` on a certified sheet; `None` unless first touch is its only other end.
    #[must_use]
    pub fn simple_end(&self, row: usize) -> Option<&Crossing> {
        let [end] = &self.crossings[row][..] else {
            return None;
        };
        let is_simple = self.touches(row) && end.is_sound() && !end.is_at_touch();
        (is_simple && !self.is_continued()).then_some(end)
    }

    /// Sets the `net` of this sheet for an engine.
    pub fn set_net(&mut self, net: Option<ValueNet>) {
        self.net = net;
    }

    /// Returns the net for an engine; `None` without one.
    #[must_use]
    pub const fn net(&self) -> Option<&ValueNet> {
        self.net.as_ref()
    }

    /// Returns the states of a `row` by the sheet's net, from first touch to its only other end, with the bound on their residual in whisker
    /// lengths. `None` if the row has other ends, or is not in the net.
    #[must_use]
    pub fn net_row(&self, row: usize) -> Option<(NetRow, f64)> {
        self.net.as_ref()?.row(self, row)
    }

    /// Returns the end of each of `rows` with a bound on the residual of all its states by the net for guesses, from first touch to this only other
    /// end, in whisker lengths: `[row]`. `None` if a row has other ends or no panel, or if the sheet is not certified.
    ///
    /// Each push angle between both ends has a state: see `docs/numerics.md`, "Spectral engine".
    #[must_use]
    pub fn known_residuals(&self, rows: &[usize]) -> Vec<Option<(&Crossing, f64)>> {
        let mut known = vec![None; rows.len()];
        let samples = self.samples.as_ref();
        let Some(panels) = samples.and_then(|samples| samples.panels.as_ref()) else {
            return known;
        };
        for (panel, places) in panels.with_rows(rows) {
            let ends = places.iter().filter_map(|place| {
                let row = rows[*place];
                Some((*place, &self.rows[row], self.simple_end(row)?))
            });
            let ends: Vec<(usize, &Row, &Crossing)> = ends.collect();
            let of_panel: Vec<_> = ends.iter().map(|(_, row, end)| (*row, *end)).collect();
            let residuals = panel.residuals(self.case(), &of_panel);
            for ((place, _, end), residual) in ends.into_iter().zip(residuals) {
                known[place] = Some((end, residual));
            }
        }
        known
    }

    /// Returns a Newton start `(tau, load)` for each cell of `row`, `[push_angle]`, one for each of the growing `pushes`. Push angles are magnitudes in
    /// radians. An entry is `None` outside the sheet.
    #[must_use]
    pub fn guesses(&self, row: usize, pushes: &[f64]) -> Vec<Option<DVec2>> {
        let mut guesses = vec![None; pushes.len()];
        if pushes.is_empty() {
            return guesses;
        }
        for span in &self.continued[row] {
            span.write_guesses(pushes, &mut guesses);
        }
        if let Some(panel) =
            self.samples.as_ref().and_then(|samples| samples.panels.as_ref()?.of(row))
        {
            for (begin, end) in pieces(self.touches(row), &self.crossings[row]) {
                let [from, to] = [begin.map_or(0.0, |begin| begin.push), end.push];
                let is_near = |push: &f64| from - PUSH_MARGIN <= *push && *push <= to + PUSH_MARGIN;
                let needed = pushes.iter().any(is_near);
                let (case, place) = (self.case(), &self.rows[row]);
                let piece = || GuessRow::new(panel, case, place, [begin, Some(end)]);
                if let Some(piece) = needed.then(piece).flatten() {
                    piece.write_guesses(&self.rod, pushes, &mut guesses);
                }
            }
        }
        guesses
    }

    /// Returns true if a state is on the sheet: loaded toward the pole, and on the stable side of the Jacobian's first singularity.
    #[must_use]
    pub fn is_stable(&self, tau: f64, load: f64, map: &ShootingMap) -> bool {
        let load = self.side.sign() * load;
        let samples = self.samples.as_ref();
        let is_loaded = samples.is_none_or(|samples| samples.is_below_fold(tau, load));
        is_loaded && map.is_stable()
    }
}
