//! Courses of whiskers against one pole, as sequences of shapes: Figs. 4B, 4C and 5B.

use super::{Figure, FigureError, FigurePanel, figure};
use crate::paper::whiskers::{FIG4_HAIR, FIG4_WHISKER, FIG5_RIGHT, POLE};
use crate::render::{Disc, Ink, Line, Plot, STUCK, Stroke};
use crate::scene::Whisker;
use crate::whisk::{AngleCourse, CourseShapes, Whisk, WhiskRegime, whisk};
use serde::Serialize;
use std::f64::consts::TAU;

/// Points along a whisker.
const POINTS: usize = 60;

/// Course of a whisker against the paper's pole, with its shapes.
pub struct Motion {
    pub whisk: Whisk,
    pub shapes: CourseShapes,
}

/// Point of a shape in a frame, a row of a table.
#[derive(Clone, Copy, Serialize)]
struct FramePoint {
    time_s: f64,
    angle_deg: Option<f64>,
    regime: WhiskRegime,
    x_mm: f64,
    y_mm: f64,
}

/// Returns the course `middle - amplitude cos(2 pi frequency t)` in degrees over half a period, in frames at `rate` per second.
pub fn protraction(
    [middle, amplitude]: [f64; 2],
    frequency: f64,
    rate: f64,
) -> Result<AngleCourse, FigureError> {
    let frames = (0.5 / frequency * rate).floor() as u32;
    let times: Vec<f64> = (0..=frames).map(|i| f64::from(i) / rate).collect();
    let angle = |time: &f64| middle - amplitude * libm::cos(TAU * frequency * time);
    let angles = times.iter().map(angle).collect();
    Ok(AngleCourse::new(times, angles)?)
}

impl Motion {
    pub fn new(
        whisker: &Whisker,
        distance_mm: f64,
        course: &AngleCourse,
    ) -> Result<Self, FigureError> {
        let whisk = whisk(whisker, &POLE, distance_mm, course)?;
        let shapes = CourseShapes::new(whisker, &POLE, distance_mm, &whisk)?;
        Ok(Self { whisk, shapes })
    }

    /// Draws every `every`th frame in grey, the last one before the detachment in red, and the one after it in black.
    fn panel(
        &self,
        letter: &'static str,
        title: &str,
        every: usize,
    ) -> Result<FigurePanel, FigureError> {
        let samples = &self.whisk.samples;
        let mut events = self.whisk.events.iter();
        let end = events.find(|event| event.event.is_detachment());
        let after =
            samples.partition_point(|sample| end.is_none_or(|end| sample.time_s < end.time_s));
        let (mut lines, mut rows) = (Vec::new(), Vec::new());
        for (i, sample) in samples.iter().enumerate() {
            let look = match i {
                _ if i + 1 == after => Some((STUCK, "last frame before detachment")),
                _ if i == after => Some((Ink::Black, "next frame")),
                _ if i % every == 0 => Some((Ink::Grey, "other frames")),
                _ => None,
            };
            let Some((ink, name)) = look else { continue };
            let points = self.shapes.points(sample, POINTS, true)?;
            rows.extend(points.iter().map(|[x_mm, y_mm]| FramePoint {
                time_s: sample.time_s,
                angle_deg: sample.angle_deg,
                regime: sample.regime,
                x_mm: *x_mm,
                y_mm: *y_mm,
            }));
            lines.push(Line::new(points, ink, Stroke::Solid).named(name));
        }
        // Grey lines first, so that the others lie over them.
        lines.sort_by_key(|line| line.ink != Ink::Grey);
        let plot = Plot {
            title: title.to_owned(),
            x_label: "x (mm)".to_owned(),
            y_label: "y (mm)".to_owned(),
            lines,
            discs: vec![Disc { centre: self.shapes.pole_mm, radius: POLE.radius_mm, dark: true }],
            equal_axes: true,
            ..Plot::default()
        };
        Ok(FigurePanel::new(letter, plot, rows))
    }
}

/// Draws the paper's Figs. 4B and 4C: an isolated whisker and a hair, rotated into a pole and past it.
pub fn fig4b() -> Result<Figure, FigureError> {
    const WHISKER_MM: f64 = 13.0;
    const HAIR_MM: f64 = 14.2;
    let course = protraction([12.0, 15.0], 0.2, 32.0)?;
    let cone = Motion::new(&FIG4_WHISKER, WHISKER_MM, &course)?;
    let hair = Motion::new(&FIG4_HAIR, HAIR_MM, &course)?;
    let panels = vec![
        ("fig4b".to_owned(), cone.panel("B", "mouse whisker: slips off", 4)?),
        ("fig4c".to_owned(), hair.panel("C", "human hair: is pulled off", 4)?),
    ];
    let caption = vec![
        "The base turns by 30 deg at 0.2 Hz as in the paper; every fourth frame of 32 per second. The pole stands still.".to_owned(),
        format!("The paper gives no distance of the pole: here it is touched at {WHISKER_MM} mm (B) and {HAIR_MM} mm (C)."),
        "Quasi-static model: a whisker that has detached is at rest in the next frame.".to_owned(),
    ];
    let title = "Figs. 4B, 4C: a whisker and a hair, rotated into a pole";
    Ok(figure("fig4b", title, caption, panels))
}

/// Draws the paper's Fig. 5B: a whisker of a behaving mouse that slips off a pole.
pub fn fig5b() -> Result<Figure, FigureError> {
    const DISTANCE_MM: f64 = 12.0;
    let course = protraction([12.0, 18.0], 8.0, 250.0)?;
    let motion = Motion::new(&FIG5_RIGHT, DISTANCE_MM, &course)?;
    let panels =
        vec![("fig5b".to_owned(), motion.panel("B", "protraction, 250 frames per second", 1)?)];
    let caption = vec![
        "A made-up protraction: the paper gives neither the course nor the distance of its example. The whisker is that of Fig. 5C, right;"
            .to_owned(),
        format!("the base turns by 36 deg at 8 Hz, and the pole is touched at {DISTANCE_MM} mm. Inertia is left out."),
    ];
    let title = "Fig. 5B: a whisker that slips off a pole";
    Ok(figure("fig5b", title, caption, panels))
}
