//! `whiskmap render`.

use super::{Place, Run, SCENE, names, no_file, no_folder, words};

#[test]
fn render_draws_the_picture_again() {
    let place = Place::with(SCENE);
    place.map(&["scene.toml"]);
    let drawn = place.bytes("outputs/scene.png");
    std::fs::remove_file(place.path("outputs/scene.png")).unwrap();

    let run = place.quiet(&["render", "outputs/scene.exr"]);
    assert!(run.out.trim_end().ends_with("scene.png"), "{run:?}");
    assert!(place.bytes("outputs/scene.png") == drawn);

    place.quiet(&["render", "outputs/scene.exr", "--channel", "force_un"]);
    let force = place.bytes("outputs/scene.force_un.png");
    assert!(force.starts_with(b"\x89PNG") && force != drawn);

    let run = place.run(&["render", "outputs/scene.exr", "-o", "elsewhere.png"]);
    assert_eq!((run.code, &*run.out), (Some(0), "elsewhere.png\n"), "{run:?}");
    assert!(place.bytes("elsewhere.png") == drawn);
}

#[test]
fn every_channel_can_be_drawn() {
    let place = Place::with(&SCENE.replace("count = 24", "count = 7"));
    place.map(&["scene.toml", "--no-png"]);
    let map = whiskmap::store::StoredMap::open(&place.path("outputs/scene.exr")).unwrap();
    for channel in map.channels() {
        place.quiet(&["render", "outputs/scene.exr", "--channel", channel]);
    }
    assert_eq!(names(&place.path("outputs")).len(), 1 + map.channels().len());
}

/// Names of whiskers may have separators of paths, which a name of a file has not.
#[test]
fn whiskers_of_any_name_have_a_picture() {
    let table = "[whiskers]\ntable = [{ name = 'L/C1', taper = 0.9 }, { name = 'L/C2', taper = 0.5 }]\n[grid]";
    let place = Place::with(&SCENE.replace("[grid]", table));
    place.map(&["scene.toml", "--no-png"]);
    let run = place.good(&["render", "outputs/scene.exr", "--at", "whisker=L/C1"]);
    assert_eq!(run.out.replace('\\', "/"), "outputs/scene.whisker=L-C1.png\n");
    let range = ["render", "outputs/scene.exr", "--channel", "force_un", "--range", "5,1"];
    place
        .run(&range)
        .assert_refused(&["--range 5,1: must be two different numbers, the smaller one first"]);
}

/// The picture of a part of a store equals that of the part's map.
#[test]
fn stores_and_parts_are_drawn_like_maps() {
    let place = Place::with(super::store::SWEEP);
    super::store::good(&place, ".", &[]);
    let run = |arguments: &[&str]| place.good(arguments);
    let at = ["--at=friction=0.2", "--at=taper=0.5"];
    run(&[&["extract", "scene.zarr", "-o", "part.exr"], &at[..]].concat());
    for channel in [&[][..], &["--channel=status"], &["--channel=force_un", "--log"]] {
        run(&[&["render", "part.exr", "-o", "part.png"], channel].concat());
        let drawn = [&["render", "scene.zarr", "-o", "drawn.png"], &at[..], channel].concat();
        assert_eq!(run(&drawn).err, "friction = 0.3\ntaper = 0.5\n");
        assert!(place.bytes("drawn.png") == place.bytes("part.png"), "{channel:?}");
    }
    // One whisker of several in a map, and one distance.
    run(&words("extract scene.zarr --at=friction=0 -o whole.exr"));
    for at in ["--at=taper=1", "--at=distance_mm=5"] {
        run(&["extract", "whole.exr", at, "-o", "part.exr"]);
        run(&["render", "part.exr", "-o", "part.png"]);
        run(&["render", "whole.exr", at, "-o", "drawn.png"]);
        assert!(place.bytes("drawn.png") == place.bytes("part.png"), "{at}");
    }
    let beside = run(&words("render scene.zarr --at=friction=0.3 --channel=force_un"));
    assert_eq!(beside.out, "scene.friction=0.3.force_un.png\n");

    // An extracted axis of one value takes no room, and its value stands once in the title.
    run(&words("extract scene.zarr --at=friction=0.3 -o part.zarr"));
    run(&["render", "part.zarr", "-o", "own.svg"]);
    run(&words("render part.zarr --at=friction=0.3 -o chosen.svg"));
    run(&words("render scene.zarr --at=friction=0.3 -o drawn.svg"));
    let drawn = place.bytes("drawn.svg");
    assert!(drawn == place.bytes("own.svg") && drawn == place.bytes("chosen.svg"));

    place.run(&["render", "scene.zarr"]).assert_refused(&[
        "a picture has room for two sweep axes, there are taper, friction, pole_radius_mm",
        "--at",
    ]);
    place
        .run(&["render", "scene.zarr", "--at=colour=1"])
        .assert_refused(&["--at colour: must be one of the axes, taper, friction"]);
    std::fs::remove_file(place.path("scene.zarr/regime/c.0.0.0.0.0")).unwrap();
    place
        .run(&["render", "scene.zarr", "--at=friction=0", "--exact"])
        .assert_said(
            0,
            "warning: scene.zarr is not finished: 3 of 12 panels are not computed and are drawn without values",
        );
    for (channel, said) in [
        ("regime", "not computed"),
        ("status", "not computed"),
        ("force_un", "no contact, or not computed"),
    ] {
        let picture = |axes: &str| {
            place.good(&["render", "scene.zarr", axes, "--channel", channel, "-o", "part.svg"]);
            place.text("part.svg")
        };
        assert!(picture("--at=friction=0").contains(said), "{channel}");
        assert!(!picture("--at=friction=0.3").contains("not computed"), "{channel}");
    }
    // Only pictures may have gaps.
    place
        .run(&["extract", "scene.zarr", "--at=friction=0", "-o", "part.csv"])
        .assert_said(
            2,
            "error: scene.zarr is not finished: some requested whiskers are not computed; `whiskmap status` lists",
        );
}

#[test]
fn render_refuses_what_is_no_map() {
    let place = Place::with(SCENE);
    place.map(&["scene.toml", "--no-png"]);
    let run = place.run(&["render", "outputs/scene.exr", "--channel", "colour"]);
    let known = ["--channel colour", "must be one of", "regime, ", "force_un", "margin_deg"];
    run.assert_refused(&known);

    place.write("scene.txt", SCENE);
    let run = place.run(&["render", "scene.txt"]);
    run.assert_refused(&["scene.txt", "not an EXR file"]);
    let run = place.run(&["render", "nowhere.exr"]);
    run.assert_refused(&["nowhere.exr", &no_file()]);
    place.run(&["render", "outputs"]).assert_refused(&["outputs"]);

    let whole = place.bytes("outputs/scene.exr");
    for bytes in [0, 4, 100, whole.len() / 2, whole.len() - 1] {
        std::fs::write(place.path("outputs/cut.exr"), &whole[..bytes]).unwrap();
        let run = place.run(&["render", "outputs/cut.exr"]);
        run.assert_refused(&["error: outputs/cut.exr is "]);
    }
    assert_eq!(names(&place.path("outputs")), ["cut.exr", "scene.exr"]);
}

/// Returns a folder with a map.
fn mapped(scene: &str) -> Place {
    let place = Place::with(scene);
    place.map(&["scene.toml", "--no-png"]);
    place
}

#[test]
fn the_ending_decides_what_is_written() {
    let place = mapped(SCENE);
    for (name, start) in [
        ("a.png", &b"\x89PNG"[..]),
        ("b.PNG", b"\x89PNG"),
        ("c.svg", b"<?xml"),
        ("d.Svg", b"<?xml"),
        ("e.pdf", b"%PDF"),
    ] {
        let run = place.run(&["render", "outputs/scene.exr", "-o", name]);
        assert_eq!((run.code, &*run.out), (Some(0), &*format!("{name}\n")));
        assert!(place.bytes(name).starts_with(start), "{name}");
    }
    for name in ["f.jpg", "g", "h.svg.gz"] {
        let run = place.run(&["render", "outputs/scene.exr", "-o", name]);
        run.assert_refused(&[&format!("--output {name}: must end in .png, .svg or .pdf")]);
        assert!(!place.path(name).exists());
    }
    let mut piped = place.plain_command(&["render", "outputs/scene.exr", "-o", "-"]);
    let output = piped.output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stdout == place.bytes("a.png") && output.stderr.is_empty());
}

/// A missing folder, and a folder in the place of the picture.
#[test]
fn a_picture_that_cannot_be_written_leaves_nothing() {
    let place = mapped(SCENE);
    for ending in ["png", "svg"] {
        let (nowhere, taken) = (format!("nowhere/map.{ending}"), format!("taken.{ending}"));
        std::fs::create_dir(place.path(&taken)).unwrap();
        for (path, why) in [(&nowhere, &*no_folder()), (&taken, "is a directory")] {
            let run = place.run(&["render", "outputs/scene.exr", "-o", path]);
            run.assert_refused(&[&format!("--output {path}: {why}")]);
        }
        assert_eq!(names(&place.path("")), ["outputs", "scene.toml", &taken]);
        std::fs::remove_dir(place.path(&taken)).unwrap();
    }
}

#[test]
fn scale_and_width_are_chosen() {
    let place = mapped(SCENE);
    let force = ["render", "outputs/scene.exr", "--channel", "force_un"];
    let draw = |more: &[&str]| {
        place.quiet(&[&force[..], &["-o", "force.svg"], more].concat());
        place.text("force.svg")
    };
    let plain = draw(&[]);
    // Forces span more than two decades.
    assert_eq!(draw(&["--log"]), plain);
    assert_ne!(draw(&["--linear"]), plain);
    let ranged = draw(&["--range", "-10,2e6"]);
    assert!(ranged.contains(">contact force (N)<") && ranged.contains(">2.0<"));
    assert!(draw(&["--width", "640"]).contains(" width=\"640\" "));
    // Without a title, the picture is lower and has the rest.
    let untitled = draw(&["--no-title"]);
    let title = ">A test<";
    let title = match plain.contains(title) {
        true => title.to_owned(),
        false => format!(">{}<", SCENE.lines().next().unwrap().split('"').nth(1).unwrap()),
    };
    assert!(plain.contains(&title) && !untitled.contains(&title), "{title}");
    assert!(untitled.contains(">contact force ("), "{untitled}");
    let height = |svg: &str| -> f64 {
        let height = svg.split(" height=\"").nth(1).unwrap().split('"').next().unwrap();
        height.parse().unwrap()
    };
    assert!(height(&untitled) < height(&plain));
    // Moments of both signs have the logarithmic scale of their size, unless a linear one is chosen.
    let moment = |more: &[&str]| {
        let moment = words("render outputs/scene.exr --channel base_moment_nnm -o moment.svg");
        place.quiet(&[&moment[..], more].concat());
        place.text("moment.svg")
    };
    let size = ">size of the bending moment at the base (";
    assert!(moment(&[]).contains(size) && moment(&["--log"]).contains(size));
    let linear = moment(&["--linear"]);
    assert!(linear.contains(">bending moment at the base (") && !linear.contains(size));
    assert!(!moment(&["--range", "-100,100"]).contains(size));

    let arc = |range: &str| {
        let arc = ["--channel", "arc_length_mm", "-o", "arc.svg", "--range", range];
        place.good(&[&["render", "outputs/scene.exr"], &arc[..]].concat());
        place.bytes("arc.svg")
    };
    assert!(arc("5mm,2cm") == arc("5,20"));

    let refused = |more: &[&str], parts: &[&str]| {
        let run = place.run(&[&["render", "outputs/scene.exr"], more].concat());
        run.assert_refused(parts);
    };
    refused(&["--log"], &["--channel <NAME>"]);
    refused(&["--range", "1,2"], &["--channel <NAME>"]);
    refused(&["--channel", "status", "--log"], &["`status`", "made of codes"]);
    let force = ["--channel", "force_un"];
    let refused = |more: &[&str], parts: &[&str]| refused(&[&force[..], more].concat(), parts);
    for range in ["1", "1;2"] {
        refused(&["--range", range], &[range, "two numbers, separated by a comma"]);
    }
    for range in ["a,2", "1,2,3", "0,inf"] {
        refused(&["--range", range], &[range, "must be a force"]);
    }
    refused(&["--range", "1deg,2"], &["--range 1deg,2: 1deg: unit deg: must be uN (the default)"]);
    refused(&["--range", "2,1"], &["range 2,1", "smaller one first"]);
    refused(&["--range", "1e99,1"], &["range 1e99,1:"]);
    refused(&["--log", "--range", "-1,1"], &["range -1,1", "above 0"]);
    for width in ["299", "8001", "wide"] {
        refused(&["--width", width], &["--width <PX>", width]);
    }
    refused(&["--width", "9"], &["between 300 and 8000"]);
    assert_eq!(names(&place.path("outputs")), ["scene.exr"]);
}

#[test]
fn boxes_are_drawn_with_a_warning() {
    let place = Place::with(&SCENE.replace("A small map", "A small \u{5730}\u{56f3}"));
    let warned = |run: &Run| {
        let line = run.err.lines().last().unwrap_or_default();
        line.starts_with("warning: ") && line.contains("\u{201c}\u{5730}\u{56f3}\u{201d}")
    };
    let run = place.map(&["scene.toml"]);
    assert!(warned(&run), "{run:?}");
    let run = place.run(&["render", "outputs/scene.exr"]);
    assert!(run.code == Some(0) && warned(&run), "{run:?}");
    assert_eq!(run.err.lines().count(), 1, "{run:?}");
    let run = place.run(&["curve", "scene.toml", "--plot", "curve.png"]);
    assert!(run.code == Some(0) && warned(&run), "{run:?}");
    place.quiet(&["render", "outputs/scene.exr", "-o", "map.svg"]);
    let document = place.text("map.svg");
    assert!(document.contains("A small \u{5730}\u{56f3}<"));
}
