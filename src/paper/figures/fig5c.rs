//! Fig. 5C: two whiskers of behaving mice, each beside a cylinder.

use super::detachment::{dots, panel};
use super::{Figure, PUSH, Panel, figure};
use crate::measured::Point;
use crate::paper::whiskers::{FIG5_LEFT, FIG5_RIGHT, cylinder_of};
use crate::render::Stroke;
use crate::scene::Whisker;

pub fn fig5c([left, right]: [&[Point]; 2]) -> Figure {
    let panels = vec![
        (
            "fig5c_left".to_owned(),
            beside_cylinder("C", "truncated whisker", &FIG5_LEFT, left),
        ),
        (
            "fig5c_right".to_owned(),
            beside_cylinder("", "less truncated whisker", &FIG5_RIGHT, right),
        ),
    ];
    let title = "Fig. 5C: detachment of two whiskers, and of cylinders of their length and base";
    let caption = vec![
        PUSH.to_owned(),
        "Lengths are the paper's effective ones, in projection; on the right, arclengths are corrected by 3 % (Methods).".to_owned(),
    ];
    figure("fig5c", title, caption, panels)
}

fn beside_cylinder(
    letter: &'static str,
    title: &str,
    whisker: &Whisker,
    measured: &[Point],
) -> Panel {
    let cylinder = cylinder_of(whisker);
    let whiskers = [
        ("whisker", whisker, Stroke::Solid),
        ("cylinder", &cylinder, Stroke::Dashed),
    ];
    let mut panel = panel(letter, title, &whiskers);
    panel.plot.dots = dots(measured, |_| true);
    panel
}
