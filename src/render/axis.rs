//! Axes: which cell lies where, and where the ticks go.

/// An axis on which each value owns the stretch between the midpoints to its neighbours.
#[derive(Debug)]
pub(super) struct Axis {
    values: Vec<f64>,
    /// One more than there are values.
    edges: Vec<f64>,
}

impl Axis {
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
        let [low, high] = self.range();
        (value - low) / (high - low)
    }

    /// The cell at a fraction of the axis.
    pub(super) fn cell(&self, fraction: f64) -> usize {
        let [low, high] = self.range();
        let value = low + fraction * (high - low);
        let inner = &self.edges[1..self.edges.len() - 1];
        inner.partition_point(|edge| *edge <= value)
    }

    /// Values to label: all of them when they are few, else round ones.
    pub(super) fn ticks(&self) -> Vec<f64> {
        if self.values.len() <= 8 {
            self.values.clone()
        } else {
            round_ticks(self.range(), 8.0)
        }
    }
}

/// About `wanted` multiples of 1, 2 or 5 times a power of ten within a range.
pub(super) fn round_ticks([low, high]: [f64; 2], wanted: f64) -> Vec<f64> {
    let rough = (high - low) / wanted;
    let power = 10_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .map(|factor| factor * power)
        .into_iter()
        .find(|step| *step >= rough * 0.999)
        .unwrap_or(rough);
    let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
    (first..=last)
        .map(|multiple| multiple as f64 * step)
        .collect()
}

/// The ticks as text, all with the same number of decimals, as few as tell them apart.
pub(super) fn labels(ticks: &[f64]) -> Vec<String> {
    let largest = ticks
        .iter()
        .fold(0.0_f64, |most, tick| most.max(tick.abs()));
    let text = |tick: &f64, decimals: usize| {
        if largest != 0.0 && !(1e-3..1e6).contains(&largest) && *tick != 0.0 {
            format!("{tick:.decimals$e}")
        } else {
            format!("{tick:.decimals$}")
        }
    };
    let apart = ticks.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let tenth = 0.1 * apart.fold(f64::INFINITY, f64::min);
    let within = |decimals: usize, allowed: f64| {
        let near = |tick: &f64| match text(tick, decimals).parse::<f64>() {
            Ok(shown) => (shown - tick).abs() <= allowed,
            Err(_) => false,
        };
        ticks.iter().all(near)
    };
    let exact = (0..4).find(|decimals| within(*decimals, tenth.min(1e-6 * largest)));
    let decimals = exact
        .or_else(|| (4..=12).find(|decimals| within(*decimals, tenth)))
        .unwrap_or(4);
    let shown = ticks.iter().map(|tick| text(tick, decimals));
    shown.map(|text| text.replace('-', "\u{2212}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_reaches_to_the_midpoints() {
        let axis = Axis::new(&[1.0, 2.0, 5.0]);
        assert_eq!(axis.range(), [0.5, 6.5]);
        for (value, cell) in [
            (0.5, 0),
            (1.49, 0),
            (1.5, 1),
            (3.49, 1),
            (3.51, 2),
            (6.5, 2),
        ] {
            assert_eq!(axis.cell(axis.fraction(value)), cell, "{value}");
        }
        assert_eq!(Axis::new(&[7.0]).range(), [6.5, 7.5]);
    }

    #[test]
    fn ticks_are_round_and_labels_short() {
        assert_eq!(
            round_ticks([-60.3, 70.3], 8.0),
            [-60.0, -40.0, -20.0, 0.0, 20.0, 40.0, 60.0]
        );
        for (ticks, expected) in [
            (vec![0.0, 0.5, 1.0], vec!["0.0", "0.5", "1.0"]),
            (vec![-20.0, 0.0], vec!["\u{2212}20", "0"]),
            (vec![0.0, 2e-9], vec!["0", "2e\u{2212}9"]),
            (vec![1.0 / 3.0], vec!["0.3333"]),
            (vec![2.00001, 2.00002], vec!["2.00001", "2.00002"]),
            (vec![2e5, 2e5 + 0.1], vec!["200000.0", "200000.1"]),
        ] {
            assert_eq!(labels(&ticks), expected);
        }
    }
}
