//! Stays on asperities with their dwell times, and histograms.

use super::Texture;
use crate::trace::row;
use crate::whisk::WhiskEventKind;
use serde::Serialize;
use whiskmap_mechanics::rod::Side;

row! {
    /// Stay of the whisker on one asperity, from the touch until the whisker leaves it.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    pub struct AsperityStay {
        /// Number of the asperity, from 0 at the lower end of the surface.
        pub asperity: usize,
        /// Side of the whisker that the asperity is on: cb (convex) or cf (concave).
        pub side: Side,
        /// Time of the touch, in s.
        pub begin_s: f64,
        /// Time at which the whisker leaves the asperity, in s; empty for a stay that lasts to the end of the course.
        pub end_s: Option<f64>,
        /// Dwell time: duration of the stay, in s.
        pub dwell_s: Option<f64>,
        /// Event that ends the stay: release, slip-off, pull-off or undecided.
        pub end: Option<WhiskEventKind>,
    }
}

row! {
    /// Bin of a histogram of the position of the tip.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    pub struct TipBin {
        /// Lower end of the bin along the surface, in mm.
        pub tip_from_mm: f64,
        /// Upper end of the bin along the surface, in mm.
        pub tip_to_mm: f64,
        /// Time that the tip spends in the bin, in s.
        pub tip_time_s: f64,
    }
}

/// Number of bins of the histogram of the tip.
const TIP_BINS: usize = 80;

impl Texture {
    /// Returns the stays of the course on its asperities, in the order of time: `[stay]`.
    #[must_use]
    pub fn stays(&self) -> Vec<AsperityStay> {
        let mut stays: Vec<AsperityStay> = Vec::new();
        for event in &self.events {
            if event.event == WhiskEventKind::Touch {
                stays.extend(event.asperity.map(|asperity| AsperityStay {
                    asperity,
                    side: event.side,
                    begin_s: event.time_s,
                    end_s: None,
                    dwell_s: None,
                    end: None,
                }));
            } else if let Some(stay) = stays.last_mut().filter(|stay| stay.end.is_none()) {
                stay.end_s = Some(event.time_s);
                stay.dwell_s = Some(event.time_s - stay.begin_s);
                stay.end = Some(event.event);
            }
        }
        stays
    }

    /// Returns the histogram of the tip's position over time, `[bin]`. The time of a sample reaches half way to its neighbours. Undecided
    /// samples are left out.
    #[must_use]
    pub fn tip_histogram(&self) -> Vec<TipBin> {
        let samples = &self.samples;
        let time = |i: usize| samples[i.min(samples.len() - 1)].time_s;
        let places = (0..samples.len()).filter_map(|i| {
            let weight = 0.5 * (time(i + 1) - time(i.saturating_sub(1)));
            Some([samples[i].tip_x_mm?, weight])
        });
        let bins = histogram(&places.collect::<Vec<_>>(), None, TIP_BINS).into_iter().map(
            |(ends, tip_time_s)| TipBin { tip_from_mm: ends[0], tip_to_mm: ends[1], tip_time_s },
        );
        bins.collect()
    }
}

/// Returns the histogram of values, given as `[value, weight]`, in `bins` equal bins: the ends of each bin and the sum of its weights. The
/// bins begin at `least`, which no value is below, or at the least value, and end at the largest. Equal ends make one bin without width.
/// Without values there is no bin.
#[must_use]
pub fn histogram(values: &[[f64; 2]], least: Option<f64>, bins: usize) -> Vec<([f64; 2], f64)> {
    let all = || values.iter().map(|[value, _]| *value);
    let least = least.unwrap_or_else(|| all().fold(f64::INFINITY, f64::min));
    let most = all().fold(f64::NEG_INFINITY, f64::max);
    let bins = match (values.is_empty(), least < most) {
        (true, _) => 0,
        (_, true) => bins.max(1),
        _ => 1,
    };
    let width = (most - least) / bins as f64;
    let mut sums = vec![0.0; bins];
    for [value, weight] in values {
        let bin = ((value - least) / width) as usize;
        sums[bin.min(bins - 1)] += weight;
    }
    let ends = |bin: usize| [bin, bin + 1].map(|end| width.mul_add(end as f64, least));
    sums.iter().enumerate().map(|(bin, sum)| (ends(bin), *sum)).collect()
}
