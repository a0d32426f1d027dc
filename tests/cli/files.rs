//! Output files: devices, pipes, links, full disks, unusual names.

use super::traces::CURVE;
use super::{Place, Run, SCENE, names};
use std::fs::{self, File};
use std::os::unix::fs::{FileTypeExt, symlink};
use std::process::{Command, Stdio};
use std::time::Duration;

impl Place {
    /// Creates a named pipe.
    pub fn pipe(&self, name: &str) {
        let made = Command::new("mkfifo").arg(self.path(name)).status();
        assert!(made.unwrap().success());
    }

    /// Runs the program and reads the pipe `name`, which must remain a pipe.
    fn piped(&self, arguments: &[&str], name: &str) -> Vec<u8> {
        let mut child = self.plain_command(arguments);
        let child = child.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
        let bytes = fs::read(self.path(name)).unwrap();
        let run = Run::of(&child.unwrap().wait_with_output().unwrap());
        assert_eq!(run.code, Some(0), "{run:?}");
        let kind = self.path(name).metadata().unwrap().file_type();
        assert!(kind.is_fifo(), "{name}");
        bytes
    }
}

const SHAPE: [&str; 4] = ["shape", "scene.toml", "--distance=9", "--push-angle=1"];

#[test]
fn a_pipe_gets_what_a_file_gets() {
    let place = Place::with(SCENE);
    for (option, name) in [("--csv", "t.csv"), ("--plot", "p.svg"), ("--plot", "p.png")] {
        place.quiet(&[&SHAPE[..], &[option, name]].concat());
        let expected = place.bytes(name);
        let pipe = format!("pipe-{name}");
        place.pipe(&pipe);
        let found = place.piped(&[&SHAPE[..], &[option, &pipe]].concat(), &pipe);
        assert!(found == expected, "{name}");
    }
    // An EXR file is not written sequentially.
    place.map(&["scene.toml"]);
    let expected = place.bytes("outputs/scene.exr");
    fs::create_dir(place.path("piped")).unwrap();
    place.pipe("piped/scene.exr");
    let map = ["map", "scene.toml", "--engine=cpu", "-o", "piped"];
    let found = place.piped(&map, "piped/scene.exr");
    assert!(found == expected);
    assert_eq!(names(&place.path("piped")), ["scene.exr", "scene.png"]);
    assert!(place.bytes("piped/scene.png") == place.bytes("outputs/scene.png"));
}

/// The pipe has no reader.
#[test]
fn other_errors_come_before_a_pipe_is_opened() {
    let place = Place::with(SCENE);
    place.pipe("t.csv");
    let mut command =
        place.command(&["shape", "scene.toml", "--distance=15.66", "--push-angle=20"]);
    let command = command.args(["--csv", "t.csv"]).timeout(Duration::from_secs(100));
    Run::of(&command.output().unwrap()).assert_refused(&["slipped off"]);
}

/// The path is a link to `/dev/stdout`, which a faulty program could replace without harm.
#[test]
fn standard_output_has_a_name() {
    let place = Place::with(SCENE);
    symlink("/dev/stdout", place.path("out.csv")).unwrap();
    let to = [&SHAPE[..], &["--csv", "out.csv"]].concat();
    let streamed = place.quiet(&SHAPE).out;
    assert_eq!(place.quiet(&to).out, streamed);

    // Standard output is redirected to a file that is not empty.
    place.write("log", "before\n");
    let log = File::options().append(true).open(place.path("log")).unwrap();
    let run = Run::of(&place.plain_command(&to).stdout(log).output().unwrap());
    assert_eq!((run.code, &*run.err), (Some(0), ""), "{run:?}");
    assert_eq!(place.bytes("log"), format!("before\n{streamed}").as_bytes());
    assert!(place.path("out.csv").is_symlink());
}

#[test]
fn a_device_is_written_to_and_not_named() {
    let place = Place::with(SCENE);
    for name in ["t.csv", "p.svg", "p.png"] {
        symlink("/dev/null", place.path(name)).unwrap();
    }
    for plot in ["p.svg", "p.png"] {
        let run = place.quiet(&[&SHAPE[..], &["--csv=t.csv", "--plot", plot]].concat());
        assert_eq!(run.out, "");
    }
    place.map(&["scene.toml", "--no-png"]);
    place.quiet(&["render", "outputs/scene.exr", "-o", "p.png"]);
    for name in ["t.csv", "p.svg", "p.png"] {
        let kind = place.path(name).metadata().unwrap().file_type();
        assert!(kind.is_char_device(), "{name}");
    }
    assert_eq!(names(&place.path("")), ["outputs", "p.png", "p.svg", "scene.toml", "t.csv"]);
}

#[test]
fn links_stay_and_their_files_are_made_or_replaced() {
    let place = Place::with(SCENE);
    fs::create_dir(place.path("elsewhere")).unwrap();
    place.write("elsewhere/old.csv", "old");
    for (link, target) in [
        ("t.csv", "elsewhere/old.csv"),
        ("chain.csv", "t.csv"),
        ("p.svg", "elsewhere/new.svg"),
        ("p.png", "elsewhere/new.png"),
    ] {
        symlink(target, place.path(link)).unwrap();
    }
    let run = place.quiet(&[&SHAPE[..], &["--csv=t.csv", "--plot=p.svg"]].concat());
    assert_eq!(run.out, "t.csv\np.svg\n");
    let table = place.bytes("elsewhere/old.csv");
    place.write("elsewhere/old.csv", "old");
    place.quiet(&[&SHAPE[..], &["--csv=chain.csv", "--plot=p.png"]].concat());
    assert!(table == place.bytes("elsewhere/old.csv") && table.len() > 1000);
    for link in ["t.csv", "chain.csv", "p.svg", "p.png"] {
        assert!(place.path(link).is_symlink(), "{link}");
    }
    let made = names(&place.path("elsewhere"));
    assert_eq!(made, ["new.png", "new.svg", "old.csv"]);

    symlink("../map.exr", place.path("elsewhere/scene.exr")).unwrap();
    place.map(&["scene.toml", "--no-png", "-o", "elsewhere"]);
    assert!(place.path("elsewhere/scene.exr").is_symlink());
    assert!(place.bytes("map.exr").starts_with(b"\x76\x2f\x31\x01"));

    symlink("circle.csv", place.path("circle.csv")).unwrap();
    let circle = ["curve", "scene.toml", "--csv", "circle.csv"];
    place.run(&circle).assert_refused(&["--csv circle.csv: Too many levels of symbolic links"]);
    symlink("nowhere/t.csv", place.path("lost.csv")).unwrap();
    let lost = ["curve", "scene.toml", "--csv", "lost.csv"];
    place.run(&lost).assert_refused(&["--csv lost.csv: No such file"]);
}

/// A limit on the file size simulates a full disk; the shell ignores its signal.
#[test]
fn a_full_disk_is_reported_in_one_line() {
    let place = Place::with(SCENE);
    place.map(&["scene.toml", "-o", "."]);
    fs::rename(place.path("scene.exr"), place.path("whole.exr")).unwrap();
    fs::remove_file(place.path("scene.png")).unwrap();
    let before = names(&place.path(""));
    let full = |arguments: &[&str], file: &str| {
        let mut shell = Command::new("sh");
        shell.args(["-c", "trap '' XFSZ; ulimit -f 1; exec \"$0\" \"$@\""]);
        shell.arg(env!("CARGO_BIN_EXE_whiskmap")).args(arguments);
        let run = Run::of(&shell.current_dir(place.path("")).output().unwrap());
        assert_eq!(run.code, Some(1), "{run:?}");
        let said = format!("error: cannot write {file}: File too large (os error 27)\n");
        assert!(run.err.ends_with(&said), "{run:?}");
        assert_eq!(run.err.matches("error").count(), 2, "{run:?}");
        assert_eq!(names(&place.path("")), before);
    };
    full(&["map", "scene.toml", "--engine=cpu", "-o."], "./scene.exr");
    full(&["render", "whole.exr", "-o", "r.png"], "r.png");
    full(&["curve", "scene.toml", "--csv", "t.csv"], "t.csv");
    full(&["curve", "scene.toml", "--plot", "p.svg"], "p.svg");
    full(&["curve", "scene.toml", "--plot", "p.png"], "p.png");
}

#[test]
fn a_full_device_is_reported() {
    let place = Place::with(SCENE);
    for (option, name) in [("--csv", "t.csv"), ("--plot", "p.svg"), ("--plot", "p.png")] {
        symlink("/dev/full", place.path(name)).unwrap();
        let run = place.run(&["curve", "scene.toml", option, name]);
        let said = format!("error: cannot write {name}: No space left on device (os error 28)\n");
        assert_eq!((run.code, &*run.err), (Some(1), &*said), "{run:?}");
    }
}

#[test]
fn scenes_have_any_name() {
    let place = Place::with(SCENE);
    for stem in ["my scene", "Schnurrhaar µ 鬍鬚", "-", ".hidden"] {
        let name = format!("{stem}.toml");
        place.write(&name, SCENE);
        assert!(place.quiet(&["curve", &format!("./{name}")]).out.starts_with(CURVE));
        place.map(&[&format!("./{name}"), "-o", &format!("./{stem}")]);
        let files = [format!("{stem}.exr"), format!("{stem}.png")];
        assert_eq!(names(&place.path(stem)), files);
    }
}

/// Opening a pipe without a writer would block forever.
#[test]
fn a_pipe_is_no_map() {
    let place = Place::with(SCENE);
    place.pipe("map.exr");
    let run = place.run(&["render", "map.exr"]);
    run.assert_refused(&["map.exr is no regular file"]);
}

/// Opening a pipe without a writer would block forever.
#[test]
fn a_pipe_holds_no_radii() {
    let measured = "[whisker]\nprofile.rows = \"radii.csv\"";
    let scene = SCENE.replace("[whisker]", measured);
    let place = Place::with(&scene);
    place.pipe("radii.csv");
    place
        .run(&["curve", "scene.toml"])
        .assert_refused(&["whisker.profile.rows = \"radii.csv\": must name a regular file"]);

    // The scene of the store names the pipe: no command opens it.
    place.write("scene.toml", super::store::SWEEP);
    super::store::good(&place, ".", &["--shard", "1/8"]);
    let root = place.text("scene.zarr/zarr.json");
    let named = root.replace("[whisker]", &measured.replace('\n', "\\n").replace('"', "'"));
    assert_ne!(root, named);
    place.write("scene.zarr/zarr.json", &named);
    let refused = "is damaged: its `identity` does not fit";
    for command in [
        &["status", "scene.zarr"][..],
        &["render", "scene.zarr", "--at=friction=0"],
        &["extract", "scene.zarr", "-o", "part.npy"],
    ] {
        place.run(command).assert_said(2, refused);
    }
}

/// A scene given by the user may come from a pipe. A folder or an endless device contains neither a scene nor points.
#[test]
fn what_a_user_names_is_read_to_its_end_or_refused() {
    let place = Place::with(SCENE);
    place.pipe("piped.toml");
    let mut child = place.plain_command(&["curve", "piped.toml"]);
    let child = child.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    fs::write(place.path("piped.toml"), SCENE).unwrap();
    let run = Run::of(&child.unwrap().wait_with_output().unwrap());
    assert_eq!(run.code, Some(0), "{run:?}");
    assert_eq!(run.out, place.quiet(&["curve", "scene.toml"]).out);
    let is_folder = "cannot be read: Is a directory";
    let [scene, table] = [1, 32].map(|most| format!("cannot be read: longer than {most} MiB"));
    for (path, scene, table) in [(".", is_folder, is_folder), ("/dev/zero", &scene, &table)] {
        place.run(&["curve", path]).assert_refused(&[path, scene]);
        place.run(&["curve", "scene.toml", "--data", path]).assert_refused(&[path, table]);
    }
}
