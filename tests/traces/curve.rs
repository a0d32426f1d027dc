//! Detachment curves and their corners.

use super::{POLE, everything, whisker};
use crate::shipped::scene;
use whiskmap::Side;
use whiskmap::mechanics::shooting::Resolution;
use whiskmap::mechanics::shooting::batch::Method;
use whiskmap::scene::{Curvature, EulerSpiral, Parameter, Pole, SweptWhisker, Whisker};
use whiskmap::sensitivity::{Variable, detachments, detachments_of_sides};
use whiskmap::sheet::Sheet;
use whiskmap::trace::{
    Branch, Detachment, DetachmentKind, NoCorner, SweptSide, corner, curve, ends_at,
};

/// A push ends at the fold 1e-8 mm before the corner, and at the tip 1e-8 mm beyond it.
#[test]
fn at_the_corner_slip_off_turns_into_pull_off() {
    let mut corners = 0;
    for (whisker, pole) in everything() {
        for side in Side::BOTH {
            let corner = corner(&whisker, &pole, side);
            assert_eq!(corner.reason.is_none(), corner.distance_mm.is_some());
            let Some(distance) = corner.distance_mm else {
                assert_eq!(corner.reason, Some(NoCorner::AlwaysSlipsOff));
                // No push ends at the tip then.
                let distances: Vec<f64> =
                    (1..40).map(|i| pole.radius_mm + 0.5 * f64::from(i)).collect();
                let ends = curve(&whisker, &pole, side, &distances);
                assert!(
                    ends.iter().all(|end| end.kind != DetachmentKind::PullOff),
                    "{whisker:?} {pole:?} {side:?}"
                );
                continue;
            };
            let ends = curve(&whisker, &pole, side, &[distance - 1e-8, distance + 1e-8]);
            let kinds = [ends[0].kind, ends[1].kind];
            assert_eq!(
                kinds,
                [DetachmentKind::SlipOff, DetachmentKind::PullOff],
                "{whisker:?} {pole:?} {side:?}"
            );
            let push = corner.push_angle_deg.unwrap();
            assert!((ends[0].push_angle_deg.unwrap() - push).abs() < 1e-6);
            corners += 1;
        }
    }
    assert!(corners > 60, "{corners}");
}

/// The pole pulls some perfect cones off: a stiff tip and friction keep the contact from sliding beyond their fold. Ends within 1e-6 mm of the
/// corner are not resolved.
#[test]
fn a_perfect_cone_may_have_a_corner() {
    let whisker = Whisker {
        modulus_tip_to_base: 1.5,
        euler_spiral: Some(EulerSpiral { per_mm: 0.054, per_mm2: 0.0 }),
        ..Whisker::cone(20.0, [25.0, 0.0], 0.5)
    };
    let pole = Pole { radius_mm: 0.18, friction: 0.5 };
    // A tip of 2.5 nm has a corner, and changes the ends little.
    let blunt = Whisker { tip_radius_um: 0.0025, ..whisker.clone() };
    let near = corner(&blunt, &pole, Side::Cb).distance_mm.unwrap();
    let beside = [near - 1e-2, near + 1e-2];
    let kinds = curve(&whisker, &pole, Side::Cb, &beside).into_iter().map(|end| end.kind);
    let kinds: Vec<DetachmentKind> = kinds.collect();
    assert_eq!(kinds, [DetachmentKind::SlipOff, DetachmentKind::PullOff], "{near}");
    assert_eq!(corner(&whisker, &pole, Side::Cb).reason, Some(NoCorner::NotFound));
    assert_eq!(corner(&whisker, &pole, Side::Cf).reason, Some(NoCorner::AlwaysSlipsOff));
}

#[test]
fn a_curve_is_the_end_of_each_branch() {
    let whisker = whisker(6.0, 0.04);
    let distances = [3.0, 8.0, 13.0, 18.0];
    for side in Side::BOTH {
        for (distance, end) in distances.iter().zip(curve(&whisker, &POLE, side, &distances)) {
            let branch = Branch::new(&whisker, &POLE, side, *distance).unwrap();
            let points = branch.points(50).unwrap();
            let last = points.iter().rfind(|point| point.stable).unwrap();
            for (one, other) in [
                (last.push_angle_deg, end.push_angle_deg),
                (last.push_chord_deg, end.push_chord_deg),
                (last.contact_angle_deg, end.contact_angle_deg),
                (last.arc_length_mm, end.arc_length_mm),
                (last.force_un, end.force_un),
                (last.base_moment_nnm, end.base_moment_nnm),
                (last.base_force_x_un, end.base_force_x_un),
                (last.base_force_y_un, end.base_force_y_un),
                (last.energy_nj, end.energy_nj),
                (last.peak_strain, end.peak_strain),
                (last.peak_strain_mm, end.peak_strain_mm),
            ] {
                let other = other.unwrap();
                // Only the push angle of a fold is more accurate than the square root of the rounding error.
                assert!(
                    (one - other).abs() < 1e-6 * other.abs(),
                    "{side:?} {distance}: {one} {other}"
                );
            }
            let pole = branch.row().pole_distance * whisker.length_mm;
            assert!((end.pole_distance_mm.unwrap() - pole).abs() < 1e-12);
        }
    }
}

#[test]
fn rows_out_of_reach_have_no_values() {
    let ends = curve(&whisker(1.5, 0.0), &POLE, Side::Cb, &[19.99, 20.01]);
    assert_eq!([ends[0].kind, ends[1].kind], [DetachmentKind::PullOff, DetachmentKind::OutOfReach]);
    assert!(ends[0].residual.unwrap() < 1e-12);
    assert_eq!((ends[1].push_angle_deg, ends[1].force_un, ends[1].residual), (None, None, None));
}

/// Strongly bent cylinders with their vertex between base and tip have level curves in several pieces, and folds at push angles
/// of the opposite sign. The first edge on the branch is the end of the push.
#[test]
fn the_branch_decides_where_rows_leave_the_sheet_more_than_once() {
    let (mut compared, mut several) = (0, 0);
    for (a_length, vertex) in [(1.14, 0.71), (2.56, 0.47), (1.86, 0.5), (0.8, -1.0)] {
        for tip in [30.0, 12.0, 1.5] {
            let mut whisker = whisker(tip, a_length / 20.0);
            whisker.curvature =
                Some(Curvature { parabola_per_mm: a_length / 20.0, vertex_mm: 20.0 * vertex });
            let distances: Vec<f64> = (1..20).map(|i| 0.7 * f64::from(i)).collect();
            for side in Side::BOTH {
                let places: Vec<f64> = distances.iter().map(|distance| distance / 20.0).collect();
                let rod = whisker.rod(&POLE, side);
                let sheet = Sheet::new(Method::fine(), &rod, side, &places);
                for ((distance, end), crossings) in distances
                    .iter()
                    .zip(curve(&whisker, &POLE, side, &distances))
                    .zip(&sheet.crossings)
                {
                    let Ok(branch) = Branch::new(&whisker, &POLE, side, *distance) else {
                        continue;
                    };
                    let points = branch.points(12).unwrap();
                    let last = points.iter().rfind(|point| point.stable).unwrap();
                    let case =
                        format!("tip {tip} A L {a_length} vertex {vertex} {side:?} at {distance}");
                    let push = end.push_angle_deg.unwrap_or_else(|| panic!("{case}: {end:?}"));
                    assert!((push - last.push_angle_deg).abs() < 1e-8, "{case}: {push} {last:?}");
                    compared += 1;
                    several += usize::from(crossings.len() > 1);
                }
            }
        }
    }
    assert!(compared > 300 && several > 5, "{compared} {several}");
}

/// The trajectories of several whiskers share batches, also those of rows that are followed: each whisker has the ends and the derivatives that it has
/// alone, to the last bit. The end of a push does not depend on the other pieces of its row.
#[test]
fn ends_do_not_depend_on_the_other_whiskers() {
    let bent = Whisker {
        curvature: Some(Curvature { parabola_per_mm: 1.14 / 20.0, vertex_mm: 14.2 }),
        ..whisker(30.0, 0.0)
    };
    let measured = Whisker {
        profile: Some(vec![[0.0, 1.0], [0.4, 0.4], [0.6, 0.7], [1.0, 0.1]]),
        ..whisker(3.0, 0.02)
    };
    let others = [bent, measured].map(|whisker| (whisker, POLE));
    let place = scene("cone").first_whisker().place;
    let swept = everything().step_by(5).chain(others);
    let swept = swept.map(|(whisker, pole)| SweptWhisker { place: place.clone(), whisker, pole });
    let swept: Vec<SweptWhisker> = swept.collect();
    let both = |swept| Side::BOTH.map(|side| SweptSide { swept, side });
    let sides: Vec<SweptSide> = swept.iter().map(Ok).flat_map(both).collect();
    let distances = [4.0, 9.0, 13.0];
    let variables = [Variable::DistanceMm, Parameter::BaseRadiusUm.into()];
    let ends =
        |sides: &[SweptSide]| detachments_of_sides(Resolution::FINE, sides, &distances, &variables);
    for (side, together) in sides.iter().zip(ends(&sides)) {
        let alone = ends(std::slice::from_ref(side)).concat();
        assert_eq!(together, alone, "{side:?}");
    }
    for SweptSide { swept, side } in &sides {
        let SweptWhisker { whisker, pole, .. } = swept.unwrap();
        let first = ends_at(Resolution::FINE, whisker, pole, *side, &distances);
        let all = detachments(whisker, pole, *side, &distances, &[]);
        for (first, all) in first.iter().zip(all) {
            let snaps_deg = all.end.snaps_deg;
            assert_eq!(Detachment { snaps_deg, ..*first }, all.end);
        }
    }
    let is_followed = |side: &&SweptSide| {
        let rod = side.swept.unwrap().rod(side.side);
        Sheet::of_ends(Method::fine(), &rod, side.side, &[0.45]).is_continued()
    };
    assert!(sides.iter().filter(is_followed).count() > 2);
}
