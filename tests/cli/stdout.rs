//! Standard output that is closed or full.

use super::data::DATA;
use super::{Place, Run, SCENE};
use std::process::Command;

#[test]
fn standard_output_that_is_closed_or_full() {
    let place = Place::with(SCENE);
    place.map(&["scene.toml", "-o."]);
    place.write("pts.csv", DATA);
    let redirected = |to: &str, arguments: &[&str]| {
        let mut shell = Command::new("sh");
        let script = format!("exec \"$0\" \"$@\" {to}");
        shell.args(["-c", &script, env!("CARGO_BIN_EXE_whiskmap")]);
        let output = shell.args(arguments).current_dir(place.path("")).output();
        Run::of(&output.unwrap())
    };
    let shape = ["shape", "scene.toml", "--distance=9", "--push-angle=1"];
    let design = [
        "design",
        "scene.toml",
        "--distance=9",
        "--slip-off=40deg",
        "--for=taper",
    ];
    for (to, why) in [
        (">&-", "Bad file descriptor (os error 9)"),
        (">/dev/full", "No space left on device (os error 28)"),
    ] {
        let said = format!("error: standard output: {why}\n");
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
            &[
                "fit",
                "scene.toml",
                "--data=pts.csv",
                "--free=tip_radius_um",
            ],
            &["submit", "scene.toml", "--shards=1"],
            &["render", "scene.exr", "-o=-"],
            &["render", "scene.exr", "-o=r.png"],
            &["extract", "scene.exr", "-o=t.csv"],
            &["map", "scene.toml", "--engine=cpu", "-onew"],
        ] {
            let run = redirected(to, arguments);
            assert_eq!(run.code, Some(1), "{arguments:?} {to}: {run:?}");
            assert!(run.err.ends_with(&said), "{arguments:?} {to}: {run:?}");
        }
        redirected(to, &["curve"]).assert_refused(&["<SCENE>"]);
        redirected(to, &["curve", "no.toml"]).assert_said(if to == ">&-" { 1 } else { 2 }, "error");
    }
}
