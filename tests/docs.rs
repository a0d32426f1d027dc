//! The pages of `docs/` and README, command by command: every line of a shell block that calls `whiskmap` runs.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use assert_cmd::Command;
use std::fs;
use std::path::Path;
use whiskmap::measured::Compared;
use whiskmap::trace::{BranchPoint, Corner, Detachment, ShapePoint};
use whiskmap::uncertainty::Spread;

/// The calls of `whiskmap` in the shell blocks of a page, without their remarks and where their output goes.
fn calls(page: &str) -> Vec<Vec<String>> {
    let blocks = page.split("```sh\n").skip(1);
    let lines = blocks.flat_map(|block| block.split("```").next().unwrap_or_default().lines());
    let calls = lines.filter_map(|line| line.strip_prefix("whiskmap "));
    let words = |call: &str| {
        let call = call.split(" #").next().unwrap_or_default();
        let call = call.split(" > ").next().unwrap_or_default();
        call.split_whitespace().map(str::to_owned).collect()
    };
    calls.map(words).collect()
}

#[test]
fn every_command_of_the_pages_runs() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let place = tempfile::tempdir().expect("a folder");
    fs::create_dir(place.path().join("scenes")).expect("a folder for scenes");
    for scene in fs::read_dir(root.join("scenes")).expect("scenes") {
        let scene = scene.expect("a scene").path();
        let name = scene.file_name().expect("a name");
        fs::copy(&scene, place.path().join("scenes").join(name)).expect("a copy");
    }
    let docs = fs::read_dir(root.join("docs")).expect("docs");
    let mut pages: Vec<_> = docs.map(|page| page.expect("a page").path()).collect();
    pages.sort();
    pages.insert(0, root.join("README.md"));
    let mut ran = 0;
    for page in pages {
        let text = fs::read_to_string(&page).expect("text");
        for call in calls(&text) {
            let run = Command::cargo_bin("whiskmap")
                .expect("the program")
                .args(&call)
                .current_dir(place.path())
                .output()
                .expect("a run");
            let says = String::from_utf8_lossy(&run.stderr);
            assert!(run.status.success(), "{}: {call:?}: {says}", page.display());
            ran += 1;
        }
    }
    assert!(ran > 20, "only {ran} commands found");
}

#[test]
fn every_column_is_on_the_page_of_the_commands() {
    let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/commands.md"));
    let page = page.expect("docs/commands.md");
    let tables = [
        Detachment::COLUMNS,
        Corner::COLUMNS,
        Compared::COLUMNS,
        BranchPoint::COLUMNS,
        ShapePoint::COLUMNS,
        Spread::COLUMNS,
    ];
    for (name, meaning) in tables.into_iter().flatten() {
        let line = format!("| `{name}` | {} |", meaning.trim());
        assert!(page.contains(&line), "{line}");
    }
}

#[test]
fn links_of_the_pages_lead_somewhere() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let docs = fs::read_dir(root.join("docs")).expect("docs");
    let pages = docs.map(|page| page.expect("a page").path());
    for page in pages.chain(["README.md", "ARCHITECTURE.md"].map(|name| root.join(name))) {
        let text = fs::read_to_string(&page).expect("text");
        for link in text
            .split("](")
            .skip(1)
            .filter_map(|rest| rest.split(')').next())
        {
            let file = page.with_file_name(link.split('#').next().unwrap_or_default());
            let is_known = link.starts_with("http") || file.exists();
            assert!(is_known, "{}: {link}", page.display());
        }
    }
}
