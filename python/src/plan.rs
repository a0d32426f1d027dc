//! The cost of a map before it is computed.

use crate::errors::of_plan;
use crate::scene::CheckedScene;
use pyo3::prelude::*;
use whiskmap::plan::{Plan, effects};

/// Name of an effect, whether it is on, and which key of the scene decides it.
type EffectRow = (&'static str, bool, String);

/// Returns the numbers of whiskers and cells of a scene's map, its memory in bytes if it fits, and the effects.
#[pyfunction]
pub fn plan(scene: &CheckedScene) -> PyResult<(usize, usize, Option<u64>, Vec<EffectRow>)> {
    let plan = Plan::new(&scene.0).map_err(|why| of_plan(&why))?;
    let effects = effects(&scene.0, plan.method.effects)
        .into_iter()
        .map(|effect| (effect.name, effect.on, effect.why))
        .collect();
    // A map in memory keeps the panels of all whiskers.
    let bytes = Plan::in_memory(&scene.0).ok().map(|plan| plan.bytes);
    Ok((plan.whiskers, plan.cells, bytes, effects))
}
