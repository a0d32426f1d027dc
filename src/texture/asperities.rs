//! Asperities of a surface as obstacles of a sweep.

use super::TextureError;
use super::tip::TipFrame;
use crate::scene::{Pole, Surface, Whisker};
use crate::sheet::Row;
use crate::whisk::phase::{ContactEnd, Obstacles, Phase, ROUNDING};
use crate::whisk::states::{BothSides, SideStates};
use whiskmap_mechanics::rod::{Rest, Side};

/// Asperities that the resting whisker reaches, from left to right. The number of an obstacle is the index of its asperity here.
pub struct Asperities {
    reached: Vec<Asperity>,
}

/// Asperity within reach.
struct Asperity {
    /// Number of the asperity on its surface.
    number: usize,
    /// Position along the surface, in mm.
    x_mm: f64,
    cb: AsperityTouch,
    cf: AsperityTouch,
}

/// First touch of an asperity on one side.
#[derive(Clone, Copy)]
struct AsperityTouch {
    /// Angle of the base at the touch, in radians.
    angle: f64,
    /// Distance from the base to the contact, in mm; `None` if the resting whisker does not reach it.
    distance_mm: Option<f64>,
    /// Row of the states of this side.
    row: usize,
    /// End of a push; `None` if the resting whisker does not reach the asperity.
    end: Option<ContactEnd>,
}

impl Asperities {
    /// Finds the asperities within reach of `whisker`, and computes the ends of all pushes against them.
    pub fn new(
        whisker: &Whisker,
        surface: &Surface,
        tips: &TipFrame,
    ) -> Result<(Self, BothSides), TextureError> {
        let pole = surface.asperity();
        let rests = [Side::Cb, Side::Cf].map(|side| Rest::new(&whisker.rod(&pole, side)));
        let farthest_mm = whisker.length_mm + pole.radius_mm;
        let places = surface.asperities_mm().into_iter().enumerate();
        let reached = places.filter_map(|(number, x_mm)| {
            let pole_mm = libm::hypot(x_mm, surface.distance_mm);
            if pole_mm > farthest_mm {
                return None;
            }
            let direction = libm::atan2(surface.distance_mm, x_mm);
            let [cb, cf] = rests.each_ref().map(|rest| {
                let distance = rest.distance_of_pole(pole_mm / whisker.length_mm);
                let row = Row::new(rest, distance);
                let distance_mm = row.is_reached().then_some(distance * whisker.length_mm);
                AsperityTouch {
                    angle: row.touch - direction + tips.tangent,
                    distance_mm,
                    row: 0,
                    end: None,
                }
            });
            let is_reached = cb.distance_mm.or(cf.distance_mm).is_some();
            is_reached.then_some(Asperity { number, x_mm, cb, cf })
        });
        let mut asperities = Self { reached: reached.collect() };
        asperities.check_gaps()?;
        let states = BothSides {
            cb: asperities.solve(Side::Cb, whisker, &pole)?,
            cf: asperities.solve(Side::Cf, whisker, &pole)?,
        };
        Ok((asperities, states))
    }

    /// Checks that the resting whisker fits between neighbours, so that it meets the surface once.
    fn check_gaps(&self) -> Result<(), TextureError> {
        let mut pairs = self.reached.windows(2);
        let blocked = pairs.find(|pair| pair[0].cf.angle >= pair[1].cb.angle);
        blocked.map_or(Ok(()), |pair| {
            Err(TextureError::Blocked {
                asperities: [pair[0].number, pair[1].number],
                x_mm: [pair[0].x_mm, pair[1].x_mm],
            })
        })
    }

    /// Computes the ends of the pushes on one side. Asperities at equal distances share a row.
    fn solve(
        &mut self,
        side: Side,
        whisker: &Whisker,
        pole: &Pole,
    ) -> Result<Option<SideStates>, TextureError> {
        let mut touches: Vec<(usize, &mut AsperityTouch)> = Vec::new();
        for asperity in &mut self.reached {
            let touch = match side {
                Side::Cb => &mut asperity.cb,
                Side::Cf => &mut asperity.cf,
            };
            if touch.distance_mm.is_some() {
                touches.push((asperity.number, touch));
            }
        }
        let mut distances: Vec<f64> =
            touches.iter().filter_map(|(_, touch)| touch.distance_mm).collect();
        distances.sort_by(f64::total_cmp);
        distances.dedup();
        if distances.is_empty() {
            return Ok(None);
        }
        let row = |touch: &AsperityTouch| {
            let touch_mm = touch.distance_mm.unwrap_or_default();
            distances.partition_point(|distance| *distance < touch_mm)
        };
        for (_, touch) in &mut touches {
            touch.row = row(touch);
        }
        let states = SideStates::new(whisker, pole, side, &distances).map_err(|row| {
            let first = touches.iter().find(|(_, touch)| touch.row == row);
            let asperity = first.map_or(0, |(number, _)| *number);
            TextureError::Unresolved { asperity, side }
        })?;
        for (_, touch) in touches {
            touch.end = Some(states.end(touch.row));
        }
        Ok(Some(states))
    }

    /// Returns the number of asperities within reach.
    pub fn len(&self) -> usize {
        self.reached.len()
    }

    /// Returns the number of an obstacle on the surface, and its position along the surface in mm.
    pub fn place(&self, obstacle: i32) -> (usize, f64) {
        let asperity = &self.reached[obstacle as usize];
        (asperity.number, asperity.x_mm)
    }

    /// Returns the index of the row with the states against an obstacle on `side`.
    pub fn row(&self, side: Side, obstacle: i32) -> usize {
        self.of(side, obstacle).map_or(0, |touch| touch.row)
    }

    /// Returns the phase in which a course begins at `angle`, in radians: at rest between two asperities.
    pub fn begin(&self, angle: f64) -> Result<Phase, TextureError> {
        let before = |asperity: &Asperity| asperity.cb.angle + ROUNDING < angle;
        let after = self.reached.partition_point(before) as i32 - 1;
        match self.of(Side::Cf, after) {
            Some(touch) if angle < touch.angle - ROUNDING => Err(TextureError::Begin {
                angle_deg: angle.to_degrees(),
                asperity: self.place(after).0,
                touches_deg: [Side::Cb, Side::Cf].map(|side| self.touch(side, after).to_degrees()),
            }),
            _ => Ok(Phase::Free { after }),
        }
    }

    fn of(&self, side: Side, obstacle: i32) -> Option<&AsperityTouch> {
        let index = usize::try_from(obstacle).ok()?;
        let asperity = self.reached.get(index)?;
        Some(match side {
            Side::Cb => &asperity.cb,
            Side::Cf => &asperity.cf,
        })
    }
}

impl Obstacles for Asperities {
    fn touch(&self, side: Side, obstacle: i32) -> f64 {
        let beyond = f64::INFINITY.copysign(f64::from(obstacle));
        self.of(side, obstacle).map_or(beyond, |touch| touch.angle)
    }

    fn end(&self, side: Side, obstacle: i32) -> Option<ContactEnd> {
        self.of(side, obstacle)?.end
    }
}
