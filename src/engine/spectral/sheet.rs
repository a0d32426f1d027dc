//! Spectral sheet of a whisker side: which row is expanded through its own states, and which belongs to a patch.

use super::certificate::{Check, bounds};
use super::patch::{Patch, PatchSize, RowInterval};
use super::row::{ExactRow, FUNCTIONS, RowExpansion, Weights, largest};
use crate::engine::WhiskerSide;
use crate::numerics::expansion::Chebyshev;
use crate::sheet::Edge;
use crate::shooting::batch::Method;

/// Maximum bound on the residual of an expanded state, in whisker lengths.
pub const MOST: f64 = 1e-10;

/// Size of the first patch over an interval: enough for most whiskers.
const USUAL: PatchSize = PatchSize {
    rows: 24,
    states: 32,
};

/// Size of the patch that follows a usual one whose coefficients nearly decay.
const LARGE: PatchSize = PatchSize {
    rows: 40,
    states: 40,
};

/// Expected error of a usual patch from row to row, in whisker lengths, above which the interval is halved at once: 16 more rows divide the
/// error by less than this over [`MOST`].
const HOPELESS: f64 = 1e-6;

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
}

/// A row with its coordinate.
struct PlacedRow {
    row: usize,
    coordinate: f64,
}

impl SpectralSheet {
    /// Expands the rows of `side` where that takes fewer states than their cells; no row with measured radii. States are not analytic where
    /// the contact passes from one measured radius to the next, so the decay of coefficients bounds no error there.
    #[must_use]
    pub fn new(method: Method, side: &WhiskerSide) -> Self {
        let count = side.sheet.rows.len();
        let mut sheet = Self {
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
        let alone = |row: &usize| {
            matches!(sheet.rows[*row], RowSource::Missing)
                && cells(side, *row) > STATES[0] + ROW_CHECKS.len()
        };
        let mut alone: Vec<usize> = (0..count).filter(alone).collect();
        for states in STATES {
            for (row, found) in alone.iter().zip(expand(method, side, &alone, states)) {
                sheet.rows[*row] =
                    found.map_or(RowSource::Missing, |found| RowSource::Own(Box::new(found)));
            }
            alone.retain(|row| matches!(sheet.rows[*row], RowSource::Missing));
        }
        sheet
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
        if !pays(USUAL) || !is_wide {
            return;
        }
        let mut found = Patch::new(method, side, interval, USUAL, MOST);
        if matches!(found, Err(by_rows) if by_rows < HOPELESS) && pays(LARGE) {
            found = Patch::new(method, side, interval, LARGE, MOST);
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
            (bound <= MOST)
                .then(|| RowExpansion::new(functions, &weights, bound, &row.row, &row.end))?
        },
    );
    exact
        .iter()
        .map(|row| row.as_ref().and_then(|_| certified.next()?))
        .collect()
}
