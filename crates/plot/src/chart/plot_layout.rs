//! Layout of one plot of a chart: frame, ticks and contents.

use super::viewport::{Viewport, pen};
use super::window::{Window, drawable_disc, drawable_span};
use super::{Band, Dot, Plot, Shade};
use crate::frame::axes::{Axes, FRAME};
use crate::frame::heading::{DOT, Heading, LINE, LegendEntry, LegendSymbol};
use crate::frame::regions::RegionNames;
use crate::frame::spacing::Spacing;
use crate::frame::ticks::{self, Tick, TickChooser, fraction};
use crate::frame::units;
use crate::picture::palette::{Fill, GREY, Rgb, SHADE_DARK, SHADE_LIGHT, WHITE};
use crate::picture::{Area, Pen, Picture};
use std::borrow::Cow;

/// Width of the white ring around a dot.
const RING: f64 = 2.0;

/// Half the width of the bar of a band of one point: more than the radius of a dot.
const BAR: f64 = 12.0;

const fn ground(shade: Shade) -> Rgb {
    match shade {
        Shade::Light => SHADE_LIGHT,
        Shade::Dark => SHADE_DARK,
    }
}

/// The middle of a range.
fn middle([low, high]: [f64; 2]) -> f64 {
    0.5 * low + 0.5 * high
}

/// The pen of an open dot.
fn rim(dot: &Dot) -> Pen {
    Pen::solid(LINE, dot.ink.rgb())
}

/// A plot with the ranges, units and ticks chosen for a body of known size.
pub struct PlotLayout<'a> {
    /// The plot, with all numbers replaced by their logarithms on logarithmic axes.
    plot: Cow<'a, Plot>,
    window: Window,
    pub axes: Axes,
    pub regions: RegionNames,
}

impl<'a> PlotLayout<'a> {
    /// Chooses ranges, units and ticks of a plot for a body of this `size`, `[width, height]` in pixels.
    pub fn plan(plot: &'a Plot, size: [f64; 2], spacing: Spacing) -> Self {
        let plot = match plot.logarithmic {
            [false, false] => Cow::Borrowed(plot),
            _ => Cow::Owned(plot.logarithms()),
        };
        let window = Window::of(&plot, size);
        let choose = [0, 1].map(|axis| -> TickChooser {
            match plot.logarithmic[axis] {
                true => ticks::of_logarithms,
                false => ticks::of_numbers,
            }
        });
        let [(x_label, x_range), (y_label, y_range)] = [0, 1].map(|axis| {
            let label = [&plot.x_label, &plot.y_label][axis];
            let range = [window.x, window.y][axis];
            match plot.logarithmic[axis] {
                // Numbers span many units: the one in the middle of the axis.
                true => {
                    let (label, unit) = units::readable(label, 10_f64.powf(middle(range)));
                    (label, range.map(|end| end - unit.log10()))
                }
                false => {
                    let (label, unit) = units::readable(label, window.largest[axis]);
                    (label, range.map(|end| end / unit))
                }
            }
        });
        let mut x_ticks = ticks::across(x_range, size[0], choose[0]);
        let x_label = match plot.is_above {
            true => String::new(),
            false => x_label,
        };
        if plot.is_above {
            x_ticks.iter_mut().for_each(Tick::clear);
        }
        let y_ticks = match &*plot.y_names {
            [] => ticks::upwards(y_range, size[1], choose[1]),
            names => ticks::named(names, window.y),
        };
        let axes = Axes::new([(x_ticks, &x_label), (y_ticks, &y_label)], size, spacing);
        let regions = RegionNames::plan(plot.regions.as_ref(), fraction(window.x, 0.0), size[0]);
        Self { plot, window, axes, regions }
    }

    /// Lays out the plot's letter, title and legend above a body with `[left, width, right]`: its width and the space beside it.
    pub fn heading(&self, body: [f64; 3], spacing: Spacing) -> Heading {
        let letter = self.plot.letter.as_deref().unwrap_or_default();
        Heading::plan([letter, &self.plot.title], self.legend(), body, spacing)
    }

    /// Draws the plot into `body`, with `left` pixels of space to its left.
    pub fn draw(&self, picture: &mut Picture, body: Area, left: f64) {
        let plot = &*self.plot;
        let window = self.window;
        let viewport = Viewport { body, window };
        for band in &plot.bands {
            draw_band(picture, &viewport, band);
        }
        if plot.regions.is_some() && window.holds([0.0, window.y[0]]) {
            let ends = window.y.map(|y| viewport.place([0.0, y]));
            picture.polyline(&ends, Pen::solid(FRAME, GREY));
        }
        for disc in plot.discs.iter().filter(|disc| drawable_disc(disc)) {
            viewport.disc(picture, disc);
        }
        for line in &plot.lines {
            viewport.line(picture, line, plot.y_range.is_some());
        }
        for dot in plot.dots.iter().filter(|dot| window.holds(dot.at)) {
            let at = viewport.place(dot.at);
            match dot.open {
                true => picture.circle(at, DOT - 0.5 * LINE, WHITE, Some(rim(dot))),
                false => picture.circle(at, DOT, dot.ink.rgb(), Some(Pen::solid(RING, WHITE))),
            }
        }
        for bar in &plot.bars {
            let points = bar.points.iter().filter(|point| window.holds(**point));
            let places: Vec<_> = points.map(|point| viewport.place(*point)).collect();
            picture.polyline(&places, Pen::solid(LINE + RING, WHITE));
            picture.polyline(&places, pen(bar));
        }
        if let Some(inset) = &plot.inset {
            viewport.inset(picture, plot, inset);
        }
        viewport.notes(picture, &plot.notes);
        if !plot.bare {
            picture.frame(body, FRAME);
            self.axes.draw(picture, body, left);
            self.regions.draw(picture, body);
        }
    }

    /// The legend: each name once, with the first symbol that has the name.
    fn legend(&self) -> Vec<LegendEntry> {
        let lines = self.plot.lines.iter().map(|line| {
            let symbol = match line.points[..] {
                [_] => LegendSymbol::Dot(line.ink.rgb()),
                _ => LegendSymbol::Line(pen(line)),
            };
            (symbol, &line.name)
        });
        let shown = self.plot.dots.iter().filter(|dot| self.window.holds(dot.at));
        let dots = shown.map(|dot| match dot.open {
            true => (LegendSymbol::Ring(rim(dot)), &dot.name),
            false => (LegendSymbol::Dot(dot.ink.rgb()), &dot.name),
        });
        let bands = self.plot.bands.iter().map(|band| {
            let fill = Fill::plain(ground(band.shade));
            (LegendSymbol::Swatch(fill), &band.name)
        });
        let mut legend: Vec<LegendEntry> = Vec::new();
        for (symbol, name) in lines.chain(dots).chain(bands) {
            if let Some(name) = name.as_deref().filter(|name| !name.is_empty())
                && legend.iter().all(|known| known.name != name)
            {
                legend.push(LegendEntry::new(symbol, name));
            }
        }
        legend
    }
}

/// Draws the stretches of a band between points that cannot be drawn, or the bar of its only point.
fn draw_band(picture: &mut Picture, viewport: &Viewport, band: &Band) {
    if let [edges] = band.points[..]
        && drawable_span(edges)
    {
        let [[x, y], [to_x, to_y]] = edges.map(|edge| viewport.place(edge));
        let part = BAR / (to_x - x).hypot(to_y - y);
        if part.is_finite() {
            let [across_x, across_y] = [part * (y - to_y), part * (to_x - x)];
            let corners = [
                [x + across_x, y + across_y],
                [to_x + across_x, to_y + across_y],
                [to_x - across_x, to_y - across_y],
                [x - across_x, y - across_y],
            ];
            picture.polygon(corners.to_vec(), ground(band.shade));
        }
        return;
    }
    for stretch in band.points.split(|point| !drawable_span(*point)) {
        let [low, high] = viewport.window.y;
        let inside = |[x, y]: [f64; 2]| [x, y.clamp(low, high)];
        let there = stretch.iter().map(|[one, _]| inside(*one));
        let back = stretch.iter().rev().map(|[_, other]| inside(*other));
        let corners = there.chain(back).map(|point| viewport.place(point));
        picture.polygon(corners.collect(), ground(band.shade));
    }
}
