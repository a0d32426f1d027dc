//! Effects, states and calls that `whiskmap plan` prints.

use super::{STRAIGHT, fact, memory_mib, plan};
use crate::cli::{Place, Run, SCENE};

/// Returns the effects as `name on cost: why`.
fn effects(run: &Run) -> Vec<String> {
    let lines = run.out.split("\n\n").nth(1).unwrap().lines().skip(1);
    let squeezed = lines.map(|line| {
        let words: Vec<&str> = line.split("  ").map(str::trim).collect();
        let words: Vec<&str> = words.into_iter().filter(|word| !word.is_empty()).collect();
        words.join(" | ")
    });
    squeezed.collect()
}

#[test]
fn a_straight_cylinder_has_no_effects() {
    let run = plan(&Place::with(STRAIGHT));
    assert!(run.out.starts_with("A straight cylinder\n\neffect "));
    let expected = [
        "taper | off | own kernel | tip_radius_um 30 = base_radius_um 30",
        "measured radii | off | own kernel | no whisker.profile",
        "curvature | off | own kernel | parabola_per_mm is 0 or left out",
        "euler spiral | off | own kernel | euler_spiral is 0 or left out",
        "traced shape | off | own kernel | no whisker.rest",
        "modulus gradient | off | own kernel | tip_to_base is 1 or left out",
        "pole radius | off | free: start | radius_mm is 0 or left out",
        "friction | off | free: start | friction is 0 or left out",
        "elastic follicle | off | free: start | no whisker.follicle: the base is clamped",
        "projection | off | free: taper | arc_stretch is 1 or left out",
    ];
    assert_eq!(effects(&run), expected);
    let states = "7: 0 rest shape, 4 rod, 3 derivatives; at last 9 with energy";
    assert_eq!(fact(&run, "states"), states);
    let cells = "16: 8 push angles x 2 distances x 1 whisker";
    assert_eq!(fact(&run, "cells"), cells);
    let calls = "1: groups of 1 whisker, 1 side of 2 rows, 1024 rows a call";
    assert_eq!(fact(&run, "GPU calls"), calls);
    assert_eq!(fact(&run, "GPU memory"), "224 MiB more than below, on the host");
    // 4 MiB for each thread, 256 KiB for the sheet of the only side, and 16 cells.
    let threads = std::thread::available_parallelism().unwrap();
    let mib = 4 * threads.get() + 1;
    for format in ["EXR file", "Zarr store"] {
        assert_eq!(memory_mib(&run, format), mib);
    }
}

#[test]
fn the_cone_scene() {
    let place = Place::with(include_str!("../../../scenes/cone.toml"));
    let run = plan(&place);
    let taper = "taper | on | own kernel | tip_radius_um 1.5 < base_radius_um 30";
    assert_eq!(effects(&run)[0], taper);
    assert!(fact(&run, "states").starts_with("11: 2 rest shape"));
    let cells = "262144: 512 push angles x 512 distances x 1 whisker";
    assert_eq!(fact(&run, "cells"), cells);
    let calls = "4: groups of 1 whisker, 2 sides of 512 rows, 256 rows a call";
    assert_eq!(fact(&run, "GPU calls"), calls);

    let rough = SCENE.replace("[grid]", "[contact]\nfriction = 0.2\n[grid]");
    let line = "the CPU solves contacts that stick or slide toward the base";
    assert_eq!(fact(&plan(&Place::with(&rough)), "friction"), line);

    // Only the seconds change, and they are positive.
    let same = |run: &Run| run.out.lines().take(18).collect::<Vec<_>>().join("\n");
    let again = plan(&place);
    assert_eq!(same(&run), same(&again));
    let words: Vec<&str> = fact(&run, "time").split(' ').collect();
    let seconds: f64 = words[1].parse().unwrap();
    assert!(words[0] == "about" && words[2] == "s" && seconds > 0.0, "{run:?}");
}
