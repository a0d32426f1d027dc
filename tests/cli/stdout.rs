//! Standard output that is full.

use super::data::DATA;
use super::{Place, Run, SCENE, words};
use std::fs::File;

#[test]
fn a_full_standard_output_is_a_failure() {
    let place = Place::with(SCENE);
    place.map(&["scene.toml", "-o."]);
    place.write("pts.csv", DATA);
    let full = |arguments: &[&str]| {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let output = place.plain_command(arguments).stdout(full).output();
        Run::of(&output.unwrap())
    };
    let shape = ["shape", "scene.toml", "--distance=9", "--push-angle=1"];
    let design = words("design scene.toml --distance=9 --slip-off=40deg --for=taper");
    for arguments in [
        &["--version"][..],
        &["--help"],
        &["help", "map"],
        &["curve", "--help"],
        &["curve", "-h"],
        &["curve", "scene.toml"],
        &["curve", "scene.toml", "--plot=p.svg"],
        &["curve", "scene.toml", "--data=pts.csv"],
        &shape,
        &[&shape[..], &["--csv=/dev/null", "--plot=p.png"]].concat(),
        &["branch", "scene.toml", "--distance=9"],
        &design,
        &words("fit scene.toml --data=pts.csv --free=tip_radius_um"),
        &["submit", "scene.toml", "--shards=1"],
        &["render", "scene.exr", "-o=-"],
        &["render", "scene.exr", "-o=r.png"],
        &["extract", "scene.exr", "-o=t.csv"],
        &["map", "scene.toml", "--engine=cpu", "-onew"],
    ] {
        full(arguments)
            .assert_said(1, "error: standard output: No space left on device (os error 28)\n");
    }
    full(&["curve"]).assert_refused(&["<SCENE>"]);
    full(&["curve", "no.toml"]).assert_said(2, "error");
}
