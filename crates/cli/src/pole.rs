//! Arguments of commands for one whisker: the scene and the distance of the pole.

use super::arguments::length;
use super::failure::Failure;
use super::files::Files;
use super::selection::SelectionArgs;
use clap::Args;
use std::path::PathBuf;
use whiskmap::scene::{Scene, Whisker, digits, rounded};
use whiskmap::trace::NoState;

#[derive(Debug, Args)]
pub struct WhiskerArgs {
    /// Scene file; - is standard input
    pub scene: PathBuf,
    #[command(flatten)]
    selection: SelectionArgs,
}

impl WhiskerArgs {
    /// Reads the scene, and the selected part of its sweep.
    pub fn selected(&self, files: &mut Files) -> Result<Scene, Failure> {
        self.selection.of_scene(&files.scene(&self.scene)?)
    }

    /// Reads the scene of `command`, which needs one whisker.
    pub fn read(&self, files: &mut Files, command: &str) -> Result<Scene, Failure> {
        let scene = self.selected(files)?;
        check_single(&scene, command)?;
        // The values of axes and tables become numbers of the scene.
        Ok(scene.of_whisker(0)?)
    }

    /// Reads the scene of `command` and its only whisker, which touches its pole without friction.
    pub fn without_friction(
        &self,
        files: &mut Files,
        command: &str,
    ) -> Result<(Scene, Whisker), Failure> {
        let scene = self.read(files, command)?;
        let friction = scene.pole.friction;
        if friction != 0.0 {
            let why = format!(
                "contact.friction = {friction}: must be 0, because the force is taken as normal to the whisker"
            );
            return Err(Failure::Input(why));
        }
        let whisker = scene.first_whisker().whisker;
        Ok((scene, whisker))
    }
}

/// Returns an error if the scene of `command` has several whiskers.
pub fn check_single(scene: &Scene, command: &str) -> Result<(), Failure> {
    let whiskers = scene.whisker_count();
    if whiskers == 1 {
        return Ok(());
    }
    let mut axes = scene.grid.sweep.iter();
    let axis = axes.find(|axis| axis.values.len() > 1);
    let (key, name) = axis.map_or(("", ""), |axis| (axis.variable.key(), axis.variable.name()));
    Err(Failure::Input(format!(
        "{key}: the scene sweeps {whiskers} whiskers, but {command} needs one; select it by --at {name}=VALUE"
    )))
}

#[derive(Debug, Args)]
pub struct PoleArgs {
    #[command(flatten)]
    pub whisker: WhiskerArgs,
    /// Distance from the base to the contact at first touch, in mm or with a unit, such as 1.5cm
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = length)]
    pub distance: f64,
}

#[derive(Debug, Args)]
pub struct PolesArgs {
    #[command(flatten)]
    pub whisker: WhiskerArgs,
    /// Distance from the base to the contact at first touch, in mm or with a unit, such as 1.5cm; several are separated by
    /// commas, or given by several --distance
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

/// Reads the scene of `command` and its only whisker, with poles at these distances.
pub fn read(
    files: &mut Files,
    args: &WhiskerArgs,
    command: &str,
    distances: &[f64],
) -> Result<(Scene, Whisker), Failure> {
    let scene = args.read(files, command)?;
    check_distances(&scene, distances)?;
    let whisker = scene.first_whisker().whisker;
    Ok((scene, whisker))
}

/// Returns an error if a distance of `--distance`, in mm, is out of the range of the scene.
pub fn check_distances(scene: &Scene, distances: &[f64]) -> Result<(), Failure> {
    let (nearest, farthest) = scene.distances_mm();
    let radius = scene.pole.radius_mm;
    for &distance in distances {
        if !(nearest <= distance && distance <= farthest && distance > radius) {
            let [distance, nearest, farthest, radius] =
                [distance, nearest, farthest, radius].map(digits);
            let commas = match distances.len() {
                1 => "",
                _ => "; a comma separates distances, and numbers have decimal points",
            };
            return Err(Failure::Input(format!(
                "--distance {distance} mm: must be between {nearest} mm (length_mm / 1000) and {farthest} mm (10 * length_mm), \
                 and more than {radius} mm (pole.radius_mm){commas}"
            )));
        }
    }
    Ok(())
}

/// Significant digits of a distance in a title.
const TITLE_DIGITS: usize = 6;

/// Returns the title of a chart of the scene, with poles at these distances.
pub fn title(scene: &Scene, distances_mm: &[f64]) -> String {
    let distances: Vec<String> =
        distances_mm.iter().map(|mm| digits(rounded(*mm, TITLE_DIGITS))).collect();
    format!("{}, touched at {} mm", scene.title, distances.join(", "))
}

/// Converts a missing state to a failure: a failed continuation is not invalid input.
pub fn refuse(distance_mm: f64, why: NoState) -> Failure {
    match why {
        NoState::Failed { .. } => Failure::State(why),
        _ => Failure::Input(format!("--distance {distance_mm} mm: {why}")),
    }
}
