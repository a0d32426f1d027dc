//! Control characters in text from outside: escaped in messages, and in results on a terminal.

use super::{Place, Run, SCENE};
use std::ffi::CStr;
use std::fs;
use std::io::Read;
use std::os::fd::{FromRawFd, OwnedFd};
use std::os::unix::fs::OpenOptionsExt;
use std::process::{Command, Stdio};
use whiskmap::engine::EngineDescription;
use whiskmap::map::{Audit, Channels, EngineCells};
use whiskmap::plan::Digits;
use whiskmap::scene::{Scene, SceneData};
use whiskmap::store::{MapDescription, MapSlice, MapWriter, Output, StoredMap, TemporaryFiles};

/// Texts that a terminal must not get: all control characters of C0 and C1 that a file name can have, sequences that reset, colour
/// and name a terminal, a line that looks like a message, and all embeddings, overrides and isolates of bidirectional text.
fn hostile() -> [String; 4] {
    let c0 = (1..0x20).chain([0x7f]).filter(|code| *code != 0x1b);
    let bidi = (0x202a..=0x202e).chain(0x2066..=0x2069);
    let text = |codes: &mut dyn Iterator<Item = u32>| codes.filter_map(char::from_u32).collect();
    [
        text(&mut c0.into_iter()),
        text(&mut (0x80..0xa0)),
        text(&mut bidi.into_iter()),
        "\u{1b}c\u{1b}[31m\u{1b}]0;t\u{7}\nerror: forged".to_owned(),
    ]
}

/// Checks that a text has no control character but line breaks, and none of bidirectional text.
fn assert_plain(text: &str, about: &[String]) {
    let is_bad = |c: &char| {
        (c.is_control() && *c != '\n')
            || ('\u{202a}'..='\u{202e}').contains(c)
            || ('\u{2066}'..='\u{2069}').contains(c)
    };
    let found = text.chars().find(is_bad);
    assert_eq!(found, None, "{about:?}: {text:?}");
}

/// Runs a program with standard output on a terminal. Returns what the terminal gets, and standard error.
#[allow(unsafe_code, reason = "the standard library opens no terminals")]
fn on_terminal(mut command: Command) -> [String; 2] {
    let flags = libc::O_RDWR | libc::O_NOCTTY | libc::O_CLOEXEC;
    // SAFETY: the descriptor is a new one that nothing else owns, and its name is copied before another call can change it.
    let (master, name) = unsafe {
        let master = libc::posix_openpt(flags);
        assert!(master >= 0 && libc::grantpt(master) == 0 && libc::unlockpt(master) == 0);
        let name = CStr::from_ptr(libc::ptsname(master)).to_owned();
        (OwnedFd::from_raw_fd(master), name)
    };
    let mut options = fs::File::options();
    options.read(true).write(true).custom_flags(libc::O_NOCTTY);
    let program = options.open(name.to_str().unwrap()).unwrap();
    command.stdin(Stdio::null()).stdout(program).stderr(Stdio::piped());
    let child = command.spawn().unwrap();
    // The command holds the program's end of the terminal open.
    drop(command);
    let (mut shown, mut buffer) = (Vec::new(), [0; 4096]);
    let mut terminal = fs::File::from(master);
    // Linux reports an error when the last program has closed its end.
    while let Ok(count @ 1..) = terminal.read(&mut buffer) {
        shown.extend_from_slice(&buffer[..count]);
    }
    let output = child.wait_with_output().unwrap();
    let shown = String::from_utf8(shown).unwrap().replace("\r\n", "\n");
    [shown, String::from_utf8(output.stderr).unwrap()]
}

/// Writes the map of the scene in `place` with a title, an engine and other texts that are hostile.
fn forge(place: &Place, text: &str, name: &str) {
    place.map(&["scene.toml", "--no-png", "-o", "."]);
    let map = StoredMap::open(&place.path("scene.exr")).unwrap();
    let scene = Scene::parse(SCENE, "scene.toml").unwrap();
    let scene = SceneData { title: text.to_owned(), ..SceneData::clone(&scene) };
    let about = MapDescription {
        scene: &scene,
        engine: &EngineDescription { engine: text.to_owned(), adapter: text.to_owned() },
        tolerances: &serde_json::json!({ text: text }),
        channels: Channels::STANDARD,
        digits: Digits::ALL,
        arithmetic: text,
    };
    let path = place.path(name);
    let mut writer =
        MapWriter::create(Output::create(&path, &TemporaryFiles::default()).unwrap(), &about)
            .unwrap();
    let panel = MapSlice::from(map).panel(Channels::STANDARD, 0).unwrap();
    writer.write_panels(&[panel]).unwrap();
    writer.finish(EngineCells::default(), Audit::default()).unwrap();
    let mut bytes = place.bytes(name);
    // Texts of equal length: the version, which a warning names, and a regime.
    let version = concat!("\"", env!("CARGO_PKG_VERSION"), "\"");
    let other = format!("\"\u{9b}\u{202e}{}\"", ".".repeat(version.len() - 7));
    for (from, to) in [(version, &*other), ("slip-off", "\\u001bc-")] {
        let from = from.as_bytes();
        assert_eq!(from.len(), to.len());
        let starts = 0..bytes.len() - from.len();
        let starts: Vec<usize> = starts.filter(|start| bytes[*start..].starts_with(from)).collect();
        assert!(!starts.is_empty());
        for start in starts {
            bytes[start..][..from.len()].copy_from_slice(to.as_bytes());
        }
    }
    super::sealed::seal(&mut bytes);
    fs::write(path, bytes).unwrap();
}

/// Command lines with `X` for a hostile text, as words.
const COMMANDS: &str = "\
X
--X
map X.toml -o out
map X
map scene.toml -o X/X --no-png --engine=cpu
map scene.toml -o X.toml
map scene.toml --engine=X
map scene.toml --engine=gpu --adapter=X
map scene.toml --precision=X
map scene.toml --threads=X
map scene.toml --tolerance=X
map scene.toml --channels=X
map scene.toml --digits=X
map scene.toml --format=X
map scene.toml --shard=X
map bad.toml
map key.toml
plan X.toml
plan X
extract X.exr -o X.csv
extract X.exr -o X.zarr
extract X.exr -o X
extract X.exr -o new.exr --channel=X
extract X.exr -o new.exr --at=X=1
extract X.exr -o new.exr --at=distance_mm=X
extract scene.exr -o X/new.csv
extract X -o new.csv
status X
status X.zarr
status X.exr
submit X.toml --shards=1 -o X --time=1:00:00 --mem=1G
submit scene.toml --shards=X
submit scene.toml --shards=1 --partition=X
submit scene.toml --shards=1 --time=X
submit scene.toml --shards=1 -- X
compare X.exr X.exr
compare X.exr scene.exr
compare X.exr X
compare X.exr scene.exr --within=X
compare X.exr scene.exr --json=X/X
explore X.toml -o X.html --no-open
explore X.exr -o X/X.html --no-open
explore X.toml --data=X.csv --no-open
explore X --no-open
render X.exr
render X.exr -o X
render X.exr --channel=X
render X.exr --channel=force_un --range=X
render X.exr --width=X
render X.exr --size=X
render X.exr --at=X=1
render X
curve X.toml --csv=X.csv.csv --plot=X.svg
curve scene.toml --csv=X/X
curve scene.toml --plot=X
curve scene.toml --units=X
curve scene.toml --data=X.csv
curve scene.toml --data=X
curve scene.toml --distance=X
fit X.toml --data=X.csv --free=taper
fit scene.toml --data=X --free=X
branch X.toml --distance=9 --csv=X.csv.csv
branch scene.toml --distance=X
shape X.toml --distance=9 --push-angle=1 --csv=X.csv.csv
shape scene.toml --distance=9 --push-angle=X
sensitivity X.toml --distance=9 --csv=X.csv.csv
sensitivity X --distance=X
whisk X.toml --distance=9 --sine=40deg,10,0.2 --csv=X.csv.csv
whisk scene.toml --distance=9 --sine=X
whisk scene.toml --distance=9 --angles=X
texture X.toml --csv=X
texture scene.toml --units=X
force X.toml --frames=X.csv
force scene.toml --frames=X
design X.toml --distance=9 --slip-off=30deg --for=taper --plot=X.svg
design scene.toml --distance=9 --slip-off=30deg --for=X
reproduce X.csv
reproduce X.csv --fig4d=X.csv
reproduce X.csv --size=X
verify X
bench X
bench scene.toml --json=X/X
bench scene.toml --plot=p.svg --peers=X.csv
devices X
completions X
man X
";

/// Every command with hostile texts as paths, values of options, titles, keys of scenes, headers of tables, and attributes of maps.
#[test]
fn no_command_lets_control_characters_through() {
    for text in hostile() {
        let place = Place::with(SCENE);
        let titled = SCENE.replace("A small map", "A \u{202e}small\u{2066} map");
        place.write(&format!("{text}.toml"), &titled);
        // What TOML does not allow is an error, which shows the line.
        place.write("bad.toml", &SCENE.replace("A small map", &text));
        place.write("key.toml", &format!("\"{text}\" = 1\n{SCENE}"));
        let header = format!("side,distance_mm,push_angle_deg,\"{text}\"\ncb,9,20,\"{text}\"\n");
        place.write(&format!("{text}.csv"), &header);
        fs::create_dir(place.path(&format!("{text}.zarr"))).unwrap();
        place.write(&format!("{text}.zarr/zarr.json"), &format!("{{\"{text}\": 1}}"));
        forge(&place, &text, &format!("{text}.exr"));
        for line in COMMANDS.lines() {
            let words = line.split(' ').map(|word| word.replace('X', &text));
            let words: Vec<String> = words.collect();
            let words: Vec<&str> = words.iter().map(String::as_str).collect();
            let [shown, said] = on_terminal(place.plain_command(&words));
            let about = [line.to_owned(), text.clone()];
            assert_plain(&shown.replace('\t', " "), &about);
            assert_plain(&said, &about);
            assert!(!said.contains("panicked"), "{about:?}: {said}");
            assert!(!said.contains("\nerror: forged"), "{about:?}: {said}");
        }
    }
}

/// Results on a pipe and in files are as they are.
#[test]
fn results_on_a_pipe_are_not_changed() {
    let [_, c1, bidi, sequences] = hostile();
    for text in [c1, bidi, sequences] {
        let place = Place::with(SCENE);
        let csv = format!("{text}.csv");
        let run = place.run(&["curve", "scene.toml", "--csv", &csv]);
        assert_eq!((run.code, run.out), (Some(0), format!("{csv}\n")));
        forge(&place, &text, "forged.exr");
        let run: Run = place.run(&["compare", "forged.exr", "forged.exr"]);
        assert!(run.out.contains(&format!("engine {text}")), "{run:?}");
        let run = place.run(&["explore", "forged.exr", "-o", "-"]);
        assert!(run.out.starts_with("<!doctype html>"), "{run:?}");
    }
}
