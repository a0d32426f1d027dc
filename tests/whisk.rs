//! Courses of whisking against closed forms, branches and the balance of energy.

use crate::shipped;
use whiskmap::mechanics::rod::{Rest, Side};
use whiskmap::scene::{Parameter, Scene};
use whiskmap::trace::{Branch, DetachmentKind, ShapePoint, WhiskerPart, curve};
use whiskmap::whisk::{
    AngleCourse, CourseError, CourseShapes, CourseStart, Undecided, Whisk, WhiskError, WhiskEvent,
    WhiskEventKind, WhiskOptions, WhiskRegime, whisk, whisk_with,
};

const DISTANCE: f64 = 15.66;

fn scene(name: &str) -> Scene {
    shipped::scene(name)
}

/// The course of the scene's whisker through these angles in degrees, one a second.
fn through(scene: &Scene, distance_mm: f64, angles: &[f64]) -> Result<Whisk, WhiskError> {
    let times = (0..angles.len()).map(|i| i as f64).collect();
    let course = AngleCourse::new(times, angles.to_vec()).unwrap();
    whisk(&scene.whisker, &scene.pole, distance_mm, &course)
}

fn kinds(events: &[WhiskEvent]) -> Vec<(WhiskEventKind, Side)> {
    events.iter().map(|event| (event.event, event.side)).collect()
}

/// The distance of first touch on CF in front of the pole that touches at `distance_mm` on CB.
fn cf_distance(scene: &Scene, distance_mm: f64) -> f64 {
    let rests = [Side::Cb, Side::Cf].map(|side| Rest::new(&scene.whisker.rod(&scene.pole, side)));
    let length = scene.whisker.length_mm;
    let pole = rests[0].pole_at_distance(distance_mm / length).length();
    rests[1].distance_of_pole(pole) * length
}

/// Events are the ends of the detachment curves of both sides, at one distance of the pole. Every state is that of the branch.
#[test]
fn events_and_states_are_those_of_curves_and_branches() {
    for name in ["cone", "cylinder", "measured", "traced"] {
        let scene = scene(name);
        let angles: Vec<f64> = (0..=200).map(|i| f64::from(i) - 30.0).collect();
        let back: Vec<f64> = angles.iter().rev().map(|deg| deg - 120.0).collect();
        let found = through(&scene, DISTANCE, &[angles, back].concat()).unwrap();
        let distances = [DISTANCE, cf_distance(&scene, DISTANCE)];
        let mut detached = found.events.iter().filter(|event| event.event != WhiskEventKind::Touch);
        for (side, distance) in [Side::Cb, Side::Cf].into_iter().zip(distances) {
            let end = curve(&scene.whisker, &scene.pole, side, &[distance])[0];
            let event = detached.next().unwrap();
            let kind = match end.kind {
                DetachmentKind::SlipOff => WhiskEventKind::SlipOff,
                _ => WhiskEventKind::PullOff,
            };
            assert_eq!((event.event, event.side), (kind, side), "{name}");
            let ends = [
                (event.push_angle_deg.unwrap(), end.push_angle_deg),
                (event.force_un.unwrap(), end.force_un),
                (event.energy_nj.unwrap(), end.energy_nj),
            ];
            for (value, wanted) in ends {
                // The pole's distance is the root of an equation: 1e-15 of it can change a push by 1e-12.
                assert!((value / wanted.unwrap() - 1.0).abs() < 1e-11, "{name} {value} {wanted:?}");
            }
            let branch = Branch::new(&scene.whisker, &scene.pole, side, distance).unwrap();
            let in_contact = found.samples.iter().filter(|sample| sample.side == Some(side));
            let in_contact: Vec<_> = in_contact.collect();
            assert!(in_contact.len() > 3, "{name}");
            for sample in in_contact {
                let push = sample.push_angle_deg.unwrap();
                let state = branch.state(push.to_radians(), true).unwrap();
                let wanted = branch.read(&state);
                let pairs = [
                    (sample.force_un, wanted.force_un),
                    (sample.base_moment_nnm, wanted.base_moment_nnm),
                    (sample.energy_nj, wanted.energy_nj),
                    (sample.arc_length_mm, wanted.arc_length_mm),
                ];
                for (value, wanted) in pairs {
                    let value = value.unwrap();
                    assert!(
                        (value - wanted).abs() <= 1e-9 * wanted.abs(),
                        "{name} {push} {value} {wanted}"
                    );
                }
            }
        }
        assert!(detached.next().is_none());
    }
}

/// A straight whisker touches a pole of radius r, at the distance D, on both sides of its centre: asin(r/D) apart from it.
#[test]
fn the_touches_of_a_straight_whisker_are_the_width_of_the_pole_apart() {
    let straight = scene("cone").with(Parameter::ParabolaPerMm, 0.0).unwrap();
    let radius = straight.pole.radius_mm;
    let wanted = 2.0 * (radius / DISTANCE.hypot(radius)).asin().to_degrees();
    let found = through(&straight, DISTANCE, &[-1.0, 40.0, -40.0]).unwrap();
    assert!((found.cf_touch_deg - wanted).abs() < 1e-12);
    let kinds = kinds(&found.events);
    use WhiskEventKind::{SlipOff, Touch};
    let both = [Side::Cb, Side::Cf].map(|side| [(Touch, side), (SlipOff, side)]);
    assert_eq!(kinds, both.concat());
    // The sides are mirror images.
    let [_, cb, _, cf] = &found.events[..] else {
        panic!("{kinds:?}");
    };
    assert!((cb.push_angle_deg.unwrap() + cf.push_angle_deg.unwrap()).abs() < 1e-9);
}

/// In front of a point both touches are at the angle 0. A course that begins there pushes CB first.
#[test]
fn a_course_in_front_of_a_point_begins_on_cb() {
    let point = scene("cone").with(Parameter::PoleRadiusMm, 0.0).unwrap();
    let found = through(&point, DISTANCE, &[0.0, 20.0, -40.0]).unwrap();
    use WhiskEventKind::{SlipOff, Touch};
    let both = [Side::Cb, Side::Cf].map(|side| [(Touch, side), (SlipOff, side)]);
    assert_eq!(kinds(&found.events), both.concat());
}

/// Without a detachment, a cycle returns to the same forces; with one, it does not.
#[test]
fn a_cycle_without_detachment_is_closed() {
    let cone = scene("cone");
    let up: Vec<f64> = (0..=30).map(|i| 0.5 * f64::from(i)).collect();
    let down: Vec<f64> = up.iter().rev().copied().collect();
    let forces = |angles: &[f64]| -> Vec<f64> {
        let found = through(&cone, DISTANCE, angles).unwrap();
        found.samples.iter().map(|sample| sample.force_un.unwrap()).collect()
    };
    let closed = forces(&[&up[..], &down].concat());
    for (one, other) in closed.iter().zip(closed.iter().rev()) {
        assert!((one - other).abs() <= 1e-10 * one.abs());
    }
    let open = forces(&[&up[..], &[16.0], &down[..25]].concat());
    assert!(open[30] > 1.0 && open[31..].iter().all(|force| *force == 0.0));
}

/// A detachment loses its energy less that of a touch at once. What an undecided state holds at once is not known, nor is a touch without energy.
#[test]
fn the_lost_energy_is_unknown_if_one_of_its_energies_is() {
    let detachment = WhiskEvent {
        event: WhiskEventKind::SlipOff,
        angle_deg: 10.0,
        energy_nj: Some(5.0),
        ..WhiskEvent::default()
    };
    let lost = |event: WhiskEventKind, angle_deg: f64, energy_nj: Option<f64>| {
        let next = WhiskEvent { event, angle_deg, energy_nj, ..WhiskEvent::default() };
        let course = Whisk {
            samples: Vec::new(),
            events: vec![detachment, next],
            gaps: Vec::new(),
            cf_touch_deg: 0.0,
            assumed_free_deg: None,
        };
        course.lost_nj()
    };
    let (touch, undecided) = (WhiskEventKind::Touch, WhiskEventKind::Undecided);
    assert_eq!(lost(touch, 10.0, Some(2.0)), 3.0);
    assert_eq!([lost(touch, 11.0, None), lost(undecided, 11.0, None)], [5.0; 2]);
    let unknown = [lost(touch, 10.0, None), lost(undecided, 10.0, Some(5.0))];
    assert!(unknown.iter().all(|lost| lost.is_nan()));
}

/// The work of the base from the touch to the detachment, integrated over the moments of samples, is the energy that is lost.
#[test]
fn the_work_of_the_base_is_the_lost_energy() {
    // Midpoints in u, with the angle at `end (1 - (1 - u)^2)`: the moment is smooth in u at the fold. Measured: 4e-8.
    const COUNT: usize = 4000;
    for (name, distance) in [("cone", DISTANCE), ("cylinder", DISTANCE), ("robot", 60.0)] {
        let scene = scene(name);
        let first = through(&scene, distance, &[-1.0, 200.0, -200.0]).unwrap();
        let detached = first.events.iter().filter(|event| event.event != WhiskEventKind::Touch);
        let mut work = 0.0;
        for end in detached {
            let push = end.push_angle_deg.unwrap();
            let touch = end.angle_deg - push;
            let rest = (0..COUNT).map(|i| (i as f64 + 0.5) / COUNT as f64);
            let angles = rest.clone().map(|u| touch + push * (1.0 - (1.0 - u).powi(2)));
            let angles: Vec<f64> = [touch].into_iter().chain(angles).collect();
            let found = through(&scene, distance, &angles).unwrap();
            let work_of_leg: f64 = rest
                .zip(&found.samples[1..])
                .map(|(u, sample)| {
                    let by_u = push.to_radians() * 2.0 * (1.0 - u);
                    sample.base_moment_nnm.unwrap() * by_u / COUNT as f64
                })
                .sum();
            let energy = end.energy_nj.unwrap();
            assert!(
                (work_of_leg / energy - 1.0).abs() < 1e-6,
                "{name} {:?}: {work_of_leg} {energy}",
                end.side
            );
            work += work_of_leg;
        }
        assert!((work / first.lost_nj() - 1.0).abs() < 1e-6, "{name}");
    }
}

/// What a course cannot tell has a reason; what cannot be is refused.
#[test]
fn undecided_samples_have_a_reason() {
    let cone = scene("cone");
    let why = through(&cone, DISTANCE, &[1.0, 2.0]).unwrap_err();
    assert!(matches!(why, WhiskError::Begin { angle_deg: 1.0, .. }), "{why}");
    assert!(matches!(through(&cone, 30.0, &[0.0, 1.0]), Err(WhiskError::Pole(_))));
    // Next to the tip a push ends before the resting whisker is clear of the pole.
    let found = through(&cone, 19.65, &[-1.0, 0.5, 1.0, 5.0]).unwrap();
    let regimes: Vec<_> =
        found.samples.iter().map(|sample| (sample.regime, sample.reason)).collect();
    let last = (WhiskRegime::Free, None);
    assert_eq!(regimes[3], last);
    assert!(
        regimes[1..3].contains(&(WhiskRegime::Undecided, Some(Undecided::OnThePole))),
        "{regimes:?}"
    );
}

/// The largest number of samples, and the frequency with two samples in a period, are accepted.
#[test]
fn the_ends_of_the_ranges_of_a_sine_are_accepted() {
    let sine = |frequency, seconds| AngleCourse::sine(10.0, frequency, seconds, 1.0);
    let most = sine(0.5, 999_999.0).unwrap();
    assert_eq!(most.times_s().len(), 1_000_000);
    assert_eq!(sine(0.5, 1_000_000.0), Err(CourseError::Samples(1_000_001.0)));
    assert!(matches!(sine(0.51, 10.0), Err(CourseError::Frequency { .. })));
}

/// A course that is cut in the middle of a touch has the states of the whole course if it begins in contact. Without a start, a free
/// whisker is assumed, and a warning says so.
#[test]
fn a_cut_course_begins_in_contact() {
    for friction in [0.0, 0.3] {
        let scene = scene("cone").with(Parameter::Friction, friction).unwrap();
        for sign in [1.0, -1.0] {
            let angles: Vec<f64> = (0..=40).map(|i| sign * f64::from(i) * 0.5).collect();
            let before = [-sign, 0.0].map(|deg| if sign < 0.0 { 5.0 + deg } else { deg });
            let whole = through(&scene, DISTANCE, &[&before[..], &angles].concat()).unwrap();
            assert!(whole.warnings().is_empty() == (sign > 0.0), "{:?}", whole.warnings());
            let cut = &angles[20..];
            let times = (0..cut.len()).map(|i| (22 + i) as f64).collect();
            let course = AngleCourse::new(times, cut.to_vec()).unwrap();
            let of = |start| {
                let mut options = WhiskOptions::default();
                options.start = start;
                whisk_with(&scene.whisker, &scene.pole, DISTANCE, &course, &options).unwrap()
            };
            let held = of(Some(CourseStart::Contact));
            assert_eq!(held.samples[..], whole.samples[22..], "{friction} {sign}");
            assert_eq!(held.events[..], whole.events[1..], "{friction} {sign}");
            assert!(held.warnings().is_empty());
            let free = of(Some(CourseStart::Free));
            assert_eq!(free.samples[0].regime, WhiskRegime::Free);
            let assumed = of(None);
            assert_eq!(assumed.samples, free.samples);
            let is_beyond =
                assumed.warnings().iter().any(|warning| warning.contains("beyond first touch"));
            assert_eq!(is_beyond, sign > 0.0);
        }
    }
}

/// Beyond the ends of both pushes, no course can begin in contact.
#[test]
fn a_course_begins_in_contact_only_where_a_side_holds_the_whisker() {
    let scene = scene("cone");
    let course = AngleCourse::new(vec![0.0, 1.0], vec![20.0, 0.0]).unwrap();
    let mut options = WhiskOptions::default();
    options.start = Some(CourseStart::Contact);
    let found = whisk_with(&scene.whisker, &scene.pole, DISTANCE, &course, &options);
    let why = found.unwrap_err().to_string();
    let wanted = "cannot begin in contact: the first angle is 20 deg; pushes on CB end at 15.609";
    assert!(why.starts_with(wanted), "{why}");
}

/// The course through angles, one a second, with a bridge across gaps of at most `bridge_s`.
fn with_gaps(scene: &Scene, angles: &[f64], bridge_s: f64) -> Whisk {
    let times = (0..angles.len()).map(|i| i as f64).collect();
    let course = AngleCourse::new(times, angles.to_vec()).unwrap();
    let mut options = WhiskOptions::default();
    options.bridge_s = bridge_s;
    whisk_with(&scene.whisker, &scene.pole, DISTANCE, &course, &options).unwrap()
}

fn reasons(found: &Whisk) -> Vec<Option<Undecided>> {
    found.samples.iter().map(|sample| sample.reason).collect()
}

/// A bridged gap takes its angles, and their samples, and nothing else: here they lie on straight lines.
#[test]
fn a_course_continues_across_a_bridged_gap() {
    let whole = [-10.0, -5.0, 0.0, 5.0, 10.0, 15.0, 20.0, 10.0, 0.0, -10.0];
    for friction in [0.0, 0.3] {
        let scene = scene("cone").with(Parameter::Friction, friction).unwrap();
        let mut angles = whole;
        for missing in [2, 4, 5, 8] {
            angles[missing] = f64::NAN;
        }
        let wanted = through(&scene, DISTANCE, &whole).unwrap();
        let found = with_gaps(&scene, &angles, 3.0);
        assert_eq!(kinds(&found.events), kinds(&wanted.events));
        for (event, other) in found.events.iter().zip(&wanted.events) {
            // Times are interpolated over longer lines.
            assert!((event.time_s - other.time_s).abs() < 1e-12, "{event:?} {other:?}");
            assert_eq!(event.force_un, other.force_un);
        }
        for ((sample, other), angle) in found.samples.iter().zip(&wanted.samples).zip(angles) {
            assert_eq!(sample.time_s, other.time_s);
            match angle.is_nan() {
                true => {
                    assert_eq!(sample.reason, Some(Undecided::Bridged), "{sample:?}");
                    assert_eq!(
                        (sample.angle_deg, sample.force_un, sample.side),
                        (None, None, None)
                    );
                }
                false => assert_eq!(sample, other),
            }
        }
        let counts: Vec<_> = found.gaps.iter().map(|gap| (gap.count, gap.is_bridged)).collect();
        assert_eq!(counts, [(1, true), (2, true), (1, true)]);
        assert_eq!(found.lost_nj(), wanted.lost_nj());
        // The longest gap lasts 3 s: a shorter bridge ends there.
        assert!(!with_gaps(&scene, &angles, 2.999).gaps[1].is_bridged);
    }
}

/// After a gap that is not bridged the whisker can be free or in contact, until only one phase is possible.
#[test]
fn a_course_is_undecided_after_a_gap_until_one_phase_is_left() {
    let nan = f64::NAN;
    // At the first angle, no side holds the whisker.
    let angles = [nan, -30.0, 5.0, nan, 10.0, 20.0, 5.0, -5.0, nan];
    for friction in [0.0, 0.3] {
        let scene = scene("cone").with(Parameter::Friction, friction).unwrap();
        let found = with_gaps(&scene, &angles, 0.0);
        let (missing, after) = (Some(Undecided::Missing), Some(Undecided::AfterGap));
        let wanted = [missing, None, None, missing, after, None, None, None, missing];
        assert_eq!(reasons(&found), wanted, "{friction}");
        let regimes: Vec<_> = found.samples[5..8].iter().map(|sample| sample.regime).collect();
        let (free, contact) = (WhiskRegime::Free, WhiskRegime::Contact);
        assert_eq!(regimes, [free, free, contact]);
        let held = through(&scene, DISTANCE, &[-10.0, 20.0, 5.0, -5.0]).unwrap();
        assert_eq!(found.samples[7].force_un, held.samples[3].force_un);
        assert!(found.lost_nj().is_nan());
        let warnings = found.warnings();
        let gaps =
            "missing angles: 3, gaps: 3, the first at 0 s: after them the course is undecided";
        assert!(warnings[0].starts_with(gaps), "{warnings:?}");
        // What friction has dissipated in the gap is not known.
        let known = found.samples[7].dissipated_nj;
        assert_eq!(known.is_none(), friction > 0.0, "{known:?}");
    }
}

/// A course that begins with a gap begins in no known phase, unless a start is given; a bridge does not help.
#[test]
fn a_course_that_begins_with_a_gap_is_undecided_without_a_start() {
    let nan = f64::NAN;
    let angles = [nan, -5.0, -22.0, -30.0, -22.0, nan];
    let (missing, after) = (Some(Undecided::Missing), Some(Undecided::AfterGap));
    let scene = scene("cone");
    let found = with_gaps(&scene, &angles, 100.0);
    assert_eq!(reasons(&found), [missing, after, after, None, None, missing]);
    let warnings = found.warnings();
    let ends_with = "is possible; choose the start `contact` or `free`";
    assert!(warnings[0].ends_with(ends_with), "{warnings:?}");
    let times = (0..angles.len()).map(|i| i as f64).collect();
    let course = AngleCourse::new(times, angles.to_vec()).unwrap();
    let (free, contact) = (WhiskRegime::Free, WhiskRegime::Contact);
    for (start, first) in [(CourseStart::Free, free), (CourseStart::Contact, contact)] {
        let mut options = WhiskOptions::default();
        options.start = Some(start);
        let found = whisk_with(&scene.whisker, &scene.pole, DISTANCE, &course, &options).unwrap();
        assert_eq!(reasons(&found), [missing, None, None, None, None, missing]);
        let regimes = [1, 2, 3, 4].map(|i| found.samples[i].regime);
        assert_eq!(regimes, [first, first, free, free]);
        let warnings = found.warnings();
        let what = "missing angles: 2, gaps: 2, the first at 0 s";
        assert_eq!(warnings[0], what, "{warnings:?}");
    }
}

/// Samples a few roundings before the end of a push have a state: the ends of the push and of the branch are computed apart.
#[test]
fn samples_next_to_an_end_have_states() {
    let text = "title = \"end\"\n[whisker]\nlength_mm = 3.535\nyoungs_modulus_gpa = 0.534\nbase_radius_um = 13.936\ntip_radius_um = 0.6968\n\
                [whisker.curvature]\nparabola_per_mm = 0.218935\n[whisker.projection]\narc_stretch = 1.0525\n\
                [grid]\npush_angle_deg = [-60, 60]\ndistance_mm = [1.0178]\n";
    let scene = Scene::parse(text, "next to an end").unwrap();
    let distance = scene.grid.distance_mm[0];
    // From either side of the pole, the whisker touches it and is pushed beyond its end.
    for from in [-90.0, 90.0] {
        let whole = through(&scene, distance, &[from, -from]).unwrap();
        let end = whole.events[1].angle_deg;
        let before = (0..25).rev().map(|i| end * (1.0 - f64::from(i) * f64::EPSILON));
        let angles: Vec<f64> = std::iter::once(from).chain(before).collect();
        let found = through(&scene, distance, &angles).unwrap();
        assert_eq!(reasons(&found), vec![None; angles.len()], "{end}");
    }
}

#[test]
fn a_course_of_missing_angles_is_refused() {
    let course = AngleCourse::new(vec![0.0, 1.0, 2.0], vec![f64::NAN, 1.0, f64::NAN]);
    let (known, angles) = (1, 3);
    assert_eq!(course, Err(CourseError::Missing { known, angles }));
}

/// Contact and curvature of samples are those of the shape, which is fixed to the pole: on both sides, with and without friction.
#[test]
fn contacts_and_curvatures_are_those_of_shapes() {
    let angles: Vec<f64> = [-20.0, -5.0, 3.0, 9.0, 15.0, 20.0, 5.0, -3.0, -12.0, -20.0].to_vec();
    for (name, friction) in [("cone", 0.0), ("cone", 0.3), ("measured", 0.0)] {
        let scene = scene(name).with(Parameter::Friction, friction).unwrap();
        let times = (0..angles.len()).map(|i| i as f64).collect();
        let course = AngleCourse::new(times, angles.clone()).unwrap();
        let mut options = WhiskOptions::default();
        let length = scene.whisker.length_mm;
        let at_mm = 0.1 * length;
        options.curvature_at_mm = Some(at_mm);
        let found = whisk_with(&scene.whisker, &scene.pole, DISTANCE, &course, &options).unwrap();
        let rest = Rest::new(&scene.whisker.rod(&scene.pole, Side::Cb));
        let mut compared = [0; 2];
        for sample in &found.samples {
            let Some(side) = sample.side else {
                assert_eq!(sample.contact_x_mm, None);
                let curvature = sample.curvature_per_mm.unwrap();
                assert_eq!(curvature, rest.curvature(at_mm / length) / length);
                continue;
            };
            let is_cf = side == Side::Cf;
            let distance = if is_cf { cf_distance(&scene, DISTANCE) } else { DISTANCE };
            let branch = Branch::new(&scene.whisker, &scene.pole, side, distance).unwrap();
            let push = sample.push_angle_deg.unwrap();
            let state = branch.state(push.to_radians(), true).unwrap();
            let shape = branch.shape(&state, 101);
            let contact =
                shape.points.iter().find(|point| point.part == WhiskerPart::Contact).unwrap();
            let near = |point: &&ShapePoint| (point.arc_length_mm - at_mm).abs() < 1e-9;
            let at = shape.points.iter().find(near).unwrap();
            // The axes of first touch on CF are turned by the touch.
            let turn = if is_cf { -found.cf_touch_deg.to_radians() } else { 0.0 };
            let (sin, cos) = turn.sin_cos();
            let [x, y] = [contact.x_mm, contact.y_mm];
            let wanted = [x * cos - y * sin, x * sin + y * cos];
            let contact = [sample.contact_x_mm.unwrap(), sample.contact_y_mm.unwrap()];
            let miss = (contact[0] - wanted[0]).hypot(contact[1] - wanted[1]);
            assert!(miss < 1e-8, "{name} {friction} {contact:?} {wanted:?}");
            let curvature = sample.curvature_per_mm.unwrap();
            assert!(
                (curvature - at.curvature_per_mm).abs() < 1e-9,
                "{name} {friction} {curvature} {at:?}"
            );
            compared[usize::from(is_cf)] += 1;
        }
        assert!(compared[0] > 1 && compared[1] > 1, "{compared:?}");
    }
    let scene = scene("cone");
    let course = AngleCourse::new(vec![0.0, 1.0], vec![0.0, 5.0]).unwrap();
    for at_mm in [-1.0, 20.1, f64::NAN] {
        let mut options = WhiskOptions::default();
        options.curvature_at_mm = Some(at_mm);
        let why = whisk_with(&scene.whisker, &scene.pole, DISTANCE, &course, &options).unwrap_err();
        let said = format!("curvature_at_mm = {at_mm}: must be between 0 and 20");
        assert!(why.to_string().starts_with(&said), "{why}");
    }
}

/// Shapes of a course stand at the pole: a bent whisker has its contact at the sample's, and a free one is turned with the base.
#[test]
fn shapes_of_a_course_stand_at_the_pole() {
    const POINTS: usize = 40;
    let angles = [-20.0, -5.0, 3.0, 9.0, 15.0, 20.0, 5.0, -3.0, -12.0, -20.0];
    let scene = scene("cone");
    let found = through(&scene, DISTANCE, &angles).unwrap();
    let shapes = CourseShapes::new(&scene.whisker, &scene.pole, DISTANCE, &found).unwrap();
    let mut compared = [0; 3];
    for sample in &found.samples {
        let even = shapes.points(sample, POINTS, false).unwrap();
        let all = shapes.points(sample, POINTS, true).unwrap();
        assert_eq!(even.len(), POINTS);
        let Some(side) = sample.side else {
            assert_eq!(even, all);
            let direction = even[1][1].atan2(even[1][0]).to_degrees();
            // Along the first point, the resting whisker bends by 0.6 degrees.
            assert!((direction + sample.angle_deg.unwrap()).abs() < 1.0);
            compared[2] += 1;
            continue;
        };
        let contact = [sample.contact_x_mm, sample.contact_y_mm].map(Option::unwrap);
        let apart = |at: [f64; 2]| (at[0] - contact[0]).hypot(at[1] - contact[1]);
        let nearest = all.iter().map(|at| apart(*at)).fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-8, "{nearest} {sample:?}");
        assert!((apart(shapes.pole_mm) - scene.pole.radius_mm).abs() < 1e-8);
        compared[usize::from(side == Side::Cf)] += 1;
    }
    assert!(compared.into_iter().all(|count| count > 1), "{compared:?}");
}
