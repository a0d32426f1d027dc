//! Courses of whisking, with the shapes of the whisker.

use crate::response::Response;
use serde::Deserialize;
use serde_json::json;
use whiskmap::scene::Scene;
use whiskmap::whisk::{AngleCourse, CourseShapes, whisk};

/// Number of points of a whisker's shape.
const POINTS: usize = 48;

/// Periods of a course, and samples of one period.
const PERIODS: f64 = 2.0;
const SAMPLES: f64 = 120.0;

/// Task: compute a course in front of one pole, in which the base's angle is a sine of time.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WhiskTask {
    /// Distance of first touch from the base, in mm.
    distance_mm: f64,
    /// Amplitude of the base's angle, in degrees.
    amplitude_deg: f64,
    /// Periods per second.
    frequency_hz: f64,
}

impl WhiskTask {
    /// Returns samples and events as from `whiskmap whisk`, the pole, and the shapes of the whisker in mm, `[sample][point][x, y]`: the
    /// origin is at the base, the first axis along the base's tangent at first touch on CB. Undecided samples have shapes of NaN.
    pub fn respond(&self, scene: &Scene) -> Result<Response, String> {
        let frequency = self.frequency_hz;
        let seconds = PERIODS / frequency;
        let course = AngleCourse::sine(self.amplitude_deg, frequency, seconds, SAMPLES * frequency);
        let course = course.map_err(|why| why.to_string())?;
        let (whisker, pole) = (&scene.whisker, &scene.pole);
        let found = whisk(whisker, pole, self.distance_mm, &course);
        let found = found.map_err(|why| why.to_string())?;
        let shapes = CourseShapes::new(whisker, pole, self.distance_mm, &found);
        let shapes = shapes.map_err(|why| why.to_string())?;
        let points = found.samples.iter().flat_map(|sample| {
            let is_known = sample.reason.is_none();
            let points = is_known.then(|| shapes.points(sample, POINTS, false).ok());
            let unknown = || vec![[f64::NAN; 2]; POINTS];
            points.flatten().unwrap_or_else(unknown)
        });
        Ok(Response {
            numbers: points.flatten().map(|coordinate| coordinate as f32).collect(),
            text: json!({
                "distance_mm": self.distance_mm,
                "points": POINTS,
                "pole_mm": shapes.pole_mm,
                "pole_radius_mm": pole.radius_mm,
                "samples": found.samples,
                "events": found.events,
                "lost_nj": found.lost_nj(),
            }),
        })
    }
}
