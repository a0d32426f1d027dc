//! `--at` and `--channel`: which part of a map or a store a command takes.

use super::failure::{Failure, say};
use super::files::Files;
use clap::Args;
use std::path::Path;
use std::str::FromStr;
use whiskmap::input::did_you_mean;
use whiskmap::map::Channels;
use whiskmap::scene::digits;
use whiskmap::store::{At, Slice, Stored};

/// Options that choose a part.
#[derive(Debug, Args)]
pub struct Selection {
    /// Select the nearest value on an axis, with or without a unit, such as distance_mm=1.5cm
    #[arg(long, value_name = "AXIS=VALUE", value_parser = At::from_str, allow_hyphen_values = true)]
    at: Vec<At>,
    /// Take the values of --at alone, not the nearest
    #[arg(long)]
    exact: bool,
}

impl Selection {
    /// Opens the part of `source`, an input, and says which values were taken.
    pub fn open(&self, files: &mut Files, source: &Path) -> Result<Slice, Failure> {
        let stored = Stored::open(source)?;
        files.input(source);
        if let Some(version) = stored.foreign_version()? {
            say(&format!(
                "warning: {} was written by whiskmap {version}, not by {}; what it holds may mean something else",
                source.display(),
                env!("CARGO_PKG_VERSION")
            ));
        }
        let slice = Slice::new(stored, &self.at, self.exact);
        let slice = slice.map_err(|why| Failure::Input(format!("--at {why}")))?;
        for (name, value) in slice.chosen() {
            say(&format!("{name} = {}", digits(*value)));
        }
        Ok(slice)
    }
}

/// The `channels` of the slice of `source`, and with friction the one that marks their states; warns if it is missing.
pub fn with_marks(
    source: &Path,
    slice: &Slice,
    channels: &[&'static str],
) -> Result<Vec<&'static str>, Failure> {
    let chosen = Channels::those(|name| channels.contains(&name));
    let has_friction = chosen.has_state() && slice.has_friction()?;
    let known = slice.channels();
    if has_friction && !known.contains(&"status") {
        say(&format!(
            "warning: {} has friction, but no channel status: where the contact slides toward the base or sticks, \
             contact, force and moment are off, unmarked",
            source.display()
        ));
    }
    let marked = chosen.with_marks(has_friction);
    Ok(marked.names().filter(|name| known.contains(name)).collect())
}

/// The channels that were `asked` for, or all.
pub fn channels(slice: &Slice, asked: &[String]) -> Result<Vec<&'static str>, Failure> {
    let known = slice.channels();
    if let Some(name) = asked.iter().find(|name| !known.contains(&name.as_str())) {
        let hint = did_you_mean(name, known.iter().copied());
        let known = known.join(", ");
        return Err(Failure::Input(format!(
            "--channel {name}: must be one of {known}{hint}"
        )));
    }
    let is_wanted = |name: &&str| asked.is_empty() || asked.iter().any(|own| own == name);
    Ok(known.into_iter().filter(is_wanted).collect())
}
