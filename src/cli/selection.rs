//! Options `--at` and `--channel`: the selected part of a map, a store or a sweep.

use super::failure::{Failure, message};
use super::files::Files;
use clap::Args;
use std::path::Path;
use std::str::FromStr;
use whiskmap::input::did_you_mean;
use whiskmap::scene::{Scene, digits};
use whiskmap::store::{AxisValue, InvalidAxisValue, MapSlice, MapSource, scene_at};

#[derive(Debug, Args)]
pub struct SelectionArgs {
    /// Select the nearest value on an axis; the value may have a unit, such as distance_mm=1.5cm
    #[arg(long, value_name = "AXIS=VALUE", value_parser = AxisValue::from_str, allow_hyphen_values = true)]
    at: Vec<AxisValue>,
    /// Accept only values on the axis in --at, not the nearest
    #[arg(long)]
    exact: bool,
}

impl SelectionArgs {
    /// Opens the selected part of the input `source`, a map or a store, and prints the selected values.
    pub fn open(&self, files: &mut Files, source: &Path) -> Result<MapSlice, Failure> {
        let stored = MapSource::open(source)?;
        files.input(source);
        if let Some(version) = stored.foreign_version()? {
            message(&format!(
                "warning: {} was written by whiskmap {version}, not by {}; its channels may have another meaning",
                source.display(),
                env!("CARGO_PKG_VERSION")
            ));
        }
        let slice = MapSlice::new(stored, &self.at, self.exact).map_err(refused)?;
        name(slice.chosen());
        Ok(slice)
    }

    /// Returns the selected part of the sweep of a scene, and prints the selected values.
    pub fn of_scene(&self, scene: &Scene) -> Result<Scene, Failure> {
        if let Some(at) = self.at.iter().find(|at| at.axis == "distance_mm") {
            let value = digits(at.value);
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

fn name(chosen: &[(&'static str, f64)]) {
    for (name, value) in chosen {
        message(&format!("{name} = {}", digits(*value)));
    }
}

/// Returns the names of the `wanted` channels, or of all if there are none.
pub fn channels(slice: &MapSlice, wanted: &[String]) -> Result<Vec<&'static str>, Failure> {
    let known = slice.channels();
    if let Some(name) = wanted.iter().find(|name| !known.contains(&name.as_str())) {
        let hint = did_you_mean(name, known.iter().copied());
        let known = known.join(", ");
        return Err(Failure::Input(format!(
            "--channel {name}: must be one of {known}{hint}"
        )));
    }
    let is_wanted = |name: &&str| wanted.is_empty() || wanted.iter().any(|own| own == name);
    Ok(known.into_iter().filter(is_wanted).collect())
}
