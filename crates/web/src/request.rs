//! Requests of the page, and the responses to them.

use crate::response::{MOST, Response};
use crate::{course, map, points, scene, traces};
use serde::Deserialize;
use serde_json::json;
use whiskmap::scene::{Parameter, Scene, SweepPlace};
use whiskmap::sensitivity::effects;

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
    /// Name of the whisker in the table of the scene; `None` for the first whisker.
    #[serde(default)]
    whisker: Option<String>,
    /// What is to be computed.
    task: Task,
}

/// Task of a request: what is to be computed for a scene.
#[derive(Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Task {
    /// Task: return the numbers and effects of the scene.
    Scene,
    /// Task: return the scene as TOML with the values of the request.
    Toml,
    /// Task: compute a map of one whisker.
    Map(map::MapTask),
    /// Task: compute the stable state at one push angle and distance.
    State {
        /// Push angle since first touch, in degrees.
        push_angle_deg: f64,
        /// Distance of first touch from the base, in mm.
        distance_mm: f64,
    },
    /// Task: compute the branches of both sides at one distance, and the unstable state at a push angle.
    Branches {
        /// Distance of first touch from the base, in mm.
        distance_mm: f64,
        /// Push angle since first touch of the unstable state, in degrees; `None` for the branches alone.
        push_angle_deg: Option<f64>,
        /// Number of points of each branch.
        count: usize,
    },
    /// Task: compute the detachment curve of both sides.
    Curve {
        /// Range `[least, greatest]` of distances of first touch from the base, in mm; equal for one distance.
        distance_mm: [f64; 2],
        /// Number of distances of the detachment curve; 1 for equal ends.
        count: usize,
    },
    /// Task: compute the effects of all numbers of the scene on the detachments of both sides at one distance.
    Sensitivities {
        /// Distance of first touch from the base, in mm.
        distance_mm: f64,
    },
    /// Task: compute the course in front of one pole while the base's angle is a sine of time.
    Whisk(course::WhiskTask),
    /// Task: compare measured detachments with the detachments of the scene, after a fit of the free parameters if there are any.
    Points(points::PointsTask),
}

/// Returns the response to a request in JSON.
pub fn respond(request: &[u8]) -> Response {
    let request = serde_json::from_slice(request).map_err(|why| why.to_string());
    let response = request.and_then(|request: Request| request.respond());
    response.unwrap_or_else(|why| json!({ "error": why }).into())
}

impl Request {
    fn respond(&self) -> Result<Response, String> {
        let scene = self.scene()?;
        Ok(match &self.task {
            Task::Scene => scene::description(&scene, &self.parsed()?, &self.place()?)?.into(),
            Task::Toml => {
                json!({ "toml": scene::toml(&self.one(Vec::new())?, &self.changes()?)? }).into()
            }
            Task::Map(task) => task.respond(&scene)?,
            Task::State { push_angle_deg, distance_mm } => {
                traces::state(&scene, *push_angle_deg, *distance_mm)?.into()
            }
            Task::Branches { distance_mm, push_angle_deg, count } => {
                let count = (*count).clamp(3, MOST);
                traces::branches(&scene, *distance_mm, *push_angle_deg, count).into()
            }
            Task::Curve { distance_mm, count } => {
                traces::curve(&scene, *distance_mm, (*count).clamp(1, MOST))?.into()
            }
            Task::Sensitivities { distance_mm } => {
                json!({ "distance_mm": distance_mm, "rows": effects(&scene, *distance_mm) }).into()
            }
            Task::Whisk(task) => task.respond(&scene)?,
            Task::Points(task) => task.respond(&scene, &self.place()?)?.into(),
        })
    }

    /// Returns the scene of one whisker with the values of the request. The whisker is the named one, or the first one of a sweep.
    fn scene(&self) -> Result<Scene, String> {
        self.one(self.changes()?)
    }

    fn one(&self, values: Vec<(Parameter, f64)>) -> Result<Scene, String> {
        let sweep = self.parsed()?;
        let scene = sweep.of_whisker(self.index(&sweep)?);
        let scene = scene.and_then(|scene| match values.is_empty() {
            true => Ok(scene),
            false => scene.with_parameters(&values),
        });
        scene.map_err(|why| why.to_string())
    }

    /// Index of the whisker in the sweep.
    fn index(&self, sweep: &Scene) -> Result<usize, String> {
        let mut indices = 0..sweep.whisker_count();
        let found = indices.find(|index| match &self.whisker {
            Some(name) => sweep.grid.place(*index).whisker() == Some(name),
            None => sweep.whisker(*index).is_ok(),
        });
        let name = || self.whisker.as_deref().unwrap_or_default();
        found.ok_or_else(|| format!("whisker = {}: is not in the table of whiskers", name()))
    }

    /// Place of the whisker in the sweep.
    fn place(&self) -> Result<SweepPlace, String> {
        let sweep = self.parsed()?;
        Ok(sweep.grid.place(self.index(&sweep)?))
    }

    fn parsed(&self) -> Result<Scene, String> {
        Scene::parse(&self.text, &self.origin).map_err(|why| why.to_string())
    }

    fn changes(&self) -> Result<Vec<(Parameter, f64)>, String> {
        let values = self.values.iter();
        let values = values.map(|(name, value)| Some((Parameter::named(name)?, *value)));
        values.collect::<Option<_>>().ok_or_else(|| {
            "error: an unknown parameter: take the link from this version of the page".to_owned()
        })
    }
}
