//! Measured detachments: comparison with a scene, and fits.

use serde::Deserialize;
use serde_json::{Value, json};
use whiskmap::measured::{Comparison, MeasuredPoints};
use whiskmap::scene::{Parameter, Scene, SweepPlace};

/// Task: compare measured detachments with a scene, or fit the scene to them.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointsTask {
    /// CSV text of the points.
    csv: String,
    /// Name of the points' file in messages.
    name: String,
    /// Names of the parameters to fit; none for a comparison.
    free: Vec<String>,
}

impl PointsTask {
    /// Returns the points with the predictions of `scene`, or of its best fit. If the points name their whiskers, only the points of the
    /// whisker at `place` count.
    pub fn respond(&self, scene: &Scene, place: &SweepPlace) -> Result<Value, String> {
        let all = MeasuredPoints::parse(&self.csv, &self.name);
        let at_place = all.and_then(|points| points.at(place));
        let points = at_place.map_err(|why| why.to_string())?;
        let free = self.free.iter().filter_map(|name| Parameter::named(name));
        let free: Vec<Parameter> = free.collect();
        if free.is_empty() {
            let whisker = scene.first_whisker();
            let reach = points.check_reach(&whisker.whisker, &whisker.pole);
            reach.map_err(|why| why.to_string())?;
            let beside = points.beside(&whisker.whisker, &whisker.pole);
            return Ok(
                json!({ "angle": points.angle.column(), "beside": comparison(&beside), "note": points.note }),
            );
        }
        let fit = whiskmap::fit(scene, &points, &free).map_err(|why| why.to_string())?;
        let estimates = fit.estimates.iter().map(|estimate| {
            json!({
                "name": estimate.parameter.name(),
                "value": estimate.value,
                "standard_error": estimate.standard_error,
                "is_at_limit": estimate.is_at_limit,
            })
        });
        Ok(json!({
            "angle": points.angle.column(),
            "beside": comparison(&fit.comparison),
            "estimates": estimates.collect::<Vec<_>>(),
            "chi_square": fit.chi_square,
            "degrees_of_freedom": fit.degrees_of_freedom,
            "not_a_fit": fit.not_a_fit.map(|why| why.to_string()),
        }))
    }
}

fn comparison(comparison: &Comparison) -> Value {
    json!({
        "rows": comparison.rows,
        "count": comparison.count(),
        "of_another_kind": comparison.of_another_kind(),
        "rms_deg": comparison.rms_deg(),
        "bias_deg": comparison.bias_deg(),
    })
}
