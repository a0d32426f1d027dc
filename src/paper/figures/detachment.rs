//! Panels of the paper with detachment curves over push angle and distance, Figs. 3E, 3J, 4D and 5C, and measured detachments.

use super::{Figure, FigurePanel, PUSH, figure};
use crate::measured::MeasuredPoint;
use crate::paper::whiskers::{FIG4_HAIR, FIG4_WHISKER, FIG5_LEFT, FIG5_RIGHT, POLE, cylinder_of};
use crate::render::{CurveAxis, Dot, DrawnCurve, Ink, Stroke, curves, regions};
use crate::scene::Whisker;
use crate::trace::{Detachment, DetachmentKind, curve, reach_mm};
use serde::Serialize;
use whiskmap_mechanics::rod::Side;

/// Measured detachments, by push angle, for the panels of the paper that show them; each list may be empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measurements {
    /// Measured detachments of Fig. 4D, `[point]`: slip-offs (the whisker's) are open circles, others (the hair's) filled circles.
    pub fig4d: Vec<MeasuredPoint>,
    /// Measured detachments of Fig. 5C, left, as open circles: `[point]`.
    pub fig5c_left: Vec<MeasuredPoint>,
    /// Measured detachments of Fig. 5C, right, as open circles: `[point]`.
    pub fig5c_right: Vec<MeasuredPoint>,
}

/// A row of a panel's table.
#[derive(Clone, Copy, Serialize)]
struct DetachmentRow {
    whisker: &'static str,
    side: Side,
    kind: DetachmentKind,
    push_angle_deg: Option<f64>,
    distance_mm: f64,
    contact_distance_mm: Option<f64>,
}

/// Distances per side.
const DISTANCES: usize = 96;
/// The nearest distance, as a fraction of the farthest.
const NEAREST: f64 = 0.25;

/// Detachment curves of both sides, up to the distance at which the tip of the resting whisker touches the pole. Push angles grow
/// like a root near there, so distances are closer together.
fn detachments(whisker: &Whisker) -> Vec<Detachment> {
    let of_side = |side| {
        let reach = reach_mm(whisker, &POLE, side);
        let to_tip = |i: usize| (1.0 - (i + 1) as f64 / DISTANCES as f64).powi(2);
        let distances: Vec<f64> =
            (0..DISTANCES).map(|i| reach * (1.0 - (1.0 - NEAREST) * to_tip(i))).collect();
        curve(whisker, &POLE, side, &distances)
    };
    Side::BOTH.into_iter().flat_map(of_side).collect()
}

const AXES: [CurveAxis; 2] = [
    CurveAxis {
        label: "push angle \u{3b8}_{p} at detachment (deg)",
        value: |end| end.push_angle_deg,
    },
    CurveAxis {
        label: "object distance d at first touch (mm)",
        value: |end| Some(end.distance_mm),
    },
];

/// Draws a panel with the detachment curves of named whiskers.
pub fn panel(
    letter: &'static str,
    title: &str,
    whiskers: &[(&'static str, &Whisker, Stroke)],
) -> FigurePanel {
    let rows = whiskers.iter().map(|(_, whisker, _)| detachments(whisker));
    let rows: Vec<_> = rows.collect();
    let all = || whiskers.iter().zip(&rows);
    let drawn = all().map(|((name, _, stroke), rows)| DrawnCurve {
        rows,
        reach_mm: rows.last().map_or(0.0, |end| end.distance_mm),
        stroke: *stroke,
        name: if whiskers.len() > 1 { name } else { "" },
        ink: None,
    });
    let mut plot = curves(title, &drawn.collect::<Vec<_>>(), AXES);
    plot.regions =
        Some(regions(whiskers.iter().all(|(_, whisker, _)| whisker.sharpest_bend_per_mm() == 0.0)));
    let table = all().flat_map(|((whisker, ..), rows)| {
        rows.iter().map(|end| DetachmentRow {
            whisker,
            side: end.side,
            kind: end.kind,
            push_angle_deg: end.push_angle_deg,
            distance_mm: end.distance_mm,
            contact_distance_mm: end.contact_distance_mm,
        })
    });
    FigurePanel::new(letter, plot, table.collect())
}

/// Measured detachments as circles.
fn dots(measured: &[MeasuredPoint], is_open: impl Fn(Option<DetachmentKind>) -> bool) -> Vec<Dot> {
    let dot = |end: &MeasuredPoint| Dot {
        at: [end.angle_deg, end.distance_mm],
        ink: match end.kind {
            Some(DetachmentKind::SlipOff) => Ink::Black,
            Some(_) => Ink::Blue,
            None => Ink::Grey,
        },
        open: is_open(end.kind),
        name: Some("measured".to_owned()),
    };
    measured.iter().map(dot).collect()
}

/// Draws the paper's Fig. 4D: a mouse whisker and a human hair.
pub fn fig4d(measured: &[MeasuredPoint]) -> Figure {
    let whiskers = [
        ("mouse whisker", &FIG4_WHISKER, Stroke::Solid),
        ("human hair", &FIG4_HAIR, Stroke::Dashed),
    ];
    let mut panel = panel("D", "", &whiskers);
    panel.plot.dots = dots(measured, |kind| kind == Some(DetachmentKind::SlipOff));
    let title = "Fig. 4D: detachment of a mouse whisker and a human hair";
    let panels = vec![("fig4d".to_owned(), panel)];
    figure("fig4d", title, vec![PUSH.to_owned()], panels)
}

/// Draws the paper's Fig. 5C: two whiskers of behaving mice, each beside a cylinder.
pub fn fig5c(measured: &Measurements) -> Figure {
    #[rustfmt::skip]
    let panels = [
        ("fig5c_left", "C", "truncated whisker", &FIG5_LEFT, &measured.fig5c_left),
        ("fig5c_right", "", "less truncated whisker", &FIG5_RIGHT, &measured.fig5c_right),
    ].map(|(table, letter, title, whisker, measured)| {
        let cylinder = cylinder_of(whisker);
        let whiskers = [
            ("whisker", whisker, Stroke::Solid),
            ("cylinder", &cylinder, Stroke::Dashed),
        ];
        let mut panel = panel(letter, title, &whiskers);
        panel.plot.dots = dots(measured, |_| true);
        (table.to_owned(), panel)
    });
    let title = "Fig. 5C: detachment of two whiskers, and of cylinders of their length and base";
    let caption = vec![
        PUSH.to_owned(),
        "Lengths are the paper's effective ones, in projection; on the right, arclengths are corrected by 3 % (Methods).".to_owned(),
    ];
    figure("fig5c", title, caption, panels.into())
}
