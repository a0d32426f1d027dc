//! Help of the program: the commands by topic, and examples.

use super::Command;
use clap::builder::styling::Styles;
use clap::{Command as Definitions, Subcommand};
use std::fmt::Write;

/// Topics of the program with the names of their commands, in the order of the help.
const TOPICS: [(&str, &[&str]); 6] = [
    ("Maps", &["map", "plan", "render", "explore", "compare"]),
    ("Stores of large sweeps", &["submit", "status", "extract"]),
    (
        "One whisker",
        &["curve", "branch", "shape", "sensitivity", "whisk", "texture", "fit", "design"],
    ),
    ("Films and sensors", &["import", "force", "locate"]),
    ("Checks", &["verify", "reproduce", "bench", "devices"]),
    ("Shells", &["completions", "man"]),
];

pub const EXAMPLES: &str = "\
Examples:
  whiskmap map scenes/cone.toml                      # outputs/cone.exr and outputs/cone.png
  whiskmap explore scenes/cone.toml                  # one page with the solver inside
  whiskmap curve scenes/cone.toml --plot curve.png   # push angle at detachment by distance
  whiskmap fit scenes/cone.toml --data scenes/cone_points.csv --free tip_radius_um
  whiskmap whisk scenes/cone.toml --distance 15.66 --sine 40deg,10,0.2
  whiskmap design scenes/robot.toml --distance 60 --slip-off 30deg --for taper

`whiskmap COMMAND --help` has the options, columns and examples of a command.";

/// Returns the template of the help: the commands by topic, each with its description.
pub fn template() -> String {
    let commands = commands();
    let styles = Styles::styled();
    let (header, literal) = (styles.get_header(), styles.get_literal());
    let wide = commands.get_subcommands().map(|command| command.get_name().len());
    let wide = wide.max().unwrap_or_default();
    let mut template = "{about-with-newline}\n{usage-heading} {usage}\n".to_owned();
    // Writing to a String cannot fail.
    for (topic, names) in TOPICS {
        let _ = writeln!(template, "\n{header}{topic}:{header:#}");
        for command in names.iter().filter_map(|name| commands.find_subcommand(name)) {
            let name = command.get_name();
            let about = command.get_about().map(ToString::to_string).unwrap_or_default();
            let _ = writeln!(template, "  {literal}{name:wide$}{literal:#}  {about}");
        }
    }
    let _ = write!(template, "\n{header}Options:{header:#}\n{{options}}{{after-help}}");
    template
}

/// Returns the names of all commands, in the order of the help.
pub fn command_names() -> impl Iterator<Item = &'static str> {
    TOPICS.into_iter().flat_map(|(_, names)| names).copied()
}

/// Returns the definitions of all commands.
fn commands() -> Definitions {
    Command::augment_subcommands(Definitions::new(""))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_has_one_topic() {
        let commands = commands();
        let mut defined: Vec<&str> =
            commands.get_subcommands().map(Definitions::get_name).collect();
        let mut listed: Vec<&str> = command_names().collect();
        defined.sort_unstable();
        listed.sort_unstable();
        assert_eq!(listed, defined);
    }

    /// Returns the word after an option, as of `-o FILE`.
    fn after<'a>(words: &[&'a str], option: &str) -> Option<&'a str> {
        let place = words.iter().position(|word| *word == option)?;
        words.get(place + 1).copied()
    }

    #[test]
    fn examples_read_maps_of_earlier_examples() {
        let mut commands = commands();
        commands.build();
        let mut count = 0;
        for command in commands.get_subcommands() {
            let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
            let mut made: Vec<String> = Vec::new();
            for example in help.lines().filter_map(|line| line.strip_prefix("  whiskmap ")) {
                let words: Vec<&str> = example.split_whitespace().collect();
                let output = after(&words, "-o");
                let is_map = |word: &&str| word.ends_with(".exr") || word.ends_with(".zarr");
                for read in words.iter().copied().filter(is_map) {
                    let is_made = made.iter().any(|map| map == read);
                    assert!(is_made || output == Some(read), "{}: {read}", command.get_name());
                    count += 1;
                }
                made.extend(output.map(str::to_owned));
                if let ["map", scene, ..] = words[..] {
                    let name = scene.trim_start_matches("scenes/").trim_end_matches(".toml");
                    let ending = after(&words, "--format").unwrap_or("exr");
                    made.push(format!("{}/{name}.{ending}", output.unwrap_or("outputs")));
                }
            }
        }
        assert!(count > 10, "{count}");
    }

    /// The lines of a template are not wrapped.
    #[test]
    fn the_list_of_commands_fits_a_terminal() {
        let help = Definitions::new("").help_template(template()).render_help().to_string();
        let lines: Vec<&str> = help.lines().filter(|line| line.chars().count() > 100).collect();
        assert!(lines.is_empty(), "{lines:#?}");
    }
}
