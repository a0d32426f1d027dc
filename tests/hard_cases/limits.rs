//! Order of convergence of the detachment angle as one parameter tends to a limit.

use whiskmap::Side;
use whiskmap::scene::{Curvature, Pole, Whisker};
use whiskmap::trace::{Detachment, DetachmentKind, corner, curve};

/// Distance of first touch, in whisker lengths, at which every whisker of this module slips off on both sides.
const DISTANCE: f64 = 0.4;

/// Whisker of 1 mm length and its pole, as deviations from a straight cylinder and a point.
#[derive(Clone, Copy, Default)]
struct Away {
    taper: f64,
    bend: f64,
    pole: f64,
}

impl Away {
    fn whisker(self) -> Whisker {
        Whisker {
            curvature: (self.bend > 0.0)
                .then_some(Curvature { parabola_per_mm: self.bend, vertex_mm: 0.0 }),
            ..Whisker::cone(1.0, [1.0, 1.0 - self.taper], 3.0)
        }
    }

    fn end(self, side: Side, distance: f64) -> Detachment {
        curve(&self.whisker(), &Pole::smooth(self.pole), side, &[distance])[0]
    }

    /// Magnitude of the push angle of slip-off, in degrees.
    fn slip(self, side: Side) -> f64 {
        let end = self.end(side, DISTANCE);
        assert_eq!(end.kind, DetachmentKind::SlipOff);
        end.push_angle_deg.unwrap() * side.sign()
    }
}

/// Deviations over three decades. Below, the solution error of 1e-8 degrees is visible.
const SIZES: [f64; 4] = [1e-2, 1e-3, 1e-4, 1e-5];

/// Observed orders of `miss`, one per decade.
fn orders(name: &str, miss: impl Fn(f64) -> f64) -> [f64; 3] {
    let misses = SIZES.map(|size| miss(size).abs());
    let orders = [0, 1, 2].map(|i| (misses[i] / misses[i + 1]).log10());
    eprintln!("{name}: {misses:?}, orders {orders:.4?}");
    orders
}

/// Returns true if all `orders` equal `order`. The largest measured difference is 0.0041, for the thickest poles: the next term of
/// the series.
fn is(order: f64, orders: &[f64]) -> bool {
    orders.iter().all(|found| (found - order).abs() < 0.01)
}

#[test]
fn small_tapers_tend_to_cylinders() {
    for side in Side::BOTH {
        let cylinder = Away::default().slip(side);
        let miss = |taper| Away { taper, ..Away::default() }.slip(side) - cylinder;
        assert!(is(1.0, &orders("taper", miss)));
        assert!(miss(1e-12).abs() < 1e-8);
    }
}

#[test]
fn small_curvatures_tend_to_straight_whiskers() {
    for taper in [0.0, 0.95] {
        let straight = Away { taper, ..Away::default() };
        let slip = |bend, side| Away { bend, ..straight }.slip(side);
        let rest = straight.slip(Side::Cb);
        for side in Side::BOTH {
            let miss = |bend| slip(bend, side) - rest;
            assert!(is(1.0, &orders("bend", miss)));
            assert!(miss(1e-9).abs() < 1e-6);
        }
        let mean = |bend| 0.5 * (slip(bend, Side::Cb) + slip(bend, Side::Cf)) - rest;
        let found = orders("mean of both sides", mean);
        // The last mean is 2e-10 degrees, so rounding affects its order.
        assert!(is(2.0, &found[..2]));
    }
}

#[test]
fn thin_poles_tend_to_points() {
    for (taper, bend) in [(0.0, 0.0), (0.95, 0.4)] {
        for side in Side::BOTH {
            let whisker = Away { taper, bend, pole: 0.0 };
            let point = whisker.slip(side);
            let miss = |pole| Away { pole, ..whisker }.slip(side) - point;
            assert!(is(1.0, &orders("pole", miss)));
        }
    }
}

#[test]
fn blunt_cones_tend_to_perfect_ones_that_are_never_pulled_off() {
    for side in Side::BOTH {
        let cone = |tip: f64| Away { taper: 1.0 - tip, bend: 0.4, pole: 0.01 };
        let perfect = cone(0.0).slip(side);
        let miss = |tip| cone(tip).slip(side) - perfect;
        assert!(is(1.0, &orders("tip", miss)));
        let tip = cone(0.0);
        for distance in [0.5, 0.9, 0.93] {
            assert_eq!(tip.end(side, distance).kind, DetachmentKind::SlipOff);
        }
        assert!(corner(&tip.whisker(), &Pole::smooth(0.01), side).distance_mm.is_none());
    }
    // The corner of the straight cone tends to its tip.
    let from_tip = |tip: f64| {
        let cone = Away { taper: 1.0 - tip, bend: 0.0, pole: 0.0 };
        1.0 - corner(&cone.whisker(), &Pole::smooth(0.0), Side::Cb).distance_mm.unwrap()
    };
    assert!(is(1.0, &orders("corner", from_tip)));
}
