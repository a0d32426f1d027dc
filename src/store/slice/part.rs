//! Parts of a grid: the rows, columns and whiskers of selected values.

use crate::scene::{Coordinate, Grid};
use crate::store::at::{AxisValue, ChosenValues, InvalidAxisValue, NamedAxis, select};

/// Part of a grid in which the values of some axes are fixed.
#[derive(Clone, Debug)]
pub struct GridPart {
    /// Axes of the part. A fixed sweep axis is absent; a fixed axis of the panels has one value.
    pub grid: Grid,
    /// Selected rows of each panel.
    pub(super) rows: Vec<usize>,
    /// Selected columns of each panel.
    pub(super) columns: Vec<usize>,
    pub(super) chosen: ChosenValues,
    /// Selected index of each sweep axis of the whole.
    pub(super) fixed: Vec<Option<usize>>,
}

impl GridPart {
    /// Creates the part that is all of `grid`.
    #[must_use]
    pub fn whole(grid: &Grid) -> Self {
        Self {
            rows: (0..grid.distance_mm.len()).collect(),
            columns: (0..grid.push_angle_deg.len()).collect(),
            chosen: Vec::new(),
            fixed: vec![None; grid.sweep.len()],
            grid: grid.clone(),
        }
    }

    /// Creates the part of `whole` at the values nearest to those `wanted`, which must be values of the axes if `exact`.
    ///
    /// # Errors
    /// An axis is unknown or given twice, ends more than half a step before the value, or does not have it although `exact`.
    pub fn new(whole: &Grid, wanted: &[AxisValue], exact: bool) -> Result<Self, InvalidAxisValue> {
        let mut part = Self::whole(whole);
        for at in wanted {
            let chosen = part.choose(whole, at, exact);
            chosen.map_err(|why| InvalidAxisValue::new(at, why))?;
        }
        Ok(part)
    }

    fn choose(&mut self, whole: &Grid, at: &AxisValue, exact: bool) -> Result<(), String> {
        let sweep = whole.sweep.iter().map(NamedAxis::of);
        let inside =
            [("distance_mm", &*whole.distance_mm), ("push_angle_deg", &*whole.push_angle_deg)]
                .map(|(name, values)| NamedAxis { name, values, names: &[] });
        let axes: Vec<_> = sweep.chain(inside).collect();
        let (axis, index) = select(&axes, &self.chosen, at, exact)?;
        let (name, value) = (axes[axis].name, axes[axis].values[index]);
        let number = Coordinate::Number(value);
        let coordinate = whole.sweep.get(axis);
        let coordinate = coordinate.map_or(number, |axis| axis.variable.coordinate(value));
        self.chosen.push((name, coordinate));
        match name {
            "distance_mm" => {
                self.rows = vec![index];
                self.grid.distance_mm = vec![value];
            }
            "push_angle_deg" => {
                self.columns = vec![index];
                self.grid.push_angle_deg = vec![value];
            }
            _ => {
                self.fixed[axis] = Some(index);
                let sweep = &mut self.grid.sweep;
                sweep.retain(|axis| axis.variable.name() != name);
            }
        }
        Ok(())
    }
}
