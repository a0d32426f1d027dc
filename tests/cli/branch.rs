//! `whiskmap branch`.

use super::traces::{BRANCH, CB, SHAPE, cells};
use super::{Place, SCENE, words};

#[test]
fn a_branch_has_the_requested_number_of_points() {
    let place = Place::with(SCENE);
    let run = place.quiet(&[&CB[..], &["--points", "17"]].concat());
    let rows = cells(&run.out, BRANCH);
    assert_eq!(rows.len(), 17);
    let marks: Vec<&str> = rows.iter().map(|row| row[16]).filter(|mark| !mark.is_empty()).collect();
    assert_eq!(marks, ["first-touch", "slip-off", "second-fold"]);
    let both = place.quiet(&["branch", "scene.toml", "--distance", "15.66"]);
    assert_eq!(cells(&both.out, BRANCH).len(), 400);
}

/// The printed push angle of the fold has a state, whichever way it is rounded.
#[test]
fn the_fold_can_be_asked_for() {
    let place = Place::with(SCENE);
    for distance in ["5.5", "8", "11.3", "14.1", "15.66", "17.9"] {
        for side in ["cb", "cf"] {
            let run =
                place.quiet(&["branch", "scene.toml", "--distance", distance, "--side", side]);
            let rows = cells(&run.out, BRANCH);
            let fold = rows.iter().find(|row| row[16] == "slip-off").unwrap();
            for branch in ["stable", "unstable"] {
                let at = ["shape", "scene.toml", "--distance", distance, "--push-angle", fold[3]];
                place.quiet(&[&at[..], &["--branch", branch, "--points=2"]].concat());
            }
        }
    }
    // Unstable states reach across first touch.
    let at = words("shape scene.toml --distance=15.66 --push-angle -20 --branch=unstable");
    let run = place.quiet(&[&at[..], &["--side", "cb"]].concat());
    assert!(run.out.starts_with(SHAPE));
    place.quiet(&words("shape scene.toml --distance=9 --push-angle -1e-5"));
}

#[test]
fn several_poles_share_a_table_and_a_plot() {
    let place = Place::with(SCENE);
    let several = words("branch scene.toml --distance 10,13 --distance=15.66 --points=9");
    let run = place.quiet(&several);
    let rows = cells(&run.out, BRANCH);
    let blocks: Vec<_> = rows
        .chunk_by(|a, b| a[..2] == b[..2])
        .map(|block| (block[0][0], block[0][1], block.len()))
        .collect();
    let expected =
        ["10.0", "13.0", "15.66"].map(|distance| [(distance, "cf", 9), (distance, "cb", 9)]);
    assert_eq!(blocks, expected.concat());
    let alone = place.quiet(&["branch", "scene.toml", "--distance=13", "--points=9"]);
    assert_eq!(cells(&alone.out, BRANCH), rows[18..36]);

    for (column, label) in [
        ("arc_length_mm", "arc length from base to contact (mm)"),
        ("force_un", "contact force (\u{b5}N)"),
        ("base_moment_nnm", "bending moment at the base (nN m)"),
        ("contact_angle_deg", "contact angle (deg)"),
    ] {
        place.quiet(&[&several[..], &["--y", column, "--whole", "--plot=p.svg"]].concat());
        let svg = place.text("p.svg");
        for text in
            [label, "first touch", "slip-off", "second fold", "10 mm, stable", "15.66 mm, stable"]
        {
            assert!(svg.contains(&format!(">{text}<")), "{column}: {text}");
        }
    }
    let many: Vec<String> = (5..17).map(|mm| format!("--distance={mm}")).collect();
    let many: Vec<&str> = many.iter().map(String::as_str).collect();
    place.quiet(&[&["branch", "scene.toml", "--points=9", "--plot=p.svg"], &many[..]].concat());
    let svg = place.text("p.svg");
    let colours = svg.split("stroke=\"#").skip(1).map(|rest| &rest[..6]);
    let colours: std::collections::BTreeSet<&str> = colours.collect();
    // Ends are black, blue and grey.
    assert!(colours.len() >= many.len() + 2, "{colours:?}");
    let far = place.run(&["branch", "scene.toml", "--distance", "10,25"]);
    far.assert_refused(&["--distance 25 mm: out of reach: the tip of the resting whisker is 19.6"]);
    let wide = place.run(&["branch", "scene.toml", "--distance", "10,1000"]);
    wide.assert_refused(&["--distance 1000 mm: must be between"]);
}
