//! Panels B and D: the whisker pushed into the pole.

use super::{PLACES, TOUCH_MM, drawing, places};
use crate::paper::figures::Panel;
use crate::paper::figures::drawing::{arc, arrow, line, text};
use crate::paper::whiskers::{CONE, POLE};
use crate::render::{Disc, Dot, Ink, Inset, Line, Stroke};
use crate::rod::{Rest, Side};
use crate::trace::{Branch, NoState, Part, Shape, ShapePoint};
use glam::DVec2;

/// The push angle.
const PUSH_DEG: f64 = 30.0;

/// A whisker pushed CB, in the axes of first touch.
struct Pushed {
    shape: Shape,
    at_rest: Vec<[f64; 2]>,
    contact: ShapePoint,
    /// Of the contact from the base, as the crow flies.
    distance_mm: f64,
}

impl Pushed {
    fn new() -> Result<Self, NoState> {
        let branch = Branch::new(&CONE, &POLE, Side::Cb, TOUCH_MM)?;
        let state = branch.state(PUSH_DEG.to_radians(), true)?;
        let shape = Shape::new(&branch, &state, PLACES);
        let at = shape
            .points
            .iter()
            .find(|point| point.part == Part::Contact);
        Ok(Self {
            contact: at.copied().unwrap_or(shape.points[0]),
            at_rest: Shape::at_rest(&branch, PLACES),
            distance_mm: branch.read(&state).contact_distance_mm,
            shape,
        })
    }

    fn points(&self) -> Vec<[f64; 2]> {
        self.shape
            .points
            .iter()
            .map(|point| [point.x_mm, point.y_mm])
            .collect()
    }

    fn pole(&self, dark: bool) -> Disc {
        Disc {
            centre: self.shape.pole_mm,
            radius: self.shape.pole_radius_mm,
            dark,
        }
    }
}

/// From a point, so far in a direction.
fn from([x, y]: [f64; 2], length: f64, angle: f64) -> [f64; 2] {
    [
        length.mul_add(angle.cos(), x),
        length.mul_add(angle.sin(), y),
    ]
}

/// B: base, contact, angles and force, with the contact in the inset.
pub fn contact() -> Result<Panel, NoState> {
    let pushed = Pushed::new()?;
    let (base, at) = ([0.0, 0.0], [pushed.contact.x_mm, pushed.contact.y_mm]);
    let angle = pushed.contact.angle_deg.to_radians();
    let (pole, radius) = (pushed.shape.pole_mm, pushed.shape.pole_radius_mm);
    let some = pushed.shape.points[PLACES / 3];
    let middle = [some.x_mm, some.y_mm];
    let turned = -PUSH_DEG.to_radians();
    let grey = |points, stroke| line(points, Ink::Grey, stroke);

    let mut plot = drawing("the whisker in contact; inset: the contact");
    plot.discs = vec![pushed.pole(false)];
    plot.lines = vec![
        grey(vec![base, [7.0, 0.0]], Stroke::Dashed),
        grey(vec![base, from(base, 4.5, turned)], Stroke::Dashed),
        grey(arc(3.0, [0.0, turned]), Stroke::Solid),
        grey(vec![base, at], Stroke::Solid),
        line(pushed.points(), Ink::Black, Stroke::Solid),
    ];
    let dot = |at| Dot {
        at,
        ..Dot::default()
    };
    plot.dots = vec![dot(base), dot(middle)];
    let normal = angle + std::f64::consts::FRAC_PI_2;
    plot.notes = vec![
        text(base, "(x\u{2080}, y\u{2080})"),
        text([2.2, -3.2], "\u{3b8}\u{2080}"),
        text(from(base, 6.0, at[1].atan2(at[0])), "d"),
        arrow(
            [middle[0] + 0.8, middle[1] - 2.0],
            middle,
            "(x(s), y(s)), \u{3b8}(s)",
            Ink::Grey,
        ),
        arrow(at, from(at, 3.0, normal), "", Ink::Blue),
        text(from(at, 3.0, normal), "F"),
    ];
    let beside = |x: f64, y: f64| [x.mul_add(radius, pole[0]), y.mul_add(radius, pole[1])];
    plot.inset = Some(Inset {
        centre: pole,
        half: 5.0 * radius,
        place: [0.19, 0.72],
        lines: vec![
            grey(vec![at, from(at, 3.5 * radius, 0.0)], Stroke::Dashed),
            grey(arc_at(at, 2.5 * radius, [0.0, angle]), Stroke::Solid),
        ],
        notes: vec![
            text(from(at, 3.2 * radius, 0.3 * angle), "\u{3b8}_obj"),
            arrow(beside(-1.9, 2.6), at, "(x_obj, y_obj)", Ink::Grey),
            arrow(beside(1.2, -3.0), pole, "(x_cen, y_cen)", Ink::Grey),
            arrow(pole, beside(0.82, -0.57), "", Ink::Black),
            text(beside(2.6, -1.6), "r_pole"),
        ],
    });
    Ok(Panel::new("B", plot, pushed.shape.points))
}

/// Part of a circle around a point.
fn arc_at([x, y]: [f64; 2], radius: f64, ends: [f64; 2]) -> Vec<[f64; 2]> {
    let points = arc(radius, ends).into_iter();
    points.map(|[across, up]| [x + across, y + up]).collect()
}

/// D: the push angle, between the contacts of the real and of the virtual whisker.
pub fn push_angle() -> Result<Panel, NoState> {
    let pushed = Pushed::new()?;
    let rest = Rest::new(&CONE.rod(&POLE, Side::Cb));
    let turn = DVec2::from_angle(-PUSH_DEG.to_radians());
    let to_mm = |place: DVec2| (turn.rotate(place) * CONE.length_mm).to_array();
    let distance = pushed.distance_mm / CONE.length_mm;
    let virtual_at = to_mm(rest.point_at_distance(distance));
    let virtual_pole = to_mm(rest.pole_at_distance(distance));
    let virtual_whisker: Vec<[f64; 2]> = pushed
        .at_rest
        .iter()
        .map(|point| turn.rotate(DVec2::from(*point)).to_array())
        .collect();
    let at = [pushed.contact.x_mm, pushed.contact.y_mm];
    let [real, other] = [at, virtual_at].map(|at| DVec2::from(at).to_angle());

    let mut plot = drawing("the push angle \u{3b8}_p between lines of equal length d");
    plot.discs = vec![
        pushed.pole(true),
        Disc {
            centre: virtual_pole,
            ..pushed.pole(false)
        },
    ];
    let deflected = pushed.points();
    let rows = places("deflected", &deflected)
        .chain(places("undeflected", &pushed.at_rest))
        .chain(places("virtual", &virtual_whisker))
        .collect();
    plot.lines = vec![
        line(vec![at, [0.0, 0.0], virtual_at], Ink::Blue, Stroke::Solid),
        line(arc(6.0, [real, other]), Ink::Blue, Stroke::Solid),
        Line::new(pushed.at_rest, Ink::Grey, Stroke::Solid, "undeflected"),
        Line::new(
            virtual_whisker,
            Ink::Grey,
            Stroke::Dashed,
            "virtual, undeflected",
        ),
        Line::new(deflected, Ink::Black, Stroke::Solid, "deflected"),
    ];
    let beside = |[x, y]: [f64; 2], words: &str| {
        let (begin, end) = ([x + 1.8, y - 1.2], [x + 0.35, y - 0.35]);
        arrow(begin, end, words, Ink::Grey)
    };
    let between = from([0.0, 0.0], 7.0, 0.5 * (real + other));
    plot.notes = vec![
        text(between, "\u{3b8}_p"),
        beside(at, "(x_obj, y_obj)"),
        beside(virtual_at, "(x_virtual, y_virtual)"),
    ];
    Ok(Panel::new("D", plot, rows))
}
