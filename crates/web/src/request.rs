//! Requests of the page, and their answers.

use crate::answer::{Answer, MOST};
use crate::{map, points, scene, traces};
use serde::Deserialize;
use serde_json::json;
use whiskmap::scene::{Parameter, Scene};

/// Request: a scene, values that replace those in it, and a task.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Request {
    /// TOML text of the scene.
    text: String,
    /// Name of the scene in messages.
    origin: String,
    /// Names of parameters with other values, in their units.
    values: Vec<(String, f64)>,
    /// What is to be computed.
    task: Task,
}

/// What is to be computed for a scene.
#[derive(Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Task {
    /// The numbers and effects of the scene.
    Scene,
    /// The scene as TOML with the values of the request.
    Toml,
    /// A map of one whisker.
    Map(map::MapTask),
    /// The state at one push angle and distance.
    State {
        /// Push angle since first touch, in degrees.
        push_angle_deg: f64,
        /// Distance of first touch from the base, in mm.
        distance_mm: f64,
    },
    /// The branches of both sides at one distance.
    Branches {
        /// Distance of first touch from the base, in mm.
        distance_mm: f64,
        /// Number of points of each branch.
        count: usize,
    },
    /// The detachment curve of both sides.
    Curve {
        /// Least and greatest distance, in mm.
        distance_mm: [f64; 2],
        /// Number of distances.
        count: usize,
    },
    /// Measured detachments beside those of the scene, after a fit of the free parameters if there are any.
    Points(points::PointsTask),
}

/// Answers a request in JSON.
pub fn answer(request: &[u8]) -> Answer {
    let request = serde_json::from_slice(request).map_err(|why| why.to_string());
    let answer = request.and_then(|request: Request| request.answer());
    answer.unwrap_or_else(|why| json!({ "error": why }).into())
}

impl Request {
    fn answer(&self) -> Result<Answer, String> {
        let scene = self.scene()?;
        Ok(match &self.task {
            Task::Scene => scene::description(&scene)?.into(),
            Task::Toml => {
                json!({ "toml": scene::toml(&self.one(Vec::new())?, &self.changes()?)? }).into()
            }
            Task::Map(task) => task.answer(&scene)?,
            Task::State {
                push_angle_deg,
                distance_mm,
            } => traces::state(&scene, *push_angle_deg, *distance_mm)?.into(),
            Task::Branches { distance_mm, count } => {
                traces::branches(&scene, *distance_mm, (*count).clamp(3, MOST)).into()
            }
            Task::Curve { distance_mm, count } => {
                traces::curve(&scene, *distance_mm, (*count).clamp(2, MOST))?.into()
            }
            Task::Points(task) => task.answer(&scene)?.into(),
        })
    }

    /// The one whisker of the request: the first one of a sweep, with its values.
    fn scene(&self) -> Result<Scene, String> {
        self.one(self.changes()?)
    }

    fn one(&self, values: Vec<(Parameter, f64)>) -> Result<Scene, String> {
        let scene = Scene::parse(&self.text, &self.origin);
        let scene = scene.and_then(|scene| scene.of_whisker(0));
        let scene = scene.and_then(|scene| match values.is_empty() {
            true => Ok(scene),
            false => scene.with_parameters(&values),
        });
        scene.map_err(|why| why.to_string())
    }

    fn changes(&self) -> Result<Vec<(Parameter, f64)>, String> {
        let values = self.values.iter();
        let values = values.map(|(name, value)| Some((Parameter::named(name)?, *value)));
        values.collect::<Option<_>>().ok_or_else(|| {
            "error: an unknown parameter: take the link from this version of the page".to_owned()
        })
    }
}
