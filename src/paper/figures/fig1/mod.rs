//! Fig. 1 of the paper: definitions, drawn from computed states.

mod pushed;

use super::drawing::{MAGNIFIED, arc, extent, outline, sections};
use super::{Figure, FigurePanel, lettered};
use crate::paper::whiskers::{CONE, FIG5_LEFT, POLE};
use crate::render::{Disc, Ink, Line, Note, Plot, Stroke};
use crate::scene::Whisker;
use crate::trace::{NoState, StableBranch};
use glam::DVec2;
use serde::Serialize;
use whiskmap_mechanics::rod::Side;

/// Distance of the pole of panels B to D at first touch.
const TOUCH_MM: f64 = 10.0;
/// Points along a whisker.
const POINTS: usize = 100;

/// A point of one of the whiskers in a panel, a row of its table.
#[derive(Clone, Copy, Serialize)]
struct WhiskerPoint {
    whisker: &'static str,
    x_mm: f64,
    y_mm: f64,
}

/// The rows of a whisker in the table of a panel.
fn whisker_points(
    whisker: &'static str,
    points: &[[f64; 2]],
) -> impl Iterator<Item = WhiskerPoint> {
    let point = move |&[x_mm, y_mm]: &[f64; 2]| WhiskerPoint { whisker, x_mm, y_mm };
    points.iter().map(point)
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
    Plot { title: title.to_owned(), equal_axes: true, bare: true, ..Plot::default() }
}

/// A: the truncated cone, and the perfect cone that it is a part of.
fn cone() -> FigurePanel {
    let straight = Whisker { curvature: None, ..FIG5_LEFT };
    let sections = sections(&straight, 2);
    let tip = straight.length_mm;
    let length = tip / (1.0 - straight.tip_radius_um / straight.base_radius_um);
    let [at_base, at_tip] =
        [straight.base_radius_um, straight.tip_radius_um].map(|um| 1e-3 * MAGNIFIED * um);
    let virtual_tip = vec![[tip, at_tip], [length, 0.0], [tip, -at_tip]];
    let below =
        |y: f64, end: f64, words: &str| extent([0.0, -at_base - y], [end, -at_base - y], words);
    let mut plot =
        drawing(&format!("a truncated cone; radii drawn {MAGNIFIED} times as large as lengths"));
    plot.lines = vec![
        Line::new(outline(&sections), Ink::Black, Stroke::Solid),
        Line::new(virtual_tip, Ink::Grey, Stroke::Dashed),
    ];
    plot.notes = [
        below(1.2, tip, "L_{w}"),
        below(2.4, length, "L"),
        [
            Note::arrow([0.6, 0.0], [0.6, at_base], "", Ink::Grey),
            Note::arrow([0.6, at_base], [0.6, 0.0], "", Ink::Grey),
            Note::text([1.7, 0.4], "r_{base}"),
        ],
        [
            Note::arrow([tip, 1.4], [tip, at_tip], "tip: r_{tip}", Ink::Grey),
            Note::arrow([length, 1.4], [length, 0.1], "virtual tip", Ink::Grey),
            Note::text([-0.9, -0.6], "base"),
        ],
    ]
    .concat();
    FigurePanel::new("A", plot, sections)
}

/// Distance between the drawings of CF and CB.
const APART_MM: f64 = 24.0;

/// C: resting whiskers at first touch, and how they move.
fn sides() -> Result<FigurePanel, NoState> {
    let mut plot = drawing("concave forward (CF, left), concave backward (CB, right)");
    let mut rows = Vec::new();
    for (side, name, words, start) in [
        (Side::Cf, "cf", "CF: \u{3b8}_{p} < 0", -APART_MM),
        (Side::Cb, "cb", "CB: \u{3b8}_{p} > 0", 0.0),
    ] {
        let branch = StableBranch::new(&CONE, &POLE, side, TOUCH_MM)?;
        let points = branch.at_rest(POINTS);
        rows.extend(whisker_points(name, &points));
        let moved = |points: &[[f64; 2]]| -> Vec<_> {
            points.iter().map(|[x, y]| [x + start, *y]).collect()
        };
        let row = branch.row();
        let pole = (row.pole(0.0) * CONE.length_mm).to_array();
        let seen = DVec2::from(points[4 * POINTS / 5]);
        // The base turns against the push angle's sign.
        let path = [0.0, -side.sign() * 0.35].map(|turn| seen.to_angle() + turn);
        let path = moved(&arc(seen.length(), path));
        let tip = path.len() - 1;
        plot.notes.push(Note::arrow(path[tip - 1], path[tip], "", Ink::Grey));
        plot.notes.push(Note::text([start + 4.0, 4.0], words));
        plot.lines.push(Line::new(path, Ink::Grey, Stroke::Solid));
        plot.lines.push(Line::new(moved(&points), Ink::Black, Stroke::Solid));
        plot.discs.push(Disc { centre: moved(&[pole])[0], radius: POLE.radius_mm, dark: true });
    }
    Ok(FigurePanel::new("C", plot, rows))
}
