//! Commands `whiskmap completions` and `whiskmap man`, made from the definitions of the arguments.

use super::Arguments;
use super::arguments::completed;
use super::failure::Failure;
use super::overview::command_names;
use clap::builder::StringValueParser;
use clap::{Args, Command, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;
use std::io::Write;
use whiskmap::input::did_you_mean;
use whiskmap::terminal::StandardOutput;

/// Name of the program in completions.
const PROGRAM: &str = "whiskmap";

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap completions bash > ~/.local/share/bash-completion/completions/whiskmap
  whiskmap completions zsh > ~/.zfunc/_whiskmap           # with fpath+=~/.zfunc before compinit
  whiskmap completions fish > ~/.config/fish/completions/whiskmap.fish")]
pub struct CompletionsArgs {
    /// Shell that completes commands, options and values
    shell: Shell,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap man | man -l -                                 # the program
  whiskmap man curve | man -l -                           # one command, with the columns of its tables
  whiskmap man curve > ~/.local/share/man/man1/whiskmap-curve.1")]
pub struct ManArgs {
    /// Command that the page describes [default: the program]
    #[arg(value_parser = completed(StringValueParser::new(), command_names()), hide_possible_values = true)]
    command: Option<String>,
}

/// Prints the completions of a shell on standard output.
pub fn completions(args: &CompletionsArgs) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Arguments::command(), PROGRAM, &mut script);
    Ok(StandardOutput::open().write_all(&script)?)
}

/// Prints the manual page of the program or of a command on standard output.
pub fn man(args: &ManArgs) -> Result<(), Failure> {
    let program = definitions();
    let command = args.command.as_ref().map_or(Ok(&program), |name| {
        program.find_subcommand(name).ok_or_else(|| {
            let known: Vec<&str> = program.get_subcommands().map(Command::get_name).collect();
            let hint = did_you_mean(name, known.iter().copied());
            Failure::Input(format!("{name}: must be one of {}{hint}", known.join(", ")))
        })
    })?;
    let mut page = Vec::new();
    let source = concat!("whiskmap ", env!("CARGO_PKG_VERSION"));
    Man::new(command.clone()).source(source).render(&mut page)?;
    Ok(StandardOutput::open().write_all(&page)?)
}

/// Returns the definitions of the program and its commands, with the names of the manual pages.
fn definitions() -> Command {
    let mut program = Arguments::command().disable_help_subcommand(true);
    program.build();
    program
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    const PAGE: &str = include_str!("../../../docs/commands.md");

    /// Returns the options in a text: words such as `--plot`.
    fn mentioned(text: &str) -> BTreeSet<&str> {
        let words = text.split(|c: char| c != '-' && !c.is_ascii_alphanumeric());
        let options = words.filter_map(|word| word.strip_prefix("--"));
        options.filter(|name| !name.starts_with('-')).filter(|name| !name.is_empty()).collect()
    }

    /// Returns the options of a command, without `--help` and `--version`.
    fn defined(command: &Command) -> BTreeSet<&str> {
        let options = command.get_arguments().filter_map(|argument| argument.get_long());
        options.filter(|name| !["help", "version"].contains(name)).collect()
    }

    #[test]
    fn the_page_has_a_row_and_a_section_with_all_options_of_each_command() {
        let program = definitions();
        let (start, _) = PAGE.split_once("\n## ").unwrap_or_default();
        let mut missing = Vec::new();
        for command in program.get_subcommands() {
            let name = command.get_name();
            let mut sections = PAGE.split("\n## ").skip(1);
            let section = sections.find(|section| {
                let heading = section.lines().next().unwrap_or_default();
                heading.split(", ").any(|word| word == name)
            });
            let section = section.unwrap_or_else(|| panic!("no section for {name}"));
            let row = format!("\n| `{name}` | ");
            assert!(start.contains(&row), "no row of {name} in the first table");
            let mentioned = mentioned(section);
            let unnamed = defined(command).into_iter().filter(|option| !mentioned.contains(option));
            missing.extend(unnamed.map(|option| format!("{name} --{option}")));
        }
        assert!(missing.is_empty(), "{missing:?}");
    }

    #[test]
    fn the_page_has_no_unknown_option() {
        let program = definitions();
        let known: BTreeSet<&str> = program.get_subcommands().flat_map(defined).collect();
        let mentioned = mentioned(PAGE);
        let unknown: Vec<_> =
            mentioned.difference(&known).filter(|name| **name != "help").collect();
        assert!(unknown.is_empty(), "{unknown:?}");
    }
}
