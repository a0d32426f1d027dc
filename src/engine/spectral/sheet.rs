//! The spectral sheet of a whisker side: which row is expanded through its own states, and which belongs to a patch.

use super::certificate::{Check, MARGIN, bounds};
use super::patch::{Patch, PatchSize, RowInterval};
use super::row::{ExactRow, FUNCTIONS, RowExpansion, Weights, largest};
use crate::engine::WhiskerSide;
use crate::numerics::expansion::{Chebyshev, MOST_POINTS};
use crate::sheet::Edge;
use crate::shooting::batch::Method;

/// Maximum bound on the residual of a state that is expanded as accurately as maps need, in whisker lengths.
pub const MOST: f64 = 1e-10;

/// Rows, and states along each, by which the error of a patch falls to a tenth: measured on the paper's cone.
const PER_DIGIT: [f64; 2] = [1.5, 2.0];

/// Expected error of a usual patch from row to row, over the maximum bound, above which the interval is halved at once.
const HOPELESS: f64 = 1e4;

/// Number of times that an interval of rows is halved.
const HALVINGS: u32 = 3;

/// Places at which a row that is expanded alone is checked.
const ROW_CHECKS: [f64; 2] = [0.237, 0.761];

/// Size of the first patch over an interval, enough for most whiskers: 26 rows of 32 states for a bound `most` of 1e-10 whisker lengths.
fn usual(most: f64) -> PatchSize {
    let digits = libm::log10(MOST / most);
    let [rows, states] = [26.0 + PER_DIGIT[0] * digits, 32.0 + PER_DIGIT[1] * digits]
        .map(|points| points.round().clamp(1.0, MOST_POINTS as f64) as usize);
    PatchSize { rows, states }
}

/// Size of the patch that follows one of `size` whose expected error from row to row is `by_rows`.
fn larger(size: PatchSize, by_rows: f64, most: f64) -> PatchSize {
    let digits = libm::log10(MARGIN * by_rows / most).max(0.0);
    let more = (PER_DIGIT[0] * digits).ceil() as usize + 1;
    PatchSize {
        rows: MOST_POINTS.min(size.rows + more),
        states: MOST_POINTS,
    }
}

/// Where the expansions of a row are.
#[derive(Clone, Debug)]
enum RowSource {
    /// In a patch with this index.
    Patch(usize),
    /// Through the row's own states.
    Own(Box<RowExpansion>),
    /// The row has none.
    Missing,
}

/// Certified expansions of the rows of a whisker side.
#[derive(Clone, Debug)]
pub struct SpectralSheet {
    /// Maximum bound on the residual of a state, in whisker lengths.
    pub most: f64,
    patches: Vec<Patch>,
    rows: Vec<RowSource>,
}

/// A row with its coordinate.
struct PlacedRow {
    row: usize,
    coordinate: f64,
}

impl SpectralSheet {
    /// Expands the rows of `side` with a bound of at most `most` whisker lengths, where that takes fewer states than their cells; no row with
    /// measured radii. States are not analytic where the contact passes from one measured radius to the next, so the decay of coefficients
    /// bounds no error there.
    #[must_use]
    pub fn new(method: Method, side: &WhiskerSide, most: f64) -> Self {
        let count = side.sheet.rows.len();
        let mut sheet = Self {
            most,
            patches: Vec::new(),
            rows: vec![RowSource::Missing; count],
        };
        if method.effects.profile {
            return sheet;
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
        let states = usual(most).states;
        let alone = |row: &usize| {
            matches!(sheet.rows[*row], RowSource::Missing)
                && cells(side, *row) > states + ROW_CHECKS.len()
        };
        let mut alone: Vec<usize> = (0..count).filter(alone).collect();
        for states in [states, MOST_POINTS] {
            for (row, found) in alone.iter().zip(expand(method, side, &alone, states, most)) {
                sheet.rows[*row] =
                    found.map_or(RowSource::Missing, |found| RowSource::Own(Box::new(found)));
            }
            alone.retain(|row| matches!(sheet.rows[*row], RowSource::Missing));
        }
        sheet
    }

    /// Number of states along a row of the first patch, for a bound of `most` whisker lengths.
    #[must_use]
    pub fn states(most: f64) -> usize {
        usual(most).states
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
        let pays = |size: PatchSize| size.rows < rows.len() && size.rows * size.states < cells;
        let is_wide = interval.ends[0] < interval.ends[1];
        let (most, usual) = (self.most, usual(self.most));
        if !pays(usual) || !is_wide {
            return;
        }
        let mut found = Patch::new(method, side, interval, usual, most);
        if let Err(by_rows) = found
            && by_rows < HOPELESS * most
        {
            let size = larger(usual, by_rows, most);
            if pays(size) {
                found = Patch::new(method, side, interval, size, most);
            }
        }
        if let Ok(patch) = found {
            for own in rows {
                // A row that the patch refuses is expanded alone.
                if patch.row(side, own.row).is_some() {
                    self.rows[own.row] = RowSource::Patch(self.patches.len());
                }
            }
            self.patches.push(patch);
        } else if halvings > 0 {
            let middle = interval.ends[0].midpoint(interval.ends[1]);
            let (near, far) = rows.split_at(rows.partition_point(|own| own.coordinate < middle));
            self.cover(method, side, edge, near, halvings - 1);
            self.cover(method, side, edge, far, halvings - 1);
        }
    }

    /// The expansions of `row` of `side`; `None` if the row has none.
    #[must_use]
    pub fn row(&self, side: &WhiskerSide, row: usize) -> Option<RowExpansion> {
        match &self.rows[row] {
            RowSource::Patch(patch) => self.patches[*patch].row(side, row),
            RowSource::Own(own) => Some(RowExpansion::clone(own)),
            RowSource::Missing => None,
        }
    }
}

/// Number of cells of a row from first touch to its end.
fn cells(side: &WhiskerSide, row: usize) -> usize {
    let end = side.sheet.crossings[row]
        .first()
        .map_or(0.0, |end| end.push);
    side.columns.magnitudes.partition_point(|push| *push < end)
}

/// Expands rows through `states` of their own, with a bound of at most `most` whisker lengths.
fn expand(
    method: Method,
    side: &WhiskerSide,
    rows: &[usize],
    states: usize,
    most: f64,
) -> Vec<Option<RowExpansion>> {
    let exact = ExactRow::all(method, &side.sheet, rows, states);
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
        .map(|(row, weights)| largest(&row.tail(), weights));
    let bounds = bounds(
        method,
        side,
        &checks.collect::<Vec<_>>(),
        &decays.collect::<Vec<_>>(),
    );
    let mut certified = found.iter().zip(functions).zip(weights).zip(bounds).map(
        |(((row, functions), weights), bound)| {
            (bound <= most)
                .then(|| RowExpansion::new(functions, &weights, bound, &row.row, &row.end))?
        },
    );
    exact
        .iter()
        .map(|row| row.as_ref().and_then(|_| certified.next()?))
        .collect()
}
