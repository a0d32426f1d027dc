//! The boundary of the map against an independent solver and closed forms. `whiskmap::paper` has the published values.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use whiskmap::classify::{PushSpan, RowBoundary};
use whiskmap::mechanics::rod::{Rod, Side, arclength};
use whiskmap::mechanics::shooting::ShootingMap;
use whiskmap::mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap::scene::{Curvature, Pole, Whisker};
use whiskmap::sheet::{Crossing, Edge, Sheet};

/// The detachment of `whisker` at `distance_mm` from a pole: push angle in degrees, signed, and the crossing.
fn detachment(whisker: &Whisker, pole: &Pole, side: Side, distance_mm: f64) -> (f64, Crossing) {
    let rod = whisker.rod(pole, side);
    let sheet = Sheet::new(Method::fine(), &rod, side, &[distance_mm / whisker.length_mm]);
    let crossing = sheet.crossings[0][0];
    let boundary = RowBoundary::new(sheet.touches(0), &sheet.crossings[0]);
    let span: &PushSpan = boundary.detachment().unwrap();
    assert_eq!((span.from(), span.end), (0.0, crossing));
    (side.sign() * span.to().to_degrees(), crossing)
}

fn whisker(
    length_mm: f64,
    base_radius_um: f64,
    tip_radius_um: f64,
    a: f64,
    vertex_mm: f64,
) -> Whisker {
    Whisker {
        curvature: (a > 0.0).then_some(Curvature { parabola_per_mm: a, vertex_mm }),
        ..Whisker::cone(length_mm, [base_radius_um, tip_radius_um], 3.0)
    }
}

/// `tests/data/detachment.csv`: detachment points from AUTO-07p on the paper's boundary-value problem.
#[test]
fn the_reference_is_reproduced() {
    let text = std::fs::read_to_string("tests/data/detachment.csv").unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let mut compared = 0;
    for line in lines {
        let fields: Vec<&str> = line.split(',').collect();
        let text = |name: &str| fields[names.iter().position(|n| *n == name).unwrap()];
        let number = |name: &str| text(name).parse::<f64>().unwrap();
        assert_eq!(number("modulus_gradient"), 0.0);
        let mut whisker = whisker(
            number("length_mm"),
            number("base_radius_um"),
            number("tip_radius_um"),
            number("parabola_per_mm"),
            number("vertex_mm"),
        );
        whisker.arc_stretch = number("projection");
        let side = if text("side") == "CB" { Side::Cb } else { Side::Cf };
        let pole = Pole::smooth(number("pole_radius_mm"));
        let (push, crossing) = detachment(&whisker, &pole, side, number("distance_mm"));
        let kind = if crossing.edge == Edge::Fold { "slip-off" } else { "pull-off" };
        assert_eq!(kind, text("kind"), "{line}");
        // The file has 9 decimals.
        let miss = (push - number("push_angle_deg")).abs();
        assert!(miss < 1e-8, "{line}: {push}, off by {miss:.1e}");
        let rod = whisker.rod(&pole, side);
        let arc = arclength(&rod, crossing.tau) * whisker.length_mm;
        let miss = (arc - number("arc_length_mm")).abs() / whisker.length_mm;
        assert!(miss < 1e-8, "{line}: arc length {arc}");
        compared += 1;
    }
    assert_eq!(compared, 40);
}

/// A straight cylinder at a point contact: elliptic integrals give the fold at 99.56849875 degrees and
/// `s/d = 1.79038351`.
#[test]
fn the_fold_of_a_straight_cylinder_has_its_closed_form() {
    let cylinder = whisker(20.0, 30.0, 30.0, 0.0, 0.0);
    for distance in [2.0, 5.0, 11.0] {
        let (push, crossing) = detachment(&cylinder, &Pole::smooth(0.0), Side::Cb, distance);
        assert_eq!(crossing.edge, Edge::Fold);
        assert!((push - 99.568_498_75).abs() < 1e-8, "{push}");
        assert!((crossing.tau * 20.0 / distance - 1.790_383_51).abs() < 1e-8);
    }
    let (_, crossing) = detachment(&cylinder, &Pole::smooth(0.0), Side::Cb, 0.5586 * 20.0);
    assert_eq!(crossing.edge, Edge::Tip);
}

/// Without curvature CB and CF are mirror images: to the last bit, since every sum and product is.
#[test]
fn straight_whiskers_are_symmetric() {
    for tip_um in [0.0, 1.5, 20.0, 30.0] {
        for pole_mm in [0.0, 0.25] {
            for distance in [2.0, 9.0, 15.0, 19.9] {
                let whisker = whisker(20.0, 30.0, tip_um, 0.0, 0.0);
                let (cb, at_cb) = detachment(&whisker, &Pole::smooth(pole_mm), Side::Cb, distance);
                let (cf, at_cf) = detachment(&whisker, &Pole::smooth(pole_mm), Side::Cf, distance);
                assert_eq!(cb, -cf, "{tip_um} {pole_mm} {distance}: {at_cb:?} {at_cf:?}");
                assert_eq!((at_cb.tau, at_cb.load), (at_cf.tau, -at_cf.load));
            }
        }
    }
}

/// Scaling every length scales nothing that is an angle; Young's modulus neither.
#[test]
fn angles_do_not_depend_on_units() {
    let (push, _) =
        detachment(&whisker(20.0, 30.0, 1.5, 0.02, 0.0), &Pole::smooth(0.25), Side::Cb, 14.0);
    for scale in [5e-3, 50.0] {
        let mut scaled = whisker(20.0 * scale, 30.0 * scale, 1.5 * scale, 0.02 / scale, 0.0);
        scaled.youngs_modulus_gpa = 1.0;
        let (other, _) = detachment(&scaled, &Pole::smooth(0.25 * scale), Side::Cb, 14.0 * scale);
        assert!((other - push).abs() < 1e-10, "{other} {push}");
    }
}

/// The cone of Fig. 2 with the moduli that were measured at base and tip (2.90 and 3.96, or 3.9 and 3.1 GPa).
#[test]
fn a_modulus_gradient_shifts_the_slip() {
    for (ratio, expected) in [(3.96 / 2.90, 16.27), (3.1 / 3.9, 15.15)] {
        let mut cone = whisker(20.0, 30.0, 1.5, 0.02, 0.0);
        cone.modulus_tip_to_base = ratio;
        let (push, crossing) =
            detachment(&cone, &Pole::smooth(0.25), Side::Cb, 15.660_459_763_365_8);
        assert_eq!(crossing.edge, Edge::Fold);
        assert!((push - expected).abs() < 5e-3, "{push}, expected {expected}");
    }
}

/// An effect that vanishes changes an angle by less and less, to the first order in its size.
#[test]
fn effects_vanish_to_the_first_order() {
    let push = |change: &dyn Fn(&mut Whisker, &mut Pole)| {
        let mut whisker = whisker(20.0, 30.0, 1.5, 0.02, 0.0);
        let mut pole = Pole::smooth(0.25);
        change(&mut whisker, &mut pole);
        detachment(&whisker, &pole, Side::Cb, 14.0).0
    };
    let none = push(&|_, _| {});
    let effects: [(&str, &dyn Fn(f64) -> f64); 3] = [
        ("friction", &|size| push(&|_, pole| pole.friction = size)),
        ("gradient", &|size| push(&|w, _| w.modulus_tip_to_base = 1.0 + size)),
        ("projection", &|size| push(&|w, _| w.arc_stretch = 1.0 + size)),
    ];
    for (name, effect) in effects {
        let ratio = (effect(1e-3) - none) / (effect(1e-4) - none);
        assert!((ratio - 10.0).abs() < 0.1, "{name}: {ratio}");
        assert_eq!(effect(0.0), none, "{name}");
    }
}

/// The fold with the contact at the tip is the first change of the determinant's sign on the way from first touch. Of soft
/// tips it lies at a tenth of the load that it has else, and the next ones before that.
#[test]
fn the_first_fold_is_the_first() {
    for tip_to_base in [0.05, 0.1, 0.5, 1.0, 10.0] {
        for (taper, friction, bend) in [(0.0, 0.0, 0.4), (0.9, 0.5, 0.0), (0.97, 0.0, 0.0)] {
            for side in Side::BOTH {
                let rod = Rod {
                    taper,
                    bend,
                    pole: side.sign() * 0.0125,
                    gradient: tip_to_base - 1.0,
                    friction: side.sign() * friction,
                    ..Rod::default()
                };
                let method = Method::fine();
                let tau = rod.tau_tip();
                let scale = arclength(&rod, tau).powi(2);
                let conditions: Vec<InitialCondition> = (0..6000)
                    .map(|i| InitialCondition {
                        rod: &rod,
                        tau,
                        load: side.sign() * 0.05 * f64::from(i) / scale,
                    })
                    .collect();
                let shot = Batch::new(method).shoot::<ShootingMap>(&conditions);
                let beyond = shot.iter().position(|map| map.det() <= 0.0);
                let fold = Sheet::fold_at_tip(method, &rod, side).unwrap();
                let place = 20.0 * scale * fold.load.abs();
                assert!(
                    beyond.is_some_and(|i| (i as f64 - 1.0..=i as f64).contains(&place)),
                    "{tip_to_base} {taper} {side:?}: {place} instead of {beyond:?}"
                );
            }
        }
    }
}
