//! Labelled values on axes and colour bars.

use super::heading::TICK;
use crate::picture::font;

/// Least space between two labels, in pixels.
const APART: f64 = 18.0;

/// A tick of an axis or a colour bar: a position and a label.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Position of the tick, as the fraction of the axis below it, from 0 to 1.
    pub at: f64,
    pub label: String,
    /// Width of the tick's label, in pixels.
    pub width: f64,
}

impl Tick {
    pub fn new(at: f64, label: String) -> Self {
        let width = font::width(&label, TICK);
        Self { at, label, width }
    }

    /// Removes the label of the tick.
    pub fn clear(&mut self) {
        (self.label, self.width) = (String::new(), 0.0);
    }

    /// Creates a tick of a logarithmic axis. Its label has its own decimals: common labels would all have those of the smallest value.
    pub fn of_power(at: f64, value: f64) -> Self {
        Self::new(at, labels(&[value]).concat())
    }
}

/// Returns the fraction of the range `[low, high]` below `value`, from 0 to 1 inside the range.
pub fn fraction([low, high]: [f64; 2], value: f64) -> f64 {
    (value - low) / (high - low)
}

/// Creates ticks at `values` of the range `[low, high]`, with equally precise labels: `[value]`.
pub fn at(values: &[f64], range: [f64; 2]) -> Vec<Tick> {
    let ticks = values.iter().zip(labels(values));
    ticks.map(|(value, label)| Tick::new(fraction(range, *value), label)).collect()
}

/// A function that chooses the ticks of a range `[low, high]`, given about how many are wanted.
pub type TickChooser = fn([f64; 2], f64) -> Vec<Tick>;

/// Chooses about `wanted` ticks of a linear range `[low, high]`: `[tick]`.
pub fn of_numbers(range: [f64; 2], wanted: f64) -> Vec<Tick> {
    at(&round(range, wanted), range)
}

/// Chooses about `wanted` ticks of a range `[low, high]` of decimal logarithms. Labels show the numbers themselves.
pub fn of_logarithms(range: [f64; 2], wanted: f64) -> Vec<Tick> {
    // The ends of an axis may be powers that no number reaches.
    let ends = range.map(|end| 10_f64.powf(end.clamp(-300.0, 300.0)));
    let values = logarithmic(ends, wanted);
    let tick = |value: &f64| Tick::of_power(fraction(range, value.log10()), *value);
    values.iter().map(tick).collect()
}

/// Chooses as many ticks of the range `[low, high]` as fit on a horizontal axis of this length in pixels.
pub fn across(range: [f64; 2], length: f64, choose: TickChooser) -> Vec<Tick> {
    let free = |pair: &[Tick]| {
        let middles = length * (pair[1].at - pair[0].at);
        middles >= 0.5 * (pair[0].width + pair[1].width) + APART
    };
    let fit = |ticks: &Vec<Tick>| ticks.windows(2).all(free);
    let mut wanted = (length / 90.0).clamp(1.0, 10.0);
    let mut ticks = choose(range, wanted);
    while wanted > 1.0 && !fit(&ticks) {
        wanted = (wanted - 1.0).max(1.0);
        ticks = choose(range, wanted);
    }
    // One tick is no scale.
    let more = (1..FEWEST).map(|more| choose(range, wanted + more as f64));
    let mut more = more.filter(|more| more.len() > 1 && fit(more));
    match ticks.len() {
        0 | 1 => more.next().unwrap_or(ticks),
        _ => ticks,
    }
}

/// Fewest ticks of a vertical axis with room for more.
const FEWEST: usize = 3;

/// Chooses the ticks of the range `[low, high]` on a vertical axis of this length in pixels.
pub fn upwards(range: [f64; 2], length: f64, choose: TickChooser) -> Vec<Tick> {
    let mut wanted = (length / 80.0).clamp(1.0, 10.0);
    loop {
        let ticks = choose(range, wanted);
        if ticks.len() >= FEWEST || wanted + 1.0 > length / (2.0 * TICK) {
            return ticks;
        }
        wanted += 1.0;
    }
}

/// Creates ticks at the numbers 0, 1, 2, ... in the range `[low, high]`, with `names` as their labels: `[number]`.
pub fn named(names: &[String], range: [f64; 2]) -> Vec<Tick> {
    let ticks = names.iter().enumerate();
    ticks.map(|(i, name)| Tick::new(fraction(range, i as f64), name.clone())).collect()
}

/// Returns about `wanted` round values in the range `[low, high]`: multiples of 1, 2 or 5 times a power of ten.
pub fn round([low, high]: [f64; 2], wanted: f64) -> Vec<f64> {
    let rough = (high - low) / wanted;
    let power = 10_f64.powf(rough.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
    let step = steps.into_iter().find(|step| *step >= rough * 0.999);
    let step = step.unwrap_or(rough);
    if !step.is_normal() {
        return Vec::new();
    }
    let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
    let multiples = first..=last;
    multiples.map(|multiple| multiple as f64 * step).collect()
}

/// Returns at most `wanted` powers of ten in a range of positive numbers, `[value]`; where there are few, also their multiples by 2 and
/// 5. The search begins at the smallest normal number.
pub fn logarithmic([low, high]: [f64; 2], wanted: f64) -> Vec<f64> {
    let low = low.max(f64::MIN_POSITIVE);
    let powers = low.log10().floor() as i32..=high.log10().ceil() as i32;
    for factors in [&[1.0][..], &[1.0, 2.0, 5.0]] {
        let multiples = |power| factors.iter().map(move |factor| factor * 10_f64.powi(power));
        let values = powers.clone().flat_map(multiples);
        let inside = values.filter(|value| (low..=high).contains(value));
        let values: Vec<f64> = inside.collect();
        if values.len() >= 3 {
            let step = (values.len() as f64 / wanted).ceil() as usize;
            return values.into_iter().step_by(step).collect();
        }
    }
    round([low, high], wanted)
}

/// Writes values as texts with equally many decimals, as few as make all of them different: `[value]`.
pub fn labels(values: &[f64]) -> Vec<String> {
    let largest = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    let text = |value: &f64, decimals: usize| {
        if largest != 0.0 && !(1e-3..1e6).contains(&largest) && *value != 0.0 {
            format!("{value:.decimals$e}")
        } else {
            format!("{value:.decimals$}")
        }
    };
    let apart = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let tenth = 0.1 * apart.fold(f64::INFINITY, f64::min);
    let within = |decimals: usize, allowed: f64| {
        let near = |value: &f64| match text(value, decimals).parse::<f64>() {
            Ok(shown) => (shown - value).abs() <= allowed,
            Err(_) => false,
        };
        values.iter().all(near)
    };
    let exact = (0..4).find(|decimals| within(*decimals, tenth.min(1e-6 * largest)));
    let decimals =
        exact.or_else(|| (4..=12).find(|decimals| within(*decimals, tenth))).unwrap_or(4);
    let shown = values.iter().map(|value| text(value, decimals));
    shown.map(|text| text.replace('-', "\u{2212}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_labels_short() {
        assert_eq!(round([-60.3, 70.3], 8.0), [-60.0, -40.0, -20.0, 0.0, 20.0, 40.0, 60.0]);
        assert!(round([0.0, 1e-323], 8.0).is_empty());
        for (values, expected) in [
            (vec![0.0, 0.5, 1.0], vec!["0.0", "0.5", "1.0"]),
            (vec![-20.0, 0.0], vec!["\u{2212}20", "0"]),
            (vec![0.0, 2e-9], vec!["0", "2e\u{2212}9"]),
            (vec![1.0 / 3.0], vec!["0.3333"]),
            (vec![2.00001, 2.00002], vec!["2.00001", "2.00002"]),
            (vec![2e5, 2e5 + 0.1], vec!["200000.0", "200000.1"]),
        ] {
            assert_eq!(labels(&values), expected);
        }
    }

    #[test]
    fn logarithmic_ticks_are_powers_of_ten_where_these_suffice() {
        assert_eq!(logarithmic([0.5, 2e3], 8.0), [1.0, 10.0, 100.0, 1000.0]);
        assert_eq!(logarithmic([3.0, 60.0], 8.0), [5.0, 10.0, 20.0, 50.0]);
        assert_eq!(logarithmic([4.5, 8.5], 4.0), [5.0, 6.0, 7.0, 8.0]);
        assert!(logarithmic([1e-30, 1e30], 8.0).len() <= 8);
        // In a larger unit, the smallest numbers are 0.
        for low in [0.0, 1e-320] {
            let ticks = logarithmic([low, 1e308], 8.0);
            assert!((3..=8).contains(&ticks.len()), "{ticks:?}");
        }
    }

    #[test]
    fn labels_stay_apart_inside_the_axis() {
        for range in [
            [0.0, 1.0],
            [-3.2e5, 8.8e5],
            [1.0, 1.0 + 1e-8],
            [123_456.0, 123_456.001],
            [-1e-7, 3e-9],
        ] {
            for length in [760.0, 1280.0] {
                let ticks = across(range, length, of_numbers);
                assert!(ticks.len() >= 2, "{ticks:?}");
                assert!(ticks.iter().all(|tick| (0.0..=1.0).contains(&tick.at)));
                for pair in ticks.windows(2) {
                    let free =
                        length * (pair[1].at - pair[0].at) - 0.5 * (pair[0].width + pair[1].width);
                    assert!(free > 10.0, "{pair:?}");
                    assert_ne!(pair[0].label, pair[1].label);
                }
            }
        }
    }

    /// A short axis has a scale where labels fit, and one tick elsewhere.
    #[test]
    fn a_short_axis_has_the_ticks_that_fit() {
        let shown = |range: [f64; 2], length: f64| {
            let ticks = across(range, length, of_numbers).into_iter();
            ticks.map(|tick| tick.label).collect::<Vec<_>>()
        };
        let both_sides = [-60.0, 60.0];
        assert_eq!(shown(both_sides, 200.0), ["\u{2212}50", "0", "50"]);
        assert_eq!(shown(both_sides, 80.0), ["0"]);
        assert_eq!(shown([3.0, 11.0], 110.0), ["5", "10"]);
    }
}
