//! Row batches: the cells of some rows, as a request to an engine.

use super::{Values, WhiskerSide};
use crate::refine::base_points;
use crate::rod::Rod;
use crate::sheet::Sheet;
use crate::shooting::batch::{InitialCondition, Method, StepStart, step_starts};
use crate::shooting::{FirstVariation, Resolution};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// Number of coefficients of a Taylor polynomial along a row.
pub const POWERS: usize = 12;

/// Maximum number of steps of the trajectory of a base point. Most take dozens; a row that needs more gets no base points.
pub const MOST_TRAJECTORY_STEPS: u32 = 512;

/// Base points per rayon task.
const CHUNK: usize = 64;

/// Seven numbers of a state that are expanded along a row. They are the push angle (radians), `tau`, a direction (radians), and the
/// derivatives of `(ln D, phi)` by `tau` and by load. The direction is that of the resting whisker's point at the distance of the
/// contact.
pub type RowTerms = [f64; 7];

/// Base point: an exact state of a row, with the Taylor expansion of the row around it.
#[derive(Clone, Debug)]
pub struct BasePoint {
    /// Index of the base point's whisker side in the batch.
    pub rod: u32,
    /// Contact coordinate `tau` of the base point, dimensionless.
    pub tau: f64,
    /// Signed load `f/rho^2` of the base point, dimensionless.
    pub load: f64,
    /// Signed push angle of the base point since first touch, in radians.
    pub push: f64,
    /// State at the base point with its first derivatives, in the frame of the contact.
    pub state: FirstVariation,
    /// Derivative of the signed load `f/rho^2` by the row parameter `w` along a row. Here, `w` is `load tau^2` over its value at the end
    /// of the row.
    pub load_per_w: f64,
    /// Taylor coefficients of the row in `w` around the base point: `[power][term]`.
    pub row: [RowTerms; POWERS],
    /// Cells of the base point: range of indices among the columns of all sides.
    pub cells: Range<u32>,
    /// Trajectory of the base point, and the index of its first cell.
    pub trajectory: BaseTrajectory,
}

/// Trajectory of a base point, with the index of its first cell in the batch.
#[derive(Clone, Copy, Debug, Default)]
pub struct BaseTrajectory {
    /// Number of steps of the base point's trajectory.
    pub steps: u32,
    /// Angle by which bending turns the base along the base point's trajectory, in radians.
    pub bent: f64,
    /// Index of the first cell of the base point among the cells of the batch.
    pub first_cell: usize,
    /// Channel values at the base point, in map units: `[channel]`.
    pub values: Values,
}

/// Row of a batch: the cells of one row to solve.
#[derive(Clone, Debug)]
pub struct BatchRow {
    /// Index of the row's whisker side in the batch.
    pub side: usize,
    /// Index of the row in the side's sheet.
    pub row: usize,
    /// Cells of the row to solve, `[range]`: growing, disjoint ranges of the side's columns.
    pub cells: Vec<Range<usize>>,
    /// Index of the row's first cell among the cells of the batch.
    pub first: usize,
    /// Indices of the row's base points in the batch; empty where the row has none.
    pub base_points: Range<usize>,
}

impl BatchRow {
    /// Returns the number of cells of the row in the batch.
    #[must_use]
    pub fn count(&self) -> usize {
        self.cells.iter().map(Range::len).sum()
    }

    /// Returns the cells of the row to solve, in order.
    pub fn each(&self) -> impl Iterator<Item = usize> + Clone + '_ {
        self.cells.iter().flat_map(Range::clone)
    }
}

/// Row batch: cells of some rows, for an [`Engine`](super::Engine).
#[derive(Clone, Debug)]
pub struct RowBatch {
    /// Integration method of the trajectories: effects and resolution.
    pub method: Method,
    /// Whisker sides of the batch: `[side]`.
    pub sides: Arc<[WhiskerSide]>,
    /// Rows of the batch, in the order of their cells: `[row]`.
    pub rows: Vec<BatchRow>,
    /// Signed push angles of the columns of all sides, in radians: `[column]`.
    pub pushes: Arc<[f64]>,
    /// True if the engine is to return channel values.
    pub has_values: bool,
    /// True if the engine is to return `(tau, load)` of the cells.
    pub has_points: bool,
    /// Base points of all rows of the batch, `[base_point]`; none before [`RowBatch::with_base_points`].
    pub base_points: Vec<BasePoint>,
    /// States of the whisker at the starts of the integration steps of every base point's trajectory, one trajectory after the other,
    /// `[step]`. [`BaseTrajectory::steps`] is the number of a trajectory's steps.
    pub starts: Vec<StepStart>,
}

impl RowBatch {
    /// Creates a batch of all cells of `rows`, pairs of a side and a row of its sheet.
    #[must_use]
    pub fn new(
        method: Method,
        sides: Arc<[WhiskerSide]>,
        pushes: Arc<[f64]>,
        rows: impl IntoIterator<Item = (usize, usize)>,
    ) -> Self {
        let mut first = 0;
        let rows = rows.into_iter().map(|(side, row)| {
            let columns = sides[side].columns.len();
            first += columns;
            BatchRow {
                side,
                row,
                cells: std::iter::once(0..columns).collect(),
                first: first - columns,
                base_points: 0..0,
            }
        });
        let rows = rows.collect();
        Self {
            method,
            has_values: true,
            has_points: false,
            sides,
            rows,
            pushes,
            base_points: Vec::new(),
            starts: Vec::new(),
        }
    }

    /// Returns a batch of some `cells` of each row of this one, without base points.
    #[must_use]
    pub fn only(&self, cells: impl IntoIterator<Item = Vec<Range<usize>>>) -> Self {
        let (sides, pushes) = (Arc::clone(&self.sides), Arc::clone(&self.pushes));
        let mut part = Self::new(self.method, sides, pushes, []);
        (part.has_values, part.has_points) = (self.has_values, self.has_points);
        for (row, cells) in self.rows.iter().zip(cells) {
            part.rows.push(BatchRow {
                cells,
                first: part.cells(),
                base_points: 0..0,
                ..*row
            });
        }
        part
    }

    /// Returns pairs of the index of a cell in this batch and in `part`, a batch of some of its cells.
    pub fn places_in<'a>(&'a self, part: &'a Self) -> impl Iterator<Item = (usize, usize)> + 'a {
        let rows = self.rows.iter().zip(&part.rows);
        rows.flat_map(|(whole, part)| part.each().map(|cell| whole.first + cell).zip(part.first..))
    }

    /// Returns true if an engine can solve some cells of the batch: there are base points or nets.
    #[must_use]
    pub fn is_for_engine(&self) -> bool {
        let has_net = |row: &BatchRow| self.sides[row.side].net.is_some();
        !self.base_points.is_empty() || self.rows.iter().any(has_net)
    }

    /// Returns the batch with base points for all rows that can have them, with trajectories in the steps of `resolution`.
    #[must_use]
    pub fn with_base_points(mut self, resolution: Resolution) -> Self {
        let found = base_points(&self);
        let mut base_points = Vec::with_capacity(found.iter().map(Vec::len).sum());
        for (row, found) in self.rows.iter_mut().zip(found) {
            let from = base_points.len();
            base_points.extend(found);
            row.base_points = from..base_points.len();
        }
        self.set_base_points(base_points, resolution);
        self
    }

    /// Replaces the base points of the batch, which are those of the rows in order, and integrates their trajectories.
    pub fn set_base_points(&mut self, mut base_points: Vec<BasePoint>, resolution: Resolution) {
        let rows = self.rows.iter();
        let row_of = rows.flat_map(|row| std::iter::repeat_n(row, row.base_points.len()));
        let mut pairs: Vec<(&BatchRow, &mut BasePoint)> = row_of.zip(&mut base_points).collect();
        let parts = pairs.par_chunks_mut(CHUNK).map(|pairs| {
            let conditions = pairs.iter().map(|(_, base)| InitialCondition {
                rod: self.rod(base),
                tau: base.tau,
                load: base.load,
            });
            let conditions: Vec<InitialCondition> = conditions.collect();
            let steps = conditions.iter().map(|at| {
                let steps = resolution.steps(at.rod, at.tau, at.load);
                // A NaN input would request thousands of steps.
                steps.min(MOST_TRAJECTORY_STEPS)
            });
            let steps: Vec<u32> = steps.collect();
            let (starts, bent) = step_starts(&conditions, &steps);
            for ((row, base), (steps, bent)) in pairs.iter_mut().zip(steps.into_iter().zip(bent)) {
                let side = &self.sides[row.side];
                base.trajectory = BaseTrajectory {
                    steps,
                    bent,
                    first_cell: row.first + (base.cells.start - side.columns.first) as usize,
                    values: side.base_values(row.row, base),
                };
            }
            starts
        });
        self.starts = parts.collect::<Vec<Vec<StepStart>>>().concat();
        self.base_points = base_points;
    }

    /// Returns the rod of a base point.
    #[must_use]
    pub fn rod(&self, base: &BasePoint) -> &Rod {
        &self.sides[base.rod as usize].sheet.rod
    }

    /// Returns the sheets of all sides of the batch: `[side]`.
    #[must_use]
    pub fn sheets(&self) -> Vec<&Sheet> {
        self.sides.iter().map(|side| &side.sheet).collect()
    }

    /// Returns the number of cells of all rows of the batch.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.rows.last().map_or(0, |last| last.first + last.count())
    }
}
