//! Layout of a chart, in pixels: title, caption, and plots in rows.

use super::Chart;
use super::plot_layout::PlotLayout;
use crate::frame::axes::BELOW;
use crate::frame::heading::{ALONE, HEAD_ROOM, Heading, NAME, SIDES, TITLE, TITLE_LINE};
use crate::picture::font::{FittedText, fitted};
use crate::picture::{Anchor, Area, Picture};

/// Size of the body of a plot among several.
const AMONG: [f64; 2] = [760.0, 520.0];
/// Least space to the left and right of a plot among several, in pixels.
const SIDES_AMONG: [f64; 2] = [116.0, 40.0];
/// Room above where the chart has no title.
const ABOVE: f64 = 24.0;
/// Distance between lines of the caption, in pixels.
const CAPTION_LINE: f64 = 28.0;

/// A chart with the positions of its title, caption and plots, in pixels.
pub struct ChartLayout<'a> {
    title: FittedText,
    /// Lines of the caption, each with the middle of its line.
    caption: Vec<(FittedText, f64)>,
    /// Room to the left of each body.
    left: f64,
    /// Each plot with its heading, the top of the heading, and the plot's body.
    plots: Vec<(PlotLayout<'a>, Heading, f64, Area)>,
    /// Width and height of the picture.
    size: [f64; 2],
}

impl<'a> ChartLayout<'a> {
    /// Lays a chart out: plots have bodies of equal size in straight rows, with space for the widest labels.
    pub fn plan(chart: &'a Chart) -> Self {
        let columns = chart.columns.clamp(1, chart.plots.len().max(1));
        let ([width, height], least) = if chart.plots.len() > 1 {
            (AMONG, SIDES_AMONG)
        } else {
            (ALONE, SIDES)
        };
        let layouts = chart.plots.iter();
        let layouts: Vec<_> = layouts
            .map(|plot| PlotLayout::plan(plot, [width, height]))
            .collect();
        let [left, right] = layouts.iter().fold(least, |most, layout| {
            let sides = layout.axes.sides();
            [most[0].max(sides[0]), most[1].max(sides[1])]
        });
        let pitch = left + width + right;
        let across = pitch * columns as f64;

        let mut top = match &*chart.title {
            "" => ABOVE,
            _ => HEAD_ROOM,
        };
        let room = across - left - right;
        let lines = chart.caption.iter().enumerate();
        let caption = lines.map(|(i, line)| {
            let middle = top + CAPTION_LINE * (i as f64 + 0.5);
            (fitted(line, NAME, room), middle)
        });
        let caption: Vec<_> = caption.collect();
        top += CAPTION_LINE * caption.len() as f64;

        let mut plots = Vec::new();
        let mut rest = layouts.into_iter().peekable();
        while rest.peek().is_some() {
            let row: Vec<_> = rest.by_ref().take(columns).collect();
            let headings = row.iter().map(|layout| layout.heading(left, width));
            let headings: Vec<_> = headings.collect();
            let heights = headings.iter().map(|heading| heading.height);
            let head = heights.fold(0.0, f64::max);
            for (column, (layout, heading)) in row.into_iter().zip(headings).enumerate() {
                let corner = [left + pitch * column as f64, top + head];
                let body = Area::new(corner, [width, height]);
                plots.push((layout, heading, top, body));
            }
            top += head + height + BELOW;
        }
        Self {
            title: fitted(&chart.title, TITLE, room),
            caption,
            left,
            plots,
            size: [across, top],
        }
    }

    pub fn draw(&self) -> Picture {
        let mut picture = Picture::new(self.size, None);
        picture.fitted(&self.title, [self.left, TITLE_LINE], Anchor::Left);
        for (line, middle) in &self.caption {
            picture.fitted(line, [self.left, *middle], Anchor::Left);
        }
        for (layout, heading, top, body) in &self.plots {
            heading.draw(&mut picture, [body.left, *top], self.left);
            layout.draw(&mut picture, *body, self.left);
        }
        picture
    }
}
