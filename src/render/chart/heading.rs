//! What stands above a plot: letter, title and legend.

use super::Plot;
use super::plot::{self, Sample};
use super::surface::Surface;
use crate::render::Error;
use crate::render::canvas::{Anchor, Area, text_width};
use crate::render::legend::{self, LABEL, LINE, NAME, TITLE};

/// Height of the line of letter and title.
const HEAD: f64 = 46.0;
/// Room below.
const BELOW: f64 = 18.0;
/// Between a sample and its name.
const GAP: f64 = 12.0;
/// From the left end of the plot's room to the letter.
const LETTER: f64 = 18.0;

/// Letter, title and legend of a plot, laid out for a width. Letter and title come with their sizes.
pub(super) struct Heading {
    letter: Option<(String, f64)>,
    title: Option<(String, f64)>,
    /// Line of the legend, offset along it, sample and name.
    entries: Vec<(usize, f64, Sample, String)>,
    /// Height of it all, with the room below.
    pub(super) height: f64,
}

impl Heading {
    /// Decides where everything goes above a body of this width with this much room to the left of it.
    pub(super) fn plan(plot: &Plot, left: f64, width: f64) -> Result<Self, Error> {
        let letter = fitted(plot.letter.as_deref(), TITLE, left - 2.0 * LETTER)?;
        let title = fitted(Some(&plot.title), LABEL, width)?;
        let (mut samples, mut widths) = (Vec::new(), Vec::new());
        for (sample, name) in named(plot) {
            let (name, _) = legend::fitted(name, NAME, width - sample.width() - GAP)?;
            widths.push(sample.width() + GAP + text_width(&name, NAME)?);
            samples.push((sample, name));
        }
        let (places, lines) = legend::flow(&widths, width);
        let entries = places.into_iter().zip(samples);
        let head = if letter.is_some() || title.is_some() {
            HEAD
        } else {
            0.0
        };
        Ok(Self {
            letter,
            title,
            entries: entries
                .map(|((line, offset), (sample, name))| (line, offset, sample, name))
                .collect(),
            height: head + LINE * lines as f64 + BELOW,
        })
    }

    /// Draws it above `body`, from `top` downwards, with the letter `left` pixels to the left of the body.
    pub(super) fn draw(
        &self,
        surface: &mut dyn Surface,
        body: Area,
        top: f64,
        left: f64,
    ) -> Result<(), Error> {
        let mut y = top + 0.5 * HEAD;
        if let Some((letter, size)) = &self.letter {
            surface.text(letter, [body.left - left + LETTER, y], *size, Anchor::Left)?;
        }
        if let Some((title, size)) = &self.title {
            surface.text(title, [body.left, y], *size, Anchor::Left)?;
        }
        if self.letter.is_some() || self.title.is_some() {
            y += HEAD;
        }
        for (line, offset, sample, name) in &self.entries {
            let (x, y) = (body.left + offset, y + LINE * *line as f64);
            sample.draw(surface, [x, y]);
            surface.text(name, [x + sample.width() + GAP, y], NAME, Anchor::Left)?;
        }
        Ok(())
    }
}

/// A text and the size in which it fits, unless it is empty.
pub(super) fn fitted(
    text: Option<&str>,
    largest: f64,
    width: f64,
) -> Result<Option<(String, f64)>, Error> {
    let text = text.filter(|text| !text.is_empty());
    text.map(|text| legend::fitted(text, largest, width))
        .transpose()
}

/// What is in the legend: each name once, with what bears it first.
fn named(plot: &Plot) -> Vec<(Sample, &str)> {
    let lines = plot
        .lines
        .iter()
        .map(|line| (Sample::Line(plot::pen(line)), &line.name));
    let dots = plot
        .dots
        .iter()
        .map(|dot| (Sample::Dot(plot::colour(dot.ink)), &dot.name));
    let mut named: Vec<(Sample, &str)> = Vec::new();
    for (sample, name) in lines.chain(dots) {
        if let Some(name) = name.as_deref().filter(|name| !name.is_empty())
            && named.iter().all(|(_, known)| *known != name)
        {
            named.push((sample, name));
        }
    }
    named
}
