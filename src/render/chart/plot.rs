//! One plot: frame, ticks and what is inside.

use super::data::{Band, Plot, Shade};
use super::marks::{LINE, colour, disc, pen, polyline, rim};
use super::window::{Window, drawable, drawable_disc, drawable_span};
use super::{inset, notes};
use crate::render::axes::{Axes, FRAME};
use crate::render::heading::{DOT, Heading, Sample};
use crate::render::palette::{Fill, Rgb, SHADE_DARK, SHADE_LIGHT, WHITE};
use crate::render::picture::{Area, Pen, Picture};
use crate::render::{ticks, units};
use std::borrow::Cow;

/// Width of the white ring that sets a dot off.
const RING: f64 = 2.0;

/// The colour that a shade stands for.
const fn ground(shade: Shade) -> Rgb {
    match shade {
        Shade::Light => SHADE_LIGHT,
        Shade::Dark => SHADE_DARK,
    }
}

/// A plot laid out for a body of a size.
pub(super) struct Layout<'a> {
    /// With logarithms in place of everything on logarithmic axes.
    plot: Cow<'a, Plot>,
    window: Window,
    pub(super) axes: Axes,
}

impl<'a> Layout<'a> {
    /// Decides what the axes show.
    pub(super) fn plan(plot: &'a Plot, size: [f64; 2]) -> Self {
        if plot.logarithmic {
            let plot = plot.logarithms();
            let window = Window::of(&plot, size);
            let x_ticks = ticks::across(window.x, size[0], ticks::of_logarithms);
            let y_ticks = ticks::upwards(window.y, size[1], ticks::of_logarithms);
            let axes = Axes::new([(x_ticks, &plot.x_label), (y_ticks, &plot.y_label)], size);
            return Self {
                plot: Cow::Owned(plot),
                window,
                axes,
            };
        }
        let window = Window::of(plot, size);
        let [across, upwards] = window.largest;
        let (x_label, x_unit) = units::readable(&plot.x_label, across);
        let (y_label, y_unit) = units::readable(&plot.y_label, upwards);
        let x = window.x.map(|end| end / x_unit);
        let y = window.y.map(|end| end / y_unit);
        let x_ticks = ticks::across(x, size[0], ticks::of_numbers);
        let y_ticks = ticks::upwards(y, size[1], ticks::of_numbers);
        Self {
            plot: Cow::Borrowed(plot),
            window,
            axes: Axes::new([(x_ticks, &x_label), (y_ticks, &y_label)], size),
        }
    }

    /// Letter, title and legend, for a body of this width with this much room to the left of it.
    pub(super) fn heading(&self, left: f64, width: f64) -> Heading {
        let letter = self.plot.letter.as_deref().unwrap_or_default();
        Heading::plan([letter, &self.plot.title], self.samples(), [left, width])
    }

    /// Draws the plot into `body`, with `left` pixels of room to the left of it.
    pub(super) fn draw(&self, picture: &mut Picture, body: Area, left: f64) {
        for band in &self.plot.bands {
            self.band(picture, body, band);
        }
        for one in self.plot.discs.iter().filter(|one| drawable_disc(one)) {
            disc(picture, body, &self.window, one);
        }
        for line in &self.plot.lines {
            for stretch in line.points.split(|point| !drawable(*point)) {
                polyline(picture, body, &self.window, stretch, line);
            }
        }
        for dot in self.plot.dots.iter().filter(|dot| drawable(dot.at)) {
            let at = self.window.place(body, dot.at);
            match dot.open {
                true => picture.circle(at, DOT - 0.5 * LINE, WHITE, Some(rim(dot.ink))),
                false => picture.circle(at, DOT, colour(dot.ink), Some(Pen::solid(RING, WHITE))),
            }
        }
        if let Some(inset) = &self.plot.inset {
            inset::draw(picture, body, &self.window, &self.plot, inset);
        }
        notes::draw(picture, body, &self.window, &self.plot.notes);
        if !self.plot.bare {
            picture.frame(body, FRAME);
            self.axes.draw(picture, body, left);
        }
    }

    /// The stretches of a band between points that cannot be drawn.
    fn band(&self, picture: &mut Picture, body: Area, band: &Band) {
        for stretch in band.points.split(|point| !drawable_span(*point)) {
            let there = stretch.iter().map(|[x, from, _]| [*x, *from]);
            let back = stretch.iter().rev().map(|[x, _, to]| [*x, *to]);
            let corners = there
                .chain(back)
                .map(|point| self.window.place(body, point));
            picture.polygon(corners.collect(), ground(band.shade));
        }
    }

    /// What is in the legend: each name once, with what bears it first.
    fn samples(&self) -> Vec<(Sample, String)> {
        let lines = self.plot.lines.iter().map(|line| {
            let sample = match line.points[..] {
                [_] => Sample::Dot(colour(line.ink)),
                _ => Sample::Line(pen(line)),
            };
            (sample, &line.name)
        });
        let dots = self.plot.dots.iter();
        let dots = dots.map(|dot| match dot.open {
            true => (Sample::Ring(rim(dot.ink)), &dot.name),
            false => (Sample::Dot(colour(dot.ink)), &dot.name),
        });
        let bands = self.plot.bands.iter();
        let bands = bands.map(|band| (Sample::Swatch(Fill::plain(ground(band.shade))), &band.name));
        let mut samples: Vec<(Sample, String)> = Vec::new();
        for (sample, name) in lines.chain(dots).chain(bands) {
            if let Some(name) = name.as_deref().filter(|name| !name.is_empty())
                && samples.iter().all(|(_, known)| known != name)
            {
                samples.push((sample, name.to_owned()));
            }
        }
        samples
    }
}
