//! Shape of the whisker in one state, from base to tip.

use super::columns::row;
use super::{BranchPoint, FINER, StableBranch, StateAtPush};
use glam::DVec2;
use serde::Serialize;
use std::ops::RangeInclusive;
use whiskmap_mechanics::rod::{Rest, arclength};
use whiskmap_mechanics::shooting::bending_strain;
use whiskmap_mechanics::shooting::shape::{RodPoint, profile};

/// Numbers of points of a shape that can be requested, besides the contact.
pub const SHAPE_POINTS: RangeInclusive<u32> = 2..=1_000_000;

/// Shape of a whisker at its pole, in mm in the frame of the pole: the origin is at the base, the first axis along the base's tangent at
/// first touch. A push rotates the base and leaves the pole.
#[derive(Clone, Debug, PartialEq)]
pub struct WhiskerShape {
    /// Points of the whisker's shape, from the base to the tip, `[point]`.
    pub points: Vec<ShapePoint>,
    /// Centre of the pole in front of the whisker, `[x, y]` in mm.
    pub pole_mm: [f64; 2],
    /// Radius of the pole in front of the whisker, in mm.
    pub pole_radius_mm: f64,
    /// Distance of the computed pole from its true position, in whisker lengths.
    pub residual: f64,
    /// State of the whisker: its loads, energy, largest strain and sliding direction.
    pub state: BranchPoint,
}

row! {
    /// Point of the shape of a bent whisker.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    pub struct ShapePoint {
        /// Arclength from the base to the point, in mm.
        pub arc_length_mm: f64,
        /// Position along the base's tangent at first touch, in mm; the base is at 0.
        pub x_mm: f64,
        /// Position to the left of the base's tangent at first touch, in mm: the CF side.
        pub y_mm: f64,
        /// Angle of the tangent, from the base's tangent at first touch, in degrees.
        pub angle_deg: f64,
        /// Curvature of the bent whisker at the point, in 1/mm.
        pub curvature_per_mm: f64,
        /// Bending moment in the whisker at the point, in nN m.
        pub moment_nnm: f64,
        /// Bending strain at the surface: radius times change of curvature.
        pub strain: f64,
        /// Part of the whisker: loaded (before the contact), contact or free (beyond it).
        pub part: WhiskerPart,
    }
}

/// Part of a whisker in contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum WhiskerPart {
    /// The part between the base and the contact, bent by the pole.
    Loaded,
    /// The point of contact with the pole.
    Contact,
    /// The part between the contact and the tip, without load.
    Free,
}

impl StableBranch {
    /// Returns the shape in the state `found`, at `count` points evenly spaced along the whisker and at the contact.
    #[must_use]
    pub fn shape(&self, found: &StateAtPush, count: usize) -> WhiskerShape {
        let (rod, row, units) = (&*self.rod(found.ratio), self.row(), &self.units);
        let contact = arclength(rod, found.point.x).min(1.0);
        let mut at: Vec<f64> = uniform(count).filter(|s| *s != contact).collect();
        let index = at.partition_point(|s| *s < contact);
        at.insert(index, contact);
        let places = profile(rod, found.point.x, found.point.y, FINER, &at);
        // Rotation from the axes of the contact to the axes of first touch, where the base's tangent is at `-push`.
        let base = &found.full;
        let to_base = DVec2::new(base.tangent.x, -base.tangent.y);
        let turn = DVec2::from_angle(-found.signed_push).rotate(to_base);
        let pole = turn.rotate(rod.to_pole() - base.position);
        let length = units.length_mm;
        let mut angle = -found.signed_push;
        let points = places.iter().enumerate().map(|(i, place)| {
            let RodPoint { position, tangent, .. } = *place;
            let at = turn.rotate(position - base.position) * length;
            angle =
                whiskmap_mechanics::numerics::nearest_turn(turn.rotate(tangent).to_angle(), angle);
            ShapePoint {
                arc_length_mm: place.arclength * length,
                x_mm: at.x,
                y_mm: at.y,
                angle_deg: angle.to_degrees(),
                curvature_per_mm: place.curvature / length,
                moment_nnm: place.moment * units.moment_nnm,
                strain: bending_strain(rod, place.arclength, place.moment) * units.strain,
                part: match i.cmp(&index) {
                    std::cmp::Ordering::Less => WhiskerPart::Loaded,
                    std::cmp::Ordering::Equal => WhiskerPart::Contact,
                    std::cmp::Ordering::Greater => WhiskerPart::Free,
                },
            }
        });
        WhiskerShape {
            points: points.collect(),
            pole_mm: (pole * length).to_array(),
            pole_radius_mm: rod.pole.abs() * length,
            residual: found.full.map.pole.distance(row.pole(found.signed_push)),
            state: self.point_of(found),
        }
    }

    /// Returns the shape of the resting whisker at first touch: `count` points `[x, y]` in mm, in the axes of [`WhiskerShape`].
    #[must_use]
    pub fn at_rest(&self, count: usize) -> Vec<[f64; 2]> {
        let rest = Rest::new(&self.path.level.rod);
        uniform(count).map(|s| (rest.at_arclength(s).0 * self.units.length_mm).to_array()).collect()
    }
}

/// Evenly spaced numbers from 0 to 1: `count`, but at least 2.
fn uniform(count: usize) -> impl Iterator<Item = f64> {
    let last = count.max(2) - 1;
    (0..=last).map(move |i| i as f64 / last as f64)
}
