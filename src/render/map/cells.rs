//! Which cell lies where along an axis of a map.

use crate::render::ticks::{self, Tick};

/// An axis on which each value owns the stretch between the midpoints to its neighbours.
#[derive(Debug)]
pub(super) struct Cells {
    values: Vec<f64>,
    /// One more than there are values.
    edges: Vec<f64>,
}

impl Cells {
    /// `values` increase and are not empty.
    pub(super) fn new(values: &[f64]) -> Self {
        let between = values.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
        let (first, last) = (values[0], values[values.len() - 1]);
        let (low, high) = match values {
            [only] => (only - 0.5, only + 0.5),
            [_, second, ..] => (
                first - 0.5 * (second - first),
                last + 0.5 * (last - values[values.len() - 2]),
            ),
            [] => (0.0, 1.0),
        };
        let edges = std::iter::once(low).chain(between).chain([high]).collect();
        Self {
            values: values.to_vec(),
            edges,
        }
    }

    /// The outermost edges.
    pub(super) fn range(&self) -> [f64; 2] {
        [self.edges[0], self.edges[self.edges.len() - 1]]
    }

    /// Where a value lies between the outermost edges.
    pub(super) fn fraction(&self, value: f64) -> f64 {
        ticks::fraction(self.range(), value)
    }

    /// The cell at a fraction of the axis.
    pub(super) fn cell(&self, fraction: f64) -> usize {
        let [low, high] = self.range();
        let value = low + fraction * (high - low);
        let inner = &self.edges[1..self.edges.len() - 1];
        inner.partition_point(|edge| *edge <= value)
    }

    /// Labels in another unit, `unit` of the axis' own: of all values when they are few, else of round ones.
    pub(super) fn ticks(&self, unit: f64) -> Vec<Tick> {
        let range = self.range().map(|end| end / unit);
        if self.values.len() <= 8 {
            let values: Vec<f64> = self.values.iter().map(|value| value / unit).collect();
            ticks::at(&values, range)
        } else {
            ticks::at(&ticks::round(range, 8.0), range)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Cells;

    #[test]
    fn a_value_owns_the_stretch_between_the_midpoints() {
        let cells = Cells::new(&[1.0, 2.0, 4.0]);
        assert_eq!(cells.range(), [0.5, 5.0]);
        let fractions = [1.49, 1.51, 2.99, 3.01].map(|value| cells.fraction(value));
        assert_eq!(fractions.map(|fraction| cells.cell(fraction)), [0, 1, 1, 2]);
    }

    #[test]
    fn a_single_value_owns_one_unit() {
        assert_eq!(Cells::new(&[7.0]).range(), [6.5, 7.5]);
    }
}
