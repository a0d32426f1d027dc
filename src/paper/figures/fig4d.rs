//! Fig. 4D: a mouse whisker and a human hair.

use super::detachment::{dots, panel};
use super::{Figure, PUSH, figure};
use crate::measured::Point;
use crate::paper::whiskers::{FIG4_HAIR, FIG4_WHISKER};
use crate::render::Stroke;
use crate::trace::DetachmentKind;

pub fn fig4d(measured: &[Point]) -> Figure {
    let whiskers = [
        ("mouse whisker", &FIG4_WHISKER, Stroke::Solid),
        ("human hair", &FIG4_HAIR, Stroke::Dashed),
    ];
    let mut panel = panel("D", "", &whiskers);
    panel.plot.dots = dots(measured, |kind| kind == Some(DetachmentKind::SlipOff));
    let title = "Fig. 4D: detachment of a mouse whisker and a human hair";
    let panels = vec![("fig4d".to_owned(), panel)];
    figure("fig4d", title, vec![PUSH.to_owned()], panels)
}
