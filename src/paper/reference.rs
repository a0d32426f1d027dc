//! Checks against detachment points of AUTO-07p, for the paper's boundary-value problem solved forward from the base.

use super::check::{AUTO, Check, near};
use super::whiskers::whisker;
use crate::scene::Pole;
use crate::trace::{DetachmentKind, curve};
use serde::Deserialize;
use whiskmap_mechanics::rod::Side;

const POINTS: &str = include_str!("../../tests/data/detachment.csv");

/// A row of the reference file; angles in degrees with 9 decimals.
#[derive(Clone, Debug, Deserialize)]
struct ReferencePoint {
    length_mm: f64,
    base_radius_um: f64,
    tip_radius_um: f64,
    parabola_per_mm: f64,
    vertex_mm: f64,
    pole_radius_mm: f64,
    modulus_gradient: f64,
    projection: f64,
    side: String,
    distance_mm: f64,
    kind: DetachmentKind,
    push_angle_deg: f64,
    arc_length_mm: f64,
}

impl ReferencePoint {
    /// Differences in kind (0 or 1), push angle (degrees) and arclength (whisker lengths).
    fn differences(&self) -> [f64; 3] {
        let mut whisker = whisker(
            [self.length_mm, self.base_radius_um, self.tip_radius_um],
            self.parabola_per_mm,
            self.vertex_mm,
        );
        whisker.arc_stretch = self.projection;
        let side = match &*self.side {
            "CB" => Side::Cb,
            _ => Side::Cf,
        };
        let pole = Pole::smooth(self.pole_radius_mm);
        let end = curve(&whisker, &pole, side, &[self.distance_mm])[0];
        let miss = |computed: Option<f64>, known: f64| {
            let miss = computed.map(|computed| (computed - known).abs());
            miss.filter(|miss| miss.is_finite()).unwrap_or(f64::INFINITY)
        };
        [
            f64::from(u8::from(end.kind != self.kind)),
            miss(end.push_angle_deg, self.push_angle_deg),
            miss(end.arc_length_mm, self.arc_length_mm) / self.length_mm,
        ]
    }
}

/// Returns checks against AUTO-07p, `[check]`: the largest differences over all points with modelled effects, and the number of points.
pub fn checks() -> Vec<Check> {
    let points: Vec<ReferencePoint> = csv::Reader::from_reader(POINTS.as_bytes())
        .deserialize()
        .filter_map(Result::ok)
        .filter(|point: &ReferencePoint| point.modulus_gradient == 0.0)
        .collect();
    let worst =
        points.iter().map(ReferencePoint::differences).fold([0.0_f64; 3], |worst, differences| {
            std::array::from_fn(|i| worst[i].max(differences[i]))
        });
    let count = points.len() as f64;
    let check = |quantity, expected, computed| {
        near("reference file", quantity, AUTO, expected, Some(computed))
    };
    vec![
        check("points compared", (40.0, 0.0), count),
        check("kinds that differ", (0.0, 0.0), worst[0]),
        check("worst push angle (deg)", (0.0, 1e-8), worst[1]),
        check("worst arc length (L_w)", (0.0, 1e-8), worst[2]),
    ]
}
