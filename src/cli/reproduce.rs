//! `whiskmap reproduce`.

use super::failure::Failure;
use super::outputs::{self, unwritten};
use clap::Args;
use std::io::Write;
use std::path::PathBuf;
use whiskmap::paper;
use whiskmap::render::Format;
use whiskmap::store::{Output, Table};

/// Options of `reproduce`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap reproduce
  whiskmap reproduce /tmp/figures

Writes fig1, fig2, fig3, fig4d and fig5c as SVG and PNG, and a CSV for each panel. Solid lines are stable states or \
whiskers, dashed ones unstable states or cylinders; black is slip-off and blue is pull-off, as in the paper. The push \
angle is the rotation of the base since first touch.")]
pub struct Options {
    /// Folder for the files; it is made if it is missing
    #[arg(value_name = "DIR", default_value = "outputs")]
    folder: PathBuf,
}

/// Runs `reproduce`.
pub fn run(options: &Options) -> Result<(), Failure> {
    let folder = &options.folder;
    outputs::folder("DIR", folder)?;
    let mut out = std::io::stdout().lock();
    for figure in paper::figures(&paper::Measurements::default()).map_err(Failure::State)? {
        for (ending, format) in [("png", Format::Png), ("svg", Format::Svg)] {
            let path = folder.join(figure.name).with_extension(ending);
            figure.chart.picture().save(&path, format)?;
            writeln!(out, "{}", path.display())?;
        }
        for (name, write) in &figure.tables {
            let path = folder.join(name).with_extension("csv");
            let written = Output::create(&path).map(Table::new).and_then(|mut table| {
                write(&mut table)?;
                table.finish()
            });
            written.map_err(|cause| unwritten(&path, cause))?;
            writeln!(out, "{}", path.display())?;
        }
    }
    Ok(())
}
