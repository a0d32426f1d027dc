//! Shapes of a whisker along a course against one pole.

use super::{Whisk, WhiskSample};
use crate::scene::{Pole, Whisker};
use crate::trace::{NoState, StableBranch, WhiskerPart, WhiskerShape};
use glam::DVec2;
use whiskmap_mechanics::rod::{Rest, Side};

/// Shapes of a whisker along a course, from the branches on which its states lie. Lengths are in mm in the axes of first touch on CB, where the
/// pole stands still: the origin is at the base, and the first axis along the base's tangent.
pub struct CourseShapes {
    cb: StableBranch,
    /// The reason if the resting whisker does not reach the pole on CF.
    cf: Result<StableBranch, NoState>,
    cf_touch_deg: f64,
    /// Centre of the pole, `[x, y]`.
    pub pole_mm: [f64; 2],
}

impl CourseShapes {
    /// Follows the branches of the course `found` of `whisker` in front of `pole`, which first touches it at `distance_mm` from the base on CB.
    ///
    /// # Errors
    /// If the branch on CB is not found.
    pub fn new(
        whisker: &Whisker,
        pole: &Pole,
        distance_mm: f64,
        found: &Whisk,
    ) -> Result<Self, NoState> {
        let cb = StableBranch::new(whisker, pole, Side::Cb, distance_mm)?;
        let rest = Rest::new(&whisker.rod(pole, Side::Cf));
        let cf_distance = rest.distance_of_pole(cb.row().pole_distance);
        Ok(Self {
            cf: StableBranch::new(whisker, pole, Side::Cf, cf_distance * whisker.length_mm),
            cf_touch_deg: found.cf_touch_deg,
            pole_mm: (cb.row().pole(0.0) * whisker.length_mm).to_array(),
            cb,
        })
    }

    /// Returns the shape of the bent whisker in a sample, at `count` points and at the contact, in the axes of first touch on its side; `None`
    /// without contact.
    ///
    /// # Errors
    /// If the branch has no such state.
    pub fn bent(
        &self,
        sample: &WhiskSample,
        count: usize,
    ) -> Result<Option<WhiskerShape>, NoState> {
        let Some((side, push_deg)) = sample.side.zip(sample.push_angle_deg) else {
            return Ok(None);
        };
        let branch = match side {
            Side::Cb => &self.cb,
            Side::Cf => self.cf.as_ref().map_err(|why| *why)?,
        };
        let state = branch.state(push_deg.to_radians())?;
        Ok(Some(branch.shape(&state, count)))
    }

    /// Returns `count` evenly spaced points `[x, y]` of the whisker in a sample. If `with_contact` is true, a bent whisker has a point at the
    /// contact, too. The points of a sample without an angle are NaN.
    ///
    /// # Errors
    /// If the branch has no such state.
    pub fn points(
        &self,
        sample: &WhiskSample,
        count: usize,
        with_contact: bool,
    ) -> Result<Vec<[f64; 2]>, NoState> {
        let (points, turn_deg) = match self.bent(sample, count)? {
            Some(shape) => {
                // The contact lies between the evenly spaced points, or on one of them.
                let has_extra = shape.points.len() > count && !with_contact;
                let points = shape.points.iter();
                let points =
                    points.filter(|point| !has_extra || point.part != WhiskerPart::Contact);
                let turn_deg = match sample.side {
                    Some(Side::Cf) => -self.cf_touch_deg,
                    _ => 0.0,
                };
                (points.map(|point| [point.x_mm, point.y_mm]).collect(), turn_deg)
            }
            None => {
                let angle_deg = sample.angle_deg.unwrap_or(f64::NAN);
                (self.cb.at_rest(count), -angle_deg)
            }
        };
        let turn = DVec2::from_angle(turn_deg.to_radians());
        let turned = points.into_iter().map(|at| turn.rotate(at.into()));
        Ok(turned.map(|at| at.to_array()).collect())
    }
}
