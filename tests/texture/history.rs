//! History of a course: the asperity on which a detached whisker lies, and the way back.

use super::{course, scene};
use whiskmap::mechanics::rod::{Rest, Side};
use whiskmap::scene::{Pole, Scene, Surface};
use whiskmap::texture::texture;
use whiskmap::trace::curve;
use whiskmap::whisk::{AngleCourse, WhiskEventKind};

/// History: on the way back the whisker touches the asperity that it has passed, on CF. A part of a sweep does not depend on what follows.
#[test]
fn the_state_is_history() {
    let cone = scene("texture_cone");
    let surface = cone.surface.unwrap();
    let up: Vec<f64> = (0..=60).map(|i| 0.2 * f64::from(i)).collect();
    let down: Vec<f64> = up.iter().rev().map(|angle| angle - 0.1).collect();
    let all = texture(&cone.whisker, &surface, &course(&[&up[..], &down].concat())).unwrap();
    let part = texture(&cone.whisker, &surface, &course(&up)).unwrap();
    assert_eq!(all.samples[..up.len()], part.samples);
    assert_eq!(all.events[..part.events.len()], part.events);
    let slips = part.events.iter().filter(|event| event.event == WhiskEventKind::SlipOff).count();
    assert!(slips > 3, "{slips}");
    let [release, touch] = all.events[part.events.len()..] else {
        panic!("{:?}", &all.events[part.events.len()..]);
    };
    assert_eq!((release.event, release.side), (WhiskEventKind::Release, Side::Cb));
    assert_eq!((touch.event, touch.side), (WhiskEventKind::Touch, Side::Cf));
    // The asperity before the one that held it is now the next one on CF.
    assert_eq!(touch.asperity.unwrap() + 1, release.asperity.unwrap());
}

/// Angle of first touch of an asperity up to a constant, and distance of its first touch in mm, from the geometry of the resting whisker.
fn first_touch(scene: &Scene, surface: &Surface, side: Side, asperity: usize) -> (f64, f64) {
    let pole = Pole::smooth(1e-3 * surface.asperity_radius_um);
    let rest = Rest::new(&scene.whisker.rod(&pole, side));
    let x_mm = surface.asperities_mm()[asperity];
    let length = scene.whisker.length_mm;
    let distance = rest.distance_of_pole(x_mm.hypot(surface.distance_mm) / length);
    let direction = surface.distance_mm.atan2(x_mm);
    let angle = rest.pole_at_distance(distance).to_angle() - direction;
    (angle.to_degrees(), distance * length)
}

/// After a detachment, the whisker lies on the first asperity ahead whose push at this angle is shorter than its largest one.
#[test]
fn a_detached_whisker_lies_on_the_first_asperity_that_holds_it() {
    for (name, distance_mm) in [("texture_cone", 14.6866), ("texture_hair", 14.538)] {
        let scene = scene(name);
        let surface = Surface { distance_mm, ..scene.surface.unwrap() };
        let pole = Pole::smooth(1e-3 * surface.asperity_radius_um);
        let sweep = AngleCourse::sine(25.0, 0.2, 5.0, 200.0).unwrap();
        let found = texture(&scene.whisker, &surface, &sweep).unwrap();
        let caught = found
            .events
            .windows(2)
            .filter(|pair| pair[0].lost_nj.is_some() && pair[0].angle_deg == pair[1].angle_deg);
        let mut checked = [0; 2];
        for pair in caught {
            let (from, to) = (pair[0].asperity.unwrap(), pair[1].asperity.unwrap());
            let side = pair[0].side;
            let (ahead, checked): (Vec<usize>, _) = match side {
                Side::Cb => ((from + 1..=to).collect(), &mut checked[0]),
                Side::Cf => ((to..from).rev().collect(), &mut checked[1]),
            };
            if *checked == 6 {
                continue;
            }
            *checked += 1;
            let first = first_touch(&scene, &surface, side, from).0;
            for asperity in ahead {
                let (touch, distance_mm) = first_touch(&scene, &surface, side, asperity);
                let push = pair[0].push_angle_deg.unwrap() + first - touch;
                let end = curve(&scene.whisker, &pole, side, &[distance_mm])[0];
                let holds = push.abs() < end.push_angle_deg.unwrap().abs();
                assert_eq!(holds, asperity == to, "{name} {from} {asperity} {to}");
                if holds {
                    // Measured: 2e-14 degrees.
                    assert!((pair[1].push_angle_deg.unwrap() - push).abs() < 1e-12);
                }
            }
        }
        assert!(checked[0] > 3, "{name}: {checked:?}");
        assert!(name == "texture_hair" || checked[1] > 3, "{name}: {checked:?}");
    }
}
