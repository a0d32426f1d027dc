//! Fig. 2 of the paper: shapes of a cone and a cylinder in front of one pole, CB.

use super::{Figure, FigurePanel, lettered};
use crate::paper::whiskers::{CONE, CYLINDER, POLE, pole_distance_mm};
use crate::render::{DrawnShape, Ink, Inset, Plot, Stroke, shapes};
use crate::scene::Whisker;
use crate::trace::{Branch, BranchMark, BranchPoint, NoState};
use serde::Serialize;
use whiskmap_mechanics::rod::Side;

/// Points along a whisker.
const POINTS: usize = 200;
/// Push angle of panels A and C of Fig. 2, in degrees.
pub const PUSH_DEG: f64 = 10.0;

/// The state of a shape, in the first columns of a panel's table.
#[derive(Clone, Copy, Serialize)]
struct ShapeState {
    /// Stable, unstable, saddle-node or pull-off.
    solution: &'static str,
    push_angle_deg: f64,
}

/// Computes the branch of a whisker at the pole of Fig. 2, and its last stable state.
pub fn branch(whisker: &Whisker) -> Result<(Branch, BranchPoint), NoState> {
    let distance = pole_distance_mm(whisker, Side::Cb);
    let branch = Branch::new(whisker, &POLE, Side::Cb, distance)?;
    let points = branch.points(3)?;
    let is_end = |point: &&BranchPoint| {
        matches!(point.mark, Some(BranchMark::SlipOff | BranchMark::PullOff))
    };
    let end = points.iter().find(is_end).copied();
    Ok((branch, end.unwrap_or(points[0])))
}

pub fn fig2() -> Result<Figure, NoState> {
    let (cone, slip_off) = branch(&CONE)?;
    let (cylinder, pull_off) = branch(&CYLINDER)?;
    let at_slip_off = ("saddle-node", slip_off.push_angle_deg, Stroke::Solid);
    let at_pull_off = ("pull-off", pull_off.push_angle_deg, Stroke::Solid);
    let stable = ("stable", PUSH_DEG, Stroke::Solid);
    let unstable = ("unstable", PUSH_DEG, Stroke::Dashed);
    #[rustfmt::skip]
    let panels = vec![
        panel("A", "cone: the two solutions", &cone, &[stable, unstable])?,
        panel("B", "cone: the only solution at the saddle-node", &cone, &[at_slip_off])?,
        panel("C", "cylinder: the unstable solution would be longer than the whisker", &cylinder, &[stable])?,
        panel("D", "cylinder: the tip has reached the pole", &cylinder, &[at_pull_off])?,
    ];
    let chord = |end: &BranchPoint| format!("{:.2}", end.push_chord_deg);
    let caption = vec![
        "Push angle \u{3b8}_{p}: rotation of the base since first touch, which gives the paper's 15.6 and 62.7 deg;".to_owned(),
        format!("the chord angle of Fig. 1D gives {} and {}. Insets show the contact.", chord(&slip_off), chord(&pull_off)),
    ];
    let title = "Fig. 2: a cone and a cylinder in front of one pole, CB";
    Ok(lettered("fig2", title, caption, panels))
}

fn panel(
    letter: &'static str,
    title: &str,
    branch: &Branch,
    states: &[(&'static str, f64, Stroke)],
) -> Result<FigurePanel, NoState> {
    let mut drawn = Vec::new();
    let mut rows = Vec::new();
    for &(solution, push_angle_deg, stroke) in states {
        let found = branch.state(push_angle_deg.to_radians(), stroke == Stroke::Solid)?;
        let shape = branch.shape(&found, POINTS);
        let state = ShapeState { solution, push_angle_deg };
        rows.extend(shape.points.iter().map(|point| (state, *point)));
        drawn.push(DrawnShape {
            shape,
            ink: Ink::Black,
            stroke,
            name: format!("{solution}, \u{3b8}_{{p}} = {push_angle_deg:.2} deg"),
        });
    }
    let inset = Inset {
        centre: drawn[0].shape.pole_mm,
        half: 3.0 * POLE.radius_mm,
        place: [0.2, 0.72],
        ..Inset::default()
    };
    let plot = Plot { inset: Some(inset), ..shapes(title, &drawn) };
    Ok(FigurePanel::new(letter, plot, rows))
}
