//! `whiskmap render`.

use super::failure::{Failure, say};
use crate::render;
use crate::store::StoredMap;
use clap::Args;
use std::io::Write;
use std::path::PathBuf;

/// Options of `render`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap render outputs/cone.exr
  whiskmap render outputs/cone.exr --channel force_un -o force.png")]
pub struct Options {
    /// Map written by `whiskmap map`
    file: PathBuf,
    /// Channel to draw with a colour bar; without it the regimes are drawn
    #[arg(long, value_name = "NAME")]
    channel: Option<String>,
    /// Picture to write [default: FILE.png or FILE.NAME.png beside the map]
    #[arg(short, long, value_name = "PNG")]
    output: Option<PathBuf>,
}

/// Runs `render`.
pub fn run(options: &Options) -> Result<(), Failure> {
    let map = StoredMap::open(&options.file)?;
    if let Some(version) = map.foreign_version() {
        let file = options.file.display();
        say(&format!(
            "warning: {file} was written by whiskmap {version}, not by {}; what it holds may mean something else",
            env!("CARGO_PKG_VERSION")
        ));
    }
    let channels = map.channels();
    if let Some(name) = &options.channel
        && !channels.contains(&name.as_str())
    {
        let channels = channels.join(", ");
        return Err(Failure::Input(format!(
            "--channel {name}: must be one of {channels}"
        )));
    }
    let picture = options.output.clone().unwrap_or_else(|| {
        let ending = options
            .channel
            .as_ref()
            .map_or("png".to_owned(), |name| format!("{name}.png"));
        options.file.with_extension(ending)
    });
    let folder = picture
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    let same = picture
        .canonicalize()
        .is_ok_and(|path| options.file.canonicalize().is_ok_and(|map| map == path));
    if same || picture.is_dir() || folder.is_some_and(|folder| !folder.is_dir()) {
        let why = if same {
            "is the map itself"
        } else {
            "is not a file in an existing folder"
        };
        let picture = picture.display();
        return Err(Failure::Input(format!(
            "--output {picture}: {why}; name a picture to write"
        )));
    }
    match &options.channel {
        Some(name) => render::channel(&map, name, &picture)?,
        None => render::regimes(&map, &picture)?,
    }
    writeln!(std::io::stdout(), "{}", picture.display())?;
    Ok(())
}
