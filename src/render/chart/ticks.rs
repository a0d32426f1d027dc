//! Labelled values on the axes of a plot.

use super::window::fraction;
use crate::render::Error;
use crate::render::axis;
use crate::render::canvas::text_width;
use crate::render::legend::TICK;

/// Room between two labels, in pixels.
const APART: f64 = 18.0;

/// A labelled value.
#[derive(Debug)]
pub(super) struct Tick {
    /// Its fraction of the axis.
    pub(super) at: f64,
    pub(super) label: String,
    /// Of the label, in pixels.
    pub(super) width: f64,
}

/// Ticks of an axis of this length that runs across, as many as fit beside each other.
pub(super) fn across(range: [f64; 2], length: f64) -> Result<Vec<Tick>, Error> {
    let mut wanted = (length / 90.0).clamp(1.0, 10.0);
    loop {
        let ticks = ticks(range, wanted)?;
        let free = |pair: &[Tick]| {
            let middles = length * (pair[1].at - pair[0].at);
            middles >= 0.5 * (pair[0].width + pair[1].width) + APART
        };
        if wanted <= 1.0 || ticks.windows(2).all(free) {
            return Ok(ticks);
        }
        wanted = (wanted - 1.0).max(1.0);
    }
}

/// Ticks of an axis of this length that runs upwards.
pub(super) fn upwards(range: [f64; 2], length: f64) -> Result<Vec<Tick>, Error> {
    ticks(range, (length / 80.0).clamp(1.0, 10.0))
}

/// The widest label.
pub(super) fn widest(ticks: &[Tick]) -> f64 {
    ticks
        .iter()
        .fold(0.0, |widest, tick| tick.width.max(widest))
}

fn ticks(range: [f64; 2], wanted: f64) -> Result<Vec<Tick>, Error> {
    let values = axis::round_ticks(range, wanted);
    let labels = axis::labels(&values);
    let ticks = values.into_iter().zip(labels).map(|(value, label)| {
        Ok(Tick {
            at: fraction(range, value),
            width: text_width(&label, TICK)?,
            label,
        })
    });
    ticks.collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "the built-in font can be measured")]
mod tests {
    use super::*;

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
                let ticks = across(range, length).unwrap();
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
}
