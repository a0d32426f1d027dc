//! Films with a pole, whose curves are those of a rod: states come back from few points, also of another program, and with errors.

use super::{SCALE, assert_near, parse, with};
use whiskmap::Side;
use whiskmap::force::{CurvatureFrames, ForceMethod, forces};
use whiskmap::input::CsvTable;
use whiskmap::scene::Scene;
use whiskmap::trace::{Branch, WhiskerPart, WhiskerShape};
use whiskmap::tracking::{ImagePole, NoFrame, TrackedFrame, Tracking, TrackingOptions};

/// Film of eight points along the whisker of `cone.toml`, from `solve_ivp` of scipy.
const OTHER: &str = include_str!("../data/bent_film.csv");

/// Options of a film with this pole, in pixels.
pub(super) fn at_pole(pole: [f64; 2], change: &dyn Fn(&mut TrackingOptions)) -> TrackingOptions {
    with(&|options| {
        options.pole = Some(ImagePole::At(pole));
        options.contact_within_mm = Some(0.3);
        options.curvature_at_mm = Some(5.0);
        change(options);
    })
}

/// Forces of frames by `force --model`, in uN; `None` without a state.
fn forces_un(frames: &[TrackedFrame]) -> Vec<Option<f64>> {
    let scene = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml").unwrap();
    let whisker = scene.first_whisker().whisker;
    let columns = "time_s,curvature_per_mm,at_arc_length_mm,contact,contact_x_mm,contact_y_mm\n";
    let table = frames.iter().fold(columns.to_owned(), |text, row| {
        let numbers = [
            row.curvature_per_mm,
            row.at_arc_length_mm,
            row.contact.map(f64::from),
            row.contact_x_mm,
            row.contact_y_mm,
        ];
        let cell =
            |number: Option<f64>| number.map_or_else(String::new, |number| number.to_string());
        text + &format!("{},{}\n", row.time_s, numbers.map(cell).join(","))
    });
    let table = CsvTable::parse(&table, "frames.csv").unwrap();
    let frames = CurvatureFrames::of(&table, whisker.length_mm, ForceMethod::Model);
    let frames = frames.unwrap().frames;
    let found = forces(&whisker, &scene.pole, &frames, ForceMethod::Model);
    found.iter().map(|frame| frame.force_un).collect()
}

/// Film of another program: numbers of each frame before its points.
fn other_film(mirrored: bool) -> (Tracking, Vec<Vec<Option<f64>>>) {
    let rows = OTHER.lines().skip(2);
    let rows = rows.map(|line| line.split(',').map(|cell| cell.parse().ok()).collect());
    let rows: Vec<Vec<Option<f64>>> = rows.collect();
    let column = |x: f64| if mirrored { 600.0 - x } else { x };
    let mut text = String::new();
    for row in &rows {
        for point in row[7..].chunks(2) {
            let [x, y] = [point[0].unwrap(), point[1].unwrap()];
            text += &format!("{},{},{y}\n", row[0].unwrap(), column(x));
        }
    }
    let options = at_pole([column(292.748_8), 142.216_2], &|_| ());
    (parse(&text, &options).unwrap(), rows)
}

/// Points are exact to 1e-4 px.
#[test]
fn states_of_another_program_come_back_from_eight_points() {
    let (found, rows) = other_film(false);
    let forces = forces_un(&found.frames);
    let mut held = 0;
    for ((row, truth), force) in found.frames.iter().zip(&rows).zip(forces) {
        let [push, curvature, x, y, angle, force_un] =
            [1, 2, 3, 4, 5, 6].map(|column| truth[column]);
        // The first frame in contact is that of the angle 0.
        assert_near(row.angle_deg, push.unwrap() - 0.619_693, 5e-4);
        assert_near(row.rms_mm, 0.0, 1e-5);
        assert_eq!(row.contact, Some(u8::from(curvature.is_some())));
        let Some(curvature) = curvature else {
            continue;
        };
        held += 1;
        assert_near(row.curvature_per_mm, curvature, 2e-5);
        assert_near(row.contact_x_mm, x.unwrap(), 2e-3);
        assert_near(row.contact_y_mm, y.unwrap(), 2e-3);
        assert_near(row.contact_angle_deg, angle.unwrap(), 0.02);
        let part = force.unwrap() / force_un.unwrap() - 1.0;
        assert!(part.abs() < 5e-3, "{part} {truth:?}");
    }
    assert_eq!(held, 17);
    let notes = found.notes.join("\n");
    let taper = "the taper is 0.95, with a standard deviation of ";
    assert!(notes.contains(taper), "{notes}");
    assert!(notes.contains("17 of 23 frames are in contact"), "{notes}");
}

#[test]
fn a_mirrored_film_gives_the_same_rows() {
    let [(plain, _), (mirrored, _)] = [false, true].map(other_film);
    let notes = mirrored.notes.join("\n");
    assert!(notes.contains("the image is mirrored"), "{notes}");
    for (row, other) in mirrored.frames.iter().zip(&plain.frames) {
        assert_near(row.angle_deg, other.angle_deg.unwrap(), 1e-6);
        assert_near(row.curvature_per_mm, other.curvature_per_mm.unwrap(), 1e-8);
        assert_near(row.at_y_mm, other.at_y_mm.unwrap(), 1e-7);
        assert_eq!(row.contact, other.contact);
        if let (Some(y), Some(angle)) = (other.contact_y_mm, other.contact_angle_deg) {
            assert_near(row.contact_y_mm, y, 1e-6);
            assert_near(row.contact_angle_deg, angle, 1e-6);
        }
    }
}

/// State of a frame: push angle in degrees, and the shape in contact.
pub(super) struct Truth {
    push: f64,
    pub shape: Option<WhiskerShape>,
}

/// Film of a whisker at a pole 14 mm from the base: text of the points, centre of the pole in pixels, and truth. Pushes are 0.5 degrees apart.
pub(super) fn film(
    scene: &str,
    side: Side,
    count: usize,
    error_px: f64,
) -> (String, [f64; 2], Vec<Truth>) {
    film_of(1, scene, side, count, error_px)
}

/// Film as of [`film`], with the errors of a seed.
fn film_of(
    seed: u64,
    scene: &str,
    side: Side,
    count: usize,
    error_px: f64,
) -> (String, [f64; 2], Vec<Truth>) {
    let scene = Scene::parse(scene, "scene.toml").unwrap();
    let whisker = scene.first_whisker().whisker;
    let branch = Branch::new(&whisker, &scene.pole, side, 14.0).unwrap();
    let rest = branch.at_rest(count);
    let state = |push: f64| branch.state(push.to_radians(), true).ok();
    let mut pixel_error = {
        let mut bits = seed;
        move || {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            error_px * 12.0_f64.sqrt() * ((bits >> 11) as f64 / (1_u64 << 53) as f64 - 0.5)
        }
    };
    let mut pixel = |[x, y]: [f64; 2], turn_deg: f64| {
        let (sin, cos) = turn_deg.to_radians().sin_cos();
        let [x, y] = [cos * x - sin * y, sin * x + cos * y];
        [x / SCALE + pixel_error(), 300.0 - y / SCALE + pixel_error()]
    };
    let (mut text, mut truth) = (String::new(), Vec::new());
    let end = (1..).find(|step| state(side.sign() * 0.25 * f64::from(*step)).is_none());
    let end = 0.25 * f64::from(end.unwrap() - 1);
    for step in -10..(2.0 * end) as i32 + 12 {
        let push = 0.25 + 0.5 * f64::from(step);
        let held = state(side.sign() * push).filter(|_| push > 0.0 && push < end);
        let shape = held.map(|state| branch.shape(&state, count));
        let push = side.sign() * push;
        let points: Vec<[f64; 2]> = match &shape {
            Some(shape) => {
                let points = shape.points.iter();
                let traced = points.filter(|point| point.part != WhiskerPart::Contact);
                traced.map(|point| pixel([point.x_mm, point.y_mm], 0.0)).collect()
            }
            None => rest.iter().map(|point| pixel(*point, -push)).collect(),
        };
        for [x, y] in points {
            text += &format!("{},{x:?},{y:?}\n", step + 10);
        }
        truth.push(Truth { push, shape });
    }
    let first = state(side.sign()).unwrap();
    let [x, y] = branch.shape(&first, 2).pole_mm;
    (text, [x / SCALE, 300.0 - y / SCALE], truth)
}

pub(super) const CONE: &str = include_str!("../../scenes/cone.toml");

/// Root mean square.
fn rms(numbers: &[f64]) -> f64 {
    let squares: f64 = numbers.iter().map(|number| number * number).sum();
    (squares / numbers.len() as f64).sqrt()
}

/// Errors of 0.2 px in points of straight and curved whiskers, and the taper of a scene with radii of 30 and 6 um.
#[test]
fn few_points_with_errors_show_angles_forces_and_taper() {
    let straight = CONE.replace("parabola_per_mm = 0.02", "parabola_per_mm = 0.0");
    let thick = CONE.replace("tip_radius_um = 1.5", "tip_radius_um = 6.0");
    for (scene, taper) in [(CONE, 0.95), (&*straight, 0.95), (&*thick, 0.8)] {
        for side in Side::BOTH {
            for count in [5, 8, 20] {
                let (text, pole, truth) = film(scene, side, count, 0.2);
                let found = parse(&text, &at_pole(pole, &|_| ())).unwrap();
                let pairs = || found.frames.iter().zip(&truth);
                let zero = pairs().find(|(_, exact)| exact.shape.is_none());
                let zero = zero.map(|(row, exact)| row.angle_deg.unwrap() - exact.push);
                let angles =
                    pairs().map(|(row, exact)| row.angle_deg.unwrap() - exact.push - zero.unwrap());
                let angles: Vec<f64> = angles.collect();
                assert!(rms(&angles) < 0.3, "{side:?} {count} {}", rms(&angles));
                let [end] = &found.detachments[..] else {
                    panic!("{side:?} {count} {:?}", found.detachments)
                };
                let held = truth.iter().filter(|exact| exact.shape.is_some()).count();
                // First touch and detachment are in the middle between frames.
                let wanted = side.sign() * 0.5 * held as f64;
                assert_near(Some(end.push_angle_deg), wanted, 0.9);
                let note = found.notes.iter().find(|note| note.contains("the taper is "));
                let note = note.unwrap().split(['s', ',', ' ']);
                let numbers: Vec<f64> = note.filter_map(|word| word.parse().ok()).collect();
                assert!((numbers[0] - taper).abs() < 0.01, "{side:?} {count} {numbers:?}");
                if scene == CONE {
                    let parts = forces_un(&found.frames).into_iter().zip(&truth);
                    let parts = parts.filter(|(_, exact)| (2.0..15.0).contains(&exact.push.abs()));
                    let parts = parts.filter_map(|(force, exact)| {
                        Some(force? / exact.shape.as_ref()?.state.force_un - 1.0)
                    });
                    let parts: Vec<f64> = parts.collect();
                    assert!(parts.len() >= 20, "{}", parts.len());
                    assert!(rms(&parts) < 0.05, "{side:?} {count} {}", rms(&parts));
                }
            }
        }
    }
}

/// Tapers of films that differ in their errors scatter as their standard deviations say: two of three are within one.
#[test]
fn tapers_scatter_by_their_standard_deviations() {
    const FILMS: u64 = 50;
    let thick = CONE.replace("tip_radius_um = 1.5", "tip_radius_um = 6.0");
    let off = (1..=FILMS).map(|seed| {
        let (text, pole, _) = film_of(seed, &thick, Side::Cb, 8, 0.2);
        let found = parse(&text, &at_pole(pole, &|_| ())).unwrap();
        let mut notes = found.notes.iter();
        let note = notes.find_map(|note| note.strip_prefix("the taper is "));
        let numbers = note.unwrap().split([' ', ',']);
        let numbers: Vec<f64> = numbers.filter_map(|number| number.parse().ok()).collect();
        (numbers[0] - 0.8) / numbers[1]
    });
    let off: Vec<f64> = off.collect();
    let within = off.iter().filter(|off| off.abs() < 1.0).count();
    let rms = rms(&off);
    assert!((27..=41).contains(&within) && (0.75..1.3).contains(&rms), "{within} {rms}");
}

/// The scatter of the curvature without contact is that of its errors in contact, so that `force` has honest standard deviations.
#[test]
fn the_curvature_scatters_alike_with_and_without_contact() {
    let (text, pole, _) = film(CONE, Side::Cb, 8, 0.2);
    let (exact, _, _) = film(CONE, Side::Cb, 8, 0.0);
    let curvatures = |text: &str| {
        let found = parse(text, &at_pole(pole, &|options| options.taper = Some(0.95))).unwrap();
        let rows = found.frames.into_iter();
        rows.map(|row| (row.contact == Some(1), row.curvature_per_mm.unwrap()))
    };
    let pairs = curvatures(&text).zip(curvatures(&exact));
    let scatter = |is_held: bool| {
        let compared = pairs.clone().filter(|(row, exact)| row.0 == is_held && exact.0 == is_held);
        let errors: Vec<f64> = compared.map(|(row, exact)| row.1 - exact.1).collect();
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        rms(&errors.iter().map(|error| error - mean).collect::<Vec<_>>())
    };
    let ratio = scatter(true) / scatter(false);
    assert!((0.5..2.0).contains(&ratio), "{ratio}");
}

/// A taper that is wrong by 0.3 leaves the points off the rod, and a warning says so.
#[test]
fn points_off_the_rod_are_named() {
    let (text, pole, _) = film(CONE, Side::Cb, 8, 0.05);
    let is_off = |taper: Option<f64>| {
        let found = parse(&text, &at_pole(pole, &|options| options.taper = taper)).unwrap();
        let mut warnings = found.warnings.iter();
        warnings.any(|warning| {
            warning.contains("the whisker near the pole is off the rod: check `contact_within_mm`")
        })
    };
    assert_eq!([None, Some(0.95), Some(0.65)].map(is_off), [false, false, true]);
}

#[test]
fn polynomials_remain_where_they_are_selected_or_no_frame_is_free() {
    let (text, pole, truth) = film(CONE, Side::Cb, 20, 0.0);
    let polynomials = at_pole(pole, &|options| options.fit_to_mm = Some(12.0));
    let notes = parse(&text, &polynomials).unwrap().notes.join("\n");
    assert!(notes.contains("curves near the base, up to 12 mm from it"), "{notes}");
    assert!(!notes.contains("rod"), "{notes}");
    // Only frames in contact.
    let is_held = |line: &&str| {
        let frame: usize = line.split(',').next().unwrap().parse().unwrap();
        truth[frame].shape.is_some()
    };
    let held: Vec<&str> = text.lines().filter(is_held).collect();
    let found = parse(&held.join("\n"), &at_pole(pole, &|_| ())).unwrap();
    assert!(!found.notes.join("\n").contains("rod"), "{:?}", found.notes);
    // Without contact, no frame shows the taper.
    let free: Vec<&str> = text.lines().filter(|line| !is_held(line)).collect();
    let notes = parse(&free.join("\n"), &at_pole(pole, &|_| ())).unwrap().notes.join("\n");
    let why = "frames near the pole do not show the taper: 0.95 is taken; give it by `taper`";
    assert!(notes.contains(why), "{notes}");
}

/// The trace does not show whether the whisker touches a pole straight ahead of its end. Frames with four points are gaps.
#[test]
fn a_pole_ahead_of_the_trace_leaves_the_contact_unknown() {
    let mut text = String::new();
    for frame in 0..12 {
        let angle = (2.0 * f64::from(frame) - 10.0_f64).to_radians();
        for point in 0..if frame == 3 { 4 } else { 8 } {
            let s = 400.0 * f64::from(point) / 7.0;
            text += &format!("{frame},{:?},{:?}\n", s * angle.cos(), 300.0 - s * angle.sin());
        }
    }
    // 0.5 mm beyond the tip at the angle 0 of frame 5.
    let found = parse(&text, &at_pole([410.0, 300.0], &|_| ())).unwrap();
    for row in &found.frames {
        let (contact, reason) = match row.frame {
            3 => (None, Some(NoFrame::Missing)),
            5 => (None, None),
            _ => (Some(0), None),
        };
        assert_eq!((row.contact, row.reason), (contact, reason), "{row:?}");
    }
    let why = "in 1 of 12 frames, the pole is ahead of the end of the trace: contact is not known";
    assert!(found.warnings[0].contains(why), "{:?}", found.warnings);
}
