//! Fig. 3 of the paper: bifurcation diagrams at one pole, and detachment curves, of a cone and a cylinder.

use super::drawing::{MAGNIFIED, outline, sections};
use super::fig2::{self, PUSH_DEG};
use super::{Figure, FigurePanel, PUSH, detachment, lettered};
use crate::paper::whiskers::{CONE, CYLINDER, POLE, pole_distance_mm};
use crate::render::{BranchAxis, DrawnBranch, Ink, Line, Note, Plot, Stroke, branches, regions};
use crate::scene::Whisker;
use crate::trace::{Branch, BranchPoint, NoState};
use serde::Serialize;
use serde::ser::{SerializeStruct, Serializer};
use whiskmap_mechanics::rod::Side;

/// Points per branch.
const POINTS: usize = 160;
/// Distance of the second pole of the cylinder.
const NEAR_MM: f64 = 10.0;

/// A row of a table: a state on a branch, and name and value of a column for the upright axis of the panel.
struct BranchRow(BranchPoint, &'static str, f64);

impl Serialize for BranchRow {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(point, column, value) = self;
        let mut columns = serializer.serialize_struct("BranchRow", 6)?;
        columns.serialize_field("distance_mm", &point.distance_mm)?;
        columns.serialize_field("side", &point.side)?;
        columns.serialize_field("stable", &point.stable)?;
        columns.serialize_field("push_angle_deg", &point.push_angle_deg)?;
        columns.serialize_field(column, value)?;
        columns.serialize_field("mark", &point.mark)?;
        columns.end()
    }
}

const PUSH_ANGLE: BranchAxis =
    BranchAxis { label: "push angle \u{3b8}_{p} (deg)", value: |point| point.push_angle_deg };
/// The contact angle in the axes of Eqs. 8-14, in which the pole stands still and the base turns against the push.
const CONTACT_ANGLE: BranchAxis = BranchAxis {
    label: "contact angle \u{3b8}_{obj} (deg)",
    value: |point| point.contact_angle_deg - point.push_angle_deg,
};
const FORCE: BranchAxis = BranchAxis { label: "force F (\u{b5}N)", value: |point| point.force_un };
const CONTACT: BranchAxis =
    BranchAxis { label: "contact position s_{obj} (mm)", value: |point| point.arc_length_mm };

pub fn fig3() -> Result<Figure, NoState> {
    let far = |whisker: &Whisker| states(whisker, |side| pole_distance_mm(whisker, side));
    let (cone, cylinder, near) = (far(&CONE)?, far(&CYLINDER)?, states(&CYLINDER, |_| NEAR_MM)?);
    let cone = column(
        ["A", "B", "C", "D", "E"],
        ("cone", &CONE),
        "pole of Fig. 2",
        &[(Ink::Black, &cone)],
        (["a", "b"], [2.0, -0.3]),
    )?;
    let cylinder = column(
        ["F", "G", "H", "I", "J"],
        ("cylinder", &CYLINDER),
        "d = 10 mm black, d = 15.7 mm (pole of Fig. 2) blue",
        &[(Ink::Black, &near), (Ink::Blue, &cylinder)],
        (["c", "d"], [8.0, -1.2]),
    )?;
    let panels = cone.into_iter().zip(cylinder).flat_map(|(left, right)| [left, right]);
    let caption = vec![
        format!("{PUSH} Unstable states are drawn as far as \u{3b8}_{{p}} = 0."),
        "\u{3b8}_{obj}: from the x-axis of Eqs. 8-14 to the whisker at the contact; it grows toward +y, as in dy/ds = sin \u{3b8}."
            .to_owned(),
        "Arrows: a, b the states of Fig. 2A (stable), 2B; c, d those of Fig. 2C, 2D. The stable states lie inside of E and J."
            .to_owned(),
    ];
    let title = "Fig. 3: a cone and a cylinder pushed into a pole";
    Ok(lettered("fig3", title, caption, panels.collect()))
}

/// The branches of both whisker sides at one pole, up to the push angle 0.
fn states(
    whisker: &Whisker,
    distance_mm: impl Fn(Side) -> f64,
) -> Result<Vec<BranchPoint>, NoState> {
    let mut all = Vec::new();
    for side in Side::BOTH {
        let branch = Branch::new(whisker, &POLE, side, distance_mm(side))?;
        let points = branch.points(POINTS)?.into_iter();
        all.extend(points.take_while(|point| side.sign() * point.push_angle_deg >= 0.0));
    }
    Ok(all)
}

/// The panels of one whisker, from top to bottom.
fn column(
    letters: [&'static str; 5],
    (name, whisker): (&'static str, &Whisker),
    title: &str,
    poles: &[(Ink, &[BranchPoint])],
    (marked, shift): ([&str; 2], [f64; 2]),
) -> Result<Vec<FigurePanel>, NoState> {
    let [schematic, angle, force, contact, ends] = letters;
    let points: Vec<BranchPoint> =
        poles.iter().flat_map(|(_, points)| points.iter().copied()).collect();
    let drawn = poles.iter().map(|(ink, points)| DrawnBranch { points, ink: *ink, name: "stable" });
    let drawn: Vec<_> = drawn.collect();
    let plot =
        |y| Plot { regions: Some(regions(false)), ..branches(title, &drawn, [PUSH_ANGLE, y]) };
    let mut contacts = plot(CONTACT);
    let (branch, end) = fig2::branch(whisker)?;
    let at_10 = branch.read(&branch.state(PUSH_DEG.to_radians(), true)?).arc_length_mm;
    let states = [[PUSH_DEG, at_10], [end.push_angle_deg, end.arc_length_mm]];
    contacts.notes.extend(states.iter().zip(marked).map(|(at, letter)| {
        let from = [at[0] + shift[0], at[1] + shift[1]];
        Note::arrow(from, *at, letter, Ink::Black)
    }));
    Ok(vec![
        drawing(schematic, name, whisker),
        FigurePanel::new(angle, plot(CONTACT_ANGLE), rows(&points, "theta_obj_deg", CONTACT_ANGLE)),
        FigurePanel::new(force, plot(FORCE), rows(&points, "force_un", FORCE)),
        FigurePanel::new(contact, contacts, rows(&points, "s_obj_mm", CONTACT)),
        detachment::panel(ends, name, &[(name, whisker, Stroke::Solid)]),
    ])
}

/// The table of a panel, with the values of its upright axis in a column of this name.
fn rows(points: &[BranchPoint], column: &'static str, axis: BranchAxis) -> Vec<BranchRow> {
    let row = |point: &BranchPoint| BranchRow(*point, column, (axis.value)(point));
    points.iter().map(row).collect()
}

fn drawing(letter: &'static str, name: &str, whisker: &Whisker) -> FigurePanel {
    let sections = sections(whisker, 101);
    let plot = Plot {
        title: format!("{name}, radii drawn {MAGNIFIED} times as large as lengths"),
        x_label: "x (mm)".to_owned(),
        y_label: "y (mm)".to_owned(),
        lines: vec![Line::new(outline(&sections), Ink::Black, Stroke::Solid)],
        equal_axes: true,
        ..Plot::default()
    };
    FigurePanel::new(letter, plot, sections)
}
