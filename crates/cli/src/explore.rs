//! Command `whiskmap explore`.

use super::data::{self, ColumnArgs};
use super::failure::{Failure, message};
use super::files::Files;
use super::outputs::write;
use clap::Args;
use serde_json::json;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use whiskmap::Side;
use whiskmap::measured::{MeasuredPoint, MeasuredPoints};
use whiskmap::store::MapSource;
use whiskmap::terminal::StandardOutput;
use whiskmap::trace::DetachmentKind;

/// The page with the solver and an example scene, which `crates/web/build.sh` builds.
const PAGE: &str = include_str!("../explore.html");

/// Element of the page that has the scene and the points, as JSON.
const START: [&str; 2] = [r#"<script type="application/json" id="start">"#, "</script>"];

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap explore scenes/cone.toml
  whiskmap explore scenes/cone.toml --data scenes/cone_points.csv -o page.html
  whiskmap map scenes/cone.toml
  whiskmap explore outputs/cone.exr --no-open
  whiskmap map scenes/morphology.toml --format zarr
  whiskmap explore outputs/morphology.zarr

The page is one file that computes in the browser: it needs no installation and no network, and sends nothing. Of a sweep, it \
shows the first whisker; a list selects the whisker of a table. The browser opens if standard output is a terminal.")]
pub struct ExploreArgs {
    /// Scene file, or a map or store written by `whiskmap map`; - is a scene on standard input
    file: PathBuf,
    /// Write the page to FILE; - is standard output [default: outputs/NAME.html, named by the scene]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Put measured detachments on the page, in the format of curve --data
    #[arg(long, value_name = "FILE", group = "table")]
    data: Option<PathBuf>,
    #[command(flatten)]
    columns: ColumnArgs,
    /// Do not open the browser
    #[arg(long)]
    no_open: bool,
}

pub fn run(args: &ExploreArgs, files: &mut Files) -> Result<(), Failure> {
    files.inputs("--data", &args.data)?;
    let path = args.file.as_path();
    let is_map = path.is_dir() || path.extension().is_some_and(|ending| ending == "exr");
    let scene = match is_map {
        true => {
            files.inputs("FILE", [path])?;
            MapSource::open(path)?.scene()??
        }
        false => files.scene(path)?,
    };
    let points = args.data.as_deref().map(|data| {
        let whisker = scene.first_whisker();
        let points = data::read(data, &args.columns)?.at(&whisker.place)?;
        points.check_reach(&whisker.whisker, &whisker.pole)?;
        Ok::<_, Failure>(json!({ "name": points.origin, "csv": csv(&points) }))
    });
    let start = json!({
        "scene": { "text": scene.to_toml(), "origin": name_of(&args.file) },
        "points": points.transpose()?,
    });
    let output = match &args.output {
        Some(output) => output.clone(),
        None => files.unnamed(&format!("{}.html", scene.name))?,
    };
    let output = files.output("--output", &output)?;
    let Some(path) = write(output, page(&start.to_string()).as_bytes())? else {
        return Ok(());
    };
    writeln!(StandardOutput::open(), "{}", path.display())?;
    if !args.no_open && std::io::stdout().is_terminal() {
        open(&path);
    }
    Ok(())
}

/// Name of the file in the page's messages and commands, without its folder.
fn name_of(file: &Path) -> String {
    let name = file.file_name().unwrap_or(file.as_os_str());
    name.to_string_lossy().into_owned()
}

/// Measured points as CSV, in the format of `--data`.
fn csv(points: &MeasuredPoints) -> String {
    let head = format!(
        "side,distance_mm,{},kind{}\n",
        points.angle.column(),
        if points.have_deviations { ",sd_deg" } else { "" }
    );
    let row = |point: &MeasuredPoint| {
        let side = if point.side == Side::Cb { "cb" } else { "cf" };
        let kind = match point.kind {
            Some(DetachmentKind::SlipOff) => "slip-off",
            Some(DetachmentKind::PullOff) => "pull-off",
            _ => "",
        };
        let sd = points.have_deviations.then(|| format!(",{}", point.sd_deg));
        let sd = sd.unwrap_or_default();
        format!("{side},{},{},{kind}{sd}\n", point.distance_mm, point.angle_deg)
    };
    let rows = points.points.iter().map(row);
    std::iter::once(head).chain(rows).collect()
}

/// The page with another scene. Scripts end at `</script`, so that no `<` may stay in the JSON.
fn page(start: &str) -> String {
    let [begin, end] = START;
    let (before, rest) = PAGE.split_once(begin).unwrap_or((PAGE, ""));
    let after = rest.split_once(end).map_or(rest, |(_, after)| after);
    let start = start.replace('<', "\\u003c");
    [before, begin, &start, end, after].concat()
}

/// Opens a file in the browser of the desktop.
fn open(path: &Path) {
    let program = match std::env::consts::OS {
        "macos" => "open",
        "windows" => "explorer",
        _ => "xdg-open",
    };
    // Windows' `explorer` ignores a relative path with slashes, and a name may begin like an option.
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut command = Command::new(program);
    command.arg(path).stdin(Stdio::null());
    command.stdout(Stdio::null()).stderr(Stdio::null());
    if let Err(error) = command.spawn() {
        message(&format!("note: {program}: {error}; open the page yourself"));
    }
}
