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
use crate::trace::{Branch, BranchPoint, Detachment, NoState, Shape, ShapePoint, curve};
use serde::Serialize;
use std::io;

/// A figure: a chart, and the tables behind its panels.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Stem of the chart's file.
    pub name: &'static str,
    /// The chart.
    pub chart: Chart,
    /// Stem of the file and rows of each table.
    pub tables: Vec<(&'static str, Rows)>,
}

/// The rows of a table.
#[derive(Clone, Debug)]
pub enum Rows {
    /// A detachment curve.
    Curve(Vec<Detachment>),
    /// A solution branch.
    Branch(Vec<BranchPoint>),
    /// Shapes by name.
    Shapes(Vec<(Solution, ShapePoint)>),
}

/// Which state a shape belongs to.
#[derive(Clone, Debug, Serialize)]
pub struct Solution {
    /// The name of the state in the figure's legend.
    pub solution: String,
}

impl Rows {
    /// Writes the rows into `table`.
    ///
    /// # Errors
    /// When the table takes no more.
    pub fn write(&self, table: &mut Table) -> io::Result<()> {
        match self {
            Self::Curve(rows) => table.rows(rows),
            Self::Branch(rows) => table.rows(rows),
            Self::Shapes(rows) => table.rows(rows),
        }
    }
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
        let mut states = vec![(FIG2_PUSH_DEG, true, Ink::Black, Stroke::Solid)];
        match points.iter().find(|point| !point.stable) {
            Some(_) => states.push((FIG2_PUSH_DEG, false, Ink::Black, Stroke::Dashed)),
            None => {
                let end = points.last().map_or(0.0, |point| point.push_angle_deg);
                states.push((end, true, Ink::Blue, Stroke::Solid));
            }
        }
        let mut found = Vec::new();
        for (push_deg, stable, ink, stroke) in states {
            let state = branch.state(push_deg.to_radians(), stable)?;
            let kind = match (stable, ink) {
                (true, Ink::Blue) => "pull-off",
                (true, _) => "stable",
                (false, _) => "unstable",
            };
            let name = format!("{kind}, {push_deg:.2} deg");
            found.push((Shape::new(&branch, &state, BODY_POINTS), ink, stroke, name));
        }
        let drawn: Vec<Drawn> = found
            .iter()
            .map(|(shape, ink, stroke, name)| Drawn {
                shape,
                ink: *ink,
                stroke: *stroke,
                name: name.clone(),
            })
            .collect();
        let at_rest = Shape::at_rest(&branch, BODY_POINTS);
        plots.push(lettered(letters[0], shapes(title, at_rest, &drawn)));
        plots.push(lettered(
            letters[1],
            branches(title, &points, [PUSH, CONTACT]),
        ));
        let rows = found.iter().flat_map(|(shape, .., name)| {
            let solution = Solution {
                solution: name.clone(),
            };
            shape.points.iter().map(move |p| (solution.clone(), *p))
        });
        tables.push((names[0], Rows::Shapes(rows.collect())));
        tables.push((names[1], Rows::Branch(points)));
    }
    Ok(Figure {
        name: "fig2",
        chart: Chart {
            title: "Fig. 2: shapes and solution branches in front of one pole".to_owned(),
            plots,
            columns: 2,
        },
        tables,
    })
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
        .map(|(i, (letters, title, rows))| {
            lettered(letters[i], curves(title, rows, [DISTANCE, FIG3[i]]))
        })
        .collect();
    let [(_, _, cone), (_, _, cylinder)] = columns;
    Figure {
        name: "fig3",
        chart: Chart {
            title: "Fig. 3: detachment of a truncated cone and a cylinder (CF < 0 < CB)".to_owned(),
            plots,
            columns: 2,
        },
        tables: vec![
            ("fig3_cone", Rows::Curve(cone)),
            ("fig3_cylinder", Rows::Curve(cylinder)),
        ],
    }
}

fn detachments(
    name: &'static str,
    title: &str,
    whiskers: [(&'static str, &str, Whisker); 2],
) -> Figure {
    let mut plots = Vec::new();
    let mut tables = Vec::new();
    for (table, title, whisker) in whiskers {
        let rows = both_sides(&whisker);
        plots.push(curves(title, &rows, [DISTANCE, CHORD]));
        tables.push((table, Rows::Curve(rows)));
    }
    Figure {
        name,
        chart: Chart {
            title: format!("{title} (CF < 0 < CB)"),
            plots,
            columns: 2,
        },
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
