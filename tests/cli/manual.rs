//! `whiskmap completions` and `whiskmap man`.

use super::Place;
#[cfg(unix)]
use super::Run;

fn place() -> Place {
    Place::with("")
}

/// Returns the words that bash completes for `line`.
#[cfg(unix)]
fn completed(place: &Place, line: &[&str]) -> Vec<String> {
    let words: Vec<String> = line.iter().map(|word| format!("'{word}'")).collect();
    let last = line.len() - 1;
    let (word, before) = (line[last], line[last - 1]);
    let script = format!(
        "compopt() {{ :; }}; . ./whiskmap.bash; COMP_WORDS=({}); COMP_CWORD={last}; \
         _whiskmap whiskmap '{word}' '{before}'; printf '%s\\n' \"${{COMPREPLY[@]}}\"",
        words.join(" ")
    );
    let mut bash = std::process::Command::new("bash");
    let run = Run::of(&bash.args(["-c", &script]).current_dir(place.path("")).output().unwrap());
    assert_eq!((run.code, &*run.err), (Some(0), ""), "{run:?}");
    run.out.lines().map(str::to_owned).collect()
}

#[cfg(unix)]
#[test]
fn bash_completes_commands_options_and_values() {
    let place = place();
    let run = place.quiet(&["completions", "bash"]);
    place.write("whiskmap.bash", &run.out);
    assert_eq!(completed(&place, &["whiskmap", "ext"]), ["extract"]);
    assert_eq!(completed(&place, &["whiskmap", "map", "--engi"]), ["--engine"]);
    let engines = completed(&place, &["whiskmap", "map", "--engine", ""]);
    assert_eq!(engines, ["auto", "cpu", "spectral", "gpu"]);
    assert_eq!(completed(&place, &["whiskmap", "man", "cu"]), ["curve"]);
    for (line, name) in [
        (&["whiskmap", "map", "--channels", "force"][..], "force_un"),
        (&["whiskmap", "render", "--channel", "marg"], "margin_deg"),
        (&["whiskmap", "extract", "--channel", "peak"], "peak_strain"),
        (&["whiskmap", "design", "--for", "tap"], "taper"),
        (&["whiskmap", "curve", "--derivatives", "dist"], "distance_mm"),
    ] {
        assert_eq!(completed(&place, line), [name], "{line:?}");
    }
}

#[test]
fn other_shells_have_every_command() {
    for shell in ["elvish", "fish", "powershell", "zsh"] {
        let run = place().run(&["completions", shell]);
        assert_eq!((run.code, &*run.err), (Some(0), ""), "{shell}");
        assert!(run.out.contains("extract") && run.out.contains("tolerance"), "{shell}");
    }
    let run = place().run(&["completions", "cmd"]);
    run.assert_refused(&["invalid value 'cmd'", "bash, elvish, fish, powershell, zsh"]);
}

#[test]
fn manual_pages_have_options_and_columns() {
    let run = place().run(&["man", "curve"]);
    assert_eq!((run.code, &*run.err), (Some(0), ""), "{run:?}");
    for part in [".TH whiskmap-curve 1", "\\-\\-corner", "pole_distance_mm", "scenes/cone.toml"] {
        assert!(run.out.contains(part), "no {part}: {run:?}");
    }
    let run = place().run(&["man"]);
    assert!(run.out.contains("whiskmap\\-extract(1)"), "{run:?}");
    place()
        .run(&["man", "curv"])
        .assert_refused(&["curv: must be one of map", "did you mean `curve`?"]);
}

/// The description of options that several commands share does not replace those of the commands.
#[test]
fn every_command_has_its_description() {
    let run = place().run(&["completions", "fish"]);
    let of_command =
        |line: &&str| line.contains("__fish_whiskmap_needs_command") && line.contains(" -a \"");
    let lines = run.out.lines().filter(of_command);
    let described = lines.filter_map(|line| line.split_once(" -d '")).map(|(_, text)| text);
    let mut described: Vec<&str> = described.collect();
    let count = described.len();
    described.sort_unstable();
    described.dedup();
    assert!(count > 20 && described.len() == count, "{described:?}");
}

#[test]
fn an_unknown_command_has_no_page_and_names_one_that_is_near() {
    let far = place().run(&["man", "nosuch"]);
    far.assert_refused(&["nosuch: must be one of map, "]);
    assert!(!far.err.contains("did you mean"), "{far:?}");
    place().run(&["man", "bnech"]).assert_refused(&["; did you mean `bench`?"]);
}
