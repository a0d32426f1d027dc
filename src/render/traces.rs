//! Detachment curves, branches and shapes as plots: solid for stable and dashed for unstable states, black where the
//! whisker slips off and blue where it is pulled off, as in the paper.

use super::chart::{Disc, Dot, Ink, Line, Plot, Stroke};
use super::designs::look;
use crate::measured::Compared;
use crate::trace::{BranchPoint, Detachment, DetachmentKind, Mark, Shape};

/// An axis of a plot of rows.
#[derive(Clone, Copy, Debug)]
pub struct Axis<Row, Value> {
    /// What it is called, with its unit.
    pub label: &'static str,
    /// Its values.
    pub value: fn(&Row) -> Value,
}

/// An axis of a detachment curve.
pub type CurveAxis = Axis<Detachment, Option<f64>>;

/// An axis of a branch.
pub type BranchAxis = Axis<BranchPoint, f64>;

/// Detachment curves to draw, and how.
#[derive(Clone, Copy, Debug)]
pub struct Ends<'a> {
    /// Of one side and whisker after the other, each at growing distances.
    pub rows: &'a [Detachment],
    /// Solid or dashed.
    pub stroke: Stroke,
    /// Whose they are, for the legend; may be empty.
    pub name: &'a str,
}

/// A plot of detachment curves.
#[must_use]
pub fn curves(title: &str, all: &[Ends], [x, y]: [CurveAxis; 2]) -> Plot {
    let mut plot = empty(title, x.label, y.label);
    let place = |row: &Detachment| Some([(x.value)(row)?, (y.value)(row)?]);
    for Ends { rows, stroke, name } in all {
        for side in rows.chunk_by(|a, b| a.side == b.side && a.distance_mm < b.distance_mm) {
            let kinds = side.chunk_by(|a, b| a.kind == b.kind);
            let parts = kinds.filter_map(|part| {
                let (ink, kind) = look(part[0].kind)?;
                let name = match *name {
                    "" => kind.to_owned(),
                    name => format!("{name}: {kind}"),
                };
                let points = part.iter().filter_map(place).collect();
                Some(Line::new(points, ink, *stroke, name))
            });
            plot.lines.extend(joined(parts));
        }
    }
    plot
}

/// A bifurcation diagram. Points have the ink beside them; each branch begins at its first touch.
#[must_use]
pub fn branches(title: &str, poles: &[(Ink, &[BranchPoint])], [x, y]: [BranchAxis; 2]) -> Plot {
    let mut plot = empty(title, x.label, y.label);
    let place = |point: &BranchPoint| [(x.value)(point), (y.value)(point)];
    for (ink, points) in poles {
        for branch in points.chunk_by(|_, next| next.mark != Some(Mark::FirstTouch)) {
            let parts = branch.chunk_by(|a, b| a.stable == b.stable).map(|part| {
                let (stroke, name) = match part[0].stable {
                    true => (Stroke::Solid, "stable"),
                    false => (Stroke::Dashed, "unstable"),
                };
                Line::new(part.iter().map(place).collect(), *ink, stroke, name)
            });
            plot.lines.extend(joined(parts));
            plot.dots.extend(branch.iter().filter_map(|point| {
                let (ink, name) = match point.mark? {
                    Mark::FirstTouch => (*ink, "first touch"),
                    Mark::SlipOff => (Ink::Black, "slip-off"),
                    Mark::PullOff => (Ink::Blue, "pull-off"),
                    Mark::SecondFold => (Ink::Grey, "second fold"),
                    Mark::Tip => return None,
                };
                Some(Dot {
                    at: place(point),
                    ink,
                    open: point.mark == Some(Mark::FirstTouch),
                    name: Some(name.to_owned()),
                })
            }));
        }
    }
    plot
}

/// Measured detachments: slip-offs open, pull-offs filled, grey where it was not seen which.
#[must_use]
pub fn measured(points: &[Compared]) -> Vec<Dot> {
    let dots = points.iter().map(|point| {
        let (ink, open, name) = match point.kind {
            Some(DetachmentKind::SlipOff) => (Ink::Black, true, "measured slip-off"),
            Some(DetachmentKind::PullOff) => (Ink::Blue, false, "measured pull-off"),
            _ => (Ink::Grey, false, "measured"),
        };
        Dot {
            at: [point.distance_mm, point.measured_deg],
            ink,
            open,
            name: Some(name.to_owned()),
        }
    });
    dots.collect()
}

/// A shape to draw, and how.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The whisker.
    pub shape: Shape,
    /// Its colour.
    pub ink: Ink,
    /// Solid or dashed.
    pub stroke: Stroke,
    /// For the legend.
    pub name: String,
}

/// Whiskers in front of their pole.
#[must_use]
pub fn shapes(title: &str, drawn: &[Drawn]) -> Plot {
    let mut plot = empty(title, "x (mm)", "y (mm)");
    plot.equal_axes = true;
    plot.lines.extend(drawn.iter().map(|drawn| {
        let points = drawn.shape.points.iter().map(|p| [p.x_mm, p.y_mm]);
        Line::new(points.collect(), drawn.ink, drawn.stroke, &*drawn.name)
    }));
    plot.discs.extend(drawn.first().map(|drawn| Disc {
        centre: drawn.shape.pole_mm,
        radius: drawn.shape.pole_radius_mm,
        dark: false,
    }));
    plot
}

fn empty(title: &str, x_label: &str, y_label: &str) -> Plot {
    Plot {
        title: title.to_owned(),
        x_label: x_label.to_owned(),
        y_label: y_label.to_owned(),
        ..Plot::default()
    }
}

/// Lines each of which begins where the one before it has ended.
fn joined(parts: impl Iterator<Item = Line>) -> impl Iterator<Item = Line> {
    let mut end = None;
    parts.map(move |mut part| {
        part.points.splice(..0, end);
        end = part.points.last().copied();
        part
    })
}
