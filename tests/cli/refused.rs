//! Invalid input: one message, exit code 2, no file created.

use super::{Place, Run, SCENE, names, no_file, words};
use std::fs;
use std::io::{BufRead, BufReader};
#[cfg(unix)]
use std::path::Path;
use std::process::Stdio;

#[test]
fn scenes_that_cannot_be_read() {
    let place = Place::with("title = = 3");
    fs::create_dir(place.path("folder")).unwrap();
    let map = |scene: &str| place.run(&["map", scene, "--engine", "cpu"]);
    map("scene.toml").assert_refused(&["scene.toml:1:9", "title = = 3"]);
    let said = format!("nowhere.toml: cannot be read: {}", no_file());
    map("nowhere.toml").assert_refused(&[&said]);
    map("folder").assert_refused(&["folder: cannot be read"]);
    fs::write(place.path("bytes.toml"), b"title = \"\xff\"").unwrap();
    map("bytes.toml").assert_refused(&["not UTF-8 text: byte 0xFF"]);
    fs::write(place.path("empty.toml"), "").unwrap();
    map("empty.toml").assert_refused(&["missing field `title`"]);
    let left = ["bytes.toml", "empty.toml", "folder", "scene.toml"];
    assert_eq!(names(&place.path("")), left);
}

#[test]
fn maps_too_large_to_compute() {
    let place = Place::with(&SCENE.replace("count = 24", "count = 16384"));
    let run = place.run(&["map", "scene.toml", "--engine", "cpu"]);
    let needed = ["16384 push angles x 16384 distances", "268435456 cells", "at most 4096 MiB"];
    run.assert_refused(&needed);
    assert!(run.err.contains("lower grid.push_angle_deg.count"), "{run:?}");
    assert_eq!(names(&place.path("")), ["scene.toml"]);
}

/// The number of bytes in a text such as "1.5 GB".
fn bytes(text: &str) -> f64 {
    let (number, unit) = text.split_once(' ').unwrap();
    let prefixes = ["B", "kB", "MB", "GB", "TB", "PB", "EB"];
    let power = prefixes.iter().position(|prefix| *prefix == unit).unwrap();
    number.parse::<f64>().unwrap() * 1e3_f64.powi(power as i32)
}

/// The map is larger than the disk of any machine that runs tests.
#[test]
fn maps_too_large_for_the_disk() {
    let axes = "friction = { from = 0, to = 0.5, count = 1000 }\n\
                curvature_per_mm = { from = 0, to = 0.04, count = 1000 }\n";
    let large = SCENE.replace("count = 24", "count = 2048");
    let place = Place::with(&format!("{large}{axes}"));
    for format in ["exr", "zarr"] {
        let run = place.run(&["map", "scene.toml", "--engine=cpu", "--format", format]);
        let said = run.err.strip_prefix("error: cannot write outputs: the map needs about ");
        let end = " are free; give a folder with more space, or --force\n";
        let sizes = said.and_then(|said| said.strip_suffix(end)?.split_once(", but "));
        let sizes = sizes.unwrap_or_else(|| panic!("{run:?}"));
        let [needed, free] = [sizes.0, sizes.1].map(bytes);
        assert!(run.code == Some(1) && needed > free, "{run:?}");
        assert_eq!(names(&place.path("outputs")), [""; 0]);
    }
    let forced = ["map", "scene.toml", "--engine=cpu", "--force"];
    let mut child = place.plain_command(&forced).stderr(Stdio::piped()).spawn().unwrap();
    let mut line = String::new();
    BufReader::new(child.stderr.take().unwrap()).read_line(&mut line).unwrap();
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(line.starts_with("engine: "), "{line}");
}

#[test]
fn output_folders_that_cannot_be_used() {
    let place = Place::with(SCENE);
    let to = |output: &str| place.run(&["map", "scene.toml", "--engine", "cpu", "-o", output]);
    let help = "give a folder that can be written";
    to("scene.toml").assert_refused(&["--output scene.toml", help]);
    to("scene.toml/in").assert_refused(&["--output scene.toml/in", help]);
    assert_eq!(place.bytes("scene.toml"), SCENE.as_bytes());
    assert_eq!(names(&place.path("")), ["scene.toml"]);
}

/// Nobody can create files in `/proc`, not even an administrator.
#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_takes_no_files() {
    let place = Place::with(SCENE);
    let run = place.run(&["map", "scene.toml", "--engine", "cpu", "-o", "/proc"]);
    run.assert_refused(&["--output /proc: ", "give a folder that can be written"]);
    let map = words("map scene.toml --engine cpu --no-png -o maps");
    place.good(&map);
    let store = "/proc/slice.zarr";
    let run = place.run(&["extract", "maps/scene.exr", "-o", store]);
    run.assert_refused(&["--output /proc/slice.zarr: ", "in a folder that can be written"]);
}

/// An administrator may write to any folder, so the test then runs the program as another user.
#[cfg(unix)]
#[test]
fn a_folder_without_permission() {
    use std::os::unix::fs::PermissionsExt;
    use std::os::unix::process::CommandExt;
    const NOBODY: u32 = 65534;
    let place = Place::with(SCENE);
    let locked = place.path("locked");
    fs::create_dir(&locked).unwrap();
    // Without --output, both commands create the same folder.
    place.write("locked/scene.toml", SCENE);
    let lock = |mode| fs::set_permissions(&locked, fs::Permissions::from_mode(mode)).unwrap();
    lock(0o555);
    let is_allowed = tempfile::tempfile_in(&locked).is_ok();
    let mut program = Path::new(env!("CARGO_BIN_EXE_whiskmap")).to_owned();
    if is_allowed {
        // The program may be in a folder that other users cannot enter.
        let original = std::mem::replace(&mut program, place.path("whiskmap"));
        // A copy by this process would be open for writing in a child that another test starts meanwhile, and then cannot be run.
        let mut copy = std::process::Command::new("cp");
        copy.args([&original, &program]);
        assert!(copy.status().unwrap().success());
        fs::set_permissions(place.path(""), fs::Permissions::from_mode(0o755)).unwrap();
    }
    let run = |folder: &str, arguments: &[&str]| {
        let mut command = std::process::Command::new(&program);
        command.args(arguments).current_dir(place.path(folder));
        if is_allowed {
            command.uid(NOBODY).gid(NOBODY);
        }
        Run::of(&command.output().unwrap())
    };
    let map = ["map", "scene.toml", "--engine=cpu"];
    let explore = ["explore", "scene.toml"];
    let in_locked = run("", &[&map[..], &["-o", "locked"]].concat());
    in_locked.assert_refused(&["--output locked: Permission denied"]);
    for command in [&map[..], &explore] {
        run("locked", command).assert_refused(&["--output outputs: Permission denied"]);
    }
    assert_eq!(names(&locked), ["scene.toml"]);
    // A folder that exists, and is read-only itself.
    lock(0o755);
    fs::create_dir(locked.join("outputs")).unwrap();
    let inner = locked.join("outputs");
    fs::set_permissions(&inner, fs::Permissions::from_mode(0o555)).unwrap();
    for command in [&map[..], &explore] {
        run("locked", command).assert_refused(&["--output outputs: Permission denied"]);
    }
}

/// The environment variable of rayon has the limits of `--threads`, which comes first.
#[test]
fn threads_of_the_environment_are_limited() {
    let place = Place::with(SCENE);
    let plan = |threads: &str, arguments: &[&str]| {
        let mut command = place.plain_command(&[&["plan", "scene.toml"], arguments].concat());
        let command = command.env("RAYON_NUM_THREADS", threads);
        Run::of(&command.output().unwrap())
    };
    for threads in ["20000", "1025", "many", "-1"] {
        let must = "must be a whole number between 1 and 1024";
        plan(threads, &[]).assert_refused(&[&format!("RAYON_NUM_THREADS={threads}: {must}")]);
        assert_eq!(plan(threads, &["--threads=2"]).code, Some(0));
    }
    for threads in ["", "0", "2"] {
        assert_eq!(plan(threads, &[]).code, Some(0));
    }
}

#[test]
fn arguments_out_of_range() {
    let place = Place::with(SCENE);
    let map = |arguments: &[&str]| place.run(&[&["map", "scene.toml"], arguments].concat());
    let whole = "must be a whole number between 1 and 1024";
    map(&["--threads", "0"]).assert_refused(&["'0'", "--threads", whole]);
    map(&["--threads", "many"]).assert_refused(&["'many'", "--threads", whole]);
    let shape = words("shape scene.toml --distance 9 --push-angle 1");
    for (at, word, option, must) in [
        (3, "far", "--distance", "must be a length, such as"),
        (3, "30deg", "--distance", "unit deg: must be mm (the default), cm, m or um"),
        (3, "15,66mm", "--distance", "; write a decimal point, not a comma: 15.66mm"),
        (5, "far", "--push-angle", "must be an angle, such as"),
        (5, "1mm", "--push-angle", "unit mm: must be deg (the default), ° or rad"),
    ] {
        let mut words = shape.clone();
        words[at] = word;
        let quoted = format!("'{word}'");
        place.run(&words).assert_refused(&[&quoted, option, must]);
    }
    place.run(&words("curve scene.toml --distance 15,660")).assert_refused(&[
        "--distance 660 mm: must be between",
        "; a comma separates distances, and numbers have decimal points",
    ]);
    for command in [&shape[..], &["branch", "scene.toml", "--distance=9"]] {
        let run = place.run(&[command, &["--points", "2.5"]].concat());
        run.assert_refused(&["'2.5'", "must be a whole number between", "and 1000000"]);
    }
    let far = "--distance 1e99 mm: must be between 0.02 mm (length_mm / 1000) and 200 mm (10 * length_mm)";
    let branch = ["branch", "scene.toml", "--distance", "1e99"];
    place.run(&branch).assert_refused(&[far]);
    let turned = "--push-angle 1e99 deg: must be between";
    let shape = [&shape[..5], &["1e99"]].concat();
    place.run(&shape).assert_refused(&[turned]);
    map(&["--channels", "regme,force_un"])
        .assert_refused(&["out of regime, status,", "; did you mean `regime`?"]);
    map(&["--engine", "abacus"]).assert_refused(&[
        "'abacus'",
        "--engine",
        "auto, cpu, spectral, gpu",
    ]);
    place.run(&["map"]).assert_refused(&["<SCENE>"]);
    for file in ["scene.exr", "scene.png"] {
        assert!(!place.path("outputs").join(file).exists());
    }
}

/// Message about the second input that is standard input.
pub const READ_TWICE: &str =
    "-: standard input is another input, and can be read once; name a file";

#[test]
fn standard_input_is_one_input() {
    let place = Place::with(SCENE);
    for (command, option) in [
        ("bench - --peers - --plot p.svg", "SCENE"),
        ("curve - --data -", "SCENE"),
        ("explore - --data -", "SCENE"),
        ("fit - --data - --free taper", "SCENE"),
        ("force - --frames -", "SCENE"),
        ("locate - --readings -", "SCENE"),
        ("texture - --angles -", "SCENE"),
        ("whisk - --angles - --distance 9", "SCENE"),
        ("import - - --mm-per-pixel 1 --fps 1", "FILE"),
    ] {
        let command: Vec<&str> = command.split(' ').collect();
        let why = format!("error: {option} {READ_TWICE}");
        place.run(&command).assert_refused(&[&why]);
    }
}

/// An option for a picture needs one.
#[test]
fn a_column_of_a_plot_needs_a_plot() {
    let place = Place::with(SCENE);
    for words in [
        &["curve", "scene.toml", "--x", "force_un"][..],
        &["branch", "scene.toml", "--distance", "10", "--y", "force_un"],
    ] {
        place.run(words).assert_refused(&["--plot <FILE>"]);
    }
}

/// A picture without room for the name of each variable is refused.
#[test]
fn a_picture_has_room_for_all_names() {
    let place = Place::with(SCENE);
    let words = ["sensitivity", "scene.toml", "--plot", "s.svg", "--size"];
    let run = place.run(&[&words[..], &["60x40mm"]].concat());
    run.assert_refused(&["too small for text of 7 pt; the height must be at least"]);
    let run = place.run(&[&words[..], &["60mm"]].concat());
    let picture = String::from_utf8(place.bytes("s.svg")).unwrap();
    let names =
        ["length_mm", "parabola_per_mm", "base_radius_um", "tip_radius_um", "pole_radius_mm"];
    assert!(run.code == Some(0) && names.iter().all(|name| picture.contains(name)), "{picture}");
}
