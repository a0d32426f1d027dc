//! Whisker sides: one side of one whisker, and the channel values of its states in map units.

use super::{Cell, SideColumns};
use crate::classify::Outcome;
use crate::friction::FrictionState;
use crate::plan::STATE_CHANNELS;
use crate::refine::ContactState;
use crate::scene::Parameter;
use crate::sheet::net::{ValueDraft, ValueNet};
use crate::sheet::{Crossing, Sheet};
use glam::DVec2;
use std::sync::Arc;
use whiskmap_mechanics::rod::{Rod, Units, arclength};
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition};
use whiskmap_mechanics::shooting::{Dimension, FullState, PeakStrain, Reader, Reading};

/// Channel values of a state in map units, `[channel]`, in the order of [`STATE_CHANNELS`].
pub type Values = [f64; STATE_CHANNELS.len()];

/// Whisker side: its sheet, its columns of the map, and the units.
#[derive(Debug)]
pub struct WhiskerSide {
    /// Columns of the map on this whisker side.
    pub columns: Arc<SideColumns>,
    /// Stable sheet of the whisker side, with a row for each distance of the map.
    pub sheet: Sheet,
    /// Units of the channels, `[channel]`: the map's value of 1 whisker length, 1 radian, `E I_base/L_w^2` (forces), or `E I_base/L_w` (moment and
    /// energy).
    pub unit_values: Values,
    /// Derivatives of the push angle at the detachment of each row, in degrees per unit of the parameter: `[row][parameter]`. Empty
    /// without such channels.
    pub push_derivatives: Vec<Vec<(Parameter, f32)>>,
    /// Unit of bending strain.
    unit_strain: f64,
    reader: Reader,
}

impl WhiskerSide {
    /// Joins a sheet with the `columns` of its whisker side; channel values are in `units`.
    #[must_use]
    pub fn new(columns: Arc<SideColumns>, units: Units, sheet: Sheet) -> Self {
        let reader = Reader::new(units, &sheet.rod);
        Self {
            unit_values: reader.of_one(sheet.side.sign()),
            columns,
            sheet,
            push_derivatives: Vec::new(),
            unit_strain: units.strain,
            reader,
        }
    }

    /// Returns this whisker side with a net whose states have a residual of at most `most` whisker lengths. The net has the rows for which it takes
    /// less time than a trajectory for each cell.
    #[must_use]
    pub fn with_net(mut self, most: f64) -> Self {
        let net = self.net(most);
        self.sheet.set_net(net);
        self
    }

    /// Computes the net of this whisker side, as [`Self::with_net`] adds it.
    #[must_use]
    pub fn net(&self, most: f64) -> Option<ValueNet> {
        ValueNet::new(&self.sheet, |row| self.cells_before_end(row), most)
    }

    /// Begins the net of this whisker side, as [`Self::net`] computes it, for trajectories that are integrated elsewhere.
    pub(crate) fn draft(&self, most: f64) -> Option<ValueDraft> {
        ValueDraft::new(&self.sheet, |row| self.cells_before_end(row), most)
    }

    /// Number of cells of `row` before its end.
    fn cells_before_end(&self, row: usize) -> usize {
        let end = self.sheet.crossings[row].first();
        let end = end.map_or(0.0, |end| end.push);
        self.columns.pushes.partition_point(|push| *push < end)
    }

    /// Returns the converter of the side's states to map units.
    #[must_use]
    pub const fn reader(&self) -> &Reader {
        &self.reader
    }

    /// Returns true if the contact on this whisker side has friction.
    #[must_use]
    pub fn has_friction(&self) -> bool {
        self.sheet.rod.friction != 0.0
    }

    /// Returns the channel values `[channel]` of a state of `row` at `signed_push`, in radians.
    #[must_use]
    pub fn values(&self, row: usize, tau: f64, full: &FullState, signed_push: f64) -> Values {
        let touch = self.sheet.rows[row].touch;
        self.reader.values(tau, full, touch, signed_push)
    }

    /// Returns the channel values `[channel]` of a state with friction of `row` at `signed_push`, in radians.
    #[must_use]
    pub fn values_with_friction(
        &self,
        row: usize,
        signed_push: f64,
        state: &FrictionState,
    ) -> Values {
        let rod = state.rod(&self.sheet.rod);
        let reader = self.reader.with_contact(&rod);
        let touch = self.sheet.rows[row].touch;
        reader.values(state.at.point.x, &state.variation.full, touch, signed_push)
    }

    /// Returns the largest bending strains of states with contact and load `(tau, load)` and the side's friction: `[point]`. Each state takes a
    /// trajectory.
    #[must_use]
    pub fn peak_strains(&self, points: impl Iterator<Item = DVec2>) -> Vec<f32> {
        let peaks: Vec<PeakStrain> = self.strains().shoot_at(&self.sheet.rod, points);
        peaks.iter().map(|peak| self.strain(peak)).collect()
    }

    /// Returns the largest bending strains of states with friction, `[state]`.
    #[must_use]
    pub fn peak_strains_with_friction(&self, states: &[&FrictionState]) -> Vec<f32> {
        let rods = states.iter().map(|state| state.rod(&self.sheet.rod));
        let rods: Vec<Rod> = rods.collect();
        let conditions: Vec<InitialCondition> = rods
            .iter()
            .zip(states)
            .map(|(rod, state)| InitialCondition::new(rod, state.at.point))
            .collect();
        let peaks: Vec<PeakStrain> = self.strains().shoot(&conditions);
        peaks.iter().map(|peak| self.strain(peak)).collect()
    }

    /// Integrator of trajectories with their largest strains.
    fn strains(&self) -> Batch {
        Batch::new(self.sheet.method())
    }

    fn strain(&self, peak: &PeakStrain) -> f32 {
        (peak.strain * self.unit_strain) as f32
    }

    /// Returns the size of each channel's values along a row with this `end`, `[channel]`. For a component of the force it is the force, for
    /// the moment and the energy the force times its lever, and for an angle one radian.
    #[must_use]
    pub fn sizes(&self, end: &Crossing) -> Values {
        let rod = &self.sheet.rod;
        let [length, radian, force, ..] = self.unit_values;
        let arc = arclength(rod, end.tau) * length;
        let force = (end.load * rod.radius(end.tau).powi(2) * force).abs();
        Reading::DIMENSIONS.map(|dimension| match dimension {
            Dimension::Length => arc,
            Dimension::Angle => radian,
            Dimension::NormalForce | Dimension::Force => force,
            Dimension::Moment => force * arc,
        })
    }

    /// Returns the cell of `row` with a solution `state` at `signed_push`, in radians; NaN values unless `has_values`.
    #[must_use]
    pub fn solved(
        &self,
        row: usize,
        signed_push: f64,
        state: &ContactState,
        steps: u32,
        has_values: bool,
    ) -> Cell {
        let outcome = match state.is_at_tip(&self.sheet) {
            true => Outcome::AtTip,
            false => Outcome::Solved,
        };
        let unsolved = Cell::new(outcome, steps);
        let values = has_values.then(|| self.values(row, state.point.x, &state.full, signed_push));
        Cell {
            residual: state.residual as f32,
            values: values.map_or(unsolved.values, |all| all.map(|value| value as f32)),
            point: state.point,
            ..unsolved
        }
    }

    /// Returns the cell of `row` at first touch: the resting whisker without a load.
    #[must_use]
    pub fn first_touch(&self, row: usize, steps: u32) -> Cell {
        let row = &self.sheet.rows[row];
        let values = row.read_first_touch(&self.reader).channels();
        Cell {
            residual: 0.0,
            values: values.map(|value| value as f32),
            point: row.first_touch(&self.sheet.rod),
            ..Cell::new(Outcome::Solved, steps)
        }
    }
}
