//! Checks of the sweep axes, along which whiskers differ.

use super::builder::SceneBuilder;
use super::error::SceneFault;
use super::grid::{Grid, SweepAxis, SweepPlace};
use super::limits::digits;
use super::parameter::Parameter;
use super::shape;
use super::substitutes::HAS_TAPERS;

/// Returns the sweep axes. Each value is within the limits that hold whatever the other numbers are.
pub(super) fn axes(
    scene: &SceneBuilder,
    lengths_mm: [f64; 2],
) -> Result<Vec<SweepAxis>, SceneFault> {
    let checked = scene.sweep.iter().map(|(parameter, values)| {
        let parameter = *parameter;
        let limits = match parameter {
            Parameter::ParabolaPerMm => shape::parabola_limits(lengths_mm[1]),
            _ => parameter.number_limits(),
        };
        // An axis replaces the scene's own number, which must be valid nevertheless.
        if let Some(number) = scene.numbers.get(parameter) {
            limits.check(parameter.key(), number)?;
            if parameter == Parameter::ParabolaPerMm {
                shape::refuse_faint(number, lengths_mm[0])?;
            }
        }
        let values = values.checked(parameter.axis_key(), &limits)?;
        let variable = parameter.into();
        Ok(SweepAxis { variable, values })
    });
    let mut axes: Vec<SweepAxis> = checked.collect::<Result<_, _>>()?;
    if let [first, _] = &axes[..]
        && first.variable == Parameter::ParabolaPerMm.into()
    {
        axes.swap(0, 1);
    }
    Ok(axes)
}

/// Returns the least and the greatest length of the whiskers of a sweep, with the cones beyond measured rows, in millimetres.
pub(super) fn lengths_mm(scene: &SceneBuilder) -> Result<[f64; 2], SceneFault> {
    let length = Parameter::LengthMm;
    let limits = length.number_limits();
    let number = scene.numbers.get(length);
    let number = number.ok_or_else(|| SceneFault::new(length.key(), "is left out"))?;
    limits.check(length.key(), number)?;
    let Some((_, axis)) = scene.sweep.iter().find(|(swept, _)| *swept == length) else {
        let extension = scene.numbers.get(Parameter::TipExtensionMm);
        return Ok([number + extension.unwrap_or(0.0).max(0.0); 2]);
    };
    let values = axis.checked(length.axis_key(), &limits)?;
    Ok([values[0], values[values.len() - 1]])
}

/// Refuses sweep axes of parameters that another part of the scene determines.
pub(super) fn refuse_at_odds(scene: &SceneBuilder) -> Result<(), SceneFault> {
    let given = |parameter| scene.numbers.get(parameter).is_some();
    let is_measured = scene.measured.is_some();
    for (parameter, _) in &scene.sweep {
        let mut substitutes = parameter.substitutes().iter();
        let substituted = substitutes.find_map(|part| part.of_scene(scene));
        let must = match (substituted, parameter) {
            (Some(must), _) => must,
            (None, Parameter::LengthMm) if is_measured => {
                "must be left out: whisker.profile has the radii of one length"
            }
            (None, Parameter::VertexMm)
                if !given(Parameter::ParabolaPerMm) && !scene.sweeps(Parameter::ParabolaPerMm) =>
            {
                "must be left out: there is no parabola; give parabola_per_mm or grid.curvature_per_mm"
            }
            (None, parameter) if !Parameter::SWEPT.contains(parameter) => {
                "must be left out: no axis varies it"
            }
            _ => continue,
        };
        return Err(SceneFault::new(parameter.axis_key(), must));
    }
    match scene.numbers.get(Parameter::TipRadiusUm) {
        Some(tip) if scene.sweeps(Parameter::Taper) => {
            let key = Parameter::TipRadiusUm.key();
            Err(SceneFault::of_value(key, digits(tip), HAS_TAPERS))
        }
        _ => Ok(()),
    }
}

/// Runs `check` at the places of a sweep whose whiskers are valid only if all are. Every limit moves one way along every axis, so these
/// are the corners; next to a curvature of 0 there is the least one that bends.
///
/// The fault names the axis where an axis gives the number, and the place unless the fault is the same at every corner.
pub(super) fn check_corners(
    grid: &Grid,
    check: impl Fn(&SweepPlace) -> Result<(), SceneFault>,
) -> Result<(), SceneFault> {
    let mut ends = grid.ends();
    for axis in &mut ends.sweep {
        let bend = Parameter::ParabolaPerMm;
        let all = grid.axis(bend).unwrap_or_default();
        if axis.variable == bend.into() && all[0] == 0.0 && all.len() > 2 {
            axis.values.insert(1, all[1]);
        }
    }
    let corners = ends.whisker_count();
    let places = (0..corners).map(|index| ends.place(index));
    let refused: Vec<(SceneFault, SweepPlace)> =
        places.filter_map(|place| Some((check(&place).err()?, place))).collect();
    let is_everywhere =
        refused.len() == corners && refused.iter().all(|(fault, _)| *fault == refused[0].0);
    let Some((mut fault, place)) = refused.into_iter().next() else {
        return Ok(());
    };
    let mut axes = place.values();
    if let Some((parameter, _)) = axes.find(|(parameter, _)| fault.key == parameter.key()) {
        fault = SceneFault::new(parameter.axis_key(), fault.must);
    }
    if !is_everywhere {
        let values = place.values();
        let texts = values.map(|(parameter, value)| format!("{} = {value}", parameter.axis()));
        let refused_at = texts.collect::<Vec<_>>().join(", ");
        fault.must = format!("{}; refused is {refused_at}", fault.must);
    }
    Err(fault)
}
