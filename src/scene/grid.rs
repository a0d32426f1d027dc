//! Grid of a map: its axes, and the place of a whisker in a sweep.

use std::fmt;
use std::sync::Arc;

use serde::Serialize;
use serde::ser::{SerializeStruct, Serializer};

use super::limits::{digits, rounded};
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
    /// Sweep axes, along which whiskers differ, in the order of the scene, `[axis]`. A curvature is the second of two axes.
    pub sweep: Vec<SweepAxis>,
}

/// Sweep axis, along which whiskers or their poles differ.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepAxis {
    /// What differs along the sweep axis.
    pub variable: SweepVariable,
    /// Values of the variable along the sweep axis, in its unit, `[value]`.
    pub values: Vec<f64>,
}

impl SweepAxis {
    /// Returns the values of the sweep axis as numbers, or as names of whiskers: `[value]`.
    pub fn coordinates(&self) -> impl Iterator<Item = Coordinate> + '_ {
        let values = self.values.iter();
        values.map(|value| self.variable.coordinate(*value))
    }
}

/// What differs along a sweep axis.
#[derive(Clone, Debug, PartialEq)]
pub enum SweepVariable {
    /// Parameter of whiskers or their poles. The values of its axis are in its unit.
    Parameter(Parameter),
    /// Whiskers of a table with these names, `[row]`. The values of its axis are numbers of rows, from 1.
    Whisker(Arc<[String]>),
}

impl SweepVariable {
    /// Name of the axis of whiskers.
    pub const WHISKER: &str = "whisker";

    /// Key of the table of whiskers in a scene file.
    pub(crate) const TABLE: &str = "whiskers.table";

    /// Returns the name of the variable's sweep axis, as of [`Parameter::axis`]; `whisker` for whiskers of a table.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Parameter(parameter) => parameter.axis(),
            Self::Whisker(_) => Self::WHISKER,
        }
    }

    /// Returns the key of the variable's sweep axis in a scene file, such as `grid.taper`.
    #[must_use]
    pub const fn key(&self) -> &'static str {
        match self {
            Self::Parameter(parameter) => parameter.axis_key(),
            Self::Whisker(_) => Self::TABLE,
        }
    }

    /// Returns the unit of the values; `1` for ratios and numbers of rows.
    #[must_use]
    pub const fn unit(&self) -> &'static str {
        match self {
            Self::Parameter(parameter) => parameter.unit(),
            Self::Whisker(_) => "1",
        }
    }

    /// Returns the title of the variable in charts.
    #[must_use]
    pub const fn title(&self) -> &'static str {
        match self {
            Self::Parameter(parameter) => parameter.title(),
            Self::Whisker(_) => Self::WHISKER,
        }
    }

    /// Returns the parameter that differs; `None` for whiskers of a table.
    #[must_use]
    pub const fn parameter(&self) -> Option<Parameter> {
        match self {
            Self::Parameter(parameter) => Some(*parameter),
            Self::Whisker(_) => None,
        }
    }

    /// Returns the names of the whiskers of a table, `[row]`; empty for a parameter.
    #[must_use]
    pub fn names(&self) -> &[String] {
        match self {
            Self::Parameter(_) => &[],
            Self::Whisker(names) => names,
        }
    }

    /// Returns a value of the variable's axis: a number, or the name of a whisker.
    #[must_use]
    pub fn coordinate(&self, value: f64) -> Coordinate {
        let row = row_of(value);
        match self.names().get(row) {
            Some(name) => Coordinate::Name(name.clone()),
            None => Coordinate::Number(value),
        }
    }
}

impl From<Parameter> for SweepVariable {
    fn from(parameter: Parameter) -> Self {
        Self::Parameter(parameter)
    }
}

/// Index of the row of a table that a value of the axis of whiskers numbers.
const fn row_of(value: f64) -> usize {
    (value as usize).saturating_sub(1)
}

/// Value on an axis: a number, or the name of a whisker.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Coordinate {
    /// Number on an axis, in the axis' unit.
    Number(f64),
    /// Name of a whisker of a table.
    Name(String),
}

impl Coordinate {
    /// Returns a number rounded to a number of significant digits, at least 1; names stay as they are.
    #[must_use]
    pub fn rounded(&self, digits: usize) -> Self {
        match self {
            Self::Number(number) => Self::Number(rounded(*number, digits)),
            Self::Name(name) => Self::Name(name.clone()),
        }
    }

    /// Returns the number, in the axis' unit; `None` for a name.
    #[must_use]
    pub const fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            Self::Name(_) => None,
        }
    }
}

/// A number has the fewest digits that identify it.
impl fmt::Display for Coordinate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => f.write_str(&digits(*number)),
            Self::Name(name) => f.write_str(name),
        }
    }
}

impl Grid {
    /// Returns the values of the sweep axis of `parameter`, in its unit, `[value]`; `None` without such an axis.
    #[must_use]
    pub fn axis(&self, parameter: Parameter) -> Option<&[f64]> {
        let mut axes = self.sweep.iter();
        let axis = axes.find(|axis| axis.variable == parameter.into());
        axis.map(|axis| &*axis.values)
    }

    /// Returns the names of the sweep axes, with commas between them.
    #[must_use]
    pub fn sweep_names(&self) -> String {
        let names = self.sweep.iter().map(|axis| axis.variable.name());
        names.collect::<Vec<_>>().join(", ")
    }

    /// Returns the sweep axes along x and y of an atlas of at most two axes: `[x, y]`; `None` without an axis. A single axis of curvatures lies along
    /// y.
    #[must_use]
    pub fn atlas(&self) -> [Option<&SweepAxis>; 2] {
        match &*self.sweep {
            [only] if only.variable == Parameter::ParabolaPerMm.into() => [None, Some(only)],
            axes => [axes.first(), axes.get(1)],
        }
    }

    /// Returns the number of cells of one whisker's panel: distances times push angles.
    #[must_use]
    pub const fn panel_cells(&self) -> usize {
        self.distance_mm.len() * self.push_angle_deg.len()
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
        SweepPlace(axes.map(|(axis, at)| (axis.variable.clone(), axis.values[at])).collect())
    }

    /// Returns the grid with only the ends of every sweep axis of a parameter, and all whiskers of a table.
    pub(super) fn ends(&self) -> Self {
        let mut ends = self.clone();
        for axis in &mut ends.sweep {
            if axis.variable.parameter().is_some()
                && let [first, .., last] = axis.values[..]
            {
                axis.values = vec![first, last];
            }
        }
        ends
    }
}

/// Place of a whisker in a sweep: a value for each sweep axis, in the order of the axes. In a table, each axis is a column.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepPlace(Vec<(SweepVariable, f64)>);

impl SweepPlace {
    /// Returns the whisker's value on the sweep axis of `parameter`, in its unit; `None` without such an axis.
    #[must_use]
    pub fn value(&self, parameter: Parameter) -> Option<f64> {
        let mut values = self.values();
        values.find_map(|(swept, value)| (swept == parameter).then_some(value))
    }

    /// Returns the parameter of each sweep axis of a parameter with the whisker's value, in the parameter's unit.
    pub fn values(&self) -> impl Iterator<Item = (Parameter, f64)> + '_ {
        let axes = self.0.iter();
        axes.filter_map(|(variable, value)| Some((variable.parameter()?, *value)))
    }

    /// Returns the name of each sweep axis with the whisker's value, in the order of the axes.
    pub fn coordinates(&self) -> impl Iterator<Item = (&'static str, Coordinate)> + '_ {
        let axes = self.0.iter();
        axes.map(|(variable, value)| (variable.name(), variable.coordinate(*value)))
    }

    /// Returns the name of the whisker in the table of whiskers; `None` without a table.
    #[must_use]
    pub fn whisker(&self) -> Option<&str> {
        let mut axes = self.0.iter();
        let named = axes.find_map(|(variable, value)| variable.names().get(row_of(*value)));
        named.map(String::as_str)
    }

    /// Returns the index of the whisker's row in the table of whiskers; `None` without a table.
    #[must_use]
    pub fn row(&self) -> Option<usize> {
        let mut axes = self.0.iter();
        let axis = axes.find(|(variable, _)| variable.parameter().is_none());
        axis.map(|(_, value)| row_of(*value))
    }
}

impl Serialize for SweepPlace {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut columns = serializer.serialize_struct("SweepPlace", self.0.len())?;
        for (name, value) in self.coordinates() {
            columns.serialize_field(name, &value)?;
        }
        columns.end()
    }
}
