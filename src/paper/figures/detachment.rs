//! Detachment curves in the plane of push angle and distance, with measured ends over them.

use super::Panel;
use crate::measured::Point;
use crate::paper::whiskers::POLE;
use crate::render::{CurveAxis, Dot, Ends, Ink, Line, Stroke, curves};
use crate::rod::{Rest, Side};
use crate::scene::Whisker;
use crate::trace::{Detachment, DetachmentKind, curve};
use serde::Serialize;

/// Measured detachments, by their push angles, for the panels that can show them; there may be none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measurements {
    /// Slip-offs are open circles (the whisker's), others filled ones (the hair's).
    pub fig4d: Vec<Point>,
    /// Open circles.
    pub fig5c_left: Vec<Point>,
    /// Open circles.
    pub fig5c_right: Vec<Point>,
}

/// A row of a table: the end of a push.
#[derive(Clone, Copy, Serialize)]
pub struct End {
    whisker: &'static str,
    side: Side,
    kind: DetachmentKind,
    push_angle_deg: Option<f64>,
    distance_mm: f64,
    contact_distance_mm: Option<f64>,
}

/// Distances per side.
const DISTANCES: usize = 96;
/// The nearest pole, as a part of the farthest.
const NEAREST: f64 = 0.25;

/// Detachment curves of both sides, up to where the tip of the resting whisker touches the pole. Near there push angles
/// grow like a root, so that distances are closer together.
fn ends(whisker: &Whisker) -> Vec<Detachment> {
    let reach = |side| {
        let rest = Rest::new(&whisker.rod(&POLE, side));
        rest.at_arclength(rest.end()).0.length() * whisker.length_mm
    };
    let of_side = |side| {
        let to_tip = |i: usize| (1.0 - (i + 1) as f64 / DISTANCES as f64).powi(2);
        let distances: Vec<f64> = (0..DISTANCES)
            .map(|i| reach(side) * (1.0 - (1.0 - NEAREST) * to_tip(i)))
            .collect();
        curve(whisker, &POLE, side, &distances)
    };
    Side::BOTH.into_iter().flat_map(of_side).collect()
}

const AXES: [CurveAxis; 2] = [
    CurveAxis {
        label: "push angle \u{3b8}_p at detachment (deg)",
        value: |end| end.push_angle_deg,
    },
    CurveAxis {
        label: "object distance d at first touch (mm)",
        value: |end| Some(end.distance_mm),
    },
];

/// Detachment curves of whiskers by name, with their strokes.
pub fn panel(
    letter: &'static str,
    title: &str,
    whiskers: &[(&'static str, &Whisker, Stroke)],
) -> Panel {
    let all: Vec<_> = whiskers
        .iter()
        .map(|(name, whisker, stroke)| (*name, ends(whisker), *stroke))
        .collect();
    let drawn = all.iter().map(|(name, rows, stroke)| Ends {
        rows,
        stroke: *stroke,
        name: if all.len() > 1 { name } else { "" },
    });
    let mut plot = curves(title, &drawn.collect::<Vec<_>>(), AXES);
    plot.lines
        .extend(all.iter().map(|(_, rows, stroke)| reach(rows, *stroke)));
    let rows = all.iter().flat_map(|(whisker, rows, _)| {
        rows.iter().map(|end| End {
            whisker,
            side: end.side,
            kind: end.kind,
            push_angle_deg: end.push_angle_deg,
            distance_mm: end.distance_mm,
            contact_distance_mm: end.contact_distance_mm,
        })
    });
    Panel::new(letter, plot, rows.collect())
}

/// From the farthest end of one side to that of the other: where the region of stable states ends without a detachment.
fn reach(rows: &[Detachment], stroke: Stroke) -> Line {
    let farthest = |side| {
        let of_side = rows.iter().rfind(|end| end.side == side)?;
        Some([of_side.push_angle_deg?, of_side.distance_mm])
    };
    let points = Side::BOTH.into_iter().filter_map(farthest).collect();
    Line::new(points, Ink::Grey, stroke, "first touch at the tip")
}

/// Measured ends as circles.
pub fn dots(measured: &[Point], is_open: impl Fn(Option<DetachmentKind>) -> bool) -> Vec<Dot> {
    let dot = |end: &Point| Dot {
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
