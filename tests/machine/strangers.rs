//! Files and symbolic links of another user.

use crate::program::{Place, Run, SCENE};
use std::fs::{self, Permissions};
use std::os::unix::fs::{MetadataExt, PermissionsExt, chown, lchown, symlink};
use std::os::unix::process::CommandExt;
use std::process::Command;

tests! {
    Root: files_and_links_of_others, leftovers_of_others_stay,
        folders_behind_links_of_others;
}

/// A user that is neither root nor the one who runs the tests.
const STRANGER: u32 = 54_321;

/// Owner and group of a replaced file are kept, or the run is refused; links of others are followed in safe folders alone.
fn files_and_links_of_others() {
    let place = Place::with(SCENE);
    place.write("t.csv", "old");
    chown(place.path("t.csv"), Some(STRANGER), Some(STRANGER)).unwrap();
    let table = [
        "shape",
        "scene.toml",
        "--distance=9",
        "--push-angle=1",
        "--csv",
    ];
    let to = |name| [&table[..], &[name]].concat();
    let good = |name| assert_eq!(place.run(&to(name)).code, Some(0), "{name}");
    good("t.csv");
    let about = place.path("t.csv").metadata().unwrap();
    assert_eq!((about.uid(), about.gid()), (STRANGER, STRANGER));

    // A stranger may write to the file and to its folder, but cannot make a file of root.
    fs::set_permissions(place.path(""), Permissions::from_mode(0o777)).unwrap();
    place.write("ours.csv", "old");
    fs::set_permissions(place.path("ours.csv"), Permissions::from_mode(0o666)).unwrap();
    let mut command = place.plain_command(&to("ours.csv"));
    let output = command.uid(STRANGER).gid(STRANGER).output().unwrap();
    Run::of(&output).assert_refused(&[
        "--csv ours.csv: the file there belongs to user 0 and group 0; this user cannot make such a file",
    ]);
    assert_eq!(place.bytes("ours.csv"), b"old");

    // A stranger's link is followed in a folder that only its owner writes to.
    symlink("ours.csv", place.path("link.csv")).unwrap();
    lchown(place.path("link.csv"), Some(STRANGER), Some(STRANGER)).unwrap();
    let must = "--csv link.csv: link.csv is a symbolic link of user 54321 in a folder that others may write to";
    for shared in [0o1777, 0o777, 0o775] {
        fs::set_permissions(place.path(""), Permissions::from_mode(shared)).unwrap();
        place.run(&to("link.csv")).assert_refused(&[must]);
        assert_eq!(place.bytes("ours.csv"), b"old");
    }
    lchown(place.path("link.csv"), Some(0), Some(0)).unwrap();
    good("link.csv");
    lchown(place.path("link.csv"), Some(STRANGER), Some(STRANGER)).unwrap();
    place.write("ours.csv", "old");
    fs::set_permissions(place.path(""), Permissions::from_mode(0o755)).unwrap();
    good("link.csv");
    assert!(place.bytes("ours.csv").len() > 1000 && place.path("link.csv").is_symlink());
}

/// Whose link leads to the folder of an output matters as much as whose link leads to a file.
fn folders_behind_links_of_others() {
    let place = Place::with(SCENE);
    fs::set_permissions(place.path(""), Permissions::from_mode(0o1777)).unwrap();
    fs::create_dir(place.path("private")).unwrap();
    symlink("private", place.path("out")).unwrap();
    lchown(place.path("out"), Some(STRANGER), Some(STRANGER)).unwrap();
    let must = "out is a symbolic link of user 54321 in a folder that others may write to";
    let map = ["map", "scene.toml", "--engine=cpu", "-o", "out"];
    let refused = |arguments: &[&str]| {
        let run = place.run(arguments);
        assert!(run.code != Some(0) && run.err.contains(must), "{run:?}");
    };
    refused(&map);
    refused(&[&map[..], &["--format=zarr"]].concat());
    let none = fs::read_dir(place.path("private")).unwrap().next();
    assert!(none.is_none(), "{none:?}");

    // A damaged block behind such a link is not removed.
    let run = place.run(&[
        "map",
        "scene.toml",
        "--engine=cpu",
        "-o",
        ".",
        "--format=zarr",
    ]);
    assert_eq!(run.code, Some(0), "{run:?}");
    let regimes = place.path("scene.zarr/regime");
    fs::rename(&regimes, place.path("private/regime")).unwrap();
    fs::set_permissions(place.path("scene.zarr"), Permissions::from_mode(0o1777)).unwrap();
    symlink("../private/regime", &regimes).unwrap();
    lchown(&regimes, Some(STRANGER), Some(STRANGER)).unwrap();
    fs::write(place.path("private/regime/c.0.0"), "damaged").unwrap();
    let run = place.run(&["status", "scene.zarr", "--repair"]);
    assert!(
        run.code != Some(0) && run.err.contains("regime is a symbolic link of user 54321"),
        "{run:?}"
    );
    assert_eq!(place.bytes("private/regime/c.0.0"), b"damaged");
}

fn leftovers_of_others_stay() {
    let place = Place::with(SCENE);
    let name = |end| format!(".whiskmap-{}+aB3dE6gH9jK{end}", host());
    for end in ["1", "2"] {
        place.write(&name(end), "");
    }
    chown(place.path(&name("2")), Some(STRANGER), None).unwrap();
    let arguments = [
        "shape",
        "scene.toml",
        "--distance=9",
        "--push-angle=1",
        "--csv=t.csv",
    ];
    assert_eq!(place.run(&arguments).code, Some(0));
    assert!(!place.path(&name("1")).exists());
    assert!(place.path(&name("2")).exists());
}

/// Name of this host as it is in the names of temporary files.
fn host() -> String {
    let name = Command::new("uname").arg("-n").output().unwrap().stdout;
    let name = String::from_utf8(name).unwrap();
    let is_plain = |c: &char| c.is_ascii_alphanumeric() || "-_.".contains(*c);
    name.chars().filter(is_plain).take(64).collect()
}
