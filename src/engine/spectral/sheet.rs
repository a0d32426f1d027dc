//! Spectral sheet of a whisker side: which row is expanded through its own states, and which belongs to a patch.

use super::certificate::{Check, bounds};
use super::exact_row::ExactRow;
use super::expansion_tail::ExpansionTail;
use super::patch::Patch;
use super::patch_size::PatchSize;
use super::row::{FUNCTIONS, RowExpansion, Weights};
use super::row_interval::RowInterval;
use crate::engine::WhiskerSide;
use crate::numerics::expansion::Chebyshev;
use crate::plan::{STATES_OF_ROW, expansion_cost};
use crate::refine::GOAL;
use crate::sheet::Edge;
use crate::shooting::batch::Method;

/// Maximum bound on the residual of an expanded state, in whisker lengths, where no tolerance is given.
pub const MOST: f64 = 1e-10;

/// Number of times that an interval of rows is halved.
const HALVINGS: u32 = 3;

/// Numbers of states of a row that is expanded alone.
const STATES: [usize; 2] = [32, 40];

/// Places at which a row that is expanded alone is checked.
const ROW_CHECKS: [f64; 2] = [0.237, 0.761];

/// Place of the expansions of a row.
#[derive(Clone, Debug)]
enum RowSource {
    /// In a patch with this index.
    Patch(usize),
    /// Through the row's own states.
    Own(Box<RowExpansion>),
    /// The row has none.
    Missing,
}

/// Spectral sheet: certified expansions of the rows of a whisker side.
#[derive(Clone, Debug)]
pub struct SpectralSheet {
    patches: Vec<Patch>,
    rows: Vec<RowSource>,
    /// Maximum bound on the residual of an expanded state, in whisker lengths.
    most: f64,
}

/// A row with its coordinate.
struct PlacedRow {
    row: usize,
    coordinate: f64,
}

impl SpectralSheet {
    /// Expands the rows of `side` up to a residual of `most` whisker lengths where that takes fewer trajectories than their cells; no row
    /// with measured radii. States are not analytic where the contact passes from one measured radius to the next, so the decay of
    /// coefficients bounds no error there. `None` without an expanded row, as where `most` is below the residual of refined states.
    #[must_use]
    pub fn new(method: Method, side: &WhiskerSide, most: f64) -> Option<Self> {
        let count = side.sheet.rows.len();
        let mut sheet = Self {
            patches: Vec::new(),
            rows: vec![RowSource::Missing; count],
            most,
        };
        if method.effects.profile || most < GOAL {
            return None;
        }
        for edge in [Edge::Fold, Edge::Tip] {
            let places = (0..count).filter_map(|row| {
                let (own, coordinate) = RowInterval::coordinate(&side.sheet, row)?;
                (own == edge).then_some(PlacedRow { row, coordinate })
            });
            let mut places: Vec<PlacedRow> = places.collect();
            places.sort_by(|a, b| a.coordinate.total_cmp(&b.coordinate));
            sheet.cover(method, side, edge, &places, HALVINGS);
        }
        let is_missing = |source: &RowSource| matches!(source, RowSource::Missing);
        let alone = |row: &usize| {
            is_missing(&sheet.rows[*row]) && expansion_cost(STATES_OF_ROW, 1) < cells(side, *row)
        };
        let mut alone: Vec<usize> = (0..count).filter(alone).collect();
        for states in STATES {
            for (row, found) in alone.iter().zip(expand(method, side, &alone, states, most)) {
                sheet.rows[*row] =
                    found.map_or(RowSource::Missing, |found| RowSource::Own(Box::new(found)));
            }
            alone.retain(|row| is_missing(&sheet.rows[*row]));
        }
        let is_empty = sheet.rows.iter().all(is_missing);
        (!is_empty).then_some(sheet)
    }

    /// Returns the largest number of states along an expanded row.
    #[must_use]
    pub fn states(&self) -> usize {
        let own = self.rows.iter().map(|source| match source {
            RowSource::Patch(patch) => self.patches[*patch].states(),
            RowSource::Own(own) => own.inverse.functions.coefficients.len(),
            RowSource::Missing => 0,
        });
        own.max().unwrap_or(0)
    }

    /// Covers neighbouring rows with patches.
    fn cover(
        &mut self,
        method: Method,
        side: &WhiskerSide,
        edge: Edge,
        rows: &[PlacedRow],
        halvings: u32,
    ) {
        let [first, .., last] = rows else { return };
        let interval = RowInterval {
            edge,
            ends: [first.coordinate, last.coordinate],
        };
        let cells: usize = rows.iter().map(|own| cells(side, own.row)).sum();
        let pays = |size: PatchSize| {
            size.rows < rows.len() && expansion_cost(size.count(), rows.len()) < cells
        };
        let is_wide = interval.ends[0] < interval.ends[1];
        if !pays(PatchSize::USUAL) || !is_wide {
            return;
        }
        if let Some(patch) = smallest_patch(method, side, interval, self.most, pays) {
            for own in rows {
                self.rows[own.row] = RowSource::Patch(self.patches.len());
            }
            self.patches.push(patch);
        } else if halvings > 0 {
            let middle = interval.ends[0].midpoint(interval.ends[1]);
            let (near, far) = rows.split_at(rows.partition_point(|own| own.coordinate < middle));
            self.cover(method, side, edge, near, halvings - 1);
            self.cover(method, side, edge, far, halvings - 1);
        }
    }

    /// Returns the expansions of `row` of `side`; `None` if the row has none.
    #[must_use]
    pub fn row(&self, side: &WhiskerSide, row: usize) -> Option<RowExpansion> {
        match &self.rows[row] {
            RowSource::Patch(patch) => self.patches[*patch].row(side, row),
            RowSource::Own(own) => Some(RowExpansion::clone(own)),
            RowSource::Missing => None,
        }
    }
}

/// Sizes of patches that are tried over an interval: the first, and two that are expected to be enough. If they are not, states are too
/// inexact for the bound, or not analytic.
const TRIES: usize = 3;

/// A certified patch over `interval` with as few states as possible, found from small to large while the next size `pays`.
fn smallest_patch(
    method: Method,
    side: &WhiskerSide,
    interval: RowInterval,
    most: f64,
    pays: impl Fn(PatchSize) -> bool,
) -> Option<Patch> {
    let mut size = PatchSize::FIRST;
    for _ in 0..TRIES {
        match Patch::new(method, side, interval, size, most) {
            Ok(patch) => return Some(patch),
            Err(enough) => size = enough.filter(|next| pays(*next))?,
        }
    }
    None
}

/// Number of cells of a row from first touch to its end.
fn cells(side: &WhiskerSide, row: usize) -> usize {
    let end = side.sheet.crossings[row]
        .first()
        .map_or(0.0, |end| end.push);
    side.columns.magnitudes.partition_point(|push| *push < end)
}

/// Expands rows through `states` of their own.
fn expand(
    method: Method,
    side: &WhiskerSide,
    rows: &[usize],
    states: usize,
    most: f64,
) -> Vec<Option<RowExpansion>> {
    let exact = ExactRow::all(method, &side.sheet, rows, states, most);
    let found: Vec<&ExactRow> = exact.iter().flatten().collect();
    let functions: Vec<Chebyshev<FUNCTIONS>> =
        found.iter().map(|row| row.expansion(side)).collect();
    let weights: Vec<Weights> = found.iter().map(|row| row.weights(side)).collect();
    let checks = found.iter().zip(functions.iter().zip(&weights));
    let checks = checks.map(|(row, (functions, weights))| Check {
        row: row.row,
        functions,
        weights,
        places: &ROW_CHECKS,
    });
    let decays = functions
        .iter()
        .zip(&weights)
        .map(|(row, weights)| ExpansionTail::new(&row.tails(), weights).last);
    let bounds = bounds(
        method,
        side,
        &checks.collect::<Vec<_>>(),
        &decays.collect::<Vec<_>>(),
    );
    let mut certified = functions.into_iter().zip(weights).zip(bounds);
    let expansions = rows.iter().zip(&exact).map(|(row, exact)| {
        exact.as_ref()?;
        let ((functions, weights), bound) = certified.next()?;
        let expansion = || RowExpansion::new(functions, &weights, bound, &side.sheet, *row);
        (bound <= most).then(expansion)?
    });
    expansions.collect()
}
