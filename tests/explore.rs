//! The built page of `whiskmap explore`: it is not older than its sources. `tests/explore/run.sh` uses it in a browser.

use crate::shipped::root;
use std::fs;
use std::path::{Path, PathBuf};
use whiskmap::render::{DISTANCE, PUSH_ANGLE, axis_title};

/// Hash of what the page is made of, but for the library: FNV-1a of 64 bits over names and contents, as in `crates/web/assemble.py`.
fn sources(root: &Path) -> String {
    let folders = ["crates/web/page", "crates/web/src"].into_iter();
    let below = folders.flat_map(|folder| fs::read_dir(root.join(folder)).unwrap());
    let below = below.map(|entry| entry.unwrap().path());
    let others = ["crates/web/assemble.py", "crates/web/build.sh", "scenes/cone.toml"];
    let others = others.map(|name| root.join(name));
    let name = |path: PathBuf| {
        let path = path.strip_prefix(root).unwrap().to_owned();
        path.to_str().unwrap().replace('\\', "/")
    };
    let mut names: Vec<String> = below.chain(others).map(name).collect();
    names.sort();
    let bytes = names.iter().flat_map(|name| {
        let content = fs::read(root.join(name)).unwrap();
        [name.as_bytes(), b"\0", &content, b"\0"].concat()
    });
    let hash = bytes.fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    format!("{hash:016x}")
}

#[test]
fn the_page_is_built_from_its_sources() {
    let root = root();
    let page = fs::read_to_string(root.join("crates/cli/explore.html")).unwrap();
    let of = |name: &str| {
        let tag = format!("=\"{name}\" content=\"");
        let (_, rest) = page.split_once(&tag).unwrap();
        rest.split('"').next().unwrap().to_owned()
    };
    let advice = "crates/cli/explore.html is stale: run crates/web/build.sh";
    assert_eq!(of("whiskmap-sources"), sources(root), "{advice}");
    let version = format!("whiskmap {}. Mechanics", env!("CARGO_PKG_VERSION"));
    assert!(page.contains(&version), "{advice}");
    let policy = of("Content-Security-Policy");
    for rule in ["default-src 'none'", "connect-src 'none'", "worker-src blob:"] {
        assert!(policy.contains(rule), "{policy}");
    }
    assert!(!policy.contains("unsafe-inline"), "{policy}");
    assert!(page.len() < 1_800_000, "{} bytes", page.len());
}

/// The size of the page's code that the project allows.
#[test]
fn the_page_stays_small() {
    let folder = root().join("crates/web/page");
    let files = fs::read_dir(folder).unwrap();
    let lines = files.map(|file| {
        let text = fs::read_to_string(file.unwrap().path()).unwrap();
        text.lines().count()
    });
    let lines: usize = lines.sum();
    assert!(lines <= 2000, "{lines} lines");
}

/// Quantities have the words with which the program names their axes, with a capital.
#[test]
fn quantities_of_the_page_are_named_as_by_the_program() {
    let folder = root().join("crates/web/page");
    let read = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
    let words = |title: &str| {
        let (first, rest) = title.split(" (").next().unwrap().split_at(1);
        first.to_uppercase() + rest
    };
    let text = read("text.js");
    let (_, list) = text.split_once("export const CHANNELS = {").unwrap();
    let (list, _) = list.split_once("};").unwrap();
    let entries = list.trim().trim_end_matches("',").split("',");
    let entries = entries.map(|entry| entry.trim().split_once(": '").unwrap());
    let entries: Vec<_> = entries.collect();
    assert!(entries.len() > 10, "{entries:?}");
    for (name, title) in entries {
        assert_eq!(title, words(&axis_title(name)), "{name}");
    }
    let drawn = ["text.js", "charts.js", "map.js"].map(read).concat();
    for title in [PUSH_ANGLE, DISTANCE] {
        assert!(drawn.contains(&words(title)), "{title}");
    }
}
