//! Detachment curves, branches, shapes and designs as plots.
//!
//! Solid lines are stable states, dashed lines unstable states. Slip-off is black and pull-off is blue, as in the paper.

use super::labels;
use super::marks::YIELDING;
use crate::design::{Design, DesignEnd, DesignTarget, is_wide};
use crate::locate::{LocatedState, Locator};
use crate::scene::{digits, rounded};
use crate::sensitivity::Variable;
use crate::trace::{BranchMark, BranchPoint, Detachment, DetachmentKind, WhiskerShape};
use crate::yields::PushMark;
use whiskmap_plot::{Disc, Dot, Ink, Line, Plot, Stroke, readable_value};

/// Maximum number of digits of a value in a legend: another unit must not show the rounding of the conversion.
const MOST_DIGITS: usize = 15;

/// Axis of a plot of table rows: a label and the value of each row.
#[derive(Clone, Copy, Debug)]
pub struct PlotAxis<Row, Value> {
    /// Label of the plot axis, with its unit.
    pub label: &'static str,
    /// Function that returns the value of a row on the plot axis, in the unit of the label.
    pub value: fn(&Row) -> Value,
}

/// Axis of a plot of detachment curves; rows without a value are not drawn.
pub type CurveAxis = PlotAxis<Detachment, Option<f64>>;

/// Axis of a plot of branches.
pub type BranchAxis = PlotAxis<BranchPoint, f64>;

/// Detachments to draw with one stroke and one name, as a line for each whisker, side and kind of detachment.
#[derive(Clone, Copy, Debug, Default)]
pub struct DrawnCurve<'a> {
    /// Detachments of the curve, one whisker and side after the other, each in order of increasing distance.
    pub rows: &'a [Detachment],
    /// Distance in mm at which the tip of the resting whisker touches the pole. If both sides have a detachment there, a grey line between
    /// them closes the region of stable states.
    pub reach_mm: f64,
    /// Dash pattern of the curve: solid or dashed.
    pub stroke: Stroke,
    /// Name of the curve's whisker, before the kind of detachment in the legend; may be empty.
    pub name: &'a str,
    /// Colour of the curve's whisker, which its name in the legend has without the kind of detachment; pull-offs are then dashed. `None` for the
    /// colour of each kind.
    pub ink: Option<Ink>,
}

/// Returns a plot of detachment curves, with a line for each kind of detachment.
#[must_use]
pub fn curves(title: &str, all: &[DrawnCurve], [x, y]: [CurveAxis; 2]) -> Plot {
    let mut plot = empty(title, x.label, y.label);
    let place = |row: &Detachment| Some([(x.value)(row)?, (y.value)(row)?]);
    let mut has_dashes = false;
    for DrawnCurve { rows, reach_mm, stroke, name, ink: of_whisker } in all {
        for side in rows.chunk_by(|a, b| a.side == b.side && a.distance_mm < b.distance_mm) {
            let kinds = side.chunk_by(|a, b| a.kind == b.kind);
            let parts = kinds.filter_map(|part| {
                let (ink, kind) = look(part[0].kind)?;
                let points = part.iter().filter_map(place).collect();
                Some(match (of_whisker, *name) {
                    (Some(ink), name) if part[0].kind == DetachmentKind::PullOff => {
                        has_dashes = true;
                        Line::new(points, *ink, Stroke::Dashed).named(name)
                    }
                    (Some(ink), name) => Line::new(points, *ink, *stroke).named(name),
                    (None, "") => Line::new(points, ink, *stroke).named(kind),
                    (None, name) => {
                        Line::new(points, ink, *stroke).named(format!("{name}: {kind}"))
                    }
                })
            });
            plot.lines.extend(joined(parts));
        }
        let at_reach = rows.iter().filter(|row| row.distance_mm == *reach_mm);
        let tip: Vec<_> = at_reach.filter_map(place).collect();
        if tip.len() > 1 {
            plot.lines.push(Line::new(tip, Ink::Grey, *stroke).named("first touch at the tip"));
        }
    }
    if has_dashes {
        let symbol = Line::new(Vec::new(), Ink::Black, Stroke::Dashed);
        plot.lines.push(symbol.named("pull-off"));
    }
    plot
}

/// Returns a line over the ends of detachment curves whose pushes exceed the yield strain; `None` without such an end. The `ends` with their
/// marks are those of one whisker and side after the other, each in order of increasing distance.
#[must_use]
pub fn yielding_ends<'a>(
    ends: impl IntoIterator<Item = (&'a Detachment, Option<PushMark>)>,
    [x, y]: [CurveAxis; 2],
) -> Option<Line> {
    const BREAK: [f64; 2] = [f64::NAN; 2];
    let mut points = Vec::new();
    let mut before_mm = f64::INFINITY;
    for (end, mark) in ends {
        if end.distance_mm <= before_mm {
            points.push(BREAK);
        }
        before_mm = end.distance_mm;
        let yields = mark.and_then(|mark| mark.yields) == Some(true);
        let place = (x.value)(end).zip((y.value)(end));
        points.push(place.filter(|_| yields).map_or(BREAK, <[f64; 2]>::from));
    }
    let has_points = points.iter().flatten().any(|coordinate| coordinate.is_finite());
    has_points.then(|| Line::new(points, Ink::Grey, Stroke::Dashed).named(YIELDING))
}

/// The branches of a whisker at one pole, with their colour and name.
#[derive(Clone, Copy, Debug)]
pub struct DrawnBranch<'a> {
    /// Points of the branches at the pole, one side after the other; each branch begins at its first touch.
    pub points: &'a [BranchPoint],
    /// Colour of the branches.
    pub ink: Ink,
    /// Name of the stable states in the legend.
    pub name: &'a str,
}

/// Returns a bifurcation diagram: a plot of the branches at each pole.
#[must_use]
pub fn branches(title: &str, poles: &[DrawnBranch], [x, y]: [BranchAxis; 2]) -> Plot {
    let mut plot = empty(title, x.label, y.label);
    let place = |point: &BranchPoint| [(x.value)(point), (y.value)(point)];
    for DrawnBranch { points, ink, name } in poles {
        for branch in points.chunk_by(|_, next| next.mark != Some(BranchMark::FirstTouch)) {
            let parts = branch.chunk_by(|a, b| a.stable == b.stable).map(|part| {
                let (stroke, name) = match part[0].stable {
                    true => (Stroke::Solid, *name),
                    false => (Stroke::Dashed, "unstable"),
                };
                Line::new(part.iter().map(place).collect(), *ink, stroke).named(name)
            });
            plot.lines.extend(joined(parts));
            plot.dots.extend(branch.iter().filter_map(|point| {
                let (ink, name) = match point.mark? {
                    BranchMark::FirstTouch => (*ink, "first touch"),
                    BranchMark::SlipOff => (Ink::Black, "slip-off"),
                    BranchMark::PullOff => (Ink::Blue, "pull-off"),
                    BranchMark::SecondFold => (Ink::Grey, "second fold"),
                    BranchMark::Tip => return None,
                };
                Some(Dot {
                    at: place(point),
                    ink,
                    open: point.mark == Some(BranchMark::FirstTouch),
                    name: Some(name.to_owned()),
                })
            }));
        }
    }
    plot
}

/// A whisker shape to draw, with its colour, stroke and name in the legend.
#[derive(Clone, Debug)]
pub struct DrawnShape {
    /// Shape of the whisker to draw, with its pole.
    pub shape: WhiskerShape,
    /// Colour of the drawn whisker.
    pub ink: Ink,
    /// Dash pattern of the drawn whisker: solid or dashed.
    pub stroke: Stroke,
    /// Name of the drawn whisker in the legend.
    pub name: String,
}

/// Returns a plot of whisker shapes, in mm, in front of the pole of the first one.
#[must_use]
pub fn shapes(title: &str, drawn: &[DrawnShape]) -> Plot {
    let mut plot = empty(title, "x (mm)", "y (mm)");
    plot.equal_axes = true;
    plot.lines.extend(drawn.iter().map(|drawn| {
        let points = drawn.shape.points.iter().map(|p| [p.x_mm, p.y_mm]);
        Line::new(points.collect(), drawn.ink, drawn.stroke).named(&*drawn.name)
    }));
    plot.discs.extend(drawn.first().map(|drawn| Disc {
        centre: drawn.shape.pole_mm,
        radius: drawn.shape.pole_radius_mm,
        dark: false,
    }));
    plot
}

/// Returns a plot of located contacts in the frame of the base, in mm, and of the resting whisker.
#[must_use]
pub fn contacts(locator: &Locator, located: &[LocatedState]) -> Plot {
    let mut plot = empty("", "x (mm)", "y (mm)");
    plot.equal_axes = true;
    let at_rest = Line::new(locator.at_rest_mm(), Ink::Grey, Stroke::Solid);
    plot.lines.push(at_rest.named("at rest"));
    plot.dots.extend(located.iter().filter_map(|row| {
        let (ink, open, name) = match row.states {
            1 => (Ink::Black, false, "one state"),
            _ => (Ink::Blue, true, "one of several states"),
        };
        Some(Dot {
            at: [row.contact_x_mm?, row.contact_y_mm?],
            ink,
            open,
            name: Some(name.to_owned()),
        })
    }));
    plot
}

/// Returns a plot of the goal's quantity over the parameter of a design, with its solutions as dots. Axes with a wide range of positive
/// numbers are logarithmic.
#[must_use]
pub fn designs(variable: Variable, target: &DesignTarget, design: &Design) -> Plot {
    let goal = target.goal;
    let (unit, size) = match goal.quantity().unit() {
        Some("uN") => (" (\u{b5}N)", "\u{b5}N"),
        Some("nNm") => (" (nN m)", "nN m"),
        Some("deg") => (" (deg)", "deg"),
        _ => ("", ""),
    };
    let label = format!("{}{unit}", goal.title());
    let varied = match variable {
        Variable::Parameter(parameter) => labels::parameter(parameter),
        variable => labels::axis_title(&variable.name()),
    };
    let mut plot = empty("", &varied, &label);
    let kinds = [DetachmentKind::SlipOff, DetachmentKind::PullOff];
    let ranges = kinds.into_iter().filter_map(|kind| design.reached(kind));
    let reached = ranges
        .fold([target.value; 2], |[low, high], [least, most]| [low.min(least), high.max(most)]);
    plot.logarithmic = [design.range, reached].map(is_wide);
    let wanted = design.range.map(|end| [end, target.value]).to_vec();
    let wanted = Line::new(wanted, Ink::Grey, Stroke::Dashed);
    let (value, size) = readable_value(target.value, size);
    let value = digits(rounded(value, MOST_DIGITS));
    plot.lines.push(wanted.named(format!("{value} {size}").trim_end()));
    for piece in design.ends.chunk_by(|a, b| a.kind == b.kind) {
        if let Some((ink, name)) = look(piece[0].kind) {
            let place = |end: &DesignEnd| Some([end.value, end.reached?]);
            let points = piece.iter().filter_map(place).collect();
            plot.lines.push(Line::new(points, ink, Stroke::Solid).named(name));
        }
    }
    let ink = goal.kind().and_then(look).map_or(Ink::Black, |(ink, _)| ink);
    plot.dots.extend(design.values.iter().map(|value| Dot {
        at: [*value, target.value],
        ink,
        open: false,
        name: Some("solution".to_owned()),
    }));
    plot
}

/// The ink and the name of a kind of detachment; `None` if there is no detachment.
const fn look(kind: DetachmentKind) -> Option<(Ink, &'static str)> {
    match kind {
        DetachmentKind::SlipOff => Some((Ink::Black, "slip-off")),
        DetachmentKind::PullOff => Some((Ink::Blue, "pull-off")),
        DetachmentKind::OutOfReach | DetachmentKind::Unresolved | DetachmentKind::NoWhisker => None,
    }
}

fn empty(title: &str, x_label: &str, y_label: &str) -> Plot {
    Plot {
        title: title.to_owned(),
        x_label: x_label.to_owned(),
        y_label: y_label.to_owned(),
        ..Plot::default()
    }
}

/// Joins lines: each begins where the previous one ends.
fn joined(parts: impl Iterator<Item = Line>) -> impl Iterator<Item = Line> {
    let mut end = None;
    parts.map(move |mut part| {
        part.points.splice(..0, end);
        end = part.points.last().copied();
        part
    })
}
