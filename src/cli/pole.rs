//! One whisker in front of a pole.

use super::failure::Failure;
use super::files::Files;
use super::numbers::length;
use clap::Args;
use std::path::{Path, PathBuf};
use whiskmap::scene::{Scene, Whisker, digits};
use whiskmap::trace::NoState;

/// Refuses scenes of several whiskers for `command`.
pub fn check_single(scene: &Scene, command: &str) -> Result<(), Failure> {
    let whiskers = scene.whisker_count();
    if whiskers == 1 {
        return Ok(());
    }
    let mut axes = scene.grid.sweep.iter();
    let key = axes.find(|axis| axis.values.len() > 1);
    let key = key.map_or("", |axis| axis.parameter.axis());
    Err(Failure::Input(format!(
        "grid.{key}: the scene sweeps {whiskers} whiskers; {command} looks at one, so give the axis one value or leave it out"
    )))
}

/// The scene, and where the pole stands.
#[derive(Debug, Args)]
pub struct Pole {
    /// Scene file; - reads it from standard input
    pub scene: PathBuf,
    /// Distance from the base to the contact at first touch, in mm or with a unit, such as 1.5cm
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = length)]
    pub distance: f64,
}

/// The scene, and where poles stand, one at a time.
#[derive(Debug, Args)]
pub struct Poles {
    /// Scene file; - reads it from standard input
    pub scene: PathBuf,
    /// Distance from the base to the contact at first touch, in mm or with a unit, such as 1.5cm; several with commas, or by
    /// several --distance
    #[arg(
        long,
        value_name = "LENGTH",
        required = true,
        value_delimiter = ',',
        allow_hyphen_values = true,
        value_parser = length
    )]
    pub distance: Vec<f64>,
}

/// Reads the scene and its only whisker for `command`, with poles at these distances.
pub fn read(
    files: &mut Files,
    path: &Path,
    command: &str,
    distances: &[f64],
) -> Result<(Scene, Whisker), Failure> {
    let scene = files.scene(path)?;
    check_single(&scene, command)?;
    let (nearest, farthest) = scene.distances_mm();
    let radius = scene.pole.radius_mm;
    for &distance in distances {
        if !(nearest <= distance && distance <= farthest && distance > radius) {
            let [distance, nearest, farthest, radius] =
                [distance, nearest, farthest, radius].map(digits);
            return Err(Failure::Input(format!(
                "--distance {distance} mm: must be between {nearest} mm (length_mm / 1000) and {farthest} mm (10 * length_mm), \
                 and more than {radius} mm (pole.radius_mm)"
            )));
        }
    }
    let whisker = scene.first_whisker().whisker;
    Ok((scene, whisker))
}

/// The title of a chart of the scene, with poles at these distances.
pub fn title(scene: &Scene, distances_mm: &[f64]) -> String {
    let distances: Vec<String> = distances_mm.iter().map(f64::to_string).collect();
    format!("{}, touched at {} mm", scene.title, distances.join(", "))
}

/// A state that does not exist was asked for; a continuation that got lost is no fault of the input.
pub fn refuse(distance_mm: f64, why: NoState) -> Failure {
    match why {
        NoState::Lost { .. } => Failure::State(why),
        _ => Failure::Input(format!("--distance {distance_mm} mm: {why}")),
    }
}
