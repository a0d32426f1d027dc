//! Table `[uncertainty]` of a scene: standard deviations of its numbers.

use super::builder::{Deviations, FrameDeviations, SceneBuilder};
use super::error::SceneFault;
use super::limits::{NumberLimits, digits};
use super::parameter::Parameter;

/// Key of the standard deviation of the radii of measured rows.
pub(super) const ROWS: &str = "profile_radius_um";

/// Largest standard deviation, but for parameters that may be larger: these may have one as large as they are.
const MOST: f64 = 1e5;

/// Checks the standard deviations of a scene's numbers. Returns `None` if the scene gives none.
pub(super) fn checked(scene: &SceneBuilder) -> Result<Option<Deviations>, SceneFault> {
    let Some(deviations) = &scene.uncertainty else {
        return Ok(None);
    };
    let Deviations { parameters, profile_radius_um, frames } = deviations;
    if parameters.is_empty() && profile_radius_um.is_none() && *frames == FrameDeviations::default()
    {
        let must = format!("must have at least one of {}", names());
        return Err(SceneFault::new("uncertainty", must));
    }
    let is_measured = scene.measured.is_some();
    let has_tip = || parameters.iter().any(|(parameter, _)| *parameter == Parameter::TipRadiusUm);
    let limits = NumberLimits::between(0.0, MOST);
    for &(parameter, deviation) in parameters {
        let key = format!("uncertainty.{}", parameter.name());
        let [_, most] = parameter.limits();
        NumberLimits::between(0.0, MOST.max(most)).check(&key, deviation)?;
        let must = match parameter {
            Parameter::LengthMm if is_measured => "whisker.profile.rows end at the length",
            Parameter::Taper if has_tip() => {
                let must = "must be left out beside tip_radius_um: both vary the tip's radius";
                return Err(SceneFault::of_value(key, digits(deviation), must));
            }
            _ if scene.given(parameter).is_none() => {
                &format!("the scene does not give {}", parameter.key())
            }
            _ => continue,
        };
        let must = format!("must be left out: {must}");
        return Err(SceneFault::of_value(key, digits(deviation), must));
    }
    if let Some(deviation) = *profile_radius_um {
        let key = format!("uncertainty.{ROWS}");
        limits.check(&key, deviation)?;
        if !is_measured {
            let must = "must be left out: there is no whisker.profile";
            return Err(SceneFault::of_value(key, digits(deviation), must));
        }
    }
    for (name, deviation) in FrameDeviations::NAMES.into_iter().zip(frames.values()) {
        if let Some(deviation) = deviation {
            limits.check(&format!("uncertainty.{name}"), deviation)?;
        }
    }
    Ok(Some(deviations.clone()))
}

/// Returns the names of all keys of the table `[uncertainty]`, with commas between them.
pub(super) fn names() -> String {
    let names = Parameter::ALL.map(|one| format!("`{}`", one.name()));
    let frames = FrameDeviations::NAMES.map(|name| format!("`{name}`"));
    format!("{}, `{ROWS}`, {}", names.join(", "), frames.join(", "))
}
