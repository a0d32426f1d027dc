//! List of the mechanical effects by name: whether each is on, and which line of the scene decides it.

use crate::scene::{Parameter, Scene, SceneData, SweptWhisker, Whisker};
use whiskmap_mechanics::rod::Effects;

/// Mechanical effect of a scene: its name, reason and cost.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Effect {
    /// Name of the effect, as printed.
    pub name: &'static str,
    /// True if the effect changes anything in this scene.
    pub on: bool,
    /// Keys of the scene that decide the effect, with their values.
    pub why: String,
    /// Cost of the effect in the integration loop if it is on.
    pub cost: Cost,
}

/// Cost of an effect in the integration loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// The effect costs work at every step: sets of such effects have kernels of their own.
    Kernel,
    /// The effect costs nothing: it only changes the start of a trajectory, or its end.
    Start,
    /// The effect costs nothing: it is a faster taper and a steeper modulus gradient.
    Taper,
}

/// Returns every effect of `scene`, `[effect]`; `kernels` are the effects in the kernels of the run.
#[must_use]
pub fn effects(scene: &Scene, kernels: Effects) -> Vec<Effect> {
    let SceneData { whisker, pole, .. } = &**scene;
    let why = |parameter: Parameter, fixed: String| match scene.grid.axis(parameter) {
        Some(values) => swept(parameter.axis_key(), values),
        None => fixed,
    };
    let taper = match &whisker.profile {
        Some(_) => "the radii are measured".to_owned(),
        None => [Parameter::BaseRadiusUm, Parameter::TipRadiusUm, Parameter::Taper]
            .into_iter()
            .fold(radii(whisker), |text, parameter| why(parameter, text)),
    };
    let smooth = scene.smooth_radii().map_or_else(String::new, |radii| {
        let (degree, rms) = (radii.degree, radii.rms_um);
        format!(", smooth: degree {degree}, rms {rms:.1e} um")
    });
    let measured = whisker.profile.as_ref().map_or_else(
        || "no whisker.profile".to_owned(),
        |rows| format!("{} rows of whisker.profile{smooth}", rows.len()),
    );
    let number = |parameter, key, value, neutral| why(parameter, given(key, value, neutral));
    let bend = whisker.curvature.unwrap_or_default().parabola_per_mm;
    let parabola = number(Parameter::ParabolaPerMm, "parabola_per_mm", bend, 0.0);
    let spiral = whisker.euler_spiral.map_or_else(
        || "euler_spiral is 0 or left out".to_owned(),
        |spiral| format!("per_mm {}, per_mm2 {}", spiral.per_mm, spiral.per_mm2),
    );
    let traced = scene.traced().map_or_else(
        || "no whisker.rest".to_owned(),
        |shape| {
            let (degree, count, rms) = (shape.degree, shape.points_mm.len(), shape.rms_mm);
            format!("degree {degree}, rms {rms:.1e} mm, {count} points")
        },
    );
    let ratio = whisker.modulus_tip_to_base;
    let gradient = number(Parameter::ModulusTipToBase, "tip_to_base", ratio, 1.0);
    let radius = number(Parameter::PoleRadiusMm, "radius_mm", pole.radius_mm, 0.0);
    let friction = number(Parameter::Friction, "friction", pole.friction, 0.0);
    let clamped = || "no whisker.follicle: the base is clamped".to_owned();
    let stiffness = whisker.follicle_stiffness_nnm_per_rad;
    let follicle =
        stiffness.map_or_else(clamped, |stiffness| format!("stiffness_nnm_per_rad {stiffness}"));
    let follicle = why(Parameter::FollicleStiffness, follicle);
    let corners: Vec<SweptWhisker> = scene.corner_whiskers().collect();
    let any = |differs: fn(&SweptWhisker) -> bool| corners.iter().any(differs);
    let stretched = any(|swept| swept.whisker.arc_stretch != 1.0);
    let varies = kernels.taper || kernels.profile || kernels.gradient;
    let stretch = whisker.arc_stretch;
    let mut stretch = number(Parameter::ArcStretch, "arc_stretch", stretch, 1.0);
    if stretched && !varies {
        stretch += " does nothing without taper or modulus gradient";
    }
    let turns = any(|swept| swept.whisker.follicle_stiffness_nnm_per_rad.is_some());
    let is_disc = any(|swept| swept.pole.radius_mm != 0.0);
    let effect = |name, on, cost, why| Effect { name, on, why, cost };
    #[rustfmt::skip]
    let effects = vec![
        effect("taper", kernels.taper && !kernels.profile, Cost::Kernel, taper),
        effect("measured radii", kernels.profile, Cost::Kernel, measured),
        effect("curvature", kernels.curvature, Cost::Kernel, parabola),
        effect("euler spiral", kernels.spiral, Cost::Kernel, spiral),
        effect("traced shape", kernels.polynomial, Cost::Kernel, traced),
        effect("modulus gradient", kernels.gradient, Cost::Kernel, gradient),
        effect("pole radius", is_disc, Cost::Start, radius),
        effect("friction", scene.has_friction(), Cost::Start, friction),
        effect("elastic follicle", turns, Cost::Start, follicle),
        effect("projection", stretched && varies, Cost::Taper, stretch),
    ];
    effects
}

/// Describes a key that changes nothing at `neutral`, its default.
fn given(key: &str, value: f64, neutral: f64) -> String {
    if value == neutral {
        format!("{key} is {neutral} or left out")
    } else {
        format!("{key} {value}")
    }
}

/// Describes an axis that replaces the whisker's own value.
fn swept(key: &str, axis: &[f64]) -> String {
    match axis {
        [first, .., last] => format!("{key} {first} to {last}"),
        only => format!("{key} {}", only[0]),
    }
}

fn radii(whisker: &Whisker) -> String {
    let (tip, base) = (whisker.tip_radius_um, whisker.base_radius_um);
    let relation = if tip < base { "<" } else { "=" };
    format!("tip_radius_um {tip} {relation} base_radius_um {base}")
}
