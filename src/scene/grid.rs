//! Grid of a map: its axes, and the place of a whisker in a sweep.

use serde::Serialize;
use serde::ser::{SerializeStruct, Serializer};

use super::parameter::Parameter;

/// Largest ratio of the whisker's length to the distance of first touch.
pub(crate) const NEAREST: f64 = 1000.0;

/// Largest ratio of the distance of first touch to the whisker's length.
pub(super) const FARTHEST: f64 = 10.0;

/// Grid of a map: push angles, distances and sweep axes. Every list of values is strictly increasing and not empty.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Push angles, the rotations of the base since first touch, in degrees: `[push_angle]`; negative CF, positive CB.
    pub push_angle_deg: Vec<f64>,
    /// Distances from the base to the contact at first touch, in millimetres: `[distance]`.
    pub distance_mm: Vec<f64>,
    /// Sweep axes, along which whiskers differ, in the order of the scene, `[axis]`. Of two axes, a curvature is the second.
    pub sweep: Vec<SweepAxis>,
}

/// Sweep axis, along which whiskers or their poles differ in one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepAxis {
    /// Parameter that differs along the sweep axis.
    pub parameter: Parameter,
    /// Values of the parameter along the sweep axis, in its unit, `[value]`.
    pub values: Vec<f64>,
}

impl Grid {
    /// Returns the values of the sweep axis of `parameter`, in its unit, `[value]`; `None` without such an axis.
    #[must_use]
    pub fn axis(&self, parameter: Parameter) -> Option<&[f64]> {
        let mut axes = self.sweep.iter();
        let axis = axes.find(|axis| axis.parameter == parameter);
        axis.map(|axis| &*axis.values)
    }

    /// Returns the names of the sweep axes, with commas between them.
    #[must_use]
    pub fn sweep_names(&self) -> String {
        let names = self.sweep.iter().map(|axis| axis.parameter.axis());
        names.collect::<Vec<_>>().join(", ")
    }

    /// Returns the sweep axes along x and y of an atlas of at most two axes: `[x, y]`; `None` without an axis. A single axis of curvatures lies along
    /// y.
    #[must_use]
    pub fn atlas(&self) -> [Option<&SweepAxis>; 2] {
        match &*self.sweep {
            [only] if only.parameter == Parameter::ParabolaPerMm => [None, Some(only)],
            axes => [axes.first(), axes.get(1)],
        }
    }

    /// Returns the number of whiskers of the sweep.
    #[must_use]
    pub fn whisker_count(&self) -> usize {
        self.sweep.iter().map(|axis| axis.values.len()).product()
    }

    /// Returns the indices of whisker `index` on the sweep axes: `[axis]`. The first axis varies fastest; `index` is taken modulo
    /// [`Self::whisker_count`].
    #[must_use]
    pub fn indices(&self, index: usize) -> Vec<usize> {
        let mut rest = index;
        let axes = self.sweep.iter();
        axes.map(|axis| {
            let at = rest % axis.values.len();
            rest /= axis.values.len();
            at
        })
        .collect()
    }

    /// Returns the values of whisker `index` on the sweep axes; `index` is taken modulo [`Self::whisker_count`].
    #[must_use]
    pub fn place(&self, index: usize) -> SweepPlace {
        let axes = self.sweep.iter().zip(self.indices(index));
        SweepPlace(
            axes.map(|(axis, at)| (axis.parameter, axis.values[at]))
                .collect(),
        )
    }

    /// Returns the grid with only the ends of every sweep axis.
    pub(super) fn ends(&self) -> Self {
        let mut ends = self.clone();
        for axis in &mut ends.sweep {
            if let [first, .., last] = axis.values[..] {
                axis.values = vec![first, last];
            }
        }
        ends
    }
}

/// Place of a whisker in a sweep: a value for each sweep axis, in the order of the axes. In a table, each axis is a column.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepPlace(Vec<(Parameter, f64)>);

impl SweepPlace {
    /// Returns the whisker's value on the sweep axis of `parameter`, in its unit; `None` without such an axis.
    #[must_use]
    pub fn value(&self, parameter: Parameter) -> Option<f64> {
        let mut axes = self.0.iter();
        axes.find_map(|(own, value)| (*own == parameter).then_some(*value))
    }

    /// Returns the parameter of each sweep axis with the whisker's value, in the parameter's unit.
    pub fn values(&self) -> impl Iterator<Item = (Parameter, f64)> + '_ {
        self.0.iter().copied()
    }
}

impl Serialize for SweepPlace {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut columns = serializer.serialize_struct("SweepPlace", self.0.len())?;
        for (parameter, value) in &self.0 {
            columns.serialize_field(parameter.axis(), value)?;
        }
        columns.end()
    }
}
