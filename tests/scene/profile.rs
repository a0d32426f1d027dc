//! Measured radii: what is accepted, and what is refused.

use std::fs;

use whiskmap::Side;
use whiskmap::random::RandomStream;
use whiskmap::scene::{Parameter, Scene};
use whiskmap::trace::{Detachment, curve};

use super::parse;
use super::shape::{refusal, scene};
use crate::program::no_file;

const ROWS: &str = "[whisker.profile]\nrows = [[0, 30], [5, 31], [12.5, 10], [20, 1.5]]";

#[test]
fn radii_are_read_from_the_scene_and_from_a_file() {
    let listed = parse(&scene(ROWS, "")).unwrap();
    let whisker = &listed.whisker;
    assert_eq!((whisker.base_radius_um, whisker.tip_radius_um), (30.0, 1.5));
    let rows = [[0.0, 1.0], [0.25, 31.0 / 30.0], [0.625, 1.0 / 3.0], [1.0, 0.05]];
    assert_eq!(whisker.profile.as_deref(), Some(&rows[..]));

    let folder = tempfile::tempdir().unwrap();
    let csv =
        "# a remark\nwhisker, arc_length_mm ,radius_um\nC2, 0,30\nC2,5,31\nC2,12.5,10\nC2,20,1.5\n";
    fs::write(folder.path().join("radii.csv"), csv).unwrap();
    let path = folder.path().join("scene.toml");
    fs::write(&path, scene("[whisker.profile]\nrows = \"radii.csv\"", "")).unwrap();
    let read = Scene::read(&path).unwrap();
    assert_eq!(read.whisker, *whisker);

    // What is kept with a map stands for itself.
    fs::remove_dir_all(folder.path()).unwrap();
    assert_eq!(parse(&read.to_toml()).unwrap().whisker, *whisker);
}

#[test]
fn radii_that_are_refused() {
    for (rows, why) in [
        (
            "\"no.csv\"",
            "rows = \"no.csv\": must be a list of rows: only a scene file may name a CSV file",
        ),
        ("5", "expected the name of a CSV file or a list"),
        ("[]", "must be 2 to 256 rows, are 0"),
        ("[[0, 30], [20]]", "invalid length 1, expected a list of 2 numbers"),
        ("[[0, 30, 1], [20, 1]]", "invalid length 3, expected a list of 2 numbers"),
        ("[[0, 30], [20, \"thin\"]]", "expected a number"),
        ("[[0, 30], [20, 0]]", "rows[1]: the radius must be between"),
        ("[[0, 30], [20, nan]]", "rows[1]: the radius must be between"),
        ("[[0, 30], [0, 20], [20, 1]]", "rows[1]: the arclength must grow"),
        ("[[0, 30], [nan, 20], [20, 1]]", "rows[1]: the arclength must grow"),
        ("[[0, 30], [21, 1]]", "rows[1]: the arclength must grow"),
        ("[[0, 30], [1e-200, 20], [20, 1]]", "rows[1]: must be farther from the row before it"),
        ("[[1, 30], [20, 1]]", "must begin at the base, at 0, and end at length_mm"),
        ("[[0, 30], [19, 1]]", "end at length_mm (20)"),
        (
            "[[0, 30], [20, 31]]",
            "the radius at the tip must be at most that at the base (30), is 31",
        ),
        ("[[0, 30], [20, 0.02]]", "rows[1]: the radius must be between a thousandth"),
        (
            "[[0, 30], [2, 29], [3, 2], [4, 28], [20, 1]]",
            "rows[2]: the radius must be at least 7 um, is 2: a waist is at most four times as thin",
        ),
        (
            "[[0, 2], [5, 9], [20, 1]]",
            "rows[1]: the radius must be between a thousandth of that at the base (0.002) and four times it (8), is 9",
        ),
        (
            "[[0, 30], [5, 12], [6, 2.9], [7, 11], [8, 12], [20, 1]]",
            "rows[2]: the radius must be at least 3 um",
        ),
        ("[[0, 1], [5, 0.0009], [20, 1]]", "rows[1]: the radius must be"),
    ] {
        let message = refusal(&scene(&format!("[whisker.profile]\nrows = {rows}"), ""));
        assert!(message.contains(why), "{rows}: {message}");
    }
    // A step, a bulge and a waist that is just shallow enough.
    for rows in [
        "[[0, 30], [2, 30], [3, 2], [20, 2]]",
        "[[0, 30], [5, 20], [6, 120], [7, 20], [20, 1]]",
        "[[0, 30], [5, 30], [6, 3], [7, 12], [20, 1]]",
    ] {
        let accepted = parse(&scene(&format!("[whisker.profile]\nrows = {rows}"), ""));
        assert_eq!(accepted.err(), None, "{rows}");
    }
    let both = scene("", "").replace("[pole]", &format!("{ROWS}\n[pole]"));
    assert!(
        refusal(&both).contains("base_radius_um = 30.0: must be left out"),
        "{}",
        refusal(&both)
    );
    let neither = scene(ROWS, "").replace(ROWS, "");
    assert!(refusal(&neither).contains("whisker.base_radius_um: is left out"));
    let axis = scene(ROWS, "").replace("[grid]", "[grid]\ntaper = [0, 0.5]");
    assert!(refusal(&axis).contains("grid.taper: must be left out"));
}

#[test]
fn a_bad_csv_file_is_named_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    fs::write(&path, scene("[whisker.profile]\nrows = \"radii.csv\"", "")).unwrap();
    for (csv, why) in [
        (
            "arc_length_mm,radius\n0,30\n",
            "radii.csv:1: found arc_length_mm, radius; needed arc_length_mm, radius_um, each once; `radius` is not known; did you mean `radius_um`",
        ),
        (
            "arc_length_mm,radius_um\n0,30\n1,thin\n",
            "radii.csv:3: radius_um = thin: must be a number",
        ),
        (
            "arc_length_mm,radius_um\n0,30\n1\n",
            "radii.csv:3: has 1 cell: must have 2, one a column",
        ),
        (
            "arc_length_mm,radius_um\n# a remark\n0,30\n\n# another\n20,nan\n",
            "radii.csv:6: radius_um = nan: must be a number",
        ),
        (
            "arc_length_mm,radius_um\n0,30\n20,0.001\n",
            "line 3: the radius must be between a thousandth",
        ),
        ("arc_length_mm,radius_um\n0,30\n21,1\n", "line 3: the arclength"),
        ("", "radii.csv: has no rows"),
        ("arc_length_mm,radius_um\n0,30\n", "must be 2 to 256 rows, are 1"),
        (
            "arc_length_mm,radius_um\n0,30\n# a slip\n3,2\n4,30\n20,1\n",
            "line 4: the radius must be at least 7.5 um",
        ),
        (&format!("arc_length_mm,radius_um\n{}", "0,1\n".repeat(300)), "are more"),
    ] {
        fs::write(folder.path().join("radii.csv"), csv).unwrap();
        let message = Scene::read(&path).unwrap_err().to_string();
        assert!(message.contains(why), "{csv:.100}: {message}");
        assert!(message.contains("rows = \"radii.csv\""), "{message}");
    }

    // The tables of other countries and programs have the same rows.
    fs::write(
        folder.path().join("radii.csv"),
        "day;radius_um;arc_length_mm\n1;30;0\n2;20,5;5\n3;1,5;20\n",
    )
    .unwrap();
    let read = Scene::read(&path).unwrap();
    let rows = read.whisker.profile.as_ref().unwrap();
    assert_eq!(rows[1], [5.0 / 20.0, 20.5 / 30.0]);
    let note = read.notes().first().unwrap();
    let wanted = "radii.csv:1: columns that are not used: day";
    assert!(note.ends_with(wanted), "{note}");

    // What is wrong elsewhere is shown where the scene's own text has it.
    fs::write(folder.path().join("radii.csv"), "arc_length_mm,radius_um\n0,30\n5,20\n20,1\n")
        .unwrap();
    let text = fs::read_to_string(&path).unwrap();
    let text = text.replace("radius_mm = 0.25", "radius_mm = -1");
    fs::write(&path, &text).unwrap();
    let line = 1 + text.lines().position(|l| l.starts_with("radius_mm")).unwrap();
    let message = Scene::read(&path).unwrap_err().to_string();
    assert!(message.contains(&format!("scene.toml:{line}:")), "{message}");
}

/// A map or a store brings its scene along: checking its text opens no file, even one that is there.
#[test]
fn the_text_of_a_scene_names_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let csv = folder.path().join("radii.csv");
    fs::write(&csv, "arc_length_mm,radius_um\n0,30\n20,1\n").unwrap();
    let text = scene(&format!("[whisker.profile]\nrows = {csv:?}"), "");
    let path = folder.path().join("scene.toml");
    fs::write(&path, &text).unwrap();
    assert!(Scene::read(&path).is_ok());
    let refused = "only a scene file may name a CSV file";
    assert!(refusal(&text).contains(refused), "{}", refusal(&text));
}

#[test]
fn a_scene_names_regular_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    for (name, why) in [
        (".", "must name a regular file"),
        ("no.csv", &*no_file()),
        #[cfg(unix)]
        ("/dev/zero", "must name a regular file"),
    ] {
        let text = scene(&format!("[whisker.profile]\nrows = {name:?}"), "");
        fs::write(&path, &text).unwrap();
        let message = Scene::read(&path).unwrap_err().to_string();
        let key = format!("whisker.profile.rows = {name:?}: ");
        assert!(message.contains(&key) && message.contains(why), "{message}");
    }
}

/// Half of a cone, continued by its other half, is the whole cone. A factor of the radii changes no angle, and forces by its fourth power.
#[test]
fn a_scaled_and_continued_profile_is_the_whole_cone() {
    let cone = parse(&scene("base_radius_um = 30\ntip_radius_um = 1.5", "")).unwrap();
    let half = "[whisker.profile]\nrows = [[0, 15], [10, 7.875]]\ntip_extension_mm = 10\nprofile_scale = 2";
    let text = scene(half, "").replace("length_mm = 20", "length_mm = 10");
    let half = parse(&text).unwrap();
    assert_eq!(half.whisker.length_mm, 20.0);
    let ends =
        [&cone, &half].map(|scene| curve(&scene.whisker, &scene.pole, Side::Cb, &[8.0, 19.8]));
    let thin = half.with(Parameter::ProfileScale, 1.0).unwrap();
    let thin = curve(&thin.whisker, &thin.pole, Side::Cb, &[8.0, 19.8]);
    for ((one, other), thin) in ends[0].iter().zip(&ends[1]).zip(&thin) {
        let push = |end: &Detachment| end.push_angle_deg.unwrap();
        assert!((push(one) - push(other)).abs() < 1e-8, "{one:?} {other:?}");
        assert!((push(thin) - push(other)).abs() < 1e-12, "{thin:?} {other:?}");
        let ratios = [one, thin].map(|end| end.force_un.unwrap() / other.force_un.unwrap());
        assert!(
            (ratios[0] - 1.0).abs() < 1e-6 && (ratios[1] - 1.0 / 16.0).abs() < 1e-12,
            "{ratios:?}"
        );
    }
    // The written text has both numbers, and says the same.
    let other = half.with(Parameter::TipExtensionMm, 9.0).unwrap();
    assert_eq!(parse(&other.to_toml()).unwrap().whisker, other.whisker);
    let [least, most] = Parameter::TipExtensionMm.range(&thin_rows());
    assert!(least == 0.0 && (most - 1.297).abs() < 1e-3, "{most}");
}

/// The last rows of `scenes/measured.csv`, which nearly reach the tip.
fn thin_rows() -> Scene {
    let rows = "[whisker.profile]\nrows = [[0, 30], [18.5, 3.2], [20, 1.5]]\ntip_extension_mm = 1";
    parse(&scene(rows, "")).unwrap()
}

#[test]
fn a_cone_beyond_the_rows_has_limits() {
    for (profile, must) in [
        (
            "[whisker.profile]\nrows = [[0, 30], [18.5, 3.2], [20, 1.5]]\ntip_extension_mm = 1.5",
            "whisker.profile.tip_extension_mm = 1.5: must be between 0 and where the radius is a thousandth of that at the base (1.29",
        ),
        (
            "[whisker.profile]\nrows = [[0, 30], [20, 29]]\ntip_extension_mm = 20.5",
            "must be between 0 and length_mm (20)",
        ),
        (
            "[whisker.profile]\nrows = [[0, 30], [19, 10], [20, 15]]\ntip_extension_mm = 4",
            "must be between 0 and where the radius is that at the base, or four times the least (3",
        ),
        (
            "[whisker.profile]\nrows = [[0, 30], [20, 2]]\nprofile_scale = 0",
            "whisker.profile.profile_scale = 0: must be between 0.001 and 1000",
        ),
        ("base_radius_um = 30\ntip_radius_um = 1.5\nprofile.profile_scale = 2", "rows"),
    ] {
        let message = refusal(&scene(profile, ""));
        assert!(message.contains(must), "{message}");
    }
    let bare = parse(&scene("base_radius_um = 30\ntip_radius_um = 1.5", "")).unwrap();
    let why = bare.with(Parameter::TipExtensionMm, 1.0).unwrap_err().to_string();
    assert!(why.contains("must be left out: there are no whisker.profile.rows"), "{why}");
}

/// Rows every 0.5 mm of the cone of the base scene, with errors of this standard deviation in um.
fn noisy_cone(deviation_um: f64, seed: u64) -> Vec<[f64; 2]> {
    let mut random = RandomStream::new(seed, 0);
    let row = |i: u32| {
        let s = 0.5 * f64::from(i);
        [s, 30.0 - 1.425 * s + deviation_um * random.normal()]
    };
    (0..=40).map(row).collect()
}

fn smoothed(rows: &[[f64; 2]], smooth: &str) -> String {
    scene(&format!("[whisker.profile]\nrows = {rows:?}\n{smooth}"), "")
}

#[test]
fn smooth_radii_replace_the_measured_ones() {
    let rows = noisy_cone(0.3, 1);
    let smoothed_scene = parse(&smoothed(&rows, "smooth = true")).unwrap();
    let fit = smoothed_scene.smooth_radii().unwrap();
    assert_eq!((fit.degree, smoothed_scene.measured_rows()), (1, Some(&rows[..])));
    assert!((0.2..0.4).contains(&fit.rms_um), "{fit:?}");
    // The least squares of a straight line, by the normal equations.
    let count = rows.len() as f64;
    let [s, r] = [0, 1].map(|column| rows.iter().map(|row| row[column]).sum::<f64>() / count);
    let [mut ss, mut sr] = [0.0; 2];
    for [own_s, own_r] in &rows {
        ss += (own_s - s) * (own_s - s);
        sr += (own_s - s) * (own_r - r);
    }
    let line = |place: f64| r + sr / ss * (place - s);
    assert!((smoothed_scene.whisker.base_radius_um - line(0.0)).abs() < 1e-12);
    assert!((smoothed_scene.whisker.tip_radius_um - line(20.0)).abs() < 1e-12);

    // What is kept with a map is smoothed again, to the same bits; a scene of numbers keeps the key, too.
    assert_eq!(parse(&smoothed_scene.to_toml()).unwrap().whisker, smoothed_scene.whisker);
    let built = smoothed_scene.to_builder().build().unwrap();
    assert!(built.to_toml().contains("smooth = true"));
    assert_eq!(parse(&built.to_toml()).unwrap().whisker, smoothed_scene.whisker);
    let rough = smoothed_scene.to_builder().smooth_profile(false).build().unwrap();
    let plain = parse(&smoothed(&rows, "smooth = false")).unwrap();
    assert_eq!(rough.whisker, plain.whisker);
    assert_eq!((rough.smooth_radii(), rough.whisker.tip_radius_um), (None, rows[40][1]));
}

/// Smoothed radii are sums of the measured ones with the derivatives as weights, and an exact polynomial comes back with its degree.
#[test]
fn smooth_radii_are_linear_in_the_measured_ones() {
    let fit = |rows: &[[f64; 2]]| {
        let scene = parse(&smoothed(rows, "smooth = true")).unwrap();
        scene.smooth_radii().unwrap()
    };
    let rows = noisy_cone(0.3, 2);
    let smooth = fit(&rows);
    let mut sums = vec![0.0; rows.len()];
    for (row, [_, radius]) in rows.iter().enumerate() {
        for (sum, by) in sums.iter_mut().zip(smooth.by_measured(row)) {
            *sum += by * radius;
        }
    }
    for (sum, [_, radius]) in sums.iter().zip(&smooth.rows) {
        assert!((sum - radius).abs() < 1e-11, "{sum} {radius}");
    }
    let exact: Vec<[f64; 2]> = rows.iter().map(|[s, _]| [*s, 30.0 - s - 0.02 * s * s]).collect();
    let smooth = fit(&exact);
    assert_eq!(smooth.degree, 2);
    assert!(smooth.rms_um < 1e-12, "{smooth:?}");
}

/// Errors of 1 um in rows every 0.5 mm move detachments by 4 degrees; those of the smoothed whisker are near the exact cone's.
#[test]
fn smooth_radii_give_the_detachments_of_the_whisker() {
    let distances = [6.0, 8.0, 10.0, 12.0, 14.0];
    let ends = |text: &str| {
        let scene = parse(text).unwrap();
        let ends = Side::BOTH.map(|side| curve(&scene.whisker, &scene.pole, side, &distances));
        let angles = ends.into_iter().flatten().map(|end| end.push_angle_deg.unwrap());
        angles.collect::<Vec<f64>>()
    };
    let exact = ends(&smoothed(&noisy_cone(0.0, 0), ""));
    let off = |text: &str| {
        let found = ends(text);
        let pairs = found.iter().zip(&exact);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let (mut rough, mut smooth) = (0.0_f64, 0.0_f64);
    for seed in 1..=8 {
        let rows = noisy_cone(1.0, seed);
        // Errors may make the tip thicker than the rest, or no tip at all.
        let Ok(_) = parse(&smoothed(&rows, "")) else {
            continue;
        };
        rough = rough.max(off(&smoothed(&rows, "")));
        smooth = smooth.max(off(&smoothed(&rows, "smooth = true")));
    }
    // Measured: 4.26 and 1.06 degrees.
    assert!(rough > 4.0, "{rough}");
    assert!(smooth < 1.2, "{smooth}");
}

#[test]
fn smooth_radii_that_are_refused() {
    let short = "[[0, 30], [5, 20], [20, 1.5]]";
    let pointed: Vec<[f64; 2]> = noisy_cone(0.0, 0)
        .into_iter()
        .map(|[s, _]| [s, if s < 10.0 { 30.0 - 3.0 * s } else { 0.1 }])
        .collect();
    for (profile, why) in [
        (
            format!("rows = {short}\nsmooth = true"),
            "whisker.profile.smooth = true: needs at least 8 rows to choose the degree by cross-validation, has 3",
        ),
        (format!("rows = {short}\nsmooth = 3"), "expected a boolean"),
        (
            format!("rows = {pointed:?}\nsmooth = true"),
            "of the fit of degree 6: the radius must be between a thousandth of that at the base",
        ),
        ("smooth = true".to_owned(), "missing field `rows`"),
    ] {
        let message = refusal(&scene(&format!("[whisker.profile]\n{profile}"), ""));
        assert!(message.contains(why), "{profile}: {message}");
    }
}
