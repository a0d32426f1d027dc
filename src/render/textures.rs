//! Charts of courses behind rough surfaces: position of the tip over time, and histograms.

use super::{Chart, Ink, Line, Plot, Stroke};
use crate::texture::{Texture, TexturePhase, TextureSample, histogram};

/// Red ink of phases in which the whisker is stuck, as in the paper's Fig. 6.
pub const STUCK: Ink = Ink::Series(1);

/// Number of bins of the histogram of dwell times.
const DWELL_BINS: usize = 30;

/// Label of the position of the tip.
pub const TIP: &str = "tip along the surface (mm)";

/// Returns a chart of a course behind a rough surface: the position of the tip over time, red where it is stuck; the time that the tip
/// spends at each position; and the histogram of dwell times.
#[must_use]
pub fn textures(title: &str, texture: &Texture) -> Chart {
    Chart {
        plots: vec![
            tip_over_time(texture),
            tip_histogram(texture),
            dwell_histogram(texture),
        ],
        title: title.to_owned(),
        columns: 1,
        caption: [
            "Model: one asperity at a time bends the whisker; no inertia, no friction. The paper has no model for this.",
            "Stuck: an asperity holds the whisker. Slipping: it has detached since the sample before.",
        ]
        .map(str::to_owned)
        .into(),
    }
}

/// Returns the plot of the position of the tip over time. Lines break where the state is undecided.
#[must_use]
pub fn tip_over_time(texture: &Texture) -> Plot {
    Plot {
        x_label: "time (s)".to_owned(),
        y_label: TIP.to_owned(),
        lines: tip_lines(&texture.samples, |sample| sample.time_s),
        ..Plot::default()
    }
}

/// Returns the course of the tip over a coordinate, as a grey line with the stuck phases in red over it.
#[must_use]
pub fn tip_lines(samples: &[TextureSample], x: fn(&TextureSample) -> f64) -> Vec<Line> {
    let place = |sample: &TextureSample| [x(sample), sample.tip_x_mm.unwrap_or(f64::NAN)];
    let stays = samples.chunk_by(|before, next| {
        let same = before.asperity == next.asperity && before.side == next.side;
        same && next.phase == TexturePhase::Stuck
    });
    // A stay that has one sample, to which the whisker has slipped, is part of the slipping.
    let is_stuck = |part: &&[TextureSample]| {
        part[part.len() - 1].phase == TexturePhase::Stuck && part[0].asperity.is_some()
    };
    let stuck = stays.filter(is_stuck);
    let red = stuck.flat_map(|part| {
        let points = part.iter().map(place);
        points.chain([[f64::NAN; 2]])
    });
    vec![
        Line::new(samples.iter().map(place).collect(), Ink::Grey, Stroke::Solid)
            .named("slipping or free"),
        Line::new(red.collect(), STUCK, Stroke::Solid).named("stuck"),
    ]
}

/// Returns the plot of the time that the tip spends at each position.
#[must_use]
pub fn tip_histogram(texture: &Texture) -> Plot {
    let bins = texture.tip_histogram();
    let steps = bins.iter().map(|bin| ([bin.tip_from_mm, bin.tip_to_mm], bin.tip_time_s));
    steps_plot(TIP, "time of the tip there (s)", steps)
}

/// Returns the histogram of dwell times.
fn dwell_histogram(texture: &Texture) -> Plot {
    let stays = texture.stays();
    let dwells = stays.iter().filter_map(|stay| Some([stay.dwell_s?, 1.0]));
    let bins = histogram(&dwells.collect::<Vec<_>>(), Some(0.0), DWELL_BINS);
    steps_plot("dwell time on an asperity (s)", "number of stays", bins.into_iter())
}

/// Returns a histogram as a line of steps through `([from, to], height)`.
fn steps_plot(
    x_label: &str,
    y_label: &str,
    bins: impl Iterator<Item = ([f64; 2], f64)> + Clone,
) -> Plot {
    let first = bins.clone().next().map(|([from, _], _)| [from, 0.0]);
    let last = bins.clone().last().map(|([_, to], _)| [to, 0.0]);
    let steps = bins.flat_map(|(ends, height)| ends.map(|end| [end, height]));
    let points = first.into_iter().chain(steps).chain(last);
    Plot {
        x_label: x_label.to_owned(),
        y_label: y_label.to_owned(),
        lines: vec![Line::new(points.collect(), Ink::Black, Stroke::Solid)],
        ..Plot::default()
    }
}
