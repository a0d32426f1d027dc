//! Fig. 7B of the paper: forces from the change of curvature in a trial with several touches and a slip-off.

use super::motion::Motion;
use super::{Figure, FigureError, FigurePanel, figure};
use crate::force::{CurvatureFrame, ForceMethod, FrameContact, FrameForce, forces};
use crate::paper::whiskers::{FIG4_WHISKER, POLE};
use crate::random::RandomStream;
use crate::render::{Ink, Line, Plot, Stroke};
use crate::scene::Pole;
use crate::trace::WhiskerPart;
use crate::whisk::{AngleCourse, WhiskSample};
use glam::DVec2;
use serde::Serialize;
use std::f64::consts::TAU;
use whiskmap_mechanics::rod::{Rest, Side};

/// Distance of the pole at first touch, in mm.
const DISTANCE_MM: f64 = 12.0;
/// Number of frames, 1000 per second as in the paper.
const FRAMES: u32 = 461;
/// Points of each shape, evenly spaced: the curvature is measured at the second one.
const POINTS: usize = 11;
/// Standard deviation of the error of the curvature, in 1/mm.
const NOISE_PER_MM: f64 = 2e-4;
const SEED: u64 = 7;

/// Frame of the trial, a row of the table.
#[derive(Clone, Copy, Serialize)]
struct TrialFrame {
    time_s: f64,
    angle_deg: Option<f64>,
    curvature_per_mm: f64,
    force_un: Option<f64>,
    lever_force_un: Option<f64>,
    model_force_un: Option<f64>,
}

/// Angle of the base in degrees: whisking at 10 Hz with a growing amplitude.
fn angle_deg(time_s: f64) -> f64 {
    -5.0 - (10.0 + 32.0 * time_s) * libm::cos(TAU * 10.0 * time_s)
}

/// Returns the frame of a sample, with the error of its curvature.
fn frame(motion: &Motion, i: usize, sample: &WhiskSample) -> Result<CurvatureFrame, FigureError> {
    let at_arc_length_mm = FIG4_WHISKER.length_mm / (POINTS - 1) as f64;
    let noise = NOISE_PER_MM * RandomStream::new(SEED, i as u64).normal();
    let rest = Rest::new(&FIG4_WHISKER.rod(&Pole::smooth(0.0), Side::Cb));
    let s = at_arc_length_mm / FIG4_WHISKER.length_mm;
    let mut frame = CurvatureFrame {
        line: i,
        time_s: sample.time_s,
        curvature_per_mm: rest.curvature(s) / FIG4_WHISKER.length_mm + noise,
        at_arc_length_mm,
        at_mm: None,
        contact: None,
    };
    let shape = motion.shapes.bent(sample, POINTS)?;
    let Some((shape, push)) = shape.zip(sample.push_angle_deg) else {
        return Ok(frame);
    };
    // Rotation from the axes of first touch to the axes of the base.
    let turn = DVec2::from_angle(push.to_radians());
    let at = &shape.points[1];
    frame.curvature_per_mm = at.curvature_per_mm + noise;
    frame.at_mm = Some(turn.rotate(DVec2::new(at.x_mm, at.y_mm)).to_array());
    let mut points = shape.points.iter();
    frame.contact =
        points.find(|point| point.part == WhiskerPart::Contact).map(|point| FrameContact {
            is_known: true,
            contact_mm: turn.rotate(DVec2::new(point.x_mm, point.y_mm)).to_array(),
            contact_angle_deg: Some(point.angle_deg + push),
        });
    Ok(frame)
}

/// Draws the paper's Fig. 7B: contact forces of a made-up trial.
pub fn fig7b() -> Result<Figure, FigureError> {
    let times: Vec<f64> = (0..FRAMES).map(|i| 1e-3 * f64::from(i)).collect();
    let angles = times.iter().map(|time| angle_deg(*time)).collect();
    let motion = Motion::new(&FIG4_WHISKER, DISTANCE_MM, &AngleCourse::new(times, angles)?)?;
    let samples = &motion.whisk.samples;
    let frames: Vec<CurvatureFrame> = samples
        .iter()
        .enumerate()
        .map(|(i, sample)| frame(&motion, i, sample))
        .collect::<Result<_, _>>()?;
    let [lever, model] = [ForceMethod::Lever, ForceMethod::Model]
        .map(|method| forces(&FIG4_WHISKER, &POLE, &frames, method));
    let moments = samples.iter().zip(&frames).zip(lever.iter().zip(&model));
    let rows: Vec<TrialFrame> = moments
        .map(|((sample, frame), (lever, model))| TrialFrame {
            time_s: sample.time_s,
            angle_deg: sample.angle_deg,
            curvature_per_mm: frame.curvature_per_mm,
            force_un: sample.force_un,
            lever_force_un: lever.force_un,
            model_force_un: model.force_un,
        })
        .collect();
    let line = |value: &dyn Fn(&TrialFrame) -> Option<f64>, ink| {
        let points = rows.iter().map(|row| [row.time_s, value(row).unwrap_or(f64::NAN)]);
        Line::new(points.collect(), ink, Stroke::Solid)
    };
    let angle = Plot {
        x_label: "time (s)".to_owned(),
        y_label: "angle of the base (deg)".to_owned(),
        lines: vec![line(&|row| row.angle_deg, Ink::Black)],
        ..Plot::default()
    };
    let force = Plot {
        x_label: "time (s)".to_owned(),
        y_label: "contact force (\u{b5}N)".to_owned(),
        lines: vec![
            line(&|row| row.force_un, Ink::Black).named("true force"),
            line(&|row| row.lever_force_un, Ink::Series(1)).named("moment over lever"),
            line(&|row| row.model_force_un, Ink::Blue).named("full model"),
        ],
        ..Plot::default()
    };
    let without = |all: &[FrameForce]| all.iter().filter(|force| force.force_un.is_none()).count();
    let caption = vec![
        "A made-up trial: the paper's film is not published.".to_owned(),
        format!(
            "The whisker of Fig. 4 touches a pole at {DISTANCE_MM} mm five times, and slips off the last time."
        ),
        format!(
            "The curvature near the base (1.525 mm) has seeded normal errors of {NOISE_PER_MM} per mm; contacts are exact."
        ),
        format!(
            "{} frames have no force of the full model: no stable state has their curvature.",
            without(&model)
        ),
    ];
    let title = "Fig. 7B: contact forces from the change of curvature";
    let panels = vec![
        ("fig7b_angle".to_owned(), FigurePanel::new("", angle, rows.clone())),
        ("fig7b".to_owned(), FigurePanel::new("B", force, rows)),
    ];
    let mut drawn = figure("fig7b", title, caption, panels);
    drawn.chart.columns = 1;
    // Both panels have the same table.
    drawn.tables.retain(|(name, _)| name == "fig7b");
    Ok(drawn)
}
