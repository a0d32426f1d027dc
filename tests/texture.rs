//! Courses behind rough surfaces against single poles, closed forms and the balance of energy.

use whiskmap::rod::Side;
use whiskmap::scene::{Scene, Surface};
use whiskmap::texture::{
    NoTextureState, Texture, TextureError, TexturePhase, TextureSample, histogram, shape, texture,
};
use whiskmap::trace::reach_mm;
use whiskmap::whisk::{AngleCourse, WhiskEventKind, WhiskRegime, whisk};

const SHIPPED: [&str; 2] = ["texture_cone", "texture_hair"];

fn scene(name: &str) -> Scene {
    Scene::read(format!("scenes/{name}.toml")).unwrap()
}

fn course(angles: &[f64]) -> AngleCourse {
    let times = (0..angles.len()).map(|i| i as f64).collect();
    AngleCourse::new(times, angles.to_vec()).unwrap()
}

/// One asperity of the radius 50 um right in front of the base.
const SINGLE: Surface = Surface {
    distance_mm: 14.0,
    spacing_um: 1000.0,
    asperity_radius_um: 50.0,
    length_mm: 0.0,
    jitter: 0.0,
    seed: 0,
};

fn kinds(texture: &Texture) -> Vec<(WhiskEventKind, Side)> {
    let events = texture.events.iter();
    events.map(|event| (event.event, event.side)).collect()
}

/// In front of one asperity, the course is that of `whisk` against one pole, from another zero of the angle.
#[test]
fn one_asperity_is_one_pole() {
    let cone = scene("texture_cone");
    let pole = whiskmap::scene::Pole::smooth(0.05);
    let rest = whiskmap::rod::Rest::new(&cone.whisker.rod(&pole, Side::Cb));
    let length = cone.whisker.length_mm;
    let distance = rest.distance_of_pole(SINGLE.distance_mm / length) * length;
    let angles: Vec<f64> = (0..=120)
        .map(|i| 40.0 * (f64::from(i) / 19.0).sin() - 2.0)
        .collect();
    let found = texture(&cone.whisker, &SINGLE, &course(&angles)).unwrap();
    let touch = found.events[0].angle_deg;
    let shifted: Vec<f64> = angles.iter().map(|angle| angle - touch).collect();
    let wanted = whisk(&cone.whisker, &pole, distance, &course(&shifted)).unwrap();
    assert_eq!(found.reached, 1);
    assert_eq!(
        kinds(&found),
        wanted
            .events
            .iter()
            .map(|own| (own.event, own.side))
            .collect::<Vec<_>>()
    );
    assert!(kinds(&found).contains(&(WhiskEventKind::SlipOff, Side::Cf)));
    for (own, other) in found.events.iter().zip(&wanted.events) {
        // The zero of the angle is the event's own angle: both are rounded to 1e-14 degrees.
        assert!((own.angle_deg - touch - other.angle_deg).abs() < 1e-10);
    }
    for (own, other) in found.samples.iter().zip(&wanted.samples) {
        let is_free = other.regime == WhiskRegime::Free;
        assert_eq!(own.asperity.is_none(), is_free, "{own:?}");
        for (own, other) in [
            (own.force_un, other.force_un),
            (own.base_moment_nnm, other.base_moment_nnm),
            (own.energy_nj, other.energy_nj),
        ] {
            let (own, other) = (own.unwrap(), other.unwrap());
            // A push that differs by 1e-14 degrees next to the fold changes a force by 1e-8 of it.
            assert!((own - other).abs() <= 1e-7 * other.abs(), "{own} {other}");
        }
    }
    assert!((found.lost_nj() / wanted.lost_nj() - 1.0).abs() < 1e-9);
}

/// Geometry of the angle: a straight whisker touches a point at `x` where its direction is that of the point.
#[test]
fn a_straight_whisker_touches_points_in_their_direction() {
    let straight = scene("texture_cone")
        .with(whiskmap::scene::Parameter::ParabolaPerMm, 0.0)
        .unwrap();
    let points = Surface {
        asperity_radius_um: 0.0,
        spacing_um: 3000.0,
        length_mm: 6.0,
        distance_mm: 15.0,
        ..SINGLE
    };
    let found = texture(&straight.whisker, &points, &course(&[-20.0, 40.0])).unwrap();
    let touches: Vec<_> = found
        .events
        .iter()
        .filter(|own| own.event == WhiskEventKind::Touch)
        .collect();
    let wanted = [-3.0, 0.0, 3.0].map(|x: f64| (x / 15.0).atan().to_degrees());
    assert_eq!(touches.len(), 3);
    for (touch, wanted) in touches.iter().zip(wanted) {
        assert!(
            (touch.angle_deg - wanted).abs() < 1e-12,
            "{touch:?} {wanted}"
        );
        // The tip continues the straight line.
        let tip = 16.4 * wanted.to_radians().sin();
        assert!(
            (touch.tip_x_mm.unwrap() - tip).abs() < 1e-12,
            "{touch:?} {tip}"
        );
    }
}

/// Asperities so far apart that the whisker is free between them do not know of each other.
#[test]
fn far_asperities_are_single_poles() {
    let cone = scene("texture_cone");
    let both = Surface {
        spacing_um: 4000.0,
        length_mm: 4.0,
        distance_mm: 15.3,
        ..SINGLE
    };
    let angles = [-15.0, 20.0, -30.0];
    let found = texture(&cone.whisker, &both, &course(&angles)).unwrap();
    assert_eq!(found.reached, 2);
    use WhiskEventKind::{PullOff, SlipOff, Touch};
    let ends = |kind: &WhiskEventKind| matches!(kind, SlipOff | PullOff);
    let kinds: Vec<WhiskEventKind> = found.events.iter().map(|own| own.event).collect();
    assert!(
        kinds.iter().step_by(2).all(|kind| *kind == Touch),
        "{kinds:?}"
    );
    assert!(kinds.iter().skip(1).step_by(2).all(ends), "{kinds:?}");
    let places: Vec<_> = found
        .events
        .iter()
        .map(|own| own.asperity.unwrap())
        .collect();
    assert_eq!(places, [0, 0, 1, 1, 1, 1, 0, 0]);
    // Mirrored asperities have the same distance from the base, so the same push ends on each side.
    let pushes: Vec<f64> = found
        .events
        .iter()
        .filter_map(|own| own.push_angle_deg)
        .collect();
    for (one, other) in [(1, 3), (5, 7)] {
        assert!((pushes[one] - pushes[other]).abs() < 1e-12, "{pushes:?}");
    }
    // Each detachment loses all of its energy.
    assert!(
        found
            .events
            .iter()
            .filter(|own| ends(&own.event))
            .all(|own| own.lost_nj == own.energy_nj)
    );
}

/// A surface beyond the whisker, or with asperities only beyond it, leaves the whisker free.
#[test]
fn a_whisker_without_asperities_in_reach_is_free() {
    let cone = scene("texture_cone");
    let wide = Surface {
        spacing_um: 30_000.0,
        length_mm: 30.0,
        ..SINGLE
    };
    for surface in [
        wide,
        Surface {
            distance_mm: 16.4,
            ..SINGLE
        },
    ] {
        let found = texture(&cone.whisker, &surface, &course(&[-90.0, 90.0, 0.0])).unwrap();
        assert_eq!((found.reached, found.events.len()), (0, 0));
        assert!(
            found
                .samples
                .iter()
                .all(|own| own.phase == TexturePhase::Free)
        );
        let last = found.samples[2];
        // At the angle 0, the chord of the tip is normal to the surface.
        let reach = reach_mm(&cone.whisker, &whiskmap::scene::Pole::smooth(0.0), Side::Cb);
        assert!(last.tip_x_mm.unwrap().abs() < 1e-12);
        assert!((last.tip_height_mm.unwrap() - reach + surface.distance_mm).abs() < 1e-12);
    }
}

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
    let slips = part
        .events
        .iter()
        .filter(|own| own.event == WhiskEventKind::SlipOff)
        .count();
    assert!(slips > 3, "{slips}");
    let [release, touch] = all.events[part.events.len()..] else {
        panic!("{:?}", &all.events[part.events.len()..]);
    };
    assert_eq!(
        (release.event, release.side),
        (WhiskEventKind::Release, Side::Cb)
    );
    assert_eq!((touch.event, touch.side), (WhiskEventKind::Touch, Side::Cf));
    // The asperity before the one that held it is now the next one on CF.
    assert_eq!(touch.asperity.unwrap() + 1, release.asperity.unwrap());
}

/// After a detachment, the whisker lies on the first asperity ahead whose push at this angle is shorter than its largest one.
#[test]
fn a_detached_whisker_lies_on_the_first_asperity_that_holds_it() {
    for name in SHIPPED {
        let scene = scene(name);
        let surface = scene.surface.unwrap();
        let sweep = AngleCourse::sine(25.0, 0.2, 5.0, 200.0).unwrap();
        let found = texture(&scene.whisker, &surface, &sweep).unwrap();
        let places = surface.asperities_mm();
        let pole = whiskmap::scene::Pole::smooth(1e-3 * surface.asperity_radius_um);
        let mut checked = 0;
        for pair in found.events.windows(2) {
            let is_end = matches!(
                pair[0].event,
                WhiskEventKind::SlipOff | WhiskEventKind::PullOff
            );
            if !is_end || pair[0].angle_deg != pair[1].angle_deg || checked == 12 {
                continue;
            }
            let (from, to) = (pair[0].asperity.unwrap(), pair[1].asperity.unwrap());
            let side = pair[0].side;
            let ahead: Vec<usize> = match side {
                Side::Cb => (from + 1..=to).collect(),
                Side::Cf => (to..from).rev().collect(),
            };
            let rest = whiskmap::rod::Rest::new(&scene.whisker.rod(&pole, side));
            let length = scene.whisker.length_mm;
            // The push against another asperity at the same angle of the base, from the geometry of first touch.
            let touch = |asperity: usize| {
                let x: f64 = places[asperity];
                let pole_mm = x.hypot(surface.distance_mm);
                let distance = rest.distance_of_pole(pole_mm / length);
                let centre = rest.pole_at_distance(distance);
                let direction = surface.distance_mm.atan2(x);
                (centre.to_angle() - direction, distance * length)
            };
            let own = touch(from).0;
            for asperity in ahead {
                let (angle, distance_mm) = touch(asperity);
                let push = pair[0].push_angle_deg.unwrap() + (own - angle).to_degrees();
                let end = whiskmap::trace::curve(&scene.whisker, &pole, side, &[distance_mm])[0];
                let holds = push.abs() < end.push_angle_deg.unwrap().abs();
                assert_eq!(holds, asperity == to, "{name} {from} {asperity} {to}");
                if holds {
                    assert!((pair[1].push_angle_deg.unwrap() - push).abs() < 1e-9);
                }
            }
            checked += 1;
        }
        assert!(checked > 3, "{name}: {checked}");
    }
}

/// Equal seeds give equal surfaces. Asperities stay in order, and apart.
#[test]
fn surfaces_are_reproducible() {
    let surface = scene("texture_cone").surface.unwrap();
    let places = surface.asperities_mm();
    assert_eq!(places, surface.asperities_mm());
    assert_ne!(places, Surface { seed: 1, ..surface }.asperities_mm());
    assert_eq!(places.len(), 321);
    let apart = places.windows(2).map(|pair| pair[1] - pair[0]);
    let least = apart.fold(f64::INFINITY, f64::min);
    let allowed = 1e-3 * surface.spacing_um * (1.0 - surface.jitter);
    assert!(least >= allowed && least < 1.2 * allowed, "{least}");
    let even = Surface {
        jitter: 0.0,
        ..surface
    }
    .asperities_mm();
    assert!((even[0] + 8.0).abs() < 1e-12 && (even[320] - 8.0).abs() < 1e-12 && even[160] == 0.0);
}

/// The work of the base from touch to detachment, less the energy that detachments lose, is what the whisker stores at the end.
#[test]
fn the_work_of_the_base_is_stored_or_lost() {
    // Midpoints in u, with the push at `end (1 - (1 - u)^2)` of its range: the moment is smooth in u at the fold.
    const COUNT: usize = 60;
    for name in SHIPPED {
        let scene = scene(name);
        let surface = scene.surface.unwrap();
        let sweep = AngleCourse::sine(15.0, 0.2, 15.0, 100.0).unwrap();
        let first = texture(&scene.whisker, &surface, &sweep).unwrap();
        let turns = sweep
            .angles_deg()
            .windows(3)
            .filter(|own| (own[1] - own[0]) * (own[2] - own[1]) < 0.0);
        let mut ends: Vec<f64> = first.events.iter().map(|own| own.angle_deg).collect();
        let last = *sweep.angles_deg().last().unwrap();
        ends.extend(turns.map(|own| own[1]));
        // Events and turns in the order of time.
        let mut nodes: Vec<(f64, f64)> = first
            .events
            .iter()
            .map(|own| (own.time_s, own.angle_deg))
            .collect();
        let times = sweep
            .times_s()
            .windows(3)
            .zip(sweep.angles_deg().windows(3));
        nodes.extend(
            times
                .filter(|(_, own)| (own[1] - own[0]) * (own[2] - own[1]) < 0.0)
                .map(|(time, own)| (time[1], own[1])),
        );
        nodes.push((15.0, last));
        nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut angles = vec![0.0];
        let mut weights = vec![0.0];
        let mut from = 0.0;
        for (_, to) in nodes {
            let span: f64 = to - from;
            if span == 0.0 {
                continue;
            }
            for i in 0..COUNT {
                let u = (i as f64 + 0.5) / COUNT as f64;
                angles.push(from + span * (1.0 - (1.0 - u).powi(2)));
                weights.push(span.to_radians() * 2.0 * (1.0 - u) / COUNT as f64);
            }
            from = to;
        }
        angles.push(last);
        weights.push(0.0);
        let found = texture(&scene.whisker, &surface, &course(&angles)).unwrap();
        assert_eq!(kinds(&found), kinds(&first), "{name}");
        let work: f64 = found
            .samples
            .iter()
            .zip(&weights)
            .map(|(own, weight)| own.base_moment_nnm.unwrap() * weight)
            .sum();
        let stored = found.samples.last().unwrap().energy_nj.unwrap();
        let largest = found
            .samples
            .iter()
            .filter_map(|own| own.energy_nj)
            .fold(0.0, f64::max);
        let miss = (work - stored - found.lost_nj()) / largest.max(found.lost_nj());
        eprintln!(
            "{name}: work {work} stored {stored} lost {} miss {miss:e}",
            found.lost_nj()
        );
        assert!(
            miss.abs() < 1e-6,
            "{name}: {work} {stored} {} {miss:e}",
            found.lost_nj()
        );
        assert!(
            found
                .events
                .iter()
                .filter_map(|own| own.lost_nj)
                .all(|lost| lost > 0.0),
            "{name}"
        );
    }
}

/// The shape of a sample ends at its tip, and touches its asperity.
#[test]
fn shapes_end_at_the_tip() {
    for name in SHIPPED {
        let scene = scene(name);
        let surface = scene.surface.unwrap();
        let sweep = AngleCourse::sine(15.0, 0.2, 5.0, 10.0).unwrap();
        let found = texture(&scene.whisker, &surface, &sweep).unwrap();
        let bent = |own: &&TextureSample| own.asperity.is_some();
        let mut sides = Vec::new();
        for sample in found
            .samples
            .iter()
            .filter(bent)
            .step_by(5)
            .chain(&found.samples[..1])
        {
            let points = shape(&scene.whisker, &surface, sample, 400).unwrap();
            let [x, y] = points[points.len() - 1];
            let tip = [
                sample.tip_x_mm.unwrap(),
                surface.distance_mm + sample.tip_height_mm.unwrap(),
            ];
            // Measured: 2e-9 mm, the difference of two resolutions.
            assert!(
                (x - tip[0]).hypot(y - tip[1]) < 1e-7,
                "{name} {x} {y} {tip:?}"
            );
            assert_eq!(points[0], [0.0; 2]);
            if let Some(asperity) = sample.asperity {
                let centre = [surface.asperities_mm()[asperity], surface.distance_mm];
                let away = points
                    .iter()
                    .map(|[x, y]| (x - centre[0]).hypot(y - centre[1]));
                let nearest = away.fold(f64::INFINITY, f64::min);
                assert!(
                    (nearest - 1e-3 * surface.asperity_radius_um).abs() < 1e-7,
                    "{name} {nearest}"
                );
                sides.push(sample.side.unwrap());
            }
        }
        assert!(Side::BOTH.iter().all(|side| sides.contains(side)), "{name}");
    }
}

/// Courses that the model does not determine end there, with the reason.
#[test]
fn what_the_model_does_not_determine_has_a_reason() {
    let hair = scene("texture_hair");
    // Near its base a hair bends by more than a right angle: its free part comes down onto the surface behind the contact.
    let near = Surface {
        distance_mm: 8.0,
        ..SINGLE
    };
    let angles: Vec<f64> = (-30..=60).map(|i| 1.5 * f64::from(i)).collect();
    let found = texture(&hair.whisker, &near, &course(&angles)).unwrap();
    let first = found
        .samples
        .iter()
        .position(|own| own.reason.is_some())
        .unwrap();
    assert!(
        found.samples[..first]
            .iter()
            .all(|own| own.energy_nj.is_some())
    );
    for sample in &found.samples[first..] {
        assert_eq!(sample.phase, TexturePhase::Undecided);
        assert_eq!(sample.reason, Some(NoTextureState::CrossesSurface));
        assert_eq!(
            (sample.asperity, sample.force_un, sample.tip_x_mm),
            (None, None, None)
        );
        assert_eq!(
            shape(&hair.whisker, &near, sample, 9).unwrap(),
            Vec::<[f64; 2]>::new()
        );
    }
    let last = found.events.last().unwrap();
    assert_eq!(
        (last.event, last.time_s),
        (WhiskEventKind::Undecided, found.samples[first].time_s)
    );
    let stays = found.stays();
    assert_eq!(stays.last().unwrap().end, Some(WhiskEventKind::Undecided));
    // Next to the tip a push ends before the resting whisker is clear of the asperity, as in `whisk`.
    let cone = scene("texture_cone");
    let thick = Surface {
        distance_mm: 16.15,
        asperity_radius_um: 200.0,
        ..SINGLE
    };
    let angles: Vec<f64> = (0..=200).map(|i| 0.02 * f64::from(i) - 2.0).collect();
    let found = texture(&cone.whisker, &thick, &course(&angles)).unwrap();
    let reasons: Vec<_> = found.samples.iter().filter_map(|own| own.reason).collect();
    assert!(
        reasons.contains(&NoTextureState::OnAnAsperity),
        "{reasons:?}"
    );
}

#[test]
fn courses_that_cannot_be_are_refused() {
    let cone = scene("texture_cone");
    let surface = cone.surface.unwrap();
    let refused = |surface: &Surface, angles: &[f64]| {
        texture(&cone.whisker, surface, &course(angles)).unwrap_err()
    };
    assert_eq!(refused(&surface, &[0.0, 91.0]), TextureError::Angle(91.0));
    let why = refused(
        &Surface {
            asperity_radius_um: 400.0,
            ..SINGLE
        },
        &[0.0, 1.0],
    );
    let TextureError::Begin {
        touches_deg: [cb, cf],
        asperity: 0,
        ..
    } = why
    else {
        panic!("{why}");
    };
    // Both touches are accepted as they are.
    let thick = Surface {
        asperity_radius_um: 400.0,
        ..SINGLE
    };
    for touch in [cb, cf] {
        assert!(texture(&cone.whisker, &thick, &course(&[touch, touch + 1.0])).is_ok());
    }
    // Far from the middle the whisker meets the line at a slant, and does not fit between asperities.
    let dense = Surface {
        spacing_um: 101.0,
        distance_mm: 6.0,
        length_mm: 20.0,
        ..SINGLE
    };
    let why = refused(&dense, &[0.0, 1.0]);
    assert!(matches!(why, TextureError::Blocked { .. }), "{why}");
}

/// Histograms keep all weights, and the largest value lies in the last bin.
#[test]
fn histograms_keep_all_weights() {
    let bins = histogram(&[[0.0, 1.0], [0.5, 2.0], [1.0, 4.0]], 4);
    let wanted = [
        ([0.0, 0.25], 1.0),
        ([0.25, 0.5], 0.0),
        ([0.5, 0.75], 2.0),
        ([0.75, 1.0], 4.0),
    ];
    assert_eq!(bins, wanted);
    assert_eq!(histogram(&[[2.0, 1.0], [2.0, 1.0]], 4), [([2.0, 2.0], 2.0)]);
    assert_eq!(histogram(&[], 4), []);
    let found = texture(
        &scene("texture_cone").whisker,
        &scene("texture_cone").surface.unwrap(),
        &AngleCourse::sine(15.0, 0.2, 5.0, 50.0).unwrap(),
    )
    .unwrap();
    let all: f64 = found.tip_histogram().iter().map(|bin| bin.tip_time_s).sum();
    assert!((all - 5.0).abs() < 1e-9, "{all}");
    let stays = found.stays();
    let touches = found
        .events
        .iter()
        .filter(|own| own.event == WhiskEventKind::Touch);
    assert_eq!(stays.len(), touches.count());
    let held: f64 = stays
        .iter()
        .map(|stay| stay.dwell_s.unwrap_or(5.0 - stay.begin_s))
        .sum();
    assert!(held > 4.5 && held < 5.0, "{held}");
}
