//! Courses of whisking, with the shapes of the whisker.

use crate::response::Response;
use serde::Deserialize;
use serde_json::json;
use whiskmap::mechanics::rod::{Rest, Side};
use whiskmap::scene::Scene;
use whiskmap::sheet::Row;
use whiskmap::trace::{Branch, ShapePoint, WhiskerPart, WhiskerShape};
use whiskmap::whisk::{AngleCourse, WhiskSample, whisk};

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
        let rests = [Side::Cb, Side::Cf].map(|side| Rest::new(&whisker.rod(pole, side)));
        let row = Row::new(&rests[0], self.distance_mm / whisker.length_mm);
        let cf_mm = rests[1].distance_of_pole(row.pole_distance) * whisker.length_mm;
        let branch = |side, distance_mm| Branch::new(whisker, pole, side, distance_mm);
        let cb = branch(Side::Cb, self.distance_mm).map_err(|why| why.to_string())?;
        let cf = branch(Side::Cf, cf_mm).ok();
        let at_rest = WhiskerShape::at_rest(&cb, POINTS);
        let shape = |sample: &WhiskSample| {
            let Some((side, push_deg)) = sample.side.zip(sample.push_angle_deg) else {
                return Some(turned(&at_rest, -sample.angle_deg?));
            };
            let (branch, turn_deg) = match side {
                Side::Cb => (&cb, 0.0),
                Side::Cf => (cf.as_ref()?, -found.cf_touch_deg),
            };
            let state = branch.state(push_deg.to_radians(), true).ok()?;
            let points = WhiskerShape::new(branch, &state, POINTS).points;
            // The contact lies between the evenly spaced points, or on one of them.
            let is_extra =
                |point: &ShapePoint| points.len() > POINTS && point.part == WhiskerPart::Contact;
            let even = points.iter().filter(|point| !is_extra(point));
            let even: Vec<[f64; 2]> = even.map(|point| [point.x_mm, point.y_mm]).collect();
            Some(turned(&even, turn_deg))
        };
        let shapes = found.samples.iter().flat_map(|sample| {
            let known = sample.reason.is_none().then(|| shape(sample));
            known
                .flatten()
                .unwrap_or_else(|| vec![[f64::NAN; 2]; POINTS])
        });
        let (sin, cos) = libm::sincos(row.touch);
        let pole_mm = [cos, sin].map(|component| component * row.pole_distance * whisker.length_mm);
        Ok(Response {
            numbers: shapes
                .flatten()
                .map(|coordinate| coordinate as f32)
                .collect(),
            text: json!({
                "distance_mm": self.distance_mm,
                "points": POINTS,
                "pole_mm": pole_mm,
                "pole_radius_mm": pole.radius_mm,
                "samples": found.samples,
                "events": found.events,
                "lost_nj": found.lost_nj(),
            }),
        })
    }
}

/// Points turned about the base by `deg` degrees to the left.
fn turned(points: &[[f64; 2]], deg: f64) -> Vec<[f64; 2]> {
    let (sin, cos) = libm::sincos(deg.to_radians());
    let turn = |[x, y]: &[f64; 2]| [x * cos - y * sin, x * sin + y * cos];
    points.iter().map(turn).collect()
}
