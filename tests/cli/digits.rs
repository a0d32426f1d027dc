//! `--digits`: rounded maps and stores.

use super::store::{SWEEP, assert_complete, assert_same, good};
use super::{Place, words};
use std::fs;
use whiskmap::plan::{Digits, rounded};
use whiskmap::store::{ChannelValues, MapSource};

const DIGITS: &str = "5,force_un=3";

/// Checks that `found` has the values of `whole`, rounded to [`DIGITS`].
fn assert_rounded(whole: &MapSource, found: &MapSource, whiskers: usize) {
    let digits: Digits = DIGITS.parse().unwrap();
    let mut changed = 0;
    for (channel, whisker) in
        whole.channels().iter().flat_map(|channel| (0..whiskers).map(move |at| (channel, at)))
    {
        let values = [whole, found].map(|map| map.read_panel(channel, whisker).unwrap());
        match values {
            [ChannelValues::F32(whole), ChannelValues::F32(found)] => {
                let bits = digits.mantissa_bits(channel).unwrap();
                for (whole, found) in whole.into_iter().zip(found) {
                    assert_eq!(rounded(whole, bits).to_bits(), found.to_bits(), "{channel}");
                    changed += usize::from(found != whole && !found.is_nan());
                }
            }
            [ChannelValues::U32(whole), ChannelValues::U32(found)] => assert_eq!(whole, found),
            _ => unreachable!("the kinds of {channel} differ"),
        }
    }
    assert!(changed > 1000, "{changed} values changed");
}

#[test]
fn both_formats_have_the_rounded_values() {
    let place =
        Place::with(&SWEEP.replace("friction = [0, 0.3]", "").replace("count = 64", "count = 20"));
    let map = |options: &[&str]| place.map(&[&["scene.toml", "--no-png"], options].concat());
    for (format, file) in [("exr", "scene.exr"), ("zarr", "scene.zarr")] {
        map(&["-o", "whole", "--format", format]);
        map(&["-o", "rounded", "--format", format, "--digits", DIGITS]);
        map(&["-o", "seven", "--format", format, "--digits", "7"]);
        let open = |folder| MapSource::open(&place.path(folder).join(file)).unwrap();
        let [whole, found] = ["whole", "rounded"].map(open);
        assert_rounded(&whole, &found, 12);
        assert_eq!(whole.digits().unwrap(), Digits::ALL);
        assert!(whole.attribute("digits").is_err());
        let text = found.attribute("digits").unwrap();
        let text = text.as_str().unwrap();
        assert!(text.contains("force_un=3") && text.contains("margin_deg=5"), "{text}");
    }
    assert_same(&place, "whole", "seven");

    // A part of a rounded map is rounded, too.
    for name in ["part.exr", "part.zarr"] {
        place.good(&["extract", "rounded/scene.zarr", "--at", "taper=0.5", "-o", name]);
        let part = MapSource::open(&place.path(name)).unwrap();
        let digits = part.digits().unwrap();
        assert_eq!(digits.mantissa_bits("force_un"), Some(10));
    }
}

#[test]
fn a_rounded_store_is_one_for_all_shards() {
    let place = Place::with(SWEEP);
    let digits = ["--digits", "4"];
    let run = |folder, option| good(&place, folder, &[&[option], &digits[..]].concat());
    run("whole", "--no-png");
    run("parts", "--shard=1/2");
    place
        .run(&words("map scene.toml --engine=cpu --format=zarr -o parts --resume --digits=5"))
        .assert_refused(&["differs in `digits`", "force_un=4", "force_un=5"]);
    run("parts", "--resume");
    assert_same(&place, "whole", "parts");
    let status = place.run(&["status", "whole/scene.zarr", "--verify"]);
    assert!(
        status.out.contains("rounded to digits: ") && status.out.contains("force_un=4"),
        "{status:?}"
    );
    assert_complete(&place, "whole/scene.zarr");

    let json = |file: &str| -> serde_json::Value {
        let text = fs::read(place.path("whole/scene.zarr").join(file)).unwrap();
        serde_json::from_slice(&text).unwrap()
    };
    let force = &json("force_un/zarr.json")["attributes"];
    assert_eq!(force["quantization"], "quantization");
    assert_eq!(force["quantization_nsb"], 14);
    let about = &json("quantization/zarr.json")["attributes"];
    assert_eq!(about["algorithm"], "bitround");
    let regime = &json("regime/zarr.json")["attributes"];
    assert!(regime.get("quantization").is_none());
}

#[test]
fn impossible_digits_are_refused() {
    let place = Place::with(SWEEP);
    for (list, part) in [
        ("0", "`0`: must be N or NAME=N, N a whole number between 2 and 7"),
        ("8", "`8`: must be"),
        ("9", "`9`: must be"),
        ("5,force_un=1", "`force_un=1`: must be"),
        ("=5", "`` is no channel"),
        ("5,force=3", "did you mean `force_un`?"),
        ("status=5", "`status` is a channel that is not rounded"),
        ("5,4", "`4`: must be given once"),
    ] {
        let run = place.run(&["map", "scene.toml", "--digits", list]);
        run.assert_refused(&["--digits", part]);
    }
    let channels = ["--format=zarr", "--channels=regime,force_un"];
    let run = place.run(&[&["map", "scene.toml", "--digits=energy_nj=4"], &channels[..]].concat());
    run.assert_refused(&[
        "--digits energy_nj=4: energy_nj is not stored, only regime, force_un; add it",
    ]);
}

#[test]
fn fewer_digits_are_planned_as_fewer_bytes() {
    let place = Place::with(SWEEP);
    let bytes = |options: &[&str]| -> f64 {
        let run = place.good(&[&["plan", "scene.toml"], options].concat());
        let line = run.out.lines().find(|line| line.starts_with("Zarr store"));
        let (_, after) = line.unwrap().split_once("about ").unwrap();
        let mut words = after.split([' ', ',']);
        let number: f64 = words.next().unwrap().parse().unwrap();
        match words.next().unwrap() {
            "MB" => 1e6 * number,
            "kB" => 1e3 * number,
            unit => unreachable!("{unit}"),
        }
    };
    assert!(bytes(&["--digits", "4"]) < 0.7 * bytes(&[]));
}
