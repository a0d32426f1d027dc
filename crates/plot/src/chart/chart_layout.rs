//! Layout of a chart, in units of the picture: title, caption, and plots in rows.

use super::Chart;
use super::plot_layout::PlotLayout;
use crate::frame::heading::{ALONE, Heading, NAME, SIDES, TICK, TITLE};
use crate::frame::spacing::Spacing;
use crate::picture::size::{PictureSize, SizeError};
use crate::picture::text::TextBlock;
use crate::picture::{Anchor, Area, Picture};

/// Size of the body of a plot among several.
const AMONG: [f64; 2] = [760.0, 520.0];
/// Least space to the left and right of a plot among several, in pixels.
const SIDES_AMONG: [f64; 2] = [116.0, 40.0];
/// Room above where the chart has no title.
const ABOVE: f64 = 24.0;
/// Distance between lines of the caption, in pixels.
const CAPTION_LINE: f64 = 28.0;
/// Distance between the names of a vertical axis in print, in pixels.
const NAMED_LINE: f64 = 1.4 * TICK;
/// Layouts until bodies and the labels around them agree: the labels depend on the bodies.
const PASSES: usize = 3;

/// A chart with the positions of its title, caption and plots, in units of the picture.
pub struct ChartLayout<'a> {
    title: TextBlock,
    /// Lines of the caption, each with the middle of its first line.
    caption: Vec<(TextBlock, f64)>,
    /// Room to the left of each body.
    left: f64,
    /// Position of the title and the caption from the left.
    head_left: f64,
    spacing: Spacing,
    /// Each plot with its heading, the top of the heading, and the plot's body.
    plots: Vec<(PlotLayout<'a>, Heading, f64, Area)>,
    /// Width and height of the picture.
    units: [f64; 2],
    size: PictureSize,
}

impl<'a> ChartLayout<'a> {
    /// Lays a chart out: plots have bodies of equal size in straight rows, with space for the widest labels.
    pub fn plan(chart: &'a Chart, size: PictureSize) -> Result<Self, SizeError> {
        let (natural, least) = match chart.plots.len() {
            0 | 1 => (ALONE, SIDES),
            _ => (AMONG, SIDES_AMONG),
        };
        let PictureSize::Print(print) = size else {
            return Ok(Self::around(chart, natural, least, size));
        };
        let columns = chart.columns();
        let counts = [columns, chart.plots.len().div_ceil(columns).max(1)].map(|n| n as f64);
        let ratio = natural[1] * counts[1] / (natural[0] * counts[0]);
        let names = chart.plots.iter().map(|plot| plot.y_names.len());
        let names = names.max().unwrap_or_default() as f64;
        let least_height = counts[1] * names * NAMED_LINE;
        let mut body = natural;
        let mut layout = Self::around(chart, body, [0.0; 2], size);
        for _ in 0..PASSES {
            let bodies = [0, 1].map(|axis| body[axis] * counts[axis]);
            let bodies = print.bodies(layout.units, bodies, ratio, least_height);
            body = [0, 1].map(|axis| bodies[axis] / counts[axis]);
            layout = Self::around(chart, body, [0.0; 2], size);
        }
        let bodies = [0, 1].map(|axis| body[axis] * counts[axis]);
        layout.units = print.fitted(layout.units, bodies, least_height)?;
        Ok(layout)
    }

    /// Lays a chart out around bodies of this size, with at least `least` space `[left, right]` beside each.
    fn around(
        chart: &'a Chart,
        [width, height]: [f64; 2],
        least: [f64; 2],
        size: PictureSize,
    ) -> Self {
        let spacing = Spacing::of(size);
        let columns = chart.columns();
        let layouts: Vec<_> = chart
            .plots
            .iter()
            .map(|plot| PlotLayout::plan(plot, [width, height], spacing))
            .collect();
        let [left, right] = layouts.iter().fold(least, |most, layout| {
            let sides = layout.axes.sides();
            [most[0].max(sides[0]), most[1].max(sides[1])]
        });
        let pitch = left + width + right;
        let across = pitch * columns as f64;

        let [before, room] = spacing.head_span([left, across - left - right, right]);
        let title = TextBlock::new(&chart.title, TITLE, room);
        let mut top = match &*chart.title {
            "" => ABOVE,
            _ => spacing.head_room + title.below_first(),
        };
        let mut caption = Vec::new();
        for line in &chart.caption {
            let line = TextBlock::new(line, NAME, room);
            let middle = top + 0.5 * CAPTION_LINE;
            top += CAPTION_LINE + line.below_first();
            caption.push((line, middle));
        }

        let mut plots = Vec::new();
        let mut rest = layouts.into_iter().peekable();
        while rest.peek().is_some() {
            let row: Vec<_> = rest.by_ref().take(columns).collect();
            let headings: Vec<_> =
                row.iter().map(|layout| layout.heading([left, width, right], spacing)).collect();
            let most = |heights: &mut dyn Iterator<Item = f64>| heights.fold(0.0, f64::max);
            let head = most(&mut headings.iter().map(|heading| heading.height));
            let above = most(&mut row.iter().map(|layout| layout.regions.height()));
            let below = most(&mut row.iter().map(|layout| layout.axes.below()));
            for (column, (layout, heading)) in row.into_iter().zip(headings).enumerate() {
                let corner = [left + pitch * column as f64, top + head + above];
                let body = Area::new(corner, [width, height]);
                plots.push((layout, heading, top, body));
            }
            top += head + above + height + below;
        }
        Self {
            title,
            caption,
            left,
            head_left: left - before,
            spacing,
            plots,
            units: [across, top],
            size,
        }
    }

    pub fn draw(&self) -> Picture {
        let mut picture = Picture::new(self.units, self.size);
        let title = [self.head_left, self.spacing.title_line];
        picture.block(&self.title, title, Anchor::Left);
        for (line, middle) in &self.caption {
            picture.block(line, [self.head_left, *middle], Anchor::Left);
        }
        for (layout, heading, top, body) in &self.plots {
            heading.draw(&mut picture, [body.left, *top], self.left);
            layout.draw(&mut picture, *body, self.left);
        }
        picture
    }
}
