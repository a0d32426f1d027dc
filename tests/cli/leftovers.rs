//! Temporary files and folders of interrupted runs, and runs at once in one folder.

use super::{Place, Run, SCENE, names, words};
use std::fs;
use std::process::{Command, Stdio};
use whiskmap::store::{TemporaryFiles, TemporaryFolder};

/// Returns the name of this host, as in the names of temporary files.
fn host() -> String {
    let name = if cfg!(windows) {
        std::env::var("COMPUTERNAME").unwrap()
    } else {
        let name = Command::new("uname").arg("-n").output().unwrap().stdout;
        String::from_utf8(name).unwrap()
    };
    let is_plain = |c: &char| c.is_ascii_alphanumeric() || "-_.".contains(*c);
    name.chars().filter(is_plain).take(64).collect()
}

#[test]
fn only_leftovers_are_removed() {
    let place = Place::with(SCENE);
    let host = host();
    let leftover = |end: &str| format!(".whiskmap-{host}{end}");
    let exact = |end: &str| leftover(&format!("+aB3dE6gH9jK{end}"));
    let folder = |name: &str| fs::create_dir(place.path(name)).unwrap();
    for name in [exact("1"), leftover("-notes.txt"), leftover("-2-aB3dE6")] {
        place.write(&name, "");
    }
    place.write(&leftover("-2+aB3dE6gH9jK2"), "");
    place.write(&leftover("+notes.txt"), "");
    // As a killed `extract` leaves it.
    folder(&exact("3"));
    place.write(&format!("{}/zarr.json", exact("3")), "");
    #[cfg(unix)]
    {
        place.pipe(&exact("4"));
        std::os::unix::fs::symlink("scene.toml", place.path(&exact("5"))).unwrap();
    }
    folder(".whiskmap-another.host+aB3dE6gH9jK6");
    let files = TemporaryFiles::default();
    let running = TemporaryFolder::create(&place.path("x.zarr"), &files).unwrap();
    assert!(!place.path(&exact("3")).exists());
    folder(&exact("3"));
    place.write(&exact("1"), "");
    let mut kept = names(&place.path(""));
    kept.retain(|name| ![exact("1"), exact("3")].contains(name));
    place.quiet(&words("shape scene.toml --distance=9 --push-angle=1 --csv=t.csv"));
    fs::remove_file(place.path("t.csv")).unwrap();
    assert_eq!(names(&place.path("")), kept);
    assert!(running.path().exists());
}

/// Each run removes leftovers in the folder to which the others write.
#[test]
fn runs_at_once_write_the_same_files() {
    let place = Place::with(SCENE);
    let branch = words("branch scene.toml --distance=9 --csv=t.csv --plot=p.svg");
    place.quiet(&branch);
    let expected = (place.bytes("t.csv"), place.bytes("p.svg"));
    let run = || {
        let mut command = place.plain_command(&branch);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        command.spawn().unwrap()
    };
    let runs: Vec<_> = (0..6).map(|_| run()).collect();
    for run in runs {
        let run = Run::of(&run.wait_with_output().unwrap());
        assert_eq!((run.code, &*run.err), (Some(0), ""), "{run:?}");
    }
    assert!((place.bytes("t.csv"), place.bytes("p.svg")) == expected);
    assert_eq!(names(&place.path("")), ["p.svg", "scene.toml", "t.csv"]);
}
