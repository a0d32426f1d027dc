//! Windows: names in other cases, files that are open elsewhere, devices, Ctrl-Break.

use super::data::DATA;
use super::store::SWEEP;
use super::traces::CURVE;
use super::{Place, Run, SCENE, names, words};
use std::fs::{self, File};
use std::io::Read;
use std::os::windows::fs::OpenOptionsExt;
use std::os::windows::process::CommandExt;
use std::process::{Child, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

const SHAPE: [&str; 5] = ["shape", "scene.toml", "--distance=9", "--push-angle=1", "--csv=t.csv"];

#[test]
fn names_in_another_case_are_one_file() {
    let place = Place::with(SCENE);
    place.write("pts.csv", DATA);
    fs::hard_link(place.path("pts.csv"), place.path("hard.csv")).unwrap();
    let full = place.path("Pts.csv");
    for name in ["PTS.CSV", ".\\pts.csv", full.to_str().unwrap()] {
        let run = place.run(&["curve", "scene.toml", "--data=pts.csv", "--csv", name]);
        run.assert_refused(&["is the input pts.csv; name another file"]);
    }
    for (table, picture) in [("new.svg", "NEW.SVG"), ("t.svg", ".\\T.svg")] {
        place
            .run(&["curve", "scene.toml", "--csv", table, "--plot", picture])
            .assert_refused(&["must be two files"]);
    }
    // The new table takes one of the names of the file; the input keeps the other.
    place.good(&["curve", "scene.toml", "--data=pts.csv", "--csv=hard.csv"]);
    assert_eq!(place.bytes("pts.csv"), DATA.as_bytes());
}

#[test]
fn paths_have_backslashes_spaces_and_any_letters() {
    let place = Place::with(SCENE);
    fs::create_dir(place.path("my data")).unwrap();
    for stem in ["my scene", "Schnurrhaar µ 鬍鬚", ".hidden"] {
        let name = format!("my data\\{stem}.toml");
        fs::write(place.path(&name), SCENE.replace('\n', "\r\n")).unwrap();
        assert!(place.quiet(&["curve", &name]).out.starts_with(CURVE));
        let folder = format!("maps\\{stem}");
        place.map(&[&name, "-o", &folder]);
        let files = [format!("{stem}.exr"), format!("{stem}.png")];
        assert_eq!(names(&place.path(&folder)), files);
    }
    // An absolute path, and one that the system calls verbatim.
    let scene = place.path("scene.toml");
    let table = place.quiet(&["curve", scene.to_str().unwrap()]).out;
    let verbatim = scene.canonicalize().unwrap();
    assert_eq!(place.quiet(&["curve", verbatim.to_str().unwrap()]).out, table);
    assert!(!table.contains('\r'));
}

#[test]
fn a_file_that_is_being_read_is_replaced() {
    let place = Place::with(SCENE);
    place.write("t.csv", "old");
    let mut reader = File::open(place.path("t.csv")).unwrap();
    place.quiet(&SHAPE);
    let mut old = String::new();
    reader.read_to_string(&mut old).unwrap();
    assert_eq!(old, "old");
    assert!(place.bytes("t.csv").len() > 1000);
}

/// Locks of Windows keep readers away: a file has none from the moment on at which it has its name.
#[test]
fn readers_see_whole_files_only() {
    let place = Place::with(SCENE);
    place.quiet(&SHAPE);
    let whole = place.bytes("t.csv");
    let is_done = AtomicBool::new(false);
    let reads = thread::scope(|scope| {
        let reader = scope.spawn(|| {
            let mut reads = 0;
            while !is_done.load(Ordering::Relaxed) {
                assert!(place.bytes("t.csv") == whole);
                reads += 1;
            }
            reads
        });
        for _ in 0..30 {
            place.quiet(&SHAPE);
        }
        is_done.store(true, Ordering::Relaxed);
        reader.join().unwrap()
    });
    assert!(reads > 30, "{reads}");
    assert_eq!(names(&place.path("")), ["scene.toml", "t.csv"]);
}

/// Spreadsheet programs open tables such that no other program can write them.
#[test]
fn a_table_that_another_program_holds_is_refused_before_any_work() {
    let place = Place::with(SCENE);
    place.write("t.csv", "old");
    let held = File::options().read(true).share_mode(0).open(place.path("t.csv")).unwrap();
    let run = place.run(&SHAPE);
    run.assert_refused(&["--csv t.csv: ", "name a file that can be written"]);
    drop(held);
    assert_eq!(place.bytes("t.csv"), b"old");
}

#[test]
fn folders_in_the_place_of_files_are_named() {
    let place = Place::with(SCENE);
    fs::create_dir(place.path("folder")).unwrap();
    let is_folder = "folder: cannot be read: is a directory";
    place.run(&["curve", "folder"]).assert_refused(&[is_folder]);
    let data = ["curve", "scene.toml", "--data=folder"];
    place.run(&data).assert_refused(&[is_folder]);
}

#[test]
fn the_null_device_is_written_to_and_not_named() {
    let place = Place::with(SCENE);
    let shape = ["shape", "scene.toml", "--distance=9", "--push-angle=1"];
    let run = place.quiet(&[&shape[..], &["--csv=nul", "--plot=p.svg"]].concat());
    assert_eq!(run.out, "p.svg\n");
    assert_eq!(names(&place.path("")), ["p.svg", "scene.toml"]);
}

/// Begins a run in a group of processes of its own, and waits until `file` is there.
fn begun(place: &Place, arguments: &[&str], is_begun: impl Fn() -> bool) -> Child {
    const CREATE_NEW_PROCESS_GROUP: u32 = 0x200;
    let mut command = place.plain_command(arguments);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = command.creation_flags(CREATE_NEW_PROCESS_GROUP).spawn();
    let mut child = child.unwrap();
    while !is_begun() {
        assert!(child.try_wait().unwrap().is_none(), "it ended early");
        thread::yield_now();
    }
    child
}

/// Presses Ctrl-Break for a run in a group of processes of its own.
#[allow(unsafe_code, reason = "no library sends the event")]
fn interrupt(child: &Child) {
    #[link(name = "kernel32")]
    unsafe extern "system" {
        fn GenerateConsoleCtrlEvent(event: u32, group: u32) -> i32;
    }
    const CTRL_BREAK_EVENT: u32 = 1;
    // SAFETY: the call takes two numbers.
    let sent = unsafe { GenerateConsoleCtrlEvent(CTRL_BREAK_EVENT, child.id()) };
    assert_ne!(sent, 0, "{}", std::io::Error::last_os_error());
}

#[test]
fn an_interrupted_run_cleans_up() {
    const STATUS_CONTROL_C_EXIT: i32 = 0xC000_013A_u32.cast_signed();
    let place = Place::with(SWEEP);
    let map = words("map scene.toml --engine=cpu --format=zarr --threads=1 -oout");
    let blocks = || {
        let names = names(&place.path("out/scene.zarr/regime"));
        names.iter().any(|name| name.starts_with("c."))
    };
    let child = begun(&place, &map, blocks);
    interrupt(&child);
    let run = Run::of(&child.wait_with_output().unwrap());
    assert_eq!(run.code, Some(STATUS_CONTROL_C_EXIT), "{run:?}");
    let said = "interrupted by Ctrl-C; unfinished files are removed; finished blocks are kept: resume with the same command and --resume\n";
    assert!(run.err.ends_with(said), "{run:?}");
    let files = super::store::files(&place.path("out"));
    assert!(!files.keys().any(|path| super::store::is_hidden(path)));
    super::store::good(&place, "out", &["--resume"]);
    super::store::assert_complete(&place, "out/scene.zarr");
}
