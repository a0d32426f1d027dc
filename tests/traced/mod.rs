//! Traced shapes: fits to points, scenes with them, and detachments of whiskers whose shapes were traced.

mod fits;
mod pushes;
mod refused;

use glam::DVec2;
use whiskmap::mechanics::rod::{CurvaturePolynomial, Rest, Rod, Side};
use whiskmap::scene::{Pole, Whisker};

use crate::random_rods::Random;

/// Points along the whisker of `rod` at rest, `length_mm` long, turned and moved, with errors of a standard deviation in millimetres.
pub fn points(
    rod: &Rod,
    length_mm: f64,
    count: u32,
    error_mm: f64,
    random: &mut Random,
) -> Vec<[f64; 2]> {
    let rest = Rest::new(rod);
    let turned = DVec2::from_angle(-0.4);
    let mut normal = || {
        let radius = (-2.0 * (1.0 - random.unit()).ln()).sqrt();
        radius * (std::f64::consts::TAU * random.unit()).cos()
    };
    let point = |i: u32| {
        let (point, _) = rest.at_arclength(f64::from(i) / f64::from(count - 1));
        let error = error_mm * DVec2::new(normal(), normal());
        (length_mm * turned.rotate(point) + DVec2::new(3.0, -8.0) + error).into()
    };
    (0..count).map(point).collect()
}

/// A rod with this curvature at rest.
pub fn bent(legendre: [f64; 7]) -> Rod {
    Rod { polynomial: Some(CurvaturePolynomial::new(legendre).into()), ..Rod::default() }
}

/// A whisker at rest, as a rod.
pub fn resting(whisker: &Whisker) -> Rod {
    whisker.rod(&Pole::smooth(0.0), Side::Cb)
}
