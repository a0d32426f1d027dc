//! Protection of files that are not outputs of the run.

use super::data::DATA;
use super::{Place, Run, SCENE, names, words};
use std::fs::{self, Permissions};
use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};

const MAP: [&str; 4] = ["map", "scene.toml", "--engine=cpu", "-o"];

impl Place {
    /// Checks that the run is refused for its output `option`, and changes no file.
    fn keeps(&self, arguments: &[&str], parts: &[&str]) {
        let before = self.all();
        let run = self.run(arguments);
        run.assert_refused(parts);
        assert!(self.all() == before, "{run:?}");
    }

    /// Returns name and bytes of every file.
    fn all(&self) -> Vec<(String, Vec<u8>)> {
        let names = names(&self.path(""));
        let files = names.into_iter().filter(|name| self.path(name).is_file());
        files.map(|name| (name.clone(), self.bytes(&name))).collect()
    }

    fn mode(&self, name: &str) -> u32 {
        self.path(name).metadata().unwrap().mode() & 0o7777
    }
}

#[test]
fn no_output_is_an_input() {
    let place = Place::with(SCENE);
    place.write("pts.csv", DATA);
    fs::hard_link(place.path("pts.csv"), place.path("hard.csv")).unwrap();
    symlink("pts.csv", place.path("link.csv")).unwrap();
    symlink("scene.toml", place.path("p.svg")).unwrap();
    let curve = ["curve", "scene.toml", "--data=pts.csv"];
    let is = "is the input pts.csv; name another file";
    for name in ["pts.csv", "./pts.csv", "hard.csv", "link.csv"] {
        let parts = [&*format!("--csv {name}: "), is];
        place.keeps(&[&curve[..], &["--csv", name]].concat(), &parts);
    }
    let scene = "scene.toml: is the input scene.toml";
    let pole = ["scene.toml", "--distance=9"];
    for command in [
        &["curve", "scene.toml"][..],
        &[&["branch"], &pole[..]].concat(),
        &[&["shape", "--push-angle=1"], &pole[..]].concat(),
    ] {
        place.keeps(&[command, &["--csv=scene.toml"]].concat(), &[scene]);
        let plot = "--plot p.svg: is the input scene.toml";
        place.keeps(&[command, &["--plot=p.svg"]].concat(), &[plot]);
    }
    let design = ["design", "--slip-off=30deg", "--for=taper", "--plot=p.svg"];
    place.keeps(&[&design, &pole[..]].concat(), &["--plot p.svg: is the"]);
    let bench = ["bench", "scene.toml", "--quick", "--json=scene.toml"];
    place.keeps(&bench, &["--json", scene]);
    let fit = ["fit", "scene.toml", "--data=pts.csv", "--free=taper"];
    place.keeps(&[&fit[..], &["-o=pts.csv"]].concat(), &["--output", is]);
    place.keeps(&[&fit[..], &["--json=hard.csv"]].concat(), &["--json", is]);
    let figure = ["reproduce", ".", "--fig4d"];
    place.write("fig4d.csv", "side,distance_mm,push_angle_deg\ncb,9,20\n");
    let parts = ["DIR ./fig4d.csv: is the input fig4d.csv"];
    place.keeps(&[&figure[..], &["fig4d.csv"]].concat(), &parts);
}

/// The inputs are a scene named like its map, the file of its radii, and standard input.
#[test]
fn no_output_is_a_file_of_the_scene() {
    let rows = "[whisker.profile]\nrows = \"radii.csv\"\n[pole]";
    let scene = SCENE.replace("[pole]", rows);
    let radius = |line: &&str| !line.contains("radius_um");
    let scene: Vec<&str> = scene.lines().filter(radius).collect();
    let place = Place::with(&scene.join("\n"));
    place.write("radii.csv", "arc_length_mm,radius_um\n0,30\n10,14\n20,1.5\n");
    let parts = ["--csv radii.csv: is the input radii.csv"];
    place.keeps(&["curve", "scene.toml", "--csv=radii.csv"], &parts);

    for name in ["map.exr", "map.png", "map.svg"] {
        place.write(name, SCENE);
    }
    for name in ["map.exr", "map.png"] {
        let is = format!("--output ./{name}: is the input {name}");
        place.keeps(&["map", name, "--engine=cpu", "-o."], &[&is]);
    }
    symlink("map.svg", place.path("map.zarr")).unwrap();
    let map = ["map", "map.svg", "--format=zarr", "-o."];
    place.keeps(&map, &["must be a folder"]);

    // A file that is named like a standard stream is another one.
    for _ in 0..2 {
        let stdin = fs::File::open(place.path("map.svg")).unwrap();
        let mut redirected = place.plain_command(&["curve", "-", "--csv=map.svg"]);
        Run::of(&redirected.stdin(stdin).output().unwrap())
            .assert_refused(&["--csv map.svg: is the input -"]);
        assert_eq!(place.bytes("map.svg"), SCENE.as_bytes());
        place.write("-", "");
    }
}

/// A table on standard output and a picture are not written to one file.
#[test]
fn redirected_standard_output_is_no_other_output() {
    let place = Place::with(SCENE);
    let stdout = fs::File::create(place.path("o.svg")).unwrap();
    let mut both = place.plain_command(&["curve", "scene.toml", "--csv=-", "--plot=o.svg"]);
    Run::of(&both.stdout(stdout).output().unwrap()).assert_refused(&["must be two files"]);
    let parts = ["--output -: must be a folder, but - is standard output"];
    place.keeps(&["map", "scene.toml", "-o-"], &parts);

    // The files of a map are replaced as a whole, and have no messages.
    place.map(&["scene.toml", "-o."]);
    for name in ["scene.png", "scene.exr"] {
        let expected = place.bytes(name);
        let stdout = fs::File::create(place.path(name)).unwrap();
        let mut map = place.plain_command(&[&MAP[..], &["."]].concat());
        assert_eq!(map.stdout(stdout).status().unwrap().code(), Some(0));
        assert!(place.bytes(name) == expected, "{name}");
    }
}

/// The shell appends tables and summaries to an input.
#[test]
fn standard_output_is_no_input() {
    let place = Place::with(SCENE);
    place.map(&["scene.toml", "-o."]);
    let before = place.all();
    for (input, arguments) in [
        ("scene.toml", &["curve", "scene.toml"][..]),
        ("scene.toml", &["plan", "scene.toml"]),
        ("scene.toml", &["plan", "-"]),
        ("scene.toml", &["map", "scene.toml", "-o."]),
        ("scene.exr", &["compare", "scene.exr", "scene.toml"]),
        ("scene.exr", &["extract", "scene.exr", "-o=x.csv"]),
    ] {
        let stdin = fs::File::open(place.path(input)).unwrap();
        let stdout = fs::File::options().append(true).open(place.path(input));
        let mut appended = place.plain_command(arguments);
        let appended = appended.stdin(stdin).stdout(stdout.unwrap());
        let name = if arguments[1] == "-" { "-" } else { input };
        let said = format!("standard output: is the input {name}; name another file");
        Run::of(&appended.output().unwrap()).assert_refused(&[&said]);
        assert!(place.all() == before, "{arguments:?}");
    }
}

#[test]
fn no_output_is_a_map_or_in_a_store() {
    let place = Place::with(SCENE);
    place.map(&["scene.toml", "-o."]);
    fs::rename(place.path("scene.exr"), place.path("a.exr")).unwrap();
    fs::hard_link(place.path("a.exr"), place.path("b.exr")).unwrap();
    symlink("a.exr", place.path("c.csv")).unwrap();
    for name in ["a.exr", "b.exr", "c.csv"] {
        let parts = [&*format!("--output {name}: is the input a.exr")];
        place.keeps(&["extract", "a.exr", "-o", name], &parts);
    }
    let parts = ["--output b.exr: is the input a.exr; name another file"];
    place.keeps(&["render", "a.exr", "-o=b.exr"], &parts);

    place.map(&["scene.toml", "-o.", "--format=zarr"]);
    symlink("scene.zarr", place.path("link.zarr")).unwrap();
    let inside = [
        ("scene.zarr/t.csv", "is in"),
        ("link.zarr/f.npy", "is in"),
        ("scene.zarr/new/map.exr", "No such file"),
        ("scene.zarr", "is"),
        ("link.zarr", "is"),
        ("scene.zarr/new/part.zarr", "is in"),
    ];
    let before = names(&place.path("scene.zarr"));
    for (name, is) in inside {
        let of = match is {
            "No such file" => format!("--output {name}: {is}"),
            _ => format!("--output {name}: {is} the input scene.zarr"),
        };
        let extract = ["extract", "scene.zarr", "-o", name];
        let channel: &[&str] = if name.ends_with("npy") { &["--channel=regime"] } else { &[] };
        place.keeps(&[&extract[..], channel].concat(), &[&of]);
    }
    let render = ["render", "link.zarr", "-o=scene.zarr/p.png"];
    place.keeps(&render, &["--output scene.zarr/p.png: is in the input link.zarr"]);
    assert_eq!(names(&place.path("scene.zarr")), before);
}

#[test]
fn no_output_is_another_output() {
    let place = Place::with(SCENE);
    let spelt = ["curve", "scene.toml", "--csv=new.svg", "--plot=./new.svg"];
    place.keeps(&spelt, &["--csv new.svg and --plot ./new.svg: must be"]);
    place.write("scene.png", "old");
    symlink("scene.png", place.path("scene.exr")).unwrap();
    let both = "--output ./scene.exr and --output ./scene.png: must be two files";
    place.keeps(&[&MAP[..], &["."]].concat(), &[both]);
}

#[test]
fn a_file_in_the_place_of_a_folder_is_named() {
    let place = Place::with(SCENE);
    place.write("file.exr", "");
    let is_none = "must be a folder, but file.exr is not one";
    let submit = ["submit", "scene.toml", "--shards=1", "-o"];
    for command in [&MAP[..], &submit, &["reproduce"]] {
        for folder in ["file.exr", "file.exr/in"] {
            let parts = [&*format!(" {folder}: {is_none}")];
            place.keeps(&[command, &[folder]].concat(), &parts);
        }
    }
    place.write("scene.zarr", "");
    let store = "--output ./scene.zarr: must be a folder, but ./scene.zarr is not one";
    place.keeps(&[&MAP[..], &[".", "--format=zarr"]].concat(), &[store]);
    place.keeps(&[&submit[..], &["."]].concat(), &[store]);
    place.map(&["scene.toml", "-omaps"]);
    let extract = ["extract", "maps/scene.exr", "-o=scene.zarr"];
    place.keeps(&extract, &["--output scene.zarr: must be a folder"]);
}

#[test]
fn a_replaced_file_keeps_its_mode_and_a_read_only_one_is_refused() {
    let place = Place::with(SCENE);
    let table = words("shape scene.toml --distance=9 --push-angle=1 --csv=t.csv");
    place.quiet(&table);
    let expected = place.bytes("t.csv");
    // Without the set-user-ID and set-group-ID bits.
    for mode in [0o600, 0o640, 0o755, 0o666, 0o6755] {
        place.write("t.csv", "old");
        fs::set_permissions(place.path("t.csv"), Permissions::from_mode(mode)).unwrap();
        place.quiet(&table);
        assert!(place.bytes("t.csv") == expected);
        assert_eq!(place.mode("t.csv"), mode & 0o777);
    }
    fs::set_permissions(place.path("t.csv"), Permissions::from_mode(0o444)).unwrap();
    let must = "--csv t.csv: the file there is read-only; name a file that can be written";
    place.keeps(&table, &[must]);
    place.map(&["scene.toml", "-o."]);
    for name in ["scene.exr", "scene.png"] {
        fs::set_permissions(place.path(name), Permissions::from_mode(0o400)).unwrap();
        let must = format!("--output ./{name}: the file there is read-only");
        place.keeps(&[&MAP[..], &["."]].concat(), &[&must]);
        fs::set_permissions(place.path(name), Permissions::from_mode(0o600)).unwrap();
    }
}
