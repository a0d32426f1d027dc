//! The whisker in one state, from base to tip.

use super::columns::row;
use super::{Branch, FINER, Found};
use crate::classify::Sliding;
use crate::rod::{Rest, arclength};
use crate::shooting::shape::{RodPoint, profile};
use glam::DVec2;
use serde::Serialize;

/// The shape of a whisker in front of its pole: origin at the base, first axis along the base's tangent at first
/// touch; since then the base has turned, and the pole has stayed where it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// From the base to the tip.
    pub points: Vec<ShapePoint>,
    /// Centre of the pole.
    pub pole_mm: [f64; 2],
    /// Its radius.
    pub pole_radius_mm: f64,
    /// Distance of the computed pole from where it stands, in whisker lengths.
    pub residual: f64,
    /// Which way the contact slides as the branch goes on, or that it sticks; `None` without friction.
    pub sliding: Option<Sliding>,
}

row! {
    /// One place of a whisker.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    pub struct ShapePoint {
        /// Arclength from the base.
        pub arc_length_mm: f64,
        /// Position along the base's tangent at first touch; the base is at 0.
        pub x_mm: f64,
        /// Position across it, to the left: the CF side of a curved whisker.
        pub y_mm: f64,
        /// Angle of the tangent, from the base's tangent at first touch.
        pub angle_deg: f64,
        /// Curvature of the bent whisker.
        pub curvature_per_mm: f64,
        /// Bending moment in the whisker.
        pub moment_nnm: f64,
        /// loaded (before the contact), contact or free (beyond it).
        pub part: Part,
    }
}

/// The parts of a whisker in contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Part {
    /// Bent by the pole.
    Loaded,
    /// Touching it.
    Contact,
    /// Beyond it.
    Free,
}

impl Shape {
    /// The shape in the state `found` on `branch`: `count` places spread evenly along the whisker, and the contact.
    #[must_use]
    pub fn new(branch: &Branch, found: &Found, count: usize) -> Self {
        let (rod, row, units) = (&branch.level.rod, branch.row(), &branch.units);
        let contact = arclength(rod, found.tau).min(1.0);
        let mut at: Vec<f64> = uniform(count).filter(|s| *s != contact).collect();
        let index = at.partition_point(|s| *s < contact);
        at.insert(index, contact);
        let state = (DVec2::new(found.tau, found.load), found.push);
        let places = profile(rod, found.tau, found.load, FINER, &at);
        // From the axes of the contact to those of first touch: the base's tangent is at `-push` there.
        let base = &found.full;
        let to_base = DVec2::new(base.tangent.x, -base.tangent.y);
        let turn = DVec2::from_angle(-found.push).rotate(to_base);
        let pole = turn.rotate(rod.to_pole() - base.position);
        let length = units.length_mm;
        let mut angle = -found.push;
        let points = places.iter().enumerate().map(|(i, place)| {
            let RodPoint {
                position, tangent, ..
            } = *place;
            let at = turn.rotate(position - base.position) * length;
            angle = crate::numerics::nearest_turn(turn.rotate(tangent).to_angle(), angle);
            ShapePoint {
                arc_length_mm: place.arclength * length,
                x_mm: at.x,
                y_mm: at.y,
                angle_deg: angle.to_degrees(),
                curvature_per_mm: place.curvature / length,
                moment_nnm: place.moment * units.moment_nnm,
                part: match i.cmp(&index) {
                    std::cmp::Ordering::Less => Part::Loaded,
                    std::cmp::Ordering::Equal => Part::Contact,
                    std::cmp::Ordering::Greater => Part::Free,
                },
            }
        });
        Self {
            points: points.collect(),
            pole_mm: (pole * length).to_array(),
            pole_radius_mm: rod.pole.abs() * length,
            residual: found.full.map.pole.distance(row.pole(found.push)),
            sliding: branch
                .slidings(&[state], usize::from(found.stable))
                .pop()
                .flatten(),
        }
    }

    /// The resting whisker at first touch, `count` points in the same axes.
    #[must_use]
    pub fn at_rest(branch: &Branch, count: usize) -> Vec<[f64; 2]> {
        let rest = Rest::new(&branch.level.rod);
        uniform(count)
            .map(|s| (rest.at_arclength(s).0 * branch.units.length_mm).to_array())
            .collect()
    }
}

/// `count` numbers, at least 2, from 0 to 1.
fn uniform(count: usize) -> impl Iterator<Item = f64> {
    let last = count.max(2) - 1;
    (0..=last).map(move |i| i as f64 / last as f64)
}
