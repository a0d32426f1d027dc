//! Leftovers of interrupted runs, which the next run removes.

#[cfg(unix)]
use super::Run;
use super::{Place, SCENE, names};
use std::fs;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, SystemTime};

/// Scene of a sweep that takes half a minute, so that it ends by itself where no signal ends it.
fn long() -> String {
    let axes = "taper = { from = 0, to = 0.9, count = 80 }\ncurvature_per_mm = { from = 0, to = 0.04, count = 80 }";
    let scene = SCENE.lines().filter(|line| !line.starts_with("tip_radius_um"));
    let scene: Vec<&str> = scene.collect();
    format!("{}\n{axes}\n", scene.join("\n"))
}

/// Starts a run, and waits until its unfinished file is in `folder`.
fn begun(place: &Place, command: &mut Command, folder: &str) -> Child {
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    while unfinished(place, folder).is_empty() {
        assert!(child.try_wait().unwrap().is_none(), "it ended early");
        std::thread::yield_now();
    }
    child
}

fn unfinished(place: &Place, folder: &str) -> Vec<String> {
    let mut names = names(&place.path(folder));
    names.retain(|name| name.starts_with(".whiskmap-"));
    names
}

/// Sends the signal to the run.
#[cfg(unix)]
pub fn send(signal: &str, child: &Child) {
    let kill = format!("kill -{signal} {}", child.id());
    assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_cleans_up() {
    let place = Place::with(&long());
    let map = ["map", "scene.toml", "--engine=cpu"];
    for (signal, code) in [("HUP", 129), ("INT", 130), ("TERM", 143), ("USR1", 128 + libc::SIGUSR1)]
    {
        let child = begun(&place, &mut place.plain_command(&map), "outputs");
        send(signal, &child);
        let run = Run::of(&child.wait_with_output().unwrap());
        assert_eq!((run.code, &*run.out), (Some(code), ""), "{run:?}");
        let said = format!("error: interrupted by SIG{signal}; unfinished files are removed");
        assert_eq!(run.err.lines().last(), Some(&*said), "{run:?}");
        assert_eq!(names(&place.path("outputs")), [""; 0]);
    }
}

/// Beyond the limit of the size of files, a run fails with a message, and no signal ends it.
#[cfg(unix)]
#[test]
fn a_limit_of_the_size_of_files_is_a_failure() {
    let place = Place::with(SCENE);
    let map = place.plain_command(&["map", "scene.toml", "--engine=cpu"]);
    let mut shell = Command::new("sh");
    shell.current_dir(map.get_current_dir().unwrap());
    shell.args(["-c", "ulimit -f 1; exec \"$0\" \"$@\""]).arg(map.get_program());
    let run = Run::of(&shell.args(map.get_args()).output().unwrap());
    assert_eq!((run.code, &*run.out), (Some(1), ""), "{run:?}");
    assert!(run.err.contains("error: cannot write") && run.err.contains("large"), "{run:?}");
    assert_eq!(unfinished(&place, "outputs"), [""; 0]);
}

/// The store is written in a temporary folder, to which threads still add files when the signal arrives.
#[cfg(unix)]
#[test]
fn an_interrupted_extract_leaves_no_folder() {
    let place = Place::with(SCENE);
    place.map(&["scene.toml", "--no-png"]);
    fs::create_dir(place.path("new")).unwrap();
    let extract = ["extract", "outputs/scene.exr", "-o", "new/x.zarr"];
    for _ in 0..40 {
        let mut child = place.plain_command(&extract);
        let mut child = child.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        while names(&place.path("new")).is_empty() && child.try_wait().unwrap().is_none() {
            std::thread::yield_now();
        }
        if child.try_wait().unwrap().is_none() {
            send("TERM", &child);
        }
        child.wait().unwrap();
        let left = unfinished(&place, "new");
        assert_eq!(left, [""; 0]);
        let _ = fs::remove_dir_all(place.path("new/x.zarr"));
    }
}

/// `nohup` ignores SIGHUP, and a shell ignores the other two for its background jobs. A process inherits this.
#[cfg(unix)]
#[test]
fn tests_do_not_depend_on_ignored_signals() {
    let mut shell = Command::new("sh");
    shell.args(["-c", "trap '' HUP INT QUIT TERM; exec \"$0\" \"$@\""]);
    shell.arg(std::env::current_exe().unwrap());
    shell.args(["--exact", "cli::signals::an_interrupted_run_cleans_up"]);
    let output = shell.output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(said.contains("1 passed"), "{said}");
}

/// A run that waits for the reader of a pipe has its table in an unnamed file. It installs handlers before it reads its scene.
#[cfg(unix)]
#[test]
fn a_waiting_run_is_interrupted_and_an_ignored_signal_is_not_handled() {
    let place = Place::with(SCENE);
    place.pipe("t.csv");
    place.pipe("piped.toml");
    fs::create_dir(place.path("tmp")).unwrap();
    let curve = ["curve", "piped.toml", "--csv", "t.csv"];
    let begun = |command: &mut Command| {
        command.env("TMPDIR", place.path("tmp"));
        let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
        place.write("piped.toml", SCENE);
        child.unwrap()
    };
    let child = begun(&mut place.plain_command(&curve));
    send("TERM", &child);
    assert_eq!(child.wait_with_output().unwrap().status.code(), Some(143));
    assert_eq!(names(&place.path("tmp")), [""; 0]);

    // `nohup` ignores the signal.
    let mut shell = Command::new("sh");
    shell.args(["-c", "trap '' HUP; exec \"$0\" \"$@\"", env!("CARGO_BIN_EXE_whiskmap")]);
    let child = begun(shell.args(curve).current_dir(place.path("")));
    send("HUP", &child);
    assert!(fs::read(place.path("t.csv")).unwrap().len() > 1000);
    let run = Run::of(&child.wait_with_output().unwrap());
    assert_eq!((run.code, &*run.err), (Some(0), ""), "{run:?}");
    assert_eq!(names(&place.path("tmp")), [""; 0]);
}

#[test]
fn leftovers_of_an_interrupted_run_are_removed_by_the_next_one() {
    let place = Place::with(&long());
    place.write("small.toml", SCENE);
    let mut killed =
        begun(&place, &mut place.plain_command(&["map", "scene.toml", "--engine=cpu"]), "outputs");
    // Files of running processes are kept.
    place.map(&["small.toml"]);
    let left = unfinished(&place, "outputs");
    assert_eq!(left.len(), 1);
    killed.kill().unwrap();
    killed.wait().unwrap();
    assert_eq!(unfinished(&place, "outputs"), left);
    // Locks of other hosts are not visible, so the age of their files decides, by the clock of the file server.
    let hour = Duration::from_secs(3600);
    let now = SystemTime::now();
    let dates = [now - 23 * hour, now - 25 * hour, now + 48 * hour];
    for (name, date) in ["late", "olds", "skew"].into_iter().zip(dates) {
        let path = place.path(&format!("outputs/.whiskmap-another.host+a1B2c3D4{name}"));
        let file = fs::File::create(path).unwrap();
        file.set_modified(date).unwrap();
    }
    place.map(&["small.toml"]);
    assert_eq!(
        unfinished(&place, "outputs"),
        [".whiskmap-another.host+a1B2c3D4late", ".whiskmap-another.host+a1B2c3D4skew"]
    );
}
