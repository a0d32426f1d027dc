//! Maps that commands read: stored maps, and maps of scenes, which are computed when they are read.

use super::failure::{Failure, message, warnings};
use super::files::{Files, STDOUT};
use super::solver::SolverArgs;
use std::path::Path;
use whiskmap::plan::{Channel, Channels, Plan};
use whiskmap::scene::{Parameter, Scene};
use whiskmap::store::{ComputedMap, MapSource};

/// Returns true if the input `path` is a scene: standard input, or a file whose name ends in `.toml`.
pub fn is_scene(path: &Path) -> bool {
    path == Path::new(STDOUT) || path.extension().is_some_and(|ending| ending == "toml")
}

/// Opens the stored map at `path`, for which options of a solver are refused.
pub fn stored(files: &mut Files, path: &Path, solver: &SolverArgs) -> Result<MapSource, Failure> {
    if let Some(option) = solver.given() {
        let path = path.display();
        let why = format!(
            "{option}: {path} is a stored map, which is not computed; give the scene, or leave {option} out"
        );
        return Err(Failure::Input(why));
    }
    files.inputs("MAP", [path])?;
    Ok(MapSource::open(path)?)
}

/// Returns the names of all channels that a map of `scene` can have, derivatives last, `[channel]`.
pub fn channel_names(scene: &Scene) -> Vec<&'static str> {
    let parameters = Parameter::ALL.into_iter();
    let varied = parameters.filter(|parameter| parameter.has_derivative(scene));
    let derivatives = varied.map(Parameter::push_derivative);
    let others = Channels::STANDARD.with(Channel::PeakStrain.name());
    let names = others.names().collect::<Vec<_>>();
    names.into_iter().chain(derivatives).collect()
}

/// Opens the map of `scene`, which is computed when it is read, and prints its engine. The engine is selected for a map of this number of
/// `whiskers`.
pub fn computed(
    scene: Scene,
    solver: &SolverArgs,
    channels: Channels,
    whiskers: usize,
) -> Result<ComputedMap, Failure> {
    let mut map = solver.plan(&scene, Plan::new(&scene)?, channels)?;
    map.plan.cells = map.plan.cells / map.plan.whiskers * whiskers;
    map.plan.whiskers = whiskers;
    let (engine, why) = solver.open(&map)?;
    let tolerances = map.tolerances(engine.as_deref());
    let plan = map.plan;
    let map = ComputedMap::new(scene, plan, engine, tolerances);
    let (name, adapter) = (&map.engine.engine, &map.engine.adapter);
    message(&format!("engine: {name} on {adapter} ({why})"));
    Ok(map)
}

/// Prints warnings about the cells of `map` that were computed.
pub fn warn(map: &MapSource) {
    warnings(map.take_warnings());
}
