//! Whiskers of the paper, and of the closed forms.

use crate::scene::{Curvature, Pole, Whisker};
use whiskmap_mechanics::rod::{Rest, Side};

/// Pole of the paper: radius 0.25 mm, without friction.
pub const POLE: Pole = Pole::smooth(0.25);

/// Centre of the pole in Figs. 2 and 3, in mm, in the frame of the base at first touch (CB; CF as in Fig. 3).
const fn pole_mm(side: Side) -> [f64; 2] {
    match side {
        Side::Cb => [15.13, 4.29],
        Side::Cf => [14.87, 4.71],
    }
}

/// Truncated cone of the paper's Figs. 2A, 2B and 3A-E.
pub const CONE: Whisker = whisker([20.0, 30.0, 1.5], 0.02, 0.0);

/// Cylinder of the paper's Figs. 2C, 2D and 3F-J.
pub const CYLINDER: Whisker = whisker([20.0, 30.0, 30.0], 0.02, 0.0);

/// Whisker of the paper's Fig. 4.
pub const FIG4_WHISKER: Whisker = whisker([15.25, 32.5, 2.0], 0.02, 0.0);

/// Hair of the paper's Fig. 4.
pub const FIG4_HAIR: Whisker = whisker([15.0, 30.0, 26.5], 0.017, 0.0);

/// Whisker of the paper's Fig. 6. The paper gives no curvature for it: this is the curvature of Fig. 4.
pub const FIG6_WHISKER: Whisker = whisker([16.4, 33.5, 2.0], 0.02, 0.0);

/// Blunt whisker of the paper's Fig. 5.
pub const FIG5_LEFT: Whisker = whisker([12.5, 35.0, 8.5], 0.02, 2.2);

/// Slender whisker of the paper's Fig. 5, which droops out of the plane: it is 3 % longer than it looks.
pub const FIG5_RIGHT: Whisker = {
    let mut whisker = whisker([15.3, 33.5, 2.0], 0.02, 2.2);
    whisker.arc_stretch = 1.03;
    whisker
};

/// Creates a whisker with length (mm), base and tip radius (um), parabola coefficient (1/mm) and vertex of the parabola (mm).
pub const fn whisker([length_mm, base, tip]: [f64; 3], a_per_mm: f64, vertex_mm: f64) -> Whisker {
    let mut whisker = Whisker::cone(length_mm, [base, tip], 3.0);
    if a_per_mm > 0.0 {
        whisker.curvature = Some(Curvature { parabola_per_mm: a_per_mm, vertex_mm });
    }
    whisker
}

/// Returns the distance in mm at which the pole of Figs. 2 and 3 first touches `whisker` on one side: the paper's d = 15.7 mm.
pub fn pole_distance_mm(whisker: &Whisker, side: Side) -> f64 {
    let rest = Rest::new(&whisker.rod(&POLE, side));
    let [x, y] = pole_mm(side);
    rest.distance_of_pole(x.hypot(y) / whisker.length_mm) * whisker.length_mm
}

/// Returns a cylinder with the length, the base and the curvature of `whisker`.
pub fn cylinder_of(whisker: &Whisker) -> Whisker {
    Whisker { tip_radius_um: whisker.base_radius_um, ..whisker.clone() }
}
