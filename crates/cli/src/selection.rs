//! Options `--at` and `--channel`: the selected part of a map or a sweep.

use super::failure::{Failure, message};
use super::files::Files;
use super::solver::SolverArgs;
use super::source::{channel_names, computed, is_scene, stored};
use clap::Args;
use std::path::Path;
use std::str::FromStr;
use whiskmap::input::did_you_mean;
use whiskmap::plan::Channels;
use whiskmap::scene::{Coordinate, Grid, Scene};
use whiskmap::store::{AxisValue, GridPart, InvalidAxisValue, MapSlice, MapSource, scene_at};

#[derive(Debug, Args)]
pub struct SelectionArgs {
    /// Select the nearest value on an axis; the value may have a unit, such as distance_mm=1.5cm; whisker=NAME selects a row of a table
    #[arg(long, value_name = "AXIS=VALUE", value_parser = AxisValue::from_str, allow_hyphen_values = true)]
    at: Vec<AxisValue>,
    /// Accept only values on the axis in --at, not the nearest
    #[arg(long)]
    exact: bool,
}

impl SelectionArgs {
    /// Opens the selected part of the input `path`, a stored map or a scene, and prints the selected values. For a scene, the channels in
    /// `wanted` are computed. If `wanted` is empty, they are the channels of a map without a selection.
    pub fn open<'n>(
        &self,
        files: &mut Files,
        path: &Path,
        solver: &SolverArgs,
        wanted: impl FnOnce(&Scene) -> Vec<&'n str>,
    ) -> Result<MapSlice, Failure> {
        let (source, part) = match is_scene(path) {
            true => {
                let scene = files.scene(path)?;
                let part = self.part(&scene.grid)?;
                let wanted = wanted(&scene);
                channels(&channel_names(&scene), &wanted)?;
                let channels = match &wanted[..] {
                    [] => Channels::of_scene(&scene),
                    _ => Channels::those(|name| wanted.contains(&name)),
                };
                let map = computed(scene, solver, channels, part.grid.whisker_count())?;
                (MapSource::from(map), part)
            }
            false => {
                let map = stored(files, path, solver)?;
                if let Some(version) = map.foreign_version()? {
                    message(&format!(
                        "warning: {} was written by whiskmap {version}, not by {}; its channels may have another meaning",
                        path.display(),
                        env!("CARGO_PKG_VERSION")
                    ));
                }
                let part = self.part(map.grid())?;
                (map, part)
            }
        };
        let slice = MapSlice::of_part(source, part);
        name(slice.chosen());
        Ok(slice)
    }

    fn part(&self, whole: &Grid) -> Result<GridPart, Failure> {
        GridPart::new(whole, &self.at, self.exact).map_err(refused)
    }

    /// Returns the selected part of the sweep of a scene, and prints the selected values.
    pub fn of_scene(&self, scene: &Scene) -> Result<Scene, Failure> {
        if let Some(at) = self.at.iter().find(|at| at.axis == "distance_mm") {
            let value = &at.value;
            let why = format!(
                "--at distance_mm={value}: selects a whisker of the sweep; --distance {value} selects the distance"
            );
            return Err(Failure::Input(why));
        }
        let (scene, chosen) = scene_at(scene, &self.at, self.exact).map_err(refused)?;
        name(&chosen);
        Ok(scene)
    }
}

fn refused(why: InvalidAxisValue) -> Failure {
    Failure::Input(format!("--at {why}"))
}

fn name(chosen: &[(&'static str, Coordinate)]) {
    for (name, value) in chosen {
        message(&format!("{name} = {value}"));
    }
}

/// Returns the names of the `wanted` channels out of those `known`, or of all if there are none.
pub fn channels(known: &[&'static str], wanted: &[&str]) -> Result<Vec<&'static str>, Failure> {
    if let Some(name) = wanted.iter().find(|name| !known.contains(name)) {
        let hint = did_you_mean(name, known.iter().copied());
        let known = known.join(", ");
        return Err(Failure::Input(format!("--channel {name}: must be one of {known}{hint}")));
    }
    let is_wanted = |name: &&str| wanted.is_empty() || wanted.contains(name);
    Ok(known.iter().copied().filter(is_wanted).collect())
}
