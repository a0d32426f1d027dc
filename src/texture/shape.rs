//! Shape of the whisker in a sample of a course behind a surface.

use super::TextureSample;
use super::tip::TipFrame;
use crate::scene::{Surface, Whisker};
use crate::trace::{NoState, StableBranch};
use glam::DVec2;
use whiskmap_mechanics::rod::Rest;

/// Returns the shape of `whisker` behind `surface` in a sample: at least `count` points `[x, y]` in mm from the base, along the surface
/// and toward it. An undecided sample has no points.
///
/// # Errors
/// If the state of the sample is not found again, as behind another surface.
pub fn shape(
    whisker: &Whisker,
    surface: &Surface,
    sample: &TextureSample,
    count: usize,
) -> Result<Vec<[f64; 2]>, NoState> {
    if sample.reason.is_some() {
        return Ok(Vec::new());
    }
    let angle = sample.angle_deg.to_radians();
    let held = sample.asperity.zip(sample.side).zip(sample.push_angle_deg);
    let Some(((asperity, side), push_deg)) = held else {
        let tips = TipFrame::new(whisker, surface);
        let last = count.max(2) - 1;
        let points = (0..=last).map(|i| tips.resting(i as f64 / last as f64, angle).to_array());
        return Ok(points.collect());
    };
    let pole = surface.asperity();
    let along = surface.asperities_mm().get(asperity).copied();
    let along = along.ok_or(NoState::Failed { push_deg })?;
    let centre = DVec2::new(along, surface.distance_mm);
    let rest = Rest::new(&whisker.rod(&pole, side));
    let distance = rest.distance_of_pole(centre.length() / whisker.length_mm);
    let branch = StableBranch::new(whisker, &pole, side, distance * whisker.length_mm)?;
    let shape = branch.shape(&branch.state(push_deg.to_radians())?, count);
    // Rotation from the axes of first touch to the axes of the surface.
    let turn = centre.to_angle() - DVec2::from(shape.pole_mm).to_angle();
    let turn = DVec2::from_angle(turn);
    let points = shape.points.iter();
    let points = points.map(|point| turn.rotate(DVec2::new(point.x_mm, point.y_mm)).to_array());
    Ok(points.collect())
}
