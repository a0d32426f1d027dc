//! One plot: frame, ticks and what is inside.

use super::heading::{Heading, fitted};
use super::surface::{DASHES, Pen, Surface};
use super::ticks::{self, Tick};
use super::window::{Window, drawable, drawable_disc};
use super::{Ink, Line, Plot, Stroke};
use crate::render::Error;
use crate::render::canvas::{Anchor, Area};
use crate::render::legend::{LABEL, TICK};
use crate::render::palette::{BLANK, BLUE, GREY, INK, Rgb, WHITE};

/// Widths of lines.
const LINE: f64 = 3.0;
const FRAME: f64 = 1.5;
/// Radius of a dot, and width of the white ring that sets it off.
const DOT: f64 = 8.0;
const RING: f64 = 2.0;
/// The smallest disc.
const DISC: f64 = 3.0;
/// From the frame to the middle of the label below, and from the left end of the plot's room to that on its side.
const X_LABEL: f64 = 76.0;
const Y_LABEL: f64 = 34.0;

/// The colour that an ink stands for.
pub(super) const fn colour(ink: Ink) -> Rgb {
    match ink {
        Ink::Black => INK,
        Ink::Blue => BLUE,
        Ink::Grey => GREY,
    }
}

/// What a line is drawn with.
pub(super) fn pen(line: &Line) -> Pen {
    Pen {
        width: LINE,
        colour: colour(line.ink),
        dashed: line.stroke == Stroke::Dashed,
    }
}

/// What stands before a name in the legend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Sample {
    Line(Pen),
    Dot(Rgb),
}

impl Sample {
    /// Room for three dashes, or for a dot.
    pub(super) const fn width(self) -> f64 {
        match self {
            Self::Line(_) => 3.0 * DASHES[0] + 2.0 * DASHES[1],
            Self::Dot(_) => 2.0 * DOT,
        }
    }

    /// Draws it to the right of a point.
    pub(super) fn draw(self, surface: &mut dyn Surface, [x, y]: [f64; 2]) {
        match self {
            Self::Line(pen) => surface.polyline(&[[x, y], [x + self.width(), y]], pen),
            Self::Dot(colour) => surface.circle([x + DOT, y], DOT, colour, None),
        }
    }
}

/// A plot laid out for a body of a size.
pub(super) struct Layout<'a> {
    plot: &'a Plot,
    window: Window,
    x_ticks: Vec<Tick>,
    y_ticks: Vec<Tick>,
    x_label: Option<(String, f64)>,
    y_label: Option<(String, f64)>,
}

impl<'a> Layout<'a> {
    /// Decides what the axes show.
    pub(super) fn plan(plot: &'a Plot, size: [f64; 2]) -> Result<Self, Error> {
        let window = Window::of(plot, size);
        Ok(Self {
            plot,
            window,
            x_ticks: ticks::across(window.x, size[0])?,
            y_ticks: ticks::upwards(window.y, size[1])?,
            x_label: fitted(Some(&plot.x_label), LABEL, size[0])?,
            y_label: fitted(Some(&plot.y_label), LABEL, size[1])?,
        })
    }

    /// Room that the labels take to the left of the body and, from the last tick across, to the right of it.
    pub(super) fn sides(&self) -> [f64; 2] {
        let beside = Y_LABEL + 0.5 * LABEL + 16.0;
        let ends = self.x_ticks.last().map_or(0.0, |last| 0.5 * last.width);
        [beside + ticks::widest(&self.y_ticks) + 15.0, ends + 8.0]
    }

    /// Letter, title and legend, for a body of this width with this much room to the left of it.
    pub(super) fn heading(&self, left: f64, width: f64) -> Result<Heading, Error> {
        Heading::plan(self.plot, left, width)
    }

    /// Draws the plot into `body`, with `left` pixels of room to the left of it.
    pub(super) fn draw(
        &self,
        surface: &mut dyn Surface,
        body: Area,
        left: f64,
    ) -> Result<(), Error> {
        self.discs(surface, body);
        for line in &self.plot.lines {
            self.line(surface, body, line);
        }
        for dot in self.plot.dots.iter().filter(|dot| drawable(dot.at)) {
            let at = self.window.place(body, dot.at);
            surface.circle(at, DOT, colour(dot.ink), Some(Pen::solid(RING, WHITE)));
        }
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)];
        let corners = corners.map(|(x, y)| body.point(x, y));
        surface.polyline(&corners, Pen::solid(FRAME, INK));
        self.axes(surface, body, left)
    }

    fn discs(&self, surface: &mut dyn Surface, body: Area) {
        for disc in self.plot.discs.iter().filter(|disc| drawable_disc(disc)) {
            let centre = self.window.place(body, disc.centre);
            let radius = self.window.pixels(body, disc.radius).max(DISC);
            surface.circle(centre, radius, BLANK, Some(Pen::solid(FRAME, INK)));
        }
    }

    /// The stretches of a line between points that cannot be drawn; a point on its own is as wide as the line.
    fn line(&self, surface: &mut dyn Surface, body: Area, line: &Line) {
        let pen = pen(line);
        for stretch in line.points.split(|point| !drawable(*point)) {
            let places: Vec<_> = stretch
                .iter()
                .map(|point| self.window.place(body, *point))
                .collect();
            match places[..] {
                [] => {}
                [only] => surface.circle(only, 0.5 * pen.width, pen.colour, None),
                _ => surface.polyline(&places, pen),
            }
        }
    }

    fn axes(&self, surface: &mut dyn Surface, body: Area, left: f64) -> Result<(), Error> {
        let pen = Pen::solid(FRAME, INK);
        for tick in &self.x_ticks {
            let [x, y] = body.point(tick.at, 0.0);
            surface.polyline(&[[x, y], [x, y + 8.0]], pen);
            surface.text(&tick.label, [x, y + 26.0], TICK, Anchor::Centre)?;
        }
        for tick in &self.y_ticks {
            let [x, y] = body.point(0.0, tick.at);
            surface.polyline(&[[x - 8.0, y], [x, y]], pen);
            surface.text(&tick.label, [x - 15.0, y], TICK, Anchor::Right)?;
        }
        if let Some((label, size)) = &self.x_label {
            let [x, y] = body.point(0.5, 0.0);
            surface.text(label, [x, y + X_LABEL], *size, Anchor::Centre)?;
        }
        if let Some((label, size)) = &self.y_label {
            let [x, y] = body.point(0.0, 0.5);
            surface.text(label, [x - left + Y_LABEL, y], *size, Anchor::Upwards)?;
        }
        Ok(())
    }
}
