//! Fig. 1: what the words mean, drawn of computed states.

mod pushed;

use super::drawing::{MAGNIFIED, arc, arrow, extent, line, outline, sections, text};
use super::{Figure, Panel, lettered};
use crate::paper::whiskers::{CONE, FIG5_LEFT, POLE};
use crate::render::{Disc, Ink, Plot, Stroke};
use crate::rod::Side;
use crate::scene::Whisker;
use crate::trace::{Branch, NoState, Shape};
use glam::DVec2;
use serde::Serialize;

/// Where the pole of panels B to D first touches the cone.
const TOUCH_MM: f64 = 10.0;
/// Places along a whisker.
const PLACES: usize = 100;

/// A place of one of the whiskers in a panel.
#[derive(Clone, Copy, Serialize)]
struct Place {
    whisker: &'static str,
    x_mm: f64,
    y_mm: f64,
}

/// A whisker's rows in the table of a panel.
fn places(whisker: &'static str, points: &[[f64; 2]]) -> impl Iterator<Item = Place> {
    let place = move |&[x_mm, y_mm]: &[f64; 2]| Place {
        whisker,
        x_mm,
        y_mm,
    };
    points.iter().map(place)
}

pub fn fig1() -> Result<Figure, NoState> {
    let caption = vec![
        "A: the truncated whisker of Fig. 5. B-D: the cone of Fig. 3, first touched 10 mm from its base; B, D: pushed by 30 deg, CB."
            .to_owned(),
        "All shapes are computed; the frame is that of Eqs. 8-14: the pole stands still, and the base turns against it.".to_owned(),
    ];
    let panels = vec![cone(), pushed::contact()?, sides()?, pushed::push_angle()?];
    let title = "Fig. 1: the whisker in two dimensions";
    Ok(lettered("fig1", title, caption, panels))
}

/// A drawing without axes.
fn drawing(title: &str) -> Plot {
    Plot {
        title: title.to_owned(),
        equal_axes: true,
        bare: true,
        ..Plot::default()
    }
}

/// A: the truncated cone, and the perfect one that it is a part of.
fn cone() -> Panel {
    let straight = Whisker {
        curvature: None,
        ..FIG5_LEFT
    };
    let sections = sections(&straight, 2);
    let tip = straight.length_mm;
    let length = tip / (1.0 - straight.tip_radius_um / straight.base_radius_um);
    let [at_base, at_tip] =
        [straight.base_radius_um, straight.tip_radius_um].map(|um| 1e-3 * MAGNIFIED * um);
    let virtual_tip = vec![[tip, at_tip], [length, 0.0], [tip, -at_tip]];
    let below =
        |y: f64, end: f64, words: &str| extent([0.0, -at_base - y], [end, -at_base - y], words);
    let mut plot = drawing(&format!(
        "a truncated cone; radii drawn {MAGNIFIED} times as large as lengths"
    ));
    plot.lines = vec![
        line(outline(&sections), Ink::Black, Stroke::Solid),
        line(virtual_tip, Ink::Grey, Stroke::Dashed),
    ];
    plot.notes = [
        below(1.2, tip, "L_w"),
        below(2.4, length, "L"),
        [
            arrow([0.6, 0.0], [0.6, at_base], "", Ink::Grey),
            arrow([0.6, at_base], [0.6, 0.0], "", Ink::Grey),
            text([1.7, 0.4], "r_base"),
        ],
        [
            arrow([tip, 1.4], [tip, at_tip], "tip: r_tip", Ink::Grey),
            arrow([length, 1.4], [length, 0.1], "virtual tip", Ink::Grey),
            text([-0.9, -0.6], "base"),
        ],
    ]
    .concat();
    Panel::new("A", plot, sections)
}

/// From the drawing of CF to that of CB.
const APART_MM: f64 = 24.0;

/// C: resting whiskers at first touch, and where they move.
fn sides() -> Result<Panel, NoState> {
    let mut plot = drawing("concave forward (CF, left), concave backward (CB, right)");
    let mut rows = Vec::new();
    for (side, name, words, start) in [
        (Side::Cf, "cf", "CF: \u{3b8}_p < 0", -APART_MM),
        (Side::Cb, "cb", "CB: \u{3b8}_p > 0", 0.0),
    ] {
        let branch = Branch::new(&CONE, &POLE, side, TOUCH_MM)?;
        let points = Shape::at_rest(&branch, PLACES);
        rows.extend(places(name, &points));
        let moved = |points: &[[f64; 2]]| {
            points
                .iter()
                .map(|[x, y]| [x + start, *y])
                .collect::<Vec<_>>()
        };
        let row = branch.row();
        let pole = (row.pole(0.0) * CONE.length_mm).to_array();
        let seen = DVec2::from(points[4 * PLACES / 5]);
        // The base turns against the push angle's sign.
        let way = [0.0, -side.sign() * 0.35].map(|turn| seen.to_angle() + turn);
        let way = moved(&arc(seen.length(), way));
        let tip = way.len() - 1;
        plot.notes
            .push(arrow(way[tip - 1], way[tip], "", Ink::Grey));
        plot.notes.push(text([start + 4.0, 4.0], words));
        plot.lines.push(line(way, Ink::Grey, Stroke::Solid));
        plot.lines
            .push(line(moved(&points), Ink::Black, Stroke::Solid));
        plot.discs.push(Disc {
            centre: moved(&[pole])[0],
            radius: POLE.radius_mm,
            dark: true,
        });
    }
    Ok(Panel::new("C", plot, rows))
}
