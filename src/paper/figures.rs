//! The theory lines of the paper's figures.

use super::whiskers::{
    CONE, CYLINDER, FIG4_HAIR, FIG4_WHISKER, FIG5_LEFT, FIG5_RIGHT, POLE, fig2_distance_mm,
};
use crate::render::{
    BranchAxis, Chart, CurveAxis, Drawn, Ink, Plot, Stroke, branches, curves, shapes,
};
use crate::rod::Side;
use crate::scene::Whisker;
use crate::store::Table;
use crate::trace::{Branch, Detachment, NoState, Shape, curve};
use serde::Serialize;
use std::io;

/// A figure: a chart, and the tables behind its panels.
pub struct Figure {
    /// Stem of the chart's file.
    pub name: &'static str,
    /// The chart.
    pub chart: Chart,
    /// Stem of the file and rows of each table.
    pub tables: Vec<(&'static str, Rows)>,
}

/// Writes rows of any kind into a table.
pub type Rows = Box<dyn Fn(&mut Table) -> io::Result<()>>;

fn rows<R: Serialize + 'static>(rows: Vec<R>) -> Rows {
    Box::new(move |table| table.rows(&rows))
}

/// Which state a shape belongs to.
#[derive(Clone, Serialize)]
struct Solution {
    /// The name of the state in the figure's legend.
    solution: String,
}

/// Every figure of the paper that has theory lines.
///
/// # Errors
/// When a branch cannot be followed.
pub fn figures() -> Result<Vec<Figure>, NoState> {
    Ok(vec![
        fig2()?,
        fig3(),
        detachments(
            "fig4d",
            "Fig. 4D: a whisker and a hair",
            [
                ("fig4d_whisker", "mouse whisker", FIG4_WHISKER),
                ("fig4d_hair", "human hair", FIG4_HAIR),
            ],
        ),
        detachments(
            "fig5c",
            "Fig. 5C: a blunt and a slender whisker",
            [
                ("fig5c_left", "blunt tip", FIG5_LEFT),
                ("fig5c_right", "slender tip", FIG5_RIGHT),
            ],
        ),
    ])
}

const BODY_POINTS: usize = 200;

/// The push at which Fig. 2A shows a stable and an unstable shape.
const FIG2_PUSH_DEG: f64 = 10.0;

fn fig2() -> Result<Figure, NoState> {
    let mut plots = Vec::new();
    let mut tables = Vec::new();
    for (letters, names, title, whisker) in [
        (["A", "B"], ["fig2a", "fig2b"], "truncated cone", CONE),
        (["C", "D"], ["fig2c", "fig2d"], "cylinder", CYLINDER),
    ] {
        let branch = Branch::new(&whisker, &POLE, Side::Cb, fig2_distance_mm(&whisker))?;
        let points = branch.points(BODY_POINTS)?;
        let other = match points.last() {
            Some(end) if end.stable => (end.push_angle_deg, "pull-off", Ink::Blue, Stroke::Solid),
            _ => (FIG2_PUSH_DEG, "unstable", Ink::Black, Stroke::Dashed),
        };
        let mut drawn = Vec::new();
        for (push_deg, kind, ink, stroke) in
            [(FIG2_PUSH_DEG, "stable", Ink::Black, Stroke::Solid), other]
        {
            let state = branch.state(push_deg.to_radians(), stroke == Stroke::Solid)?;
            drawn.push(Drawn {
                shape: Shape::new(&branch, &state, BODY_POINTS),
                ink,
                stroke,
                name: format!("{kind}, {push_deg:.2} deg"),
            });
        }
        let at_rest = Shape::at_rest(&branch, BODY_POINTS);
        plots.push(lettered(letters[0], shapes(title, at_rest, &drawn)));
        plots.push(lettered(
            letters[1],
            branches(title, &points, [PUSH, CONTACT]),
        ));
        let places = drawn.into_iter().flat_map(|Drawn { shape, name, .. }| {
            let solution = Solution { solution: name };
            let points = shape.points.into_iter();
            points.map(move |point| (solution.clone(), point))
        });
        tables.push((names[0], rows(places.collect())));
        tables.push((names[1], rows(points)));
    }
    let title = "Fig. 2: shapes and solution branches in front of one pole";
    Ok(figure("fig2", title.to_owned(), plots, tables))
}

const PUSH: BranchAxis = BranchAxis {
    label: "push angle \u{3b8}p (deg)",
    value: |point| point.push_angle_deg,
};
const CONTACT: BranchAxis = BranchAxis {
    label: "arc length of contact (mm)",
    value: |point| point.arc_length_mm,
};

const DISTANCE: CurveAxis = CurveAxis {
    label: "object distance d (mm)",
    value: |end| end.contact_distance_mm,
};
const CHORD: CurveAxis = CurveAxis {
    label: "push angle \u{3b8}p (deg)",
    value: |end| end.push_chord_deg,
};

/// What Fig. 3 shows of each whisker, from top to bottom.
const FIG3: [CurveAxis; 4] = [
    CHORD,
    CurveAxis {
        label: "contact angle (deg)",
        value: |end| end.contact_angle_deg,
    },
    CurveAxis {
        label: "force (\u{b5}N)",
        value: |end| Some(end.side.sign() * end.force_un?),
    },
    CurveAxis {
        label: "base moment (nN m)",
        value: |end| end.base_moment_nnm,
    },
];

fn fig3() -> Figure {
    let columns = [
        (["B", "C", "D", "E"], "truncated cone", both_sides(&CONE)),
        (["G", "H", "I", "J"], "cylinder", both_sides(&CYLINDER)),
    ];
    let plots = (0..FIG3.len())
        .flat_map(|i| columns.iter().map(move |column| (i, column)))
        .map(|(i, (letters, title, ends))| {
            lettered(letters[i], curves(title, ends, [DISTANCE, FIG3[i]]))
        })
        .collect();
    let [(_, _, cone), (_, _, cylinder)] = columns;
    let title = "Fig. 3: detachment of a truncated cone and a cylinder (CF < 0 < CB)";
    let tables = vec![("fig3_cone", rows(cone)), ("fig3_cylinder", rows(cylinder))];
    figure("fig3", title.to_owned(), plots, tables)
}

fn detachments(
    name: &'static str,
    title: &str,
    whiskers: [(&'static str, &str, Whisker); 2],
) -> Figure {
    let mut plots = Vec::new();
    let mut tables = Vec::new();
    for (table, title, whisker) in whiskers {
        let ends = both_sides(&whisker);
        plots.push(curves(title, &ends, [DISTANCE, CHORD]));
        tables.push((table, rows(ends)));
    }
    figure(name, format!("{title} (CF < 0 < CB)"), plots, tables)
}

/// The plots in two columns.
fn figure(
    name: &'static str,
    title: String,
    plots: Vec<Plot>,
    tables: Vec<(&'static str, Rows)>,
) -> Figure {
    let chart = Chart {
        title,
        plots,
        columns: 2,
    };
    Figure {
        name,
        chart,
        tables,
    }
}

/// Distances per curve.
const DISTANCES: usize = 256;

/// Detachment curves of both sides, from a quarter of the whisker to its tip.
fn both_sides(whisker: &Whisker) -> Vec<Detachment> {
    let distances: Vec<f64> = (0..DISTANCES)
        .map(|i| whisker.length_mm * (0.25 + 0.75 * i as f64 / (DISTANCES - 1) as f64))
        .collect();
    Side::BOTH
        .into_iter()
        .flat_map(|side| curve(whisker, &POLE, side, &distances))
        .collect()
}

fn lettered(letter: &str, plot: Plot) -> Plot {
    Plot {
        letter: Some(letter.to_owned()),
        ..plot
    }
}
