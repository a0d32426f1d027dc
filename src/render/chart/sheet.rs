//! Where the plots of a chart stand.

use super::data::Chart;
use super::plot::Layout;
use crate::render::axes::BELOW;
use crate::render::font::fitted;
use crate::render::heading::{Heading, TITLE};
use crate::render::picture::{Anchor, Area, Picture};

/// Size of the body of the only plot, and of one among several.
const ALONE: [f64; 2] = [1280.0, 880.0];
const AMONG: [f64; 2] = [760.0, 520.0];
/// Least room to the left and to the right of the body of the only plot, and of one among several.
const SIDES_ALONE: [f64; 2] = [136.0, 48.0];
const SIDES_AMONG: [f64; 2] = [116.0, 40.0];
/// Height of the chart's title, and room above where there is none.
const HEAD: f64 = 74.0;
const ABOVE: f64 = 24.0;

/// A chart laid out.
pub(super) struct Sheet<'a> {
    title: (String, f64),
    /// Room to the left of each body.
    left: f64,
    /// Each plot with its heading, the top of the heading, and the plot's body.
    plots: Vec<(Layout<'a>, Heading, f64, Area)>,
    /// Width and height of the picture.
    size: [f64; 2],
}

impl<'a> Sheet<'a> {
    /// Decides where everything goes. Bodies have equal sizes and stand in line, with room for the widest labels.
    pub(super) fn plan(chart: &'a Chart) -> Self {
        let columns = chart.columns.clamp(1, chart.plots.len().max(1));
        let ([width, height], least) = if chart.plots.len() > 1 {
            (AMONG, SIDES_AMONG)
        } else {
            (ALONE, SIDES_ALONE)
        };
        let layouts = chart.plots.iter();
        let layouts: Vec<_> = layouts
            .map(|plot| Layout::plan(plot, [width, height]))
            .collect();
        let [left, right] = layouts.iter().fold(least, |most, layout| {
            let sides = layout.axes.sides();
            [most[0].max(sides[0]), most[1].max(sides[1])]
        });
        let pitch = left + width + right;
        let across = pitch * columns as f64;

        let mut top = if chart.title.is_empty() { ABOVE } else { HEAD };
        let mut plots = Vec::new();
        let mut rest = layouts.into_iter().peekable();
        while rest.peek().is_some() {
            let row: Vec<_> = rest.by_ref().take(columns).collect();
            let headings = row.iter().map(|layout| layout.heading(left, width));
            let headings: Vec<_> = headings.collect();
            let head = headings
                .iter()
                .fold(0.0, |most, heading| heading.height.max(most));
            for (column, (layout, heading)) in row.into_iter().zip(headings).enumerate() {
                let corner = [left + pitch * column as f64, top + head];
                let body = Area::new(corner, [width, height]);
                plots.push((layout, heading, top, body));
            }
            top += head + height + BELOW;
        }
        Self {
            title: fitted(&chart.title, TITLE, across - left - right),
            left,
            plots,
            size: [across, top],
        }
    }

    /// Draws it all.
    pub(super) fn draw(&self) -> Picture {
        let mut picture = Picture::new(self.size, None);
        let (title, size) = &self.title;
        picture.text(title, [self.left, 46.0], *size, Anchor::Left);
        for (layout, heading, top, body) in &self.plots {
            heading.draw(&mut picture, [body.left, *top], self.left);
            layout.draw(&mut picture, *body, self.left);
        }
        picture
    }
}
