//! Films that do not fit their pole or their options: a warning names what is wrong, and a contact that is not known is no contact of 0.

use super::rods::{CONE, Truth, at_pole, film};
use super::{SCALE, deeplabcut, exact, options, parse, with};
use whiskmap::Side;
use whiskmap::tracking::{ImagePole, NoFrame, Tracking};

/// Returns the film with this change of the position of each point, in pixels: `(frame, point, position)`. Points without a position are left out.
fn changed(
    text: &str,
    count: usize,
    change: impl Fn(usize, usize, [f64; 2]) -> Option<[f64; 2]>,
) -> String {
    let lines = text.lines().enumerate().filter_map(|(i, line)| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let [x, y] = change(i / count, i % count, [cells[1], cells[2]])?;
        Some(format!("{},{x:?},{y:?}\n", cells[0]))
    });
    lines.collect()
}

/// Returns true if a warning has this text.
fn warns(found: &Tracking, text: &str) -> bool {
    found.warnings.iter().any(|warning| warning.contains(text))
}

/// Frames whose state has a force, but that have the contact 0.
fn wrongly_free(found: &Tracking, truth: &[Truth]) -> Vec<u64> {
    let pairs = found.frames.iter().zip(truth);
    let wrong = pairs.filter(|(row, exact)| exact.shape.is_some() && row.contact == Some(0));
    wrong.map(|(row, _)| row.frame).collect()
}

const UNLIKE: &str = "frames far from the pole have no shape at rest in common";

#[test]
fn a_pole_on_the_other_side_of_the_base_leaves_contacts_unknown() {
    let (text, [x, y], truth) = film(CONE, Side::Cb, 8, 0.05);
    // In the second film, the pole is 15 mm farther down.
    for (down, is_aside) in [(0.0, false), (300.0, true)] {
        let found = parse(&text, &at_pole([x, 600.0 - y + down], &|_| ())).unwrap();
        assert!(warns(&found, UNLIKE), "{:?}", found.warnings);
        let far = "no frame comes near the pole: the whisker is ";
        assert_eq!(warns(&found, far), is_aside, "{:?}", found.warnings);
        assert!(found.frames.iter().all(|row| row.contact.is_none()));
        assert!(!found.notes.iter().any(|note| note.contains("mirrored")));
    }
    // The pole where it is gives neither.
    let found = parse(&text, &at_pole([x, y], &|_| ())).unwrap();
    assert_eq!(found.warnings, [""; 0]);
    assert_eq!(wrongly_free(&found, &truth), [0; 0]);
}

/// Eleven of twenty points: up to 10.5 mm along a whisker that touches the pole at 14 mm.
#[test]
fn a_trace_that_ends_before_the_pole_leaves_contacts_unknown() {
    let (text, pole, truth) = film(CONE, Side::Cb, 20, 0.0);
    let text = changed(&text, 20, |_, point, at| (point < 11).then_some(at));
    for taper in [None, Some(0.95)] {
        let found = parse(&text, &at_pole(pole, &|options| options.taper = taper)).unwrap();
        assert!(warns(&found, UNLIKE), "{:?}", found.warnings);
        assert_eq!(wrongly_free(&found, &truth), [0; 0]);
        assert!(!found.notes.iter().any(|note| note.contains("mirrored")));
    }
}

/// The pole has a radius of 0.25 mm.
#[test]
fn a_distance_in_contact_below_the_radius_of_the_pole_is_named() {
    let (text, pole, truth) = film(CONE, Side::Cb, 8, 0.05);
    let small = at_pole(pole, &|options| options.contact_within_mm = Some(0.2));
    let found = parse(&text, &small).unwrap();
    let bent = "frames, the whisker is bent at the pole, but is 0.25 mm from its centre (median), more \
                than 0.2 mm: check `contact_within_mm`, the pole's position, `taper` and `mm_per_pixel`";
    assert!(warns(&found, bent), "{:?}", found.warnings);
    assert_eq!(wrongly_free(&found, &truth), [0; 0]);
}

#[test]
fn few_points_without_a_shape_at_rest_leave_contacts_unknown() {
    for (count, is_known) in [(5, false), (20, true)] {
        let (text, pole, truth) = film(CONE, Side::Cb, count, 0.0);
        let held = changed(&text, count, |frame, _, at| truth[frame].shape.is_some().then_some(at));
        let found = parse(&held, &at_pole(pole, &|_| ())).unwrap();
        let why = "fewer than 3 frames are more than ";
        assert!(warns(&found, why), "{:?}", found.warnings);
        let hidden = "curves are polynomials that do not show contact, which is empty";
        assert_eq!(warns(&found, hidden), !is_known, "{:?}", found.warnings);
        let known = found.frames.iter().filter(|row| row.contact.is_some());
        assert_eq!(known.count() > 0, is_known);
        assert!(!warns(&found, "`pole`"), "{:?}", found.warnings);
    }
}

#[test]
fn body_parts_that_are_lost_in_all_frames_are_named() {
    let lost = |part: &'static str| {
        deeplabcut(move |_, name, [x, y]| {
            (format!("{x},{y}"), if name == part { 0.1 } else { 1.0 })
        })
    };
    let base = parse(&lost("base"), &options()).unwrap();
    let why = "body part base: lost in all frames, at a likelihood of at least 0.9: the whisker is traced without it";
    assert_eq!(base.warnings[0], why);
    let pole = with(&|options| {
        options.pole = Some(ImagePole::Part("g".to_owned()));
        options.contact_within_mm = Some(0.3);
    });
    let found = parse(&lost("g"), &pole).unwrap();
    assert!(warns(&found, "body part g: lost in all frames"), "{:?}", found.warnings);
    assert!(warns(&found, "contacts are not known"), "{:?}", found.warnings);
    assert!(!warns(&found, "5 with `pole`"), "{:?}", found.warnings);
    assert_eq!(parse(&lost("none"), &options()).unwrap().warnings.len(), 1, "few points");
}

/// A frame in contact is displaced by 30 pixels.
#[test]
fn a_displaced_frame_has_no_curve() {
    let (text, pole, truth) = film(CONE, Side::Cb, 8, 0.05);
    let held = truth.iter().position(|exact| exact.shape.is_some()).unwrap() + 8;
    let text =
        changed(&text, 8, |frame, _, [x, y]| Some([if frame == held { x + 30.0 } else { x }, y]));
    let found = parse(&text, &at_pole(pole, &|_| ())).unwrap();
    for row in &found.frames {
        let reason = (row.frame == held as u64).then_some(NoFrame::NoCurve);
        assert_eq!(row.reason, reason, "{row:?}");
    }
    assert_eq!(found.warnings, [""; 0]);
}

#[test]
fn good_films_have_no_warning_and_no_gap() {
    for side in Side::BOTH {
        for (count, error_px) in [(5, 0.0), (5, 0.2), (8, 0.2), (20, 0.5), (40, 0.3)] {
            let (text, pole, _) = film(CONE, side, count, error_px);
            let found = parse(&text, &at_pole(pole, &|_| ())).unwrap();
            assert_eq!(found.warnings, [""; 0], "{side:?} {count} {error_px}");
            let gap = found.frames.iter().find(|row| row.reason.is_some());
            assert_eq!(gap, None, "{side:?} {count} {error_px}");
        }
    }
}

/// The number of pixels per mm in place of the size of a pixel makes a whisker of 8 m.
#[test]
fn a_whisker_of_an_unlikely_length_is_named() {
    let is_long = |warning: &String| {
        warning.contains("mm long (median): expected 1 to 200 mm; mm_per_pixel = 20 is")
    };
    let film = deeplabcut(exact);
    let inverse = with(&|options| options.mm_per_pixel = 1.0 / SCALE);
    let warnings = parse(&film, &inverse).unwrap().warnings;
    assert_eq!(warnings.iter().filter(|warning| is_long(warning)).count(), 1, "{warnings:?}");
    let warnings = parse(&film, &options()).unwrap().warnings;
    assert!(!warnings.iter().any(|warning| warning.contains("mm long")), "{warnings:?}");
}

/// Frames that are lost while the whisker slips off, returns and touches the pole on its other side join two contacts, which give no detachment.
#[test]
fn a_gap_between_contacts_on_both_sides_hides_their_ends() {
    let (text, pole, _) = film(CONE, Side::Cb, 8, 0.0);
    let (back, other_pole, _) = film(CONE, Side::Cf, 8, 0.0);
    let whole = parse(&text, &at_pole(pole, &|_| ())).unwrap();
    assert_eq!(whole.detachments.len(), 1);
    let contacts = |found: &Tracking| {
        let rows = found.frames.iter().filter(|row| row.contact == Some(1));
        rows.map(|row| row.frame).collect::<Vec<_>>()
    };
    let on_cb = contacts(&whole);
    let of_back = parse(&back, &at_pole(other_pole, &|_| ())).unwrap();
    assert!(of_back.notes.iter().any(|note| note.contains("first touch on CF; in `whisk`")));
    assert!(whole.notes.iter().any(|note| note.ends_with("first touch on CB")));
    let on_cf = contacts(&of_back);
    // The second film moves to the pole of the first one. From its contacts on, it follows those of the first one, after a gap.
    let [until, from] = [on_cb[on_cb.len() - 4], on_cf[on_cf.len() / 2]];
    let moved = [pole[0] - other_pole[0], pole[1] - other_pole[1]];
    let numbered = |line: &str, to: &dyn Fn(u64) -> Option<u64>, by: [f64; 2]| {
        let cells: Vec<&str> = line.split(',').collect();
        let frame = to(cells[0].parse().unwrap())?;
        let [x, y]: [f64; 2] = [1, 2].map(|i| cells[i].parse().unwrap());
        Some(format!("{frame},{:?},{:?}\n", x + by[0], y + by[1]))
    };
    let first = |frame: u64| (frame <= until).then_some(frame);
    let second = |frame: u64| (frame >= from).then(|| until + 5 + frame - from);
    let both = text.lines().filter_map(|line| numbered(line, &first, [0.0; 2]));
    let both = both.chain(back.lines().filter_map(|line| numbered(line, &second, moved)));
    let joined = parse(&both.collect::<String>(), &at_pole(pole, &|_| ())).unwrap();
    let known = joined.frames.iter().filter(|row| row.contact == Some(1)).count() as u64;
    assert!(known > on_cb.len() as u64 / 2, "{known}");
    assert_eq!(joined.detachments, [], "{:?}", joined.notes);
    let count = "contacts that give no detachment: 2 (";
    assert!(joined.notes.iter().any(|note| note.starts_with(count)), "{:?}", joined.notes);
}
