//! An axis of a heat map, and the conversion between values and cells.

use crate::frame::ticks::{self, Tick};
use crate::frame::units;

/// An axis of a heat map with one cell for each value. A cell ends half way to the neighbouring values.
#[derive(Clone, Debug, PartialEq)]
pub struct CellAxis {
    label: String,
    values: Vec<f64>,
    /// Ends of the cells, one more than there are cells.
    edges: Vec<f64>,
}

impl CellAxis {
    /// Creates an axis with one cell for each of the increasing `values`. A label that ends in a known unit changes to the unit in which
    /// the values read best.
    #[must_use]
    pub fn new(label: impl Into<String>, values: &[f64]) -> Self {
        let between = values.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
        let (low, high) = match (values, values) {
            ([first, second, ..], [.., before, last]) => {
                (first - 0.5 * (second - first), last + 0.5 * (last - before))
            }
            ([only], _) => (only - 0.5, only + 0.5),
            _ => (0.0, 1.0),
        };
        Self {
            label: label.into(),
            values: values.to_vec(),
            edges: std::iter::once(low).chain(between).chain([high]).collect(),
        }
    }

    /// Returns the lower end of the axis' first cell and the upper end of its last cell, in the unit of the values: `[low, high]`.
    #[must_use]
    pub fn range(&self) -> [f64; 2] {
        [self.edges[0], self.edges[self.edges.len() - 1]]
    }

    pub(crate) const fn count(&self) -> usize {
        self.values.len()
    }

    /// Returns the fraction of the axis below a value, from 0 to 1.
    pub(crate) fn fraction(&self, value: f64) -> f64 {
        ticks::fraction(self.range(), value)
    }

    /// Returns the index of the cell at a fraction of the axis, from 0 to 1.
    pub(crate) fn cell(&self, fraction: f64) -> usize {
        let [low, high] = self.range();
        let value = low + fraction * (high - low);
        let inner = &self.edges[1..self.edges.len() - 1];
        inner.partition_point(|edge| *edge <= value)
    }

    /// The label in the unit that suits the values, and that unit in units of the values.
    fn readable(&self) -> (String, f64) {
        let largest = self.values.last().copied().unwrap_or_default();
        units::readable(&self.label, largest)
    }

    /// Returns the ticks and the label of an axis of this length: ticks at all values if they are few, else at round ones.
    pub(crate) fn ticks(&self, length: f64) -> (Vec<Tick>, String) {
        let (label, unit) = self.readable();
        let range = self.range().map(|end| end / unit);
        let values = match self.count() {
            0..=8 => self.values.iter().map(|value| value / unit).collect(),
            _ => ticks::round(range, (length / 60.0).clamp(3.0, 8.0)),
        };
        (ticks::at(&values, range), label)
    }

    /// Returns the label of the axis with its first and last value.
    pub(crate) fn summary(&self) -> String {
        let (label, unit) = self.readable();
        let ends = self.values.first().into_iter().chain(self.values.last());
        let ends: Vec<f64> = ends.map(|end| end / unit).collect();
        format!("{label}, {}", ticks::labels(&ends).join(" to "))
    }
}

#[cfg(test)]
mod tests {
    use super::CellAxis;

    #[test]
    fn a_value_owns_the_stretch_between_the_midpoints() {
        let axis = CellAxis::new("", &[1.0, 2.0, 4.0]);
        assert_eq!(axis.range(), [0.5, 5.0]);
        let fractions = [1.49, 1.51, 2.99, 3.01].map(|value| axis.fraction(value));
        assert_eq!(fractions.map(|fraction| axis.cell(fraction)), [0, 1, 1, 2]);
        assert_eq!(CellAxis::new("", &[7.0]).range(), [6.5, 7.5]);
        assert_eq!(CellAxis::new("", &[]).range(), [0.0, 1.0]);
    }
}
