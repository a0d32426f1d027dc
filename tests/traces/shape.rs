//! Shapes: geometry, statics and limit at rest.

use super::{POLE, branches_at_9_mm, everything, whisker};
use whiskmap::Side;
use whiskmap::trace::{Branch, WhiskerPart};

/// The base is at the origin and rotated by the push angle, the contact touches the pole, and the moment at the base
/// equals that of the pole's force.
#[test]
fn a_shape_fits_its_state() {
    for (traced, branch) in branches_at_9_mm() {
        let points = branch.points(41).unwrap();
        for stable in [true, false] {
            let case = format!("{}, {stable}", traced.case());
            let mut part = points.iter().filter(|point| point.stable == stable);
            let Some(push) = part.nth(3).map(|point| point.push_angle_deg) else {
                continue;
            };
            let state = branch.state(push.to_radians(), stable).unwrap();
            let shape = branch.shape(&state, 100);
            let base = shape.points[0];
            assert!(base.x_mm.hypot(base.y_mm) < 2e-10, "{case}: {base:?}");
            assert!((base.angle_deg + push).abs() < 2e-9, "{case}: {base:?}");
            let reading = branch.read(&state);
            let miss = (base.moment_nnm / reading.base_moment_nnm - 1.0).abs();
            assert!(miss < 1e-9, "{case}: {base:?}");
            // The curvature of the base changes by the strain over the radius, 30 um.
            let at_rest = 2.0 * traced.whisker.curvature.map_or(0.0, |bend| bend.parabola_per_mm);
            let strain = 0.03 * (base.curvature_per_mm - at_rest).abs();
            assert!((strain - base.strain).abs() < 1e-12, "{case}: {base:?}");
            let strains = shape.points.iter().map(|point| point.strain);
            let most = strains.fold(0.0, f64::max);
            let peak = shape.state.peak_strain;
            assert!((0.99..1.0 + 1e-9).contains(&(most / peak)), "{case}: {most} {peak}");
            assert!(shape.residual < 1e-12, "{case}");

            let contact = shape.points.iter().find(|p| p.part == WhiskerPart::Contact).unwrap();
            let [x, y] = shape.pole_mm;
            let (dx, dy) = (x - contact.x_mm, y - contact.y_mm);
            assert!((dx.hypot(dy) - traced.pole.radius_mm).abs() < 1e-11, "{case}");
            let (sin, cos) = contact.angle_deg.to_radians().sin_cos();
            assert!((dx * cos + dy * sin).abs() < 1e-10, "{case}: not tangential");
            assert!((contact.arc_length_mm - reading.arc_length_mm).abs() < 1e-12, "{case}");
            assert_eq!(
                (contact.moment_nnm, shape.points.last().unwrap().arc_length_mm),
                (0.0, 20.0)
            );
        }
    }
}

/// Tangents agree with the directions between points, and curvatures with the change of the tangents: centred differences have errors
/// of the square of the spacing.
#[test]
fn a_shape_is_a_curve() {
    let branch = Branch::new(&whisker(1.5, 0.02), &POLE, Side::Cb, 15.0).unwrap();
    let state = branch.state(0.2, true).unwrap();
    let error = |count: usize| {
        let points = branch.shape(&state, count).points;
        let mut worst = [0.0_f64; 2];
        for triple in points.windows(3) {
            let [a, b, c] = [triple[0], triple[1], triple[2]];
            let even = (c.arc_length_mm - b.arc_length_mm) / (b.arc_length_mm - a.arc_length_mm);
            if (even - 1.0).abs() > 1e-6 || b.part == WhiskerPart::Contact {
                continue;
            }
            let h = c.arc_length_mm - a.arc_length_mm;
            let chord = (c.y_mm - a.y_mm).atan2(c.x_mm - a.x_mm) - b.angle_deg.to_radians();
            let bend = (c.angle_deg - a.angle_deg).to_radians() / h - b.curvature_per_mm;
            worst = [worst[0].max(chord.abs()), worst[1].max(bend.abs())];
        }
        worst
    };
    let (coarse, fine) = (error(400), error(800));
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        assert!(coarse < 1e-3 && (3.0..5.0).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
    }
}

#[test]
fn without_a_push_the_whisker_is_at_rest() {
    for (traced, branch) in branches_at_9_mm().filter(|(traced, _)| traced.side == Side::Cf) {
        let state = branch.state(0.0, true).unwrap();
        // The contact is an additional point.
        let shape = branch.shape(&state, 50);
        let places = shape.points.iter().filter(|point| point.part != WhiskerPart::Contact);
        for (point, [x, y]) in places.zip(branch.at_rest(50)) {
            let miss = (point.x_mm - x).hypot(point.y_mm - y);
            assert!(miss < 1e-10, "{}: {point:?} {x} {y}", traced.case());
        }
    }
}

/// A shape is exact with few points and with a contact near the base.
#[test]
fn a_shape_is_exact_at_every_count() {
    for (whisker, pole) in everything() {
        let distance = 0.02 * whisker.length_mm + pole.radius_mm;
        for side in Side::BOTH {
            let branch = Branch::new(&whisker, &pole, side, distance).unwrap();
            let state = branch.state(side.sign() * 1.2, true).unwrap();
            for count in [2, 5, 20, 333] {
                let base = branch.shape(&state, count).points[0];
                let miss = base.x_mm.hypot(base.y_mm);
                assert!(miss < 1e-10, "{whisker:?} {pole:?} {side:?} {count}: {base:?}");
            }
        }
    }
}
