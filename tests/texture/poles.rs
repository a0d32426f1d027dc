//! Surfaces of one asperity, or of asperities far apart, against single poles and closed forms.

use super::{SINGLE, course, kinds, scene};
use whiskmap::mechanics::rod::{Rest, Side};
use whiskmap::scene::{Parameter, Pole, Surface};
use whiskmap::texture::{TexturePhase, texture};
use whiskmap::trace::reach_mm;
use whiskmap::whisk::{WhiskEventKind, WhiskRegime, whisk};

/// In front of one asperity, the course is that of `whisk` against one pole, from another zero of the angle.
#[test]
fn one_asperity_is_one_pole() {
    let cone = scene("texture_cone");
    let pole = Pole::smooth(0.05);
    let rest = Rest::new(&cone.whisker.rod(&pole, Side::Cb));
    let length = cone.whisker.length_mm;
    let distance = rest.distance_of_pole(SINGLE.distance_mm / length) * length;
    let angles: Vec<f64> = (0..=120).map(|i| 40.0 * (f64::from(i) / 19.0).sin() - 10.0).collect();
    let found = texture(&cone.whisker, &SINGLE, &course(&angles)).unwrap();
    let touch = found.events[0].angle_deg;
    let shifted: Vec<f64> = angles.iter().map(|angle| angle - touch).collect();
    let wanted = whisk(&cone.whisker, &pole, distance, &course(&shifted)).unwrap();
    assert_eq!(found.reached, 1);
    assert_eq!(
        kinds(&found),
        wanted.events.iter().map(|event| (event.event, event.side)).collect::<Vec<_>>()
    );
    assert!(kinds(&found).contains(&(WhiskEventKind::SlipOff, Side::Cf)));
    for (event, other) in found.events.iter().zip(&wanted.events) {
        // The zero of the angle is the event's own angle. Measured: 6e-15 degrees.
        assert!((event.angle_deg - touch - other.angle_deg).abs() < 1e-13);
    }
    for (sample, other) in found.samples.iter().zip(&wanted.samples) {
        let is_free = other.regime == WhiskRegime::Free;
        assert_eq!(sample.asperity.is_none(), is_free, "{sample:?}");
        for (value, other) in [
            (sample.force_un, other.force_un),
            (sample.base_moment_nnm, other.base_moment_nnm),
            (sample.energy_nj, other.energy_nj),
        ] {
            let (value, other) = (value.unwrap(), other.unwrap());
            // Measured: 6e-14. Next to the fold a push that differs by 1e-14 degrees would change a force by 1e-8; no sample is there.
            assert!((value - other).abs() <= 1e-11 * other.abs(), "{value} {other}");
        }
    }
    // Measured: no difference.
    assert!((found.lost_nj() / wanted.lost_nj() - 1.0).abs() < 1e-12);
}

/// Geometry of the angle: a straight whisker touches a point at `x` where its direction is that of the point.
#[test]
fn a_straight_whisker_touches_points_in_their_direction() {
    let straight = scene("texture_cone").with(Parameter::ParabolaPerMm, 0.0).unwrap();
    let points = Surface {
        asperity_radius_um: 0.0,
        spacing_um: 4000.0,
        length_mm: 8.0,
        distance_mm: 15.0,
        ..SINGLE
    };
    let found = texture(&straight.whisker, &points, &course(&[-20.0, 40.0])).unwrap();
    let touches: Vec<_> =
        found.events.iter().filter(|event| event.event == WhiskEventKind::Touch).collect();
    let wanted = [-4.0, 0.0, 4.0].map(|x: f64| (x / 15.0).atan().to_degrees());
    assert_eq!(touches.len(), 3);
    for (touch, wanted) in touches.iter().zip(wanted) {
        assert!((touch.angle_deg - wanted).abs() < 1e-12, "{touch:?} {wanted}");
        // The tip continues the straight line.
        let tip = 16.4 * wanted.to_radians().sin();
        assert!((touch.tip_x_mm.unwrap() - tip).abs() < 1e-12, "{touch:?} {tip}");
    }
}

/// Asperities so far apart that the whisker is free between them do not know of each other.
#[test]
fn far_asperities_are_single_poles() {
    let cone = scene("texture_cone");
    let both = Surface { spacing_um: 4000.0, length_mm: 4.0, distance_mm: 15.3, ..SINGLE };
    let angles = [-15.0, 20.0, -30.0];
    let found = texture(&cone.whisker, &both, &course(&angles)).unwrap();
    assert_eq!(found.reached, 2);
    use WhiskEventKind::{PullOff, SlipOff, Touch};
    let ends = |kind: &WhiskEventKind| matches!(kind, SlipOff | PullOff);
    let kinds: Vec<WhiskEventKind> = found.events.iter().map(|event| event.event).collect();
    assert!(kinds.iter().step_by(2).all(|kind| *kind == Touch), "{kinds:?}");
    assert!(kinds.iter().skip(1).step_by(2).all(ends), "{kinds:?}");
    let places: Vec<_> = found.events.iter().map(|event| event.asperity.unwrap()).collect();
    assert_eq!(places, [0, 0, 1, 1, 1, 1, 0, 0]);
    // Mirrored asperities have the same distance from the base, so the same push ends on each side.
    let pushes: Vec<f64> = found.events.iter().filter_map(|event| event.push_angle_deg).collect();
    for (one, other) in [(1, 3), (5, 7)] {
        assert!((pushes[one] - pushes[other]).abs() < 1e-12, "{pushes:?}");
    }
    // Each detachment loses all of its energy.
    assert!(
        found
            .events
            .iter()
            .filter(|event| ends(&event.event))
            .all(|event| event.lost_nj == event.energy_nj)
    );
}

/// A surface beyond the whisker, or with asperities only beyond it, leaves the whisker free.
#[test]
fn a_whisker_without_asperities_in_reach_is_free() {
    let cone = scene("texture_cone");
    let wide = Surface { spacing_um: 30_000.0, length_mm: 30.0, ..SINGLE };
    for surface in [wide, Surface { distance_mm: 16.4, ..SINGLE }] {
        let found = texture(&cone.whisker, &surface, &course(&[-90.0, 90.0, 0.0])).unwrap();
        assert_eq!((found.reached, found.events.len()), (0, 0));
        assert!(found.samples.iter().all(|sample| sample.phase == TexturePhase::Free));
        let last = found.samples[2];
        // At the angle 0, the chord of the tip is normal to the surface.
        let reach = reach_mm(&cone.whisker, &Pole::smooth(0.0), Side::Cb);
        assert!(last.tip_x_mm.unwrap().abs() < 1e-12);
        assert!((last.tip_height_mm.unwrap() - reach + surface.distance_mm).abs() < 1e-12);
    }
}
