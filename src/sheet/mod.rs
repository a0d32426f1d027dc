//! The stable sheet: where all the physics of a whisker on one side of a pole lives.
//!
//! The stable states form a rectangle in (contact, load) with the edges touch (no load), tip, fold (first
//! singular Jacobian) and base; its image in (distance, direction of the pole) is simple. So the edges alone
//! give the exact boundary of a regime map ([`Sheet::crossings`]). A lattice of trajectories over the rectangle
//! gives every cell of the map a guess, or the certainty that it has no solution ([`Sheet::guesses`]). The two
//! are computed independently of each other.
//!
//! In the order of work: `fold/` finds the first folds of sampled contacts, `lattice/` makes guesses, `edges/`
//! decides where a row leaves the sheet. `continuation/` follows a row from state to state where these do not suffice.

mod certificate;
mod continuation;
mod edges;
mod fold;
mod lattice;
mod row;
mod span;

pub use continuation::level_curve::{LevelCurve, Node, ON_CURVE};
pub use continuation::{Continuation, NODE_MISS, continuations};
pub use edges::edge_newton::{EdgeIterate, EdgeProblem, EdgeStart, edge_newton};
pub use fold::FoldPoint;
pub use row::{Crossing, Edge, Row};
pub use span::{Guess, RowSpan, SpanNode};

use crate::rod::{Rest, Rod, Side};
use crate::shooting::ShootingMap;
use crate::shooting::batch::Method;
use continuation::pieces::{ContinuedRow, StablePiece, stable_pieces};
use edges::Edges;
use edges::crossings::crossings;
use fold::contact_nodes::{ContactNodes, NARROW_SPACING, SPACING};
use lattice::Lattice;
use rayon::prelude::*;
use std::borrow::Cow;

/// How far below zero the load of an unloaded whisker may come out, relative to the fold's: at the soft tip of a
/// strongly curved cone the rounding of first touch (1e-13 of the length) is a load of 1e-8.
const UNLOADED: f64 = 1e-6;

/// How many of some `rows` are continued together: few enough that every thread has some, so many that lanes are full, though walks end at
/// different times. No answer depends on it.
pub fn rows_per_batch(rows: usize) -> usize {
    rows.div_ceil(rayon::current_num_threads()).clamp(32, 128)
}

/// The sheet of one whisker on one side, with the rows of a map.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// The whisker and its pole.
    pub rod: Rod,
    /// The side.
    pub side: Side,
    /// `tau` and radius over the base radius at the tip.
    pub tip: [f64; 2],
    /// The rows.
    pub rows: Vec<Row>,
    /// Per row: where it leaves and enters the sheet. The end of a push from first touch comes first, if there is one;
    /// then the ends of each other piece of the row, in the direction of growing push angles; at last the unknown one, if a piece was
    /// lost.
    pub crossings: Vec<Vec<Crossing>>,
    method: Method,
    guesses: Guesses,
}

/// Where guesses come from.
#[derive(Clone, Debug)]
enum Guesses {
    /// SheetSamples that show all of the sheet.
    Sampled(Box<SheetSamples>),
    /// Its rows, continued because no samples do; piece by piece.
    Continued(Vec<Vec<RowSpan>>),
}

/// A sheet, sampled.
#[derive(Clone, Debug)]
struct SheetSamples {
    contacts: ContactNodes,
    lattice: Lattice,
    edges: Edges,
}

impl SheetSamples {
    /// The samples down to the row `nearest` to the base; `None` if some contact has no fold, or no stable state at first touch.
    fn new(method: Method, rod: &Rod, side: Side, nearest: &Row, spacing: f64) -> Option<Self> {
        let contacts = ContactNodes::new(method, rod, side, nearest, spacing)?;
        let lattice = Lattice::new(method.coarsely(), rod, side, &contacts);
        let edges = Edges::new(method, rod, &contacts, &lattice);
        Some(Self {
            contacts,
            lattice,
            edges,
        })
    }

    fn are_certified(&self) -> bool {
        self.lattice.is_certified() && self.edges.are_certified()
    }
}

impl Sheet {
    /// The sheet of `rod`, computed by `method`, for rows at these distances (first touch, in whisker lengths).
    #[must_use]
    pub fn new(method: Method, rod: &Rod, side: Side, distances: &[f64]) -> Self {
        let rest = Rest::new(rod);
        let rows: Vec<Row> = distances.iter().map(|d| Row::new(&rest, *d)).collect();
        let nearest = rows
            .iter()
            .min_by(|a, b| a.pole_distance.total_cmp(&b.pole_distance));
        let sampled = |spacing| SheetSamples::new(method, rod, side, nearest?, spacing);
        let mut samples = sampled(SPACING);
        if !samples.as_ref().is_some_and(SheetSamples::are_certified) {
            samples = sampled(NARROW_SPACING).or(samples);
        }
        let is_certified = samples.as_ref().is_some_and(SheetSamples::are_certified);
        let mut crossings = match &samples {
            Some(samples) => crossings(method, rod, side, &samples.edges, &rows),
            None => vec![Vec::new(); rows.len()],
        };
        let fold_grows = samples
            .as_ref()
            .is_some_and(|samples| samples.edges.fold_grows);
        let needs_continuation = |row: &Row, crossings: &[Crossing]| {
            let touches = row.is_reached();
            let is_pair = usize::from(touches) + crossings.len() == 2;
            let is_simple = crossings.is_empty() && !touches
                || fold_grows && is_pair && crossings.iter().all(Crossing::is_sound);
            !(is_certified && is_simple)
        };
        let follow = |(rows, crossings): (&[Row], &mut [Vec<Crossing>])| {
            let continued: Vec<usize> = (0..rows.len())
                .filter(|i| needs_continuation(&rows[*i], &crossings[*i]))
                .collect();
            let levels: Vec<LevelCurve> = continued
                .iter()
                .map(|i| LevelCurve::new(method, rod, side, &rows[*i]))
                .collect();
            let row = |(i, level): (&usize, _)| ContinuedRow {
                level,
                touches: rows[*i].is_reached(),
                crossings: &crossings[*i],
            };
            let found = stable_pieces(&continued.iter().zip(&levels).map(row).collect::<Vec<_>>());
            let mut guesses = vec![Vec::new(); rows.len()];
            for (i, found) in continued.into_iter().zip(found) {
                let ends = |piece: &StablePiece| [piece.begin, Some(piece.end)];
                crossings[i] = found.pieces.iter().flat_map(ends).flatten().collect();
                let is_incomplete = !found.are_complete && !found.pieces.is_empty();
                if is_incomplete || samples.is_none() && !rows[i].is_reached() {
                    crossings[i].push(Crossing::unknown());
                }
                guesses[i] = found
                    .pieces
                    .iter()
                    .filter_map(|piece| piece.span(side))
                    .collect();
            }
            guesses
        };
        let continued: Vec<Vec<RowSpan>> = rows
            .par_chunks(rows_per_batch(distances.len()))
            .zip(crossings.par_chunks_mut(rows_per_batch(distances.len())))
            .map(|rows| follow(rows))
            .flatten_iter()
            .collect();
        let tip = rod.tau_tip();
        Self {
            rod: rod.clone(),
            side,
            tip: [tip, rod.radius(tip)],
            rows,
            crossings,
            method,
            guesses: match samples.filter(|_| is_certified) {
                Some(samples) => Guesses::Sampled(Box::new(samples)),
                None => Guesses::Continued(continued),
            },
        }
    }

    fn samples(&self) -> Option<&SheetSamples> {
        match &self.guesses {
            Guesses::Sampled(samples) => Some(samples),
            Guesses::Continued(_) => None,
        }
    }

    /// The fold with the contact at the tip, where slip-off turns into pull-off; `None` if it is not found.
    #[must_use]
    pub fn fold_at_tip(method: Method, rod: &Rod, side: Side) -> Option<FoldPoint> {
        fold::first_folds(method, rod, side, &[rod.tau_tip()]).pop()?
    }

    /// Whether samples do not show all of it, so that its rows are continued.
    #[must_use]
    pub fn is_continued(&self) -> bool {
        self.samples().is_none()
    }

    /// The level curve of `row`.
    #[must_use]
    pub fn level(&self, row: usize) -> LevelCurve {
        LevelCurve::new(self.method, &self.rod, self.side, &self.rows[row])
    }

    /// Whether the whisker at rest reaches the pole of `row`.
    #[must_use]
    pub fn touches(&self, row: usize) -> bool {
        self.rows[row].is_reached()
    }

    /// How far from the tip, in `tau`, the integration cannot tell a contact from one at the tip.
    #[must_use]
    pub fn tip_blur(&self) -> f64 {
        self.samples()
            .map_or(0.0, |samples| 2.0 * samples.edges.tip_error)
    }

    /// The stable pieces of `row`: from the lattice, where that is certified, else from the row's continuation.
    #[must_use]
    pub fn spans(&self, row: usize) -> Cow<'_, [RowSpan]> {
        match &self.guesses {
            Guesses::Sampled(samples) => {
                let SheetSamples {
                    contacts, lattice, ..
                } = &**samples;
                Cow::Owned(vec![lattice.span(contacts, &self.rows[row])])
            }
            Guesses::Continued(rows) => Cow::Borrowed(&rows[row]),
        }
    }

    /// Guesses for the cells of `row` at growing `pushes` (magnitudes, in radians); `None` outside the sheet.
    pub fn guesses(
        &self,
        row: usize,
        pushes: impl Iterator<Item = f64> + Clone,
    ) -> Vec<Option<Guess>> {
        let spans = self.spans(row);
        let mut guesses = match spans.first() {
            Some(span) => span.guesses(pushes.clone()),
            None => pushes.clone().map(|_| None).collect(),
        };
        for span in spans.iter().skip(1) {
            for (guess, other) in guesses.iter_mut().zip(span.guesses(pushes.clone())) {
                *guess = guess.or(other);
            }
        }
        guesses
    }

    /// Whether a state, as far as the fold goes, is on the sheet: loaded toward the pole, on the stable side of
    /// the Jacobian's first singularity.
    #[must_use]
    pub fn is_stable(&self, tau: f64, load: f64, map: &ShootingMap) -> bool {
        let load = self.side.sign() * load;
        let is_loaded = self.samples().is_none_or(|SheetSamples { contacts, .. }| {
            load >= 0.0 && contacts.is_below_folds(tau, load) || {
                let part = load / contacts.fold_load(tau);
                part > -UNLOADED && part < 1.0 + 1e-4
            }
        });
        let scale = map.by_tau.length() * map.by_load.length();
        is_loaded && map.det() > -1e-7 * scale
    }
}
