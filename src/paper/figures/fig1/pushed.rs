//! Panels B and D of the paper's Fig. 1: the whisker pushed into the pole.

use super::{POINTS, TOUCH_MM, drawing, whisker_points};
use crate::paper::figures::FigurePanel;
use crate::paper::figures::drawing::arc;
use crate::paper::whiskers::{CONE, POLE};
use crate::render::{Disc, Dot, Ink, Inset, Line, Note, Stroke};
use crate::trace::{NoState, ShapePoint, StableBranch, WhiskerPart, WhiskerShape};
use glam::DVec2;
use whiskmap_mechanics::rod::{Rest, Side};

/// Push angle of both panels, in degrees.
const PUSH_DEG: f64 = 30.0;

/// A whisker pushed CB, in the axes of first touch.
struct PushedWhisker {
    shape: WhiskerShape,
    at_rest: Vec<[f64; 2]>,
    contact: ShapePoint,
    /// Straight distance of the contact from the base.
    distance_mm: f64,
}

impl PushedWhisker {
    fn new() -> Result<Self, NoState> {
        let branch = StableBranch::new(&CONE, &POLE, Side::Cb, TOUCH_MM)?;
        let state = branch.state(PUSH_DEG.to_radians())?;
        let shape = branch.shape(&state, POINTS);
        let at = shape.points.iter().find(|point| point.part == WhiskerPart::Contact);
        Ok(Self {
            contact: at.copied().unwrap_or(shape.points[0]),
            at_rest: branch.at_rest(POINTS),
            distance_mm: branch.read(&state).contact_distance_mm,
            shape,
        })
    }

    fn points(&self) -> Vec<[f64; 2]> {
        let points = self.shape.points.iter();
        points.map(|point| [point.x_mm, point.y_mm]).collect()
    }

    fn pole(&self, dark: bool) -> Disc {
        Disc { centre: self.shape.pole_mm, radius: self.shape.pole_radius_mm, dark }
    }
}

/// The point at a distance from another, in the direction of an angle in radians.
fn from([x, y]: [f64; 2], length: f64, angle: f64) -> [f64; 2] {
    let (sine, cosine) = angle.sin_cos();
    [length.mul_add(cosine, x), length.mul_add(sine, y)]
}

/// Draws panel B of Fig. 1: base, contact, angles and force, with the contact in the inset.
pub fn contact() -> Result<FigurePanel, NoState> {
    let pushed = PushedWhisker::new()?;
    let (base, at) = ([0.0, 0.0], [pushed.contact.x_mm, pushed.contact.y_mm]);
    let angle = pushed.contact.angle_deg.to_radians();
    let (pole, radius) = (pushed.shape.pole_mm, pushed.shape.pole_radius_mm);
    let some = pushed.shape.points[POINTS / 3];
    let middle = [some.x_mm, some.y_mm];
    let beside_middle = [middle[0] + 0.8, middle[1] - 2.0];
    let turned = -PUSH_DEG.to_radians();
    let grey = |points, stroke| Line::new(points, Ink::Grey, stroke);

    let mut plot = drawing("the whisker in contact; inset: the contact");
    plot.discs = vec![pushed.pole(false)];
    plot.lines = vec![
        grey(vec![base, [7.0, 0.0]], Stroke::Dashed),
        grey(vec![base, from(base, 4.5, turned)], Stroke::Dashed),
        grey(arc(3.0, [0.0, turned]), Stroke::Solid),
        grey(vec![base, at], Stroke::Solid),
        Line::new(pushed.points(), Ink::Black, Stroke::Solid),
    ];
    let dot = |at| Dot { at, ..Dot::default() };
    plot.dots = vec![dot(base), dot(middle)];
    let normal = angle + std::f64::consts::FRAC_PI_2;
    plot.notes = vec![
        Note::text(base, "(x_{0}, y_{0})"),
        Note::text([2.2, -3.2], "\u{3b8}_{0}"),
        Note::text(from(base, 6.0, at[1].atan2(at[0])), "d"),
        Note::arrow(beside_middle, middle, "(x(s), y(s)), \u{3b8}(s)", Ink::Grey),
        Note::arrow(at, from(at, 3.0, normal), "", Ink::Blue),
        Note::text(from(at, 3.0, normal), "F"),
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
            Note::text(from(at, 3.2 * radius, 0.3 * angle), "\u{3b8}_{obj}"),
            Note::arrow(beside(-1.9, 2.6), at, "(x_{obj}, y_{obj})", Ink::Grey),
            Note::arrow(beside(1.0, -2.3), pole, "(x_{cen}, y_{cen})", Ink::Grey),
            Note::arrow(pole, beside(0.82, -0.57), "", Ink::Black),
            Note::text(beside(2.6, -1.6), "r_{pole}"),
        ],
    });
    Ok(FigurePanel::new("B", plot, pushed.shape.points))
}

/// An arc around a point, between two angles in radians.
fn arc_at([x, y]: [f64; 2], radius: f64, ends: [f64; 2]) -> Vec<[f64; 2]> {
    let points = arc(radius, ends).into_iter();
    points.map(|[across, up]| [x + across, y + up]).collect()
}

/// Draws panel D of Fig. 1: the push angle, between the contacts of the real and the virtual whisker.
pub fn push_angle() -> Result<FigurePanel, NoState> {
    let pushed = PushedWhisker::new()?;
    let rest = Rest::new(&CONE.rod(&POLE, Side::Cb));
    let turn = DVec2::from_angle(-PUSH_DEG.to_radians());
    let to_mm = |place: DVec2| (turn.rotate(place) * CONE.length_mm).to_array();
    let distance = pushed.distance_mm / CONE.length_mm;
    let virtual_at = to_mm(rest.point_at_distance(distance));
    let virtual_pole = to_mm(rest.pole_at_distance(distance));
    let virtual_whisker: Vec<[f64; 2]> =
        pushed.at_rest.iter().map(|point| turn.rotate(DVec2::from(*point)).to_array()).collect();
    let at = [pushed.contact.x_mm, pushed.contact.y_mm];
    let [real, other] = [at, virtual_at].map(|at| DVec2::from(at).to_angle());

    let mut plot = drawing("the push angle \u{3b8}_{p} between lines of equal length d");
    plot.discs = vec![pushed.pole(true), Disc { centre: virtual_pole, ..pushed.pole(false) }];
    let deflected = pushed.points();
    let rows = whisker_points("deflected", &deflected)
        .chain(whisker_points("undeflected", &pushed.at_rest))
        .chain(whisker_points("virtual", &virtual_whisker))
        .collect();
    plot.lines = vec![
        Line::new(vec![at, [0.0, 0.0], virtual_at], Ink::Blue, Stroke::Solid),
        Line::new(arc(6.0, [real, other]), Ink::Blue, Stroke::Solid),
        Line::new(pushed.at_rest, Ink::Grey, Stroke::Solid).named("undeflected"),
        Line::new(virtual_whisker, Ink::Grey, Stroke::Dashed).named("virtual, undeflected"),
        Line::new(deflected, Ink::Black, Stroke::Solid).named("deflected"),
    ];
    let beside = |[x, y]: [f64; 2], words: &str| {
        let (begin, end) = ([x + 1.8, y - 1.2], [x + 0.35, y - 0.35]);
        Note::arrow(begin, end, words, Ink::Grey)
    };
    let between = from([0.0, 0.0], 7.0, 0.5 * (real + other));
    plot.notes = vec![
        Note::text(between, "\u{3b8}_{p}"),
        beside(at, "(x_{obj}, y_{obj})"),
        beside(virtual_at, "(x_{virtual}, y_{virtual})"),
    ];
    Ok(FigurePanel::new("D", plot, rows))
}
