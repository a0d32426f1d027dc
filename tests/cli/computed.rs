//! `render`, `extract` and `compare` of scenes, whose maps are computed when they are read.

use super::refused::READ_TWICE;
use super::store::assert_same;
use super::{Place, Run, SCENE, names, words};

/// Sweep of straight and curved whiskers in front of three poles, with friction.
fn sweep() -> String {
    let axes = "curvature_per_mm = [0, 0.02]\npole_radius_mm = [0.1, 0.2, 0.4]\n";
    format!("{SCENE}{axes}[contact]\nfriction = 0.2\n")
}

/// Sweep of 10^9 whiskers, which no test can compute.
fn huge() -> String {
    let scene = SCENE.replace("tip_radius_um = 1.5\n", "");
    let axes = ["taper", "friction", "pole_radius_mm"];
    let axes = axes.map(|axis| format!("{axis} = {{ from = 0, to = 0.9, count = 1000 }}\n"));
    format!("{scene}{}", axes.concat())
}

/// Runs the program with `text` as its standard input.
fn piped(place: &Place, arguments: &[&str], text: &str) -> Run {
    let mut command = place.command(arguments);
    Run::of(&command.write_stdin(text).output().unwrap())
}

/// An EXR file has its columns by name, and a store has no adapter.
#[test]
fn a_part_of_a_scene_is_that_of_its_map() {
    let place = Place::with(&sweep().replace("count = 24", "count = 64"));
    // Lazy maps of both engines are compared with whole ones in `store::computed`.
    let engine = "spectral";
    let solver = format!("--engine={engine}");
    for format in ["exr", "zarr"] {
        let map = ["map", "scene.toml", "--no-png", "--format", format];
        place.good(&[&map[..], &["-o", engine, &solver]].concat());
    }
    for (part, output, formats) in [
        (&["--at=pole_radius_mm=0.21"][..], "part.csv", &["zarr"][..]),
        (&["--at=curvature_per_mm=0", "--channel=force_un"], "part.npy", &["exr", "zarr"]),
        (&["--at=pole_radius_mm=0.4"], "part.zarr", &["exr", "zarr"]),
        (&["--at=distance_mm=5"], "part.zarr", &["zarr"]),
        (&["--channel=force_un"], "part.zarr", &["zarr"]),
        (&["--at=curvature_per_mm=0.02"], "part.exr", &["exr"]),
        (&["--at=push_angle_deg=-30"], "part.exr", &["exr"]),
        (&[], "part.exr", &["exr"]),
    ] {
        let computed = format!("computed/{output}");
        std::fs::create_dir_all(place.path("computed")).unwrap();
        let extract = [&["extract", "scene.toml", &solver, "-o", &computed], part].concat();
        let run = place.good(&extract);
        let begin = format!("engine: {engine} f64 on ");
        assert!(run.err.starts_with(&begin), "{run:?}");
        for format in formats {
            let stored = format!("{engine}/scene.{format}");
            let of_stored = place.good(&[&["extract", &stored, "-o", output], part].concat());
            assert!(run.err.ends_with(&of_stored.err), "{run:?} {of_stored:?}");
            match output {
                "part.zarr" => {
                    assert_same(&place, output, &computed);
                    std::fs::remove_dir_all(place.path(output)).unwrap();
                }
                _ => {
                    let is_same = place.bytes(output) == place.bytes(&computed);
                    assert!(is_same, "{engine}, {part:?}, {stored}");
                }
            }
        }
        if output == "part.zarr" {
            std::fs::remove_dir_all(place.path(&computed)).unwrap();
        }
    }
}

#[test]
fn a_picture_of_a_scene_is_that_of_its_map() {
    let place = Place::with(&sweep());
    place.map(&["scene.toml", "--no-png"]);
    for (options, name) in [
        (&[][..], "scene.png"),
        (&["--at=pole_radius_mm=0.2"], "scene.pole_radius_mm=0.2.png"),
        (
            &["--channel=force_un", "--at=curvature_per_mm=0.02"],
            "scene.curvature_per_mm=0.02.force_un.png",
        ),
        (
            &words("--channel=energy_nj --at=distance_mm=9 --at=pole_radius_mm=0.1"),
            "scene.distance_mm=9.04348.pole_radius_mm=0.1.energy_nj.png",
        ),
    ] {
        let stored = ["render", "outputs/scene.exr", "-o", "stored.png"];
        place.good(&[&stored, options].concat());
        let computed = ["render", "scene.toml", "--engine", "cpu"];
        let run = place.good(&[&computed, options].concat());
        assert_eq!(run.out.replace('\\', "/"), format!("outputs/{name}\n"));
        let drawn = place.bytes(&format!("outputs/{name}"));
        assert!(drawn == place.bytes("stored.png"), "{name}");
    }
}

#[test]
fn only_the_whiskers_of_a_part_are_computed() {
    let place = Place::with(&huge());
    let at = words("--at=taper=0.9 --at=friction=0.3 --at=pole_radius_mm=0.5");
    let run = place.good(&[&["render", "scene.toml"], &at[..]].concat());
    assert!(run.err.contains("\ntaper = 0.9\nfriction = 0.3"), "{run:?}");
    let part = ["--at=distance_mm=9", "--channel=force_un", "-o", "row.csv"];
    place.good(&[&["extract", "scene.toml"], &at[..], &part].concat());
    let row = place.text("row.csv");
    assert_eq!(row.lines().count(), 1 + 24);
}

#[test]
fn a_scene_comes_from_standard_input() {
    let place = Place::with(&sweep());
    place.map(&["scene.toml", "--no-png"]);
    let part = words("extract - --engine=cpu --at=pole_radius_mm=0.2 -o");
    let run = piped(&place, &[&part[..], &["piped.exr"]].concat(), &sweep());
    assert_eq!(run.code, Some(0), "{run:?}");
    place.good(&[&["extract", "scene.toml"], &part[2..], &["part.exr"]].concat());
    assert!(place.bytes("piped.exr") == place.bytes("part.exr"));

    let run = piped(&place, &["render", "-"], &sweep());
    assert_eq!((run.code, &*run.out.replace('\\', "/")), (Some(0), "outputs/scene.png\n"));
    let compared = words("compare outputs/scene.exr - --within=0 --engine=cpu");
    assert_eq!(piped(&place, &compared, &sweep()).code, Some(0));
    piped(&place, &["compare", "-", "-"], &sweep()).assert_refused(&[READ_TWICE]);
    piped(&place, &["extract", "-", "-o", "part.csv"], "title = 1")
        .assert_refused(&["<stdin>", "title"]);
}

#[test]
fn a_scene_is_compared_with_its_map() {
    let place = Place::with(&sweep());
    let some = "--channels=regime,force_un,d_push_d_base_radius_um";
    place.map(&["scene.toml", "--format=zarr", some]);
    place.map(&["scene.toml", "--no-png", "--digits=3"]);
    let run = place.good(&words("compare outputs/scene.zarr scene.toml --within=0 --engine=cpu"));
    // The scene has the channels of the store.
    assert!(!run.out.contains("only in"), "{run:?}");
    assert_eq!(run.count("  cells"), 6 * 24 * 24);
    assert!(run.out.contains("scene.toml: engine cpu f64, arithmetic "), "{run:?}");
    assert!(run.out.contains("d_push_d_base_radius_um"), "{run:?}");
    place.good(&["compare", "scene.toml", "outputs/scene.exr", "--within=0"]);
    place.good(&["compare", "scene.toml", "scene.toml", "--within=0"]);

    place.write("other.toml", &sweep().replace("friction = 0.2", "friction = 0.3"));
    let other = ["compare", "other.toml", "outputs/scene.exr"];
    place
        .run(&other)
        .assert_said(2, "the scenes differ: friction is 0.3 in the first map, 0.2 in the second");
    place.write("other.toml", &sweep().replace("count = 24", "count = 12"));
    place.run(&other).assert_said(2, "the axis distance_mm differs");
}

#[test]
fn derivatives_are_computed_if_they_are_named() {
    let place = Place::with(SCENE);
    let channel = "d_push_d_base_radius_um";
    place.map(&["scene.toml", "--no-png", "--channels", &format!("regime,status,{channel}")]);
    for (from, to) in [("scene.toml", "computed.npy"), ("outputs/scene.exr", "stored.npy")] {
        place.good(&["extract", from, "--channel", channel, "-o", to]);
    }
    assert!(place.bytes("computed.npy") == place.bytes("stored.npy"));
    place.good(&["render", "scene.toml", "--channel", channel]);
}

#[test]
fn bad_parts_of_scenes_are_refused() {
    let place = Place::with(&huge());
    let axes = "a picture has room for two sweep axes, there are taper, friction, pole_radius_mm; choose a value";
    let picture = ["render", "scene.toml", "-o", "part.png"];
    place.run(&picture).assert_said(2, axes);
    let axes = "a map holds at most two sweep axes, the slice has taper, friction, pole_radius_mm";
    let map = ["extract", "scene.toml", "-o", "part.exr"];
    place.run(&map).assert_said(2, axes);
    for (options, said) in [
        (
            &["--at=tapr=1"][..],
            "--at tapr: must be one of the axes, taper, friction, pole_radius_mm",
        ),
        (&["--at=tapr=1"], "did you mean `taper`?"),
        (
            &["--at=taper=0.12345", "--exact"],
            "--at taper: 0.12345 is no value of the axis; the nearest is 0.123",
        ),
        (
            &["--at=taper=1"],
            "--at taper: 1 is more than half a step beyond the axis, which goes from 0 to 0.9",
        ),
        (&["--at=taper=0", "--at=taper=0"], "--at taper: is given twice"),
        (
            &["--at=taper=0", "--channel=force"],
            "--channel force: must be one of regime, status, arc_length_mm",
        ),
        (
            &["--channel=d_push_d_spiral_per_mm"],
            "--channel d_push_d_spiral_per_mm: must be one of regime",
        ),
        (&["--channel=forc_un"], "did you mean `force_un`?"),
        (&["--engine=cpu", "--precision=f32"], "--precision f32: the CPU computes in f64"),
        (&["--engine=cpu", "--adapter=0"], "--adapter 0: the CPU engine has none"),
        (&["--engine=fast"], "--engine <ENGINE>"),
        (&["--tolerance=2deg"], "must be between 1e-10deg and 1deg"),
        (&["--tolerance=1e-10deg"], "--tolerance 1e-10deg: must be at least"),
        (&["-o", "scene.toml"], "--output scene.toml: is the input scene.toml"),
        (&["-o", "part.txt"], "must end in .png, .svg or .pdf"),
    ] {
        let run = place.run(&[&["render", "scene.toml", "--at=friction=0"], options].concat());
        run.assert_said(2, said);
        assert_eq!(run.out, "", "{run:?}");
    }
    // Nothing was computed.
    assert_eq!(names(&place.path("")), ["scene.toml"]);
    for command in ["render", "extract"] {
        let run = |scene: &str| place.run(&[command, scene, "-o", "part.png"]);
        run("nowhere.toml").assert_refused(&["nowhere.toml: cannot be read"]);
        place.write("bad.toml", &SCENE.replace("length_mm = 20", "length_mm = -20"));
        run("bad.toml").assert_refused(&[
            "bad.toml:3",
            "whisker.length_mm = -20",
            "must be between",
        ]);
    }
    let compared = ["compare", "scene.toml", "bad.toml"];
    place.run(&compared).assert_said(2, "whisker.length_mm = -20");
}

#[test]
fn options_of_the_solver_are_for_scenes() {
    let place = Place::with(SCENE);
    place.map(&["scene.toml", "--no-png"]);
    let map = "outputs/scene.exr";
    for (option, name) in [
        ("--engine=cpu", "--engine"),
        ("--precision=f64", "--precision"),
        ("--adapter=0", "--adapter"),
        ("--tolerance=1e-3deg", "--tolerance"),
    ] {
        let said = format!("{name}: {map} is a stored map, which is not computed; give the scene");
        for command in [
            &["render", map, option][..],
            &["extract", map, "-o", "part.csv", option],
            &["compare", map, map, option],
        ] {
            place.run(command).assert_refused(&[&said]);
        }
    }
    let run = place.good(&words("render scene.toml --tolerance=1e-3deg --engine=cpu"));
    assert!(run.err.starts_with("accuracy: "), "{run:?}");
}

#[test]
fn files_of_a_scene_are_no_outputs() {
    let scene = SCENE.replace("base_radius_um = 30.0\ntip_radius_um = 1.5\n", "");
    let place =
        Place::with(&scene.replace("[pole]", "[whisker.profile]\nrows = \"radii.csv\"\n[pole]"));
    let radii = "arc_length_mm,radius_um\n0,30\n20,2\n";
    place.write("radii.csv", radii);
    for command in [
        &words("extract scene.toml --at=distance_mm=9 -o radii.csv")[..],
        &["compare", "scene.toml", "scene.toml", "--json", "radii.csv"],
    ] {
        place.run(command).assert_said(2, "radii.csv: is the input");
        assert_eq!(place.bytes("radii.csv"), radii.as_bytes());
    }
}
