//! One whisker in front of one pole.

use super::failure::Failure;
use super::numbers::number;
use clap::Args;
use std::path::PathBuf;
use whiskmap::scene::{Scene, Whisker, digits};
use whiskmap::trace::NoState;

/// The scene, and where the pole stands.
#[derive(Debug, Args)]
pub struct Pole {
    /// Scene file; - reads it from standard input
    scene: PathBuf,
    /// Distance from the base to the contact at first touch
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = number)]
    pub distance: f64,
}

impl Pole {
    /// Reads the scene and its only whisker for `command`.
    pub fn read(&self, command: &str) -> Result<(Scene, Whisker), Failure> {
        let scene = Scene::read(&self.scene)?;
        let whiskers = scene.whisker_count();
        if whiskers > 1 {
            let mut axes = scene.grid.sweep.iter();
            let key = axes.find(|axis| axis.values.len() > 1);
            let key = key.map_or("", |axis| axis.parameter.axis());
            return Err(Failure::Input(format!(
                "grid.{key}: the scene sweeps {whiskers} whiskers; {command} looks at one, so give the axis one value or leave \
                 it out"
            )));
        }
        let (nearest, farthest) = scene.distances_mm();
        let (distance, radius) = (self.distance, scene.pole.radius_mm);
        if !(nearest <= distance && distance <= farthest && distance > radius) {
            let [distance, nearest, farthest, radius] =
                [distance, nearest, farthest, radius].map(digits);
            return Err(Failure::Input(format!(
                "--distance {distance}: must be between {nearest} (length_mm / 1000) and {farthest} (10 * length_mm), \
                 and more than {radius} (pole.radius_mm)"
            )));
        }
        let whisker = scene.first_whisker().whisker;
        Ok((scene, whisker))
    }

    /// The title of a chart.
    pub fn title(&self, scene: &Scene) -> String {
        format!("{}, touched at {} mm", scene.title, self.distance)
    }

    /// A state that does not exist was asked for; a continuation that got lost is no fault of the input.
    pub fn refuse(&self, why: NoState) -> Failure {
        match why {
            NoState::Lost { .. } => Failure::State(why),
            _ => Failure::Input(format!("--distance {}: {why}", self.distance)),
        }
    }
}
