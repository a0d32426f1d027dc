//! Numbers of a scene that vary randomly.

use crate::scene::{Deviations, Parameter, Scene, SceneError};
use crate::sensitivity::Variable;

/// Number of a scene that varies randomly.
#[derive(Clone, Copy, Debug)]
pub(super) struct Varying {
    source: VaryingSource,
    /// Value of the number in the scene, in the unit of the parameter or, for a row of the profile, in micrometres.
    pub value: f64,
    /// Standard deviation of the number, in the same unit, more than 0.
    pub deviation: f64,
}

/// Place of a number in the scene.
#[derive(Clone, Copy, Debug)]
enum VaryingSource {
    Parameter(Parameter),
    /// Radius of a row of the profile, in micrometres.
    Row(usize),
}

/// Returns the numbers of `scene` whose `deviations` are not 0, `[number]`.
pub(super) fn varying(scene: &Scene, deviations: &Deviations) -> Vec<Varying> {
    let parameters = deviations.parameters.iter().filter_map(|&(parameter, deviation)| {
        Some(Varying {
            source: VaryingSource::Parameter(parameter),
            value: parameter.value(scene)?,
            deviation,
        })
    });
    let rows = deviations.profile_radius_um.map(|deviation| {
        let rows = rows(scene).into_iter().enumerate();
        rows.map(move |(row, [_, value])| Varying {
            source: VaryingSource::Row(row),
            value,
            deviation,
        })
    });
    let all = parameters.chain(rows.into_iter().flatten());
    all.filter(|one| one.deviation > 0.0).collect()
}

impl Varying {
    /// Returns the variables of the whisker that the number of `scene` changes, each with its change per unit of the number. The cone beyond
    /// the last measured row follows the last two rows. A measured radius changes all smoothed ones.
    /// With a taper in `all`, the radius at the tip follows the radius at the base.
    pub(super) fn variables(&self, scene: &Scene, all: &[Self]) -> Vec<(Variable, f64)> {
        let is_taper =
            |one: &Self| matches!(one.source, VaryingSource::Parameter(Parameter::Taper));
        let row = match self.source {
            VaryingSource::Parameter(Parameter::BaseRadiusUm) if all.iter().any(is_taper) => {
                let tip = 1.0 - scene.whisker.taper();
                return vec![
                    (Parameter::BaseRadiusUm.into(), 1.0),
                    (Parameter::TipRadiusUm.into(), tip),
                ];
            }
            VaryingSource::Parameter(parameter) => return vec![(parameter.into(), 1.0)],
            VaryingSource::Row(row) => row,
        };
        let rows = rows(scene);
        let changes = match scene.smooth_radii() {
            Some(smooth) => smooth.by_measured(row),
            None => (0..rows.len()).map(|other| f64::from(u8::from(other == row))).collect(),
        };
        let changed = changes.iter().enumerate().filter(|(_, change)| **change != 0.0);
        let mut variables: Vec<(Variable, f64)> = changed
            .map(|(changed_row, change)| (Variable::ProfileRadiusUm(changed_row), *change))
            .collect();
        let extension = scene.whisker.length_mm - rows[rows.len() - 1][0];
        let has_cone = scene.whisker.profile.as_ref().map_or(0, Vec::len) > rows.len();
        if let ([.., [from, _], [end, _]], [.., before, last], true) =
            (&rows[..], &changes[..], has_cone)
        {
            let growth = extension / (end - from);
            let change = last + growth * (last - before);
            if change != 0.0 {
                variables.push((Variable::ProfileRadiusUm(rows.len()), change));
            }
        }
        variables
    }
}

/// Returns the scene with each number moved by its step.
///
/// # Errors
/// If the scene is refused with these numbers.
pub(super) fn moved(scene: &Scene, steps: &[(Varying, f64)]) -> Result<Scene, SceneError> {
    let mut builder = scene.to_builder();
    let mut rows = rows(scene);
    for (Varying { source, value, .. }, step) in steps {
        match *source {
            VaryingSource::Parameter(parameter) => builder = builder.set(parameter, value + step),
            VaryingSource::Row(row) => rows[row][1] = value + step,
        }
    }
    if steps.iter().any(|(one, _)| matches!(one.source, VaryingSource::Row(_))) {
        builder = builder.profile(rows);
    }
    builder.build()
}

/// Arclength in millimetres and radius in micrometres of the measured rows.
fn rows(scene: &Scene) -> Vec<[f64; 2]> {
    scene.measured_rows().unwrap_or_default().to_vec()
}
