//! Sensitivities of detachments as bars: what a change of 1 % of each variable does to the push angle.

use super::labels;
use crate::sensitivity::{Variable, VariableEffect};
use whiskmap_mechanics::rod::Side;
use whiskmap_plot::{Band, Plot, Shade};

/// Half the height of a bar, where the distance of two variables is 1.
const HALF: f64 = 0.2;

/// Returns a bar chart of the changes of the push angle at detachment for a change of 1 % of each variable, with one bar for each side. The
/// variable with the largest effect is at the top; those without any are left out.
#[must_use]
pub fn sensitivities(effects: &[VariableEffect]) -> Plot {
    let mut variables: Vec<(Variable, f64)> = Vec::new();
    for effect in effects {
        let size = effect.push_of_1_percent_deg.map_or(0.0, f64::abs);
        match variables.iter_mut().find(|(variable, _)| *variable == effect.variable) {
            Some((_, most)) => *most = size.max(*most),
            None => variables.push((effect.variable, size)),
        }
    }
    variables.retain(|(_, most)| *most > 0.0);
    variables.sort_by(|(_, a), (_, b)| a.total_cmp(b));
    let bar = |effect: &VariableEffect| {
        let (size, place) = (effect.push_of_1_percent_deg?, variables.iter());
        let row = place.clone().position(|(variable, _)| *variable == effect.variable)? as f64;
        let (shade, row) = match effect.side {
            Side::Cb => (Shade::Dark, row + HALF),
            Side::Cf => (Shade::Light, row - HALF),
        };
        let edge = |y: f64| [[0.0, y], [size, y]];
        Some(Band {
            points: vec![edge(row - HALF), edge(row + HALF)],
            shade,
            name: Some(format!("{} push", effect.side)),
        })
    };
    Plot {
        x_label: labels::PUSH_CHANGE.to_owned(),
        y_names: variables.iter().map(|(variable, _)| variable.name()).collect(),
        bands: effects.iter().filter_map(bar).collect(),
        ..Plot::default()
    }
}
