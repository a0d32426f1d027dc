//! Documentation: commands run, links and paths exist, every column is described, every summary stands alone.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use crate::shipped::root;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use whiskmap::force::FrameForce;
use whiskmap::measured::ComparedPoint;
use whiskmap::scene::Parameter;
use whiskmap::sensitivity::VariableEffect;
use whiskmap::texture::{AsperityStay, TextureEvent, TextureSample, TipBin};
use whiskmap::trace::{BranchPoint, Corner, Detachment, ShapePoint};
use whiskmap::tracking::{TrackedDetachment, TrackedFrame, TrackedPoint};
use whiskmap::uncertainty::{EndSpread, LargestSpread, PointSpread};
use whiskmap::whisk::{WhiskEvent, WhiskSample};
use whiskmap::yields::{PushMark, StrainMark, YieldMark};

/// Returns all files below `folder` with this extension, in order.
fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("a file").path()).collect();
    paths.sort();
    let is_wanted = |path: &PathBuf| path.extension().is_some_and(|ending| ending == extension);
    let below = |path: PathBuf| match path.is_dir() {
        true => files(&path, extension),
        false => Some(path).filter(is_wanted).into_iter().collect(),
    };
    paths.into_iter().flat_map(below).collect()
}

/// Returns path and text of every page.
fn pages() -> Vec<(PathBuf, String)> {
    let names =
        ["README.md", "ARCHITECTURE.md", "CHANGELOG.md", "CONTRIBUTING.md", "tests/README.md"];
    let paths = names.map(|name| root().join(name)).into_iter();
    let paths = paths.chain(files(&root().join("docs"), "md"));
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path).expect("a page");
        (path, text)
    };
    paths.map(read).collect()
}

/// Returns the calls of `whiskmap` in the shell blocks of a page, without comments, redirection and pipes.
fn calls(page: &str) -> Vec<Vec<String>> {
    let blocks = page.split("```sh\n").skip(1);
    let lines = blocks.flat_map(|block| block.split("```").next().unwrap_or_default().lines());
    let calls = lines.filter_map(|line| line.strip_prefix("whiskmap "));
    let words = |call: &str| {
        let call = call.split(" #").next().unwrap_or_default();
        let call = call.split(" > ").next().unwrap_or_default();
        let call = call.split(" | ").next().unwrap_or_default();
        call.split_whitespace().map(str::to_owned).collect()
    };
    calls.map(words).collect()
}

#[test]
fn every_command_of_the_pages_runs() {
    let place = tempfile::tempdir().expect("a folder");
    fs::create_dir(place.path().join("scenes")).expect("a folder for scenes");
    for scene in fs::read_dir(root().join("scenes")).expect("scenes") {
        let scene = scene.expect("a scene").path();
        let name = scene.file_name().expect("a name");
        fs::copy(&scene, place.path().join("scenes").join(name)).expect("a copy");
    }
    let mut ran = 0;
    for (page, text) in pages() {
        for call in calls(&text) {
            let run = Command::new(env!("CARGO_BIN_EXE_whiskmap"))
                .args(&call)
                .current_dir(place.path())
                .output()
                .expect("a run");
            let error = String::from_utf8_lossy(&run.stderr);
            assert!(run.status.success(), "{}: {call:?}: {error}", page.display());
            ran += 1;
        }
    }
    assert!(ran > 20, "only {ran} commands found");
}

/// Rounding of another arithmetic class may change the last digits of a number.
#[test]
fn the_table_of_the_readme_is_what_curve_prints() {
    let readme = fs::read_to_string(root().join("README.md")).expect("README.md");
    let table = readme.split("```text\nside,").nth(1).expect("a table");
    let table = table.split("```").next().unwrap_or_default();
    let run = Command::new(env!("CARGO_BIN_EXE_whiskmap"))
        .args(["curve", "scenes/cone.toml", "--distance", "15.66"])
        .current_dir(root())
        .output()
        .expect("a run");
    let printed = String::from_utf8(run.stdout).expect("text");
    let table = format!("side,{table}");
    let [shown, printed] = [&table, &printed].map(|text| {
        let rows = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
        rows.collect::<Vec<_>>()
    });
    assert_eq!(shown.len(), printed.len());
    for (i, column) in shown[0].iter().enumerate() {
        let place = printed[0].iter().position(|name| name == column);
        let place = place.expect("a column of the program");
        for (row, full) in shown.iter().zip(&printed) {
            let [one, other] = [row[i], full[place]];
            let is_same = match (one.parse::<f64>(), other.parse::<f64>()) {
                (Ok(one), Ok(other)) => (one - other).abs() <= 1e-9 * other.abs(),
                _ => one == other,
            };
            assert!(is_same, "{column}: {one}, not {other}");
        }
    }
}

#[test]
fn every_column_is_on_the_page_of_the_commands() {
    let page = fs::read_to_string(root().join("docs/commands.md")).expect("docs/commands.md");
    let tables = [
        Detachment::COLUMNS,
        Corner::COLUMNS,
        ComparedPoint::COLUMNS,
        BranchPoint::COLUMNS,
        ShapePoint::COLUMNS,
        EndSpread::COLUMNS,
        LargestSpread::COLUMNS,
        PointSpread::COLUMNS,
        VariableEffect::COLUMNS,
        WhiskSample::COLUMNS,
        WhiskEvent::COLUMNS,
        TextureSample::COLUMNS,
        TextureEvent::COLUMNS,
        AsperityStay::COLUMNS,
        TipBin::COLUMNS,
        FrameForce::COLUMNS,
        TrackedFrame::COLUMNS,
        TrackedDetachment::COLUMNS,
        TrackedPoint::COLUMNS,
        YieldMark::COLUMNS,
        StrainMark::COLUMNS,
        PushMark::COLUMNS,
    ];
    for (name, meaning) in tables.into_iter().flatten() {
        let line = format!("| `{name}` | {} |", meaning.trim());
        assert!(page.contains(&line), "{line}");
    }
}

/// Every number and every axis of a scene has a row with its unit, and with its limits where no other number narrows them.
#[test]
fn the_numbers_of_scenes_are_on_their_pages() {
    let read = |page: &str| fs::read_to_string(root().join("docs").join(page)).expect("a page");
    let [scenes, sweeps] = ["scenes.md", "sweeps.md"].map(read);
    let row = |page: &str, key: &str| -> Vec<String> {
        let rows = page.lines().map(|line| line.split('|').map(str::trim));
        let mut rows = rows.map(|row| row.map(str::to_owned).collect::<Vec<String>>());
        let key = format!("`{key}`");
        let row = rows.find(|row| row.len() > 4 && row[1].contains(&key));
        row.unwrap_or_else(|| panic!("no row of {key}"))
    };
    let mut compared = 0;
    for parameter in Parameter::ALL {
        let is_swept = Parameter::SWEPT.contains(&parameter);
        let swept = is_swept.then(|| row(&sweeps, parameter.axis_key()));
        let given = (parameter != Parameter::Taper).then(|| row(&scenes, parameter.key()));
        for row in swept.iter().chain(&given) {
            let unit = Some(parameter.unit()).filter(|unit| *unit != "1");
            assert_eq!(row[2], unit.unwrap_or_default(), "{row:?}");
            let allowed = row[3].replace([',', ':'], "");
            let words: Vec<&str> = allowed.split(' ').collect();
            if let [least, "to", most, rest @ ..] = &words[..]
                && let (Ok(least), Ok(most)) = (least.parse::<f64>(), most.parse::<f64>())
                && !rest.starts_with(&["divided"])
            {
                assert_eq!([least, most], parameter.limits(), "{row:?}");
                compared += 1;
            }
        }
    }
    assert_eq!(compared, 13);
}

/// Returns the number of cells of a row of a table; pipes in cells are escaped.
fn cells(row: &str) -> usize {
    row.replace("\\|", "").matches('|').count().saturating_sub(1)
}

/// A table has a blank line before it, a second line of dashes, and equally many cells in each row.
#[test]
fn tables_are_complete() {
    let mut tables = 0;
    for (page, text) in pages() {
        let lines: Vec<&str> = text.lines().collect();
        let is_row = |line: &&str| line.starts_with('|');
        let mut number = 0;
        while number < lines.len() {
            let rows: Vec<&str> = lines[number..].iter().copied().take_while(is_row).collect();
            if rows.is_empty() {
                number += 1;
                continue;
            }
            let place = format!("{}:{}", page.display(), number + 1);
            let before = number.checked_sub(1).map_or("", |before| lines[before]);
            assert!(before.is_empty(), "{place}: no blank line before the table");
            let is_rule = |row: &&str| row.chars().all(|c| "|-: ".contains(c));
            let rules: Vec<_> = rows.iter().enumerate().filter(|(_, row)| is_rule(row)).collect();
            assert!(matches!(rules[..], [(1, _)]), "{place}: no line of dashes");
            for row in &rows {
                assert!(row.ends_with('|') && cells(row) == cells(rows[0]), "{place}: {row}");
            }
            tables += 1;
            number += rows.len();
        }
    }
    assert!(tables > 20, "only {tables} tables found");
}

/// Returns the anchor of a heading, as GitHub forms it.
fn anchor(heading: &str) -> String {
    let heading = heading.trim_start_matches('#').trim().to_lowercase();
    let kept = heading.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

#[test]
fn links_lead_to_files_and_headings() {
    for (page, text) in pages() {
        let links = text.split("](").skip(1);
        for link in links.filter_map(|rest| rest.split(')').next()) {
            if link.starts_with("http") {
                continue;
            }
            let (file, heading) = link.split_once('#').unwrap_or((link, ""));
            let target = page.with_file_name(file);
            assert!(target.exists(), "{}: {link}", page.display());
            if !heading.is_empty() {
                let text = fs::read_to_string(&target).expect("a page");
                let headings = text.lines().filter(|line| line.starts_with('#'));
                let is_there = headings.map(anchor).any(|anchor| anchor == heading);
                assert!(is_there, "{}: {link}", page.display());
            }
        }
    }
}

/// Words in backticks that end in the name of a file, or in a slash, are paths from the root or from a source folder.
#[test]
fn paths_on_pages_about_the_code_exist() {
    let bases = ["", "src", "crates", "crates/mechanics/src", "tests", "outputs"];
    let about_the_code = ["ARCHITECTURE.md", "CONTRIBUTING.md", "tests/README.md"];
    for (page, text) in pages() {
        if !about_the_code.iter().any(|name| page.ends_with(name)) {
            continue;
        }
        for word in text.split('`').skip(1).step_by(2) {
            let ends = [".rs", ".wgsl", ".sh", ".md", ".toml", "/"];
            if word.contains(char::is_whitespace) || !ends.iter().any(|end| word.ends_with(end)) {
                continue;
            }
            let exists = bases.iter().any(|base| root().join(base).join(word).exists());
            assert!(exists, "{}: `{word}`", page.display());
        }
    }
}

/// Checks that the modules of a source folder use only modules that come before them in `order`.
fn check_order(folder: &str, order: &[&str]) {
    let folder = root().join(folder);
    for path in files(&folder, "rs") {
        let inside = path.strip_prefix(&folder).expect("a file in the folder");
        let first = inside.components().next().expect("a module");
        let module = first.as_os_str().to_str().expect("a name");
        let module = module.trim_end_matches(".rs");
        if module == "lib" {
            continue;
        }
        let place = order.iter().position(|name| *name == module);
        assert!(place.is_some(), "{module}: not in the list of layers");
        let text = fs::read_to_string(&path).expect("a source file");
        let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
        for rest in code.flat_map(|line| line.split("crate::").skip(1)) {
            let is_name = |c: char| c.is_alphanumeric() || c == '_';
            let used = rest.split(|c| !is_name(c)).next().unwrap_or_default();
            let found = order.iter().position(|name| *name == used);
            let is_above = found.is_some() && found <= place;
            assert!(is_above, "{}: uses `crate::{used}`", path.display());
        }
    }
}

/// Modules use only modules above them in the list of layers, so that there is no circle between them.
#[test]
fn modules_use_only_modules_above_them() {
    let text = fs::read_to_string(root().join("ARCHITECTURE.md")).expect("a page");
    let layers = text.lines().filter(|line| line.starts_with("    "));
    let words = layers.flat_map(|line| line.split([' ', ',']));
    let order: Vec<&str> = words.filter_map(|word| word.strip_prefix("src/")).collect();
    check_order("src", &order);
    check_order("crates/mechanics/src", &["numerics", "rod", "shooting"]);
}

#[test]
fn the_architecture_has_at_most_150_lines() {
    let text = fs::read_to_string(root().join("ARCHITECTURE.md")).expect("a page");
    assert!(text.lines().count() <= 150, "{}", text.lines().count());
}

/// Cargo finds no test by itself here, so a file that no program names would never run. The page of the tests names each, too.
#[test]
fn every_test_file_is_in_a_program_and_on_the_page_of_the_tests() {
    let tests = root().join("tests");
    let programs = ["main.rs", "portable/main.rs", "machine/main.rs"];
    let read = |name: &str| fs::read_to_string(tests.join(name)).expect("a program");
    let text: String = programs.map(read).concat();
    let page = read("README.md");
    for entry in fs::read_dir(&tests).expect("tests") {
        let path = entry.expect("a test").path();
        let is_module = path.join("mod.rs").exists() || path.extension().is_some_and(|e| e == "rs");
        let name = path.file_stem().and_then(|name| name.to_str());
        let name = name.expect("a name");
        if is_module && name != "main" {
            assert!(text.contains(&format!("mod {name};")), "{}", path.display());
            let is_named = ["/", ".rs"].map(|end| page.contains(&format!("`{name}{end}`")));
            assert!(is_named.contains(&true), "{}", path.display());
        }
        assert!(
            !path.join("main.rs").exists() || ["portable", "machine"].contains(&name),
            "{}: a folder of a program that Cargo.toml does not name",
            path.display()
        );
    }
}

/// Returns true if a summary does not name its subject.
fn is_fragment(summary: &str) -> bool {
    let starts =
        ["Of", "That of", "Those", "The same", "Whether", "From", "Between", "How", "Where"];
    starts.iter().any(|start| {
        let rest = summary.strip_prefix(start);
        rest.is_some_and(|rest| !rest.starts_with(char::is_alphanumeric))
    })
}

#[test]
fn fragments_are_recognized() {
    for text in ["Of the rod.", "That of `x`.", "Whether it is", "The same"] {
        assert!(is_fragment(text), "{text}");
    }
    for text in ["Offset in bytes.", "The sameness", "That off", "Angle of the rod."] {
        assert!(!is_fragment(text), "{text}");
    }
}

/// The first line of each doc comment, and in shaders of each comment, names its subject.
#[test]
fn summaries_stand_alone() {
    let mut found = Vec::new();
    let mut summaries = 0;
    let mut folders = vec![root().join("src"), root().join("shaders")];
    let crates = fs::read_dir(root().join("crates")).expect("crates");
    folders.extend(crates.map(|entry| entry.expect("a crate").path().join("src")));
    for folder in folders {
        for (extension, markers) in [("rs", &["///", "//!"][..]), ("wgsl", &["//"])] {
            for path in files(&folder, extension) {
                let text = fs::read_to_string(&path).expect("a source file");
                let mut is_first = true;
                for (number, line) in (1..).zip(text.lines()) {
                    let marked = |marker: &&str| line.trim_start().strip_prefix(*marker);
                    let comment = markers.iter().find_map(marked);
                    if let Some(comment) = comment.filter(|_| is_first) {
                        summaries += 1;
                        if is_fragment(comment.trim()) {
                            found.push(format!("{}:{number}: {line}", path.display()));
                        }
                    }
                    is_first = comment.is_none();
                }
            }
        }
    }
    assert!(summaries > 1000, "only {summaries} summaries found");
    assert!(found.is_empty(), "{}", found.join("\n"));
}
