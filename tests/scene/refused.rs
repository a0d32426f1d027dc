//! Refused scenes, and the place, the value and the limits in their messages.

use std::fs;
use std::path::Path;

use whiskmap::scene::Scene;

use super::{BASE, parse, sweep, with_line};
use crate::program::no_file;

#[test]
fn a_bad_value_is_named_with_its_place_and_what_is_allowed() {
    let cases = include_str!("refused.txt").lines();
    for case in cases.filter(|line| !line.starts_with('#')) {
        let cells: Vec<&str> = case.split(" | ").collect();
        let [line, replacement, place, parts @ ..] = &cells[..] else {
            panic!("no case: {case}");
        };
        let message = parse(&with_line(line.parse().unwrap(), replacement)).expect_err(case);
        let place = format!(" test.toml:{place}");
        for part in parts.iter().copied().chain([&*place, "error: "]) {
            assert!(message.contains(part), "{case}\nno {part:?} in:\n{message}");
        }
        assert!(!parts.is_empty() && !message.contains('\u{1b}'), "{message}");
    }
}

#[test]
fn the_whole_message_reads_like_this() {
    let why = Scene::parse(&with_line(5, "tip_radius_um = 40"), "test.toml").unwrap_err();
    let expected = "\
error: whisker.tip_radius_um = 40: must be between 0 and base_radius_um (30)
 --> test.toml:5:17
  |
5 | tip_radius_um = 40
  |                 ^^";
    assert_eq!(why.to_string(), expected);
    assert_eq!(why.render(false), expected);
    assert!(why.render(true).contains("\u{1b}["));

    // Of a value over several lines, only the first is shown.
    let expected = "\
error: title: must be one line of text
 --> test.toml:1:9
  |
1 | title = \"\"\"over
  |         ^^^^^^^";
    let why = parse(&with_line(1, "title = \"\"\"over\ntwo lines\"\"\"")).unwrap_err();
    assert_eq!(why, expected);
}

/// The tip's radius is said once.
#[test]
fn a_taper_axis_gives_the_tip_its_radius() {
    let both = BASE.replace("# taper", "taper");
    let why = parse(&both).unwrap_err();
    let said = "whisker.tip_radius_um = 1.5: must be left out: grid.taper gives every whisker of the sweep its tip";
    assert!(why.contains(said) && why.contains("test.toml:5:17"), "{why}");
    assert!(parse(&sweep()).is_ok());
    let neither = sweep().replace("taper =", "# taper =");
    let why = parse(&neither).unwrap_err();
    assert!(why.contains("whisker.tip_radius_um: is left out"), "{why}");
}

/// Checks that need more than one line of the base scene to be reached.
#[test]
fn values_at_odds_with_each_other_are_refused() {
    // The axis' largest coefficient, 0.04, decides; not the whisker's own 0.02.
    let base = BASE.replace("distance_mm = [2.0,", "distance_mm = [");
    let bulky = base.replace("radius_mm = 0.25", "radius_mm = 6").replace("0.04]", "0.1]");
    let why = parse(&bulky).unwrap_err();
    let sharpest = "pole.radius_mm = 6: must be at least 0 and less than the whisker's smallest radius of curvature (5)";
    assert!(why.contains(sharpest), "{why}");
    let slim = bulky.replace("curvature_per_mm = [0, 0.1]", "");
    assert!(parse(&slim).is_ok(), "the whisker's own coefficient allows 25 mm");

    let far = BASE.replace("vertex_mm = 2.5", "vertex_mm = 30").replace("0.04]", "0.05]");
    let why = parse(&far).unwrap_err();
    assert!(why.contains("vertex_mm = 30: must be") && why.contains("(28.28"), "{why}");
    assert!(parse(&far.replace("curvature_per_mm = [0, 0.05]", "")).is_ok());

    let many = BASE
        .replace("count = 5", "count = 65536")
        .replace("[0, 0.04]", "{ from = 0, to = 0.04, count = 65536 }")
        .replace("[2.0, 7.5, 20.0]", "{ from = 2, to = 20, count = 65536 }");
    let why = parse(&many).unwrap_err();
    let cells = "grid: must have at most 17592186044416 cells over all axes, has 281474976710656";
    assert!(why.contains(cells) && why.contains(":12:1"), "{why}");
}

#[test]
fn unreadable_files_have_different_messages() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        path
    };
    let message = |path: &Path| {
        let message = Scene::read(path).unwrap_err().to_string();
        assert!(message.contains(path.to_str().unwrap()), "{message}");
        message
    };
    let none = message(&folder.path().join("none.toml"));
    assert!(none.contains(&format!("cannot be read: {}", no_file())));
    assert!(message(folder.path()).to_lowercase().contains("cannot be read: is a directory"));
    assert!(message(&file("large.toml", &vec![b'#'; (1 << 20) + 1])).contains("longer than 1 MiB"));
    let latin = message(&file("latin.toml", b"title = 'x'\n# 5 \xb5m\n"));
    assert!(latin.contains("not UTF-8 text: byte 0xB5"), "{latin}");
    assert!(latin.contains("latin.toml:2:5"), "{latin}");

    let unnamed = BASE.replace("name = \"base\"", "");
    for name in ["plain", "my scene", "\u{30d2}\u{30b2} \u{b5}"] {
        let path = file(&format!("{name}.toml"), unnamed.as_bytes());
        assert_eq!(Scene::read(&path).unwrap().name, name);
    }
    let full = [unnamed.as_bytes(), b"#", &vec![b'x'; (1 << 20) - unnamed.len() - 1]].concat();
    assert!(Scene::read(file("full.toml", &full)).is_ok(), "1 MiB is allowed");
}

#[test]
fn a_byte_order_mark_and_windows_line_ends_do_no_harm() {
    let windows = format!("\u{feff}{}", BASE.replace('\n', "\r\n"));
    assert!(parse(&windows).is_ok());
    let why = parse(&windows.replace("tip_radius_um = 1.5", "tip_radius_um = 40")).unwrap_err();
    assert!(why.contains("test.toml:5:17") && why.contains("um = 40: must"), "{why}");
}

/// Commas of texts and of unknown keys are no decimal commas, and lists with spaces are lists.
#[test]
fn hints_about_commas_are_not_given_elsewhere() {
    for (line, text) in [
        (1, "titel = \"1,5 mm\""),
        (1, "title = \"1,5"),
        (5, "tip_radius = \"1,5\""),
        (14, "distance_mm = [10, 5]"),
        (14, "distance_mm = [7.5,7.5]"),
    ] {
        let why = parse(&with_line(line, text)).unwrap_err();
        let is_named = ["not a comma", "decimal points"].map(|hint| why.contains(hint));
        assert!(!is_named[0] && !is_named[1], "{why}");
    }
}

/// However long a value or a key is, the message quotes its beginning and its end.
#[test]
fn long_lines_are_cut_around_the_place() {
    let long = "x".repeat(400_000);
    for (line, said) in [
        (format!("tip_radius_um = \"{long}\""), "xxx\", expected a number"),
        (format!("{long} = 1"), "xxx`, expected one of `length_mm`"),
        (format!("tip_radius_um = {long}"), "must be quoted"),
        (format!("tip_radius_um = 40 # {long}"), "um = 40: must be between"),
        (format!("tip_radius_um = {}", "4".repeat(400_000)), "overflowed"),
    ] {
        let why = parse(&with_line(5, &line)).unwrap_err();
        assert!(why.contains(said) && why.contains("test.toml:5:"), "{why}");
        assert!(why.len() < 1000, "{} bytes", why.len());
    }
}
