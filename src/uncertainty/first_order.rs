//! The spread of push angles to first order: `sd^2 = sum (d push/d value x sd of the value)^2`.

use super::varying::Varying;
use crate::input::each_once;
use crate::scene::Scene;
use crate::sensitivity::{DetachmentDerivatives, Variable, detachments_of};
use crate::trace::{EndDetail, PushedWhisker};
use whiskmap_mechanics::rod::Side;
use whiskmap_mechanics::shooting::Resolution;

/// Returns the standard deviation of the push angle in degrees, to first order, `[distance]`; `None` without a detachment or its
/// derivatives.
pub(super) fn deviations_deg(
    scene: &Scene,
    varying: &[Varying],
    resolution: Resolution,
    side: Side,
) -> Vec<Option<f64>> {
    let parts: Vec<Vec<(Variable, f64)>> =
        varying.iter().map(|one| one.variables(scene, varying)).collect();
    let all: Vec<Variable> = parts.iter().flatten().map(|(variable, _)| *variable).collect();
    let variables = each_once(&all);
    let pushed = PushedWhisker {
        whisker: &scene.whisker,
        pole: &scene.pole,
        side,
        distances_mm: &scene.grid.distance_mm,
    };
    let ends = detachments_of(resolution, &[pushed], EndDetail::State, &variables).concat();
    let deviation = |DetachmentDerivatives { end, by }: DetachmentDerivatives| {
        end.push_angle_deg?;
        let slope_of = |variable: &Variable| {
            let index = variables.iter().position(|other| other == variable)?;
            Some(by[index].as_ref().ok()?.push_angle_deg)
        };
        let mut square = 0.0;
        for (one, parts) in varying.iter().zip(&parts) {
            let mut slope = 0.0;
            for (variable, change) in parts {
                slope += change * slope_of(variable)?;
            }
            square += (slope * one.deviation).powi(2);
        }
        Some(square.sqrt())
    };
    ends.into_iter().map(deviation).collect()
}
