//! Descriptions of scenes: numbers, effects, and axes.

use serde_json::{Value, json};
use whiskmap::classify::{Regime, Status};
use whiskmap::plan::{Plan, STATE_CHANNELS, effects};
use whiskmap::scene::{Parameter, Scene, SweepPlace};

/// Returns title, units, numbers, effects and axes of `scene`, which is the whisker at `place` of `sweep`, and the names of codes and
/// channels. The value also has the names of the whiskers in the table of `sweep`, and the name of the whisker at `place`.
pub fn description(scene: &Scene, sweep: &Scene, place: &SweepPlace) -> Result<Value, String> {
    let whiskers = sweep.table.iter().filter(|row| row.found.is_ok());
    let parameters = Parameter::ALL.into_iter();
    let parameters = parameters.filter_map(|parameter| {
        Some(json!({
            "name": parameter.name(),
            "key": parameter.key(),
            "title": parameter.title(),
            "unit": parameter.unit(),
            "value": number(scene, parameter)?,
        }))
    });
    let plan = Plan::new(scene).map_err(|why| why.to_string())?;
    let effects = effects(scene, plan.method.effects).into_iter();
    let effects =
        effects.map(|effect| json!({ "name": effect.name, "on": effect.on, "why": effect.why }));
    let ends = |values: &[f64]| [values[0], values[values.len() - 1]];
    let (nearest, farthest) = scene.distances_mm();
    let units = scene.whisker.units();
    Ok(json!({
        "title": scene.title,
        "name": scene.name,
        "is_of_sweep": sweep.is_sweep(),
        "whiskers": whiskers.map(|row| &row.name).collect::<Vec<_>>(),
        "whisker": place.whisker(),
        "length_mm": units.length_mm,
        "unit_force_un": units.force_un,
        "parameters": parameters.collect::<Vec<_>>(),
        "effects": effects.collect::<Vec<_>>(),
        "warnings": scene.warnings(),
        "push_angle_deg": ends(&scene.grid.push_angle_deg),
        "distance_mm": ends(&scene.grid.distance_mm),
        "distances_mm": [nearest.max(scene.pole.radius_mm), farthest],
        "regimes": Regime::ALL.map(|regime| json!({ "code": regime.code(), "name": regime.name() })),
        "statuses": Status::ALL.map(|status| json!({ "code": status.code(), "name": status.name() })),
        "marks": Status::NOT_TOWARD_TIP.map(Status::code),
        "state_channels": STATE_CHANNELS,
    }))
}

/// Returns the number of `parameter`: the scene's own, or else the neutral one. `None` if the scene cannot have the parameter.
fn number(scene: &Scene, parameter: Parameter) -> Option<f64> {
    parameter
        .value(scene)
        .or_else(|| parameter.neutral().filter(|value| scene.with(parameter, *value).is_ok()))
}

/// Returns the TOML text of `scene` with other `values` of parameters, in their units; its comments stay.
pub fn toml(scene: &Scene, values: &[(Parameter, f64)]) -> Result<String, String> {
    scene.to_toml_with(values).map_err(|why| why.to_string())
}
