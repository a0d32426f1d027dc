//! Elements of schematics: outlines, arcs and dimension lines.

use crate::render::{Ink, Note};
use crate::scene::{Pole, Whisker};
use glam::DVec2;
use serde::Serialize;
use whiskmap_mechanics::rod::{Rest, Side};

/// Magnification of radii relative to lengths in schematics, dimensionless.
pub const MAGNIFIED: f64 = 50.0;

/// Cross-section of a whisker at rest, for its outline.
#[derive(Clone, Copy, Serialize)]
pub struct OutlineSection {
    /// Arclength of the cross-section from the base, in mm.
    pub arc_length_mm: f64,
    /// Coordinate of the cross-section along the tangent at the base, in mm.
    pub x_mm: f64,
    /// Coordinate of the cross-section across the tangent at the base, to its left, in mm.
    pub y_mm: f64,
    /// Radius of the whisker at the cross-section, in um.
    pub radius_um: f64,
}

/// Returns `count` cross-sections of a whisker at rest, evenly spaced from base to tip, `[section]`.
pub fn sections(whisker: &Whisker, count: usize) -> Vec<OutlineSection> {
    let rest = Rest::new(&whisker.rod(&Pole::smooth(0.0), Side::Cb));
    let at = |s: f64| {
        let place = rest.at_arclength(s).0 * whisker.length_mm;
        let (base, tip) = (whisker.base_radius_um, whisker.tip_radius_um);
        OutlineSection {
            arc_length_mm: s * whisker.length_mm,
            x_mm: place.x,
            y_mm: place.y,
            radius_um: (tip - base).mul_add(s, base),
        }
    };
    let last = count - 1;
    (0..=last).map(|i| at(i as f64 / last as f64)).collect()
}

/// Returns the closed outline of a whisker through its `sections`: `[point][x, y]` in mm. Radii are multiplied by [`MAGNIFIED`].
pub fn outline(sections: &[OutlineSection]) -> Vec<[f64; 2]> {
    let places: Vec<DVec2> = sections.iter().map(|at| DVec2::new(at.x_mm, at.y_mm)).collect();
    let side = |i: usize, sign: f64| {
        let (before, after) = (i.saturating_sub(1), (i + 1).min(places.len() - 1));
        let normal = (places[after] - places[before]).normalize().perp();
        let radius_mm = 1e-3 * sections[i].radius_um;
        (places[i] + sign * MAGNIFIED * radius_mm * normal).to_array()
    };
    let left = (0..places.len()).map(|i| side(i, 1.0));
    let right = (0..places.len()).rev().map(|i| side(i, -1.0));
    left.chain(right).chain([side(0, 1.0)]).collect()
}

/// Returns an arc around the origin, between two angles in radians: `[point][x, y]` in the unit of `radius`.
pub fn arc(radius: f64, [from, to]: [f64; 2]) -> Vec<[f64; 2]> {
    const STEPS: u32 = 24;
    let angle = |step: u32| (to - from).mul_add(f64::from(step) / f64::from(STEPS), from);
    (0..=STEPS).map(|step| (radius * DVec2::from_angle(angle(step))).to_array()).collect()
}

/// Returns notes that draw an arrow with heads at both ends, and a text above its middle.
pub fn extent(from: [f64; 2], to: [f64; 2], words: &str) -> [Note; 3] {
    let middle = [0, 1].map(|axis| 0.5 * (from[axis] + to[axis]));
    [
        Note::arrow(from, to, "", Ink::Grey),
        Note::arrow(to, from, "", Ink::Grey),
        Note::text(middle, words),
    ]
}
