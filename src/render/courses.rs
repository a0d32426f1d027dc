//! Charts of courses: angle of the base, force and moment over time.

use super::labels::{TIME, axis_title};
use super::{Band, Chart, Dot, Ink, Line, Plot, Stroke};
use crate::force::FrameForce;
use crate::whisk::{Whisk, WhiskEvent, WhiskEventKind, WhiskRegime, WhiskSample};
use whiskmap_plot::Shade;

/// Quantity of a course over time.
struct Curve {
    /// Name of the column with the quantity.
    name: &'static str,
    sample: fn(&WhiskSample) -> Option<f64>,
    event: fn(&WhiskEvent) -> Option<f64>,
    /// Value of a free whisker right after the event.
    free: fn(&WhiskEvent) -> f64,
}

const CURVES: [Curve; 3] = [
    Curve {
        name: "angle_deg",
        sample: |sample| sample.angle_deg,
        event: |event| Some(event.angle_deg),
        free: |event| event.angle_deg,
    },
    Curve {
        name: "force_un",
        sample: |sample| sample.force_un,
        event: |event| event.force_un,
        free: |_| 0.0,
    },
    Curve {
        name: "base_moment_nnm",
        sample: |sample| sample.base_moment_nnm,
        event: |event| event.base_moment_nnm,
        free: |_| 0.0,
    },
];

/// Returns a chart of a course: angle of the base, force and moment over time, with the events as dots, which the first plot names. At a detachment,
/// loads fall to the loads of the next state. Lines break where the state is undecided.
#[must_use]
pub fn courses(title: &str, whisk: &Whisk) -> Chart {
    let mut plots: Vec<Plot> = CURVES.iter().map(|curve| plot(whisk, curve)).collect();
    for dot in plots.iter_mut().skip(1).flat_map(|plot| &mut plot.dots) {
        dot.name = None;
    }
    let times = whisk.samples.iter().map(|sample| sample.time_s);
    share_times(&mut plots, times);
    Chart { plots, title: title.to_owned(), columns: 1, ..Chart::default() }
}

/// Value of a frame with its standard deviation.
type WithDeviation = fn(&FrameForce) -> [Option<f64>; 2];

/// Returns a chart of measured forces: contact force and moment at the base over time, with a band of one standard deviation if there is
/// one. Lines break where there is no force.
#[must_use]
pub fn forces(title: &str, forces: &[FrameForce]) -> Chart {
    let plot = |name: &str, number: WithDeviation| {
        let frames = forces.iter().map(|force| {
            let [value, deviation] = number(force).map(|found| found.unwrap_or(f64::NAN));
            (force.time_s, value, deviation)
        });
        let line = frames.clone().map(|(time, value, _)| [time, value]);
        let band = frames.map(|(time, value, deviation)| {
            [value - deviation, value + deviation].map(|end| [time, end])
        });
        let band = Band {
            points: band.collect(),
            shade: Shade::Dark,
            name: Some("\u{b1} standard deviation".to_owned()),
        };
        let has_band = |band: &Band| band.points.iter().any(|[low, _]| low[1].is_finite());
        Plot {
            x_label: TIME.to_owned(),
            y_label: axis_title(name),
            bands: Some(band).filter(has_band).into_iter().collect(),
            lines: vec![Line::new(line.collect(), Ink::Black, Stroke::Solid)],
            ..Plot::default()
        }
    };
    let mut plots = vec![
        plot("force_un", |force| [force.force_un, force.force_sd_un]),
        plot("base_moment_nnm", |force| [force.base_moment_nnm, force.base_moment_sd_nnm]),
    ];
    // The first plot has the legend.
    for band in plots.iter_mut().skip(1).flat_map(|plot| &mut plot.bands) {
        band.name = None;
    }
    share_times(&mut plots, forces.iter().map(|force| force.time_s));
    Chart { plots, title: title.to_owned(), columns: 1, ..Chart::default() }
}

/// Gives plots above each other one axis of times, below the last one.
pub(super) fn share_times(plots: &mut [Plot], times_s: impl Iterator<Item = f64>) {
    let ends = times_s.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], time| {
        [time.min(least), time.max(most)]
    });
    let last = plots.len() - 1;
    for (i, plot) in plots.iter_mut().enumerate() {
        plot.x_range = Some(ends).filter(|ends| ends[0] < ends[1]);
        plot.is_above = i < last;
    }
}

fn plot(whisk: &Whisk, curve: &Curve) -> Plot {
    let mut events = whisk.events.iter().peekable();
    let mut points = Vec::new();
    for sample in &whisk.samples {
        let value = (curve.sample)(sample).unwrap_or(f64::NAN);
        while let Some(event) = events.next_if(|event| event.time_s <= sample.time_s) {
            points.push([event.time_s, (curve.event)(event).unwrap_or(f64::NAN)]);
            let is_last = events.peek().is_none_or(|next| next.time_s > sample.time_s);
            if is_last && sample.regime == WhiskRegime::Free {
                points.push([event.time_s, (curve.free)(event)]);
            }
        }
        points.push([sample.time_s, value]);
    }
    Plot {
        x_label: TIME.to_owned(),
        y_label: axis_title(curve.name),
        lines: vec![Line::new(points, Ink::Black, Stroke::Solid)],
        dots: whisk.events.iter().filter_map(|event| dot(event, curve)).collect(),
        ..Plot::default()
    }
}

/// The dot of an event: touches are open.
fn dot(event: &WhiskEvent, curve: &Curve) -> Option<Dot> {
    let (ink, open, name) = match event.event {
        WhiskEventKind::Touch => (Ink::Grey, true, "touch"),
        WhiskEventKind::Release => (Ink::Grey, false, "release"),
        WhiskEventKind::SlipOff => (Ink::Black, false, "slip-off"),
        WhiskEventKind::PullOff => (Ink::Blue, false, "pull-off"),
        WhiskEventKind::Snap => (Ink::Series(2), false, "snap"),
        WhiskEventKind::Undecided => (Ink::Series(1), true, "undecided from here"),
    };
    Some(Dot { at: [event.time_s, (curve.event)(event)?], ink, open, name: Some(name.to_owned()) })
}
