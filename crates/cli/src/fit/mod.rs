//! Command `whiskmap fit`.

mod table;

use super::arguments::{named, parameter};
use super::data::{self, ColumnArgs};
use super::failure::{Failure, notes, warnings};
use super::files::{Files, STDOUT};
use super::outputs::write;
use super::pole::{WhiskerArgs, check_single};
use clap::Args;
use serde_json::{Map, Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use table::table;
use whiskmap::fit::{Fit, FitError, FitLoss, fit_until};
use whiskmap::scene::Parameter;
use whiskmap::store::Output;
use whiskmap::terminal::StandardOutput;

const LOSS_HELP: [&str; 3] = [
    "The square: an outlier pulls with all of its distance",
    "Smooth, and linear far away",
    "The square up to one standard deviation, then a line",
];

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap fit scenes/cone.toml --data scenes/cone_points.csv --free tip_radius_um,parabola_per_mm
  whiskmap fit scenes/cone.toml --data scenes/cone_points.csv --free tip_radius_um -o fitted.toml --json fit.json

Minimizes the squares of measured minus predicted angles, or the --loss of these, from the values of the scene and within its limits. The columns of \
the data are side (cb or cf), distance_mm, push_angle_deg or push_chord_deg, and optionally kind (slip-off, pull-off or empty) \
and sd_deg, the standard deviation of the angle. Without sd_deg, the residuals give the standard deviation. A column whisker names \
the row of the scene's table of whiskers that a point belongs to; all whiskers share the fitted values. If the scene's whisker \
does not reach a point, a free parameter such as length_mm starts at a value with which it does; a note gives the value.

With --loss soft-l1 or huber, a point pulls less the more standard deviations it is off: 1 degree without sd_deg. Outliers are \
named by their row, and the standard errors come from the scatter of the residuals. The rows that pull most are those without which \
an estimate would move by most of its standard errors.

A warning names parameters that the points do not determine. youngs_modulus_gpa and profile_scale are always among them, because no \
detachment depends on them. These parameters and parameters at a limit of the scene have no standard error.

The values are not a fit if the RMS is more than 5 degrees, or more than a third of the range of the measured angles and 0; \
with sd_deg, only if chi-square is also too large for these deviations. A reduced chi-square above 400 is never a fit. Then \
the exit code is 1 and -o writes nothing.")]
pub struct FitArgs {
    #[command(flatten)]
    whisker: WhiskerArgs,
    /// Measured detachments; - is standard input
    #[arg(long, value_name = "FILE", group = "table")]
    data: PathBuf,
    #[command(flatten)]
    columns: ColumnArgs,
    /// Parameters to fit, separated by commas
    #[arg(long, value_name = "NAMES", required = true, value_delimiter = ',', value_parser = parameter())]
    free: Vec<Parameter>,
    /// Loss of residuals in standard deviations: soft-l1 and huber grow linearly beyond one, so that outliers pull less
    #[arg(long, value_name = "LOSS", default_value = "squares", value_parser = named(FitLoss::ALL, FitLoss::name, LOSS_HELP))]
    loss: FitLoss,
    /// Write the scene with the fitted values to FITTED.toml; - is standard output
    #[arg(short, long, value_name = "FITTED.toml")]
    output: Option<PathBuf>,
    /// Write the result to FILE, as JSON; - is standard output
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

pub fn run(args: &FitArgs, files: &mut Files) -> Result<(), Failure> {
    files.inputs("--data", [&args.data])?;
    let scene = args.whisker.selected(files)?;
    let points = data::read(&args.data, &args.columns)?;
    // Points that name their whiskers belong to several whiskers of a table.
    let (scene, points) = match points.whiskers.is_empty() || scene.whisker_count() == 1 {
        true => {
            check_single(&scene, "fit").map_err(|why| match why {
                Failure::Input(why) if !scene.table.is_empty() => Failure::Input(format!(
                    "{why}, or name the whisker of each point in a column whisker of --data"
                )),
                why => why,
            })?;
            let points = points.at(&scene.first_whisker().place)?;
            (scene.of_whisker(0)?, points)
        }
        false => (scene, points),
    };
    data::note_follicle(&scene);
    let mut open = |option, path: &Option<PathBuf>| {
        let output = path.as_deref().map(|path| files.output(option, path));
        output.transpose()
    };
    let toml_output = open("--output", &args.output)?;
    let json_output = open("--json", &args.json)?;
    let never = AtomicBool::new(false);
    let found =
        fit_until(&scene, &points, &args.free, args.loss, &never).map_err(|why| match why {
            FitError::Lacking { .. }
            | FitError::Twice(..)
            | FitError::Column(..)
            | FitError::Held { .. } => Failure::Input(format!("--free {why}")),
            _ => why.into(),
        })?;
    notes(found.moved_start(&scene, &points));
    warnings(found.warnings(&points));
    let toml_output = toml_output.filter(|_| found.not_a_fit.is_none());
    let json = json_output.map(|output| (output, format!("{:#}\n", document(&found))));
    let estimates = found.estimates.iter();
    let values: Vec<_> = estimates.map(|estimate| (estimate.parameter, estimate.value)).collect();
    let toml = toml_output
        .map(|output| Ok::<_, Failure>((output, scene.to_toml_with(&values)?)))
        .transpose()?;
    let outputs = [toml, json].into_iter().flatten().collect();
    let printed = print(&scene.title, &found, outputs);
    match found.not_a_fit {
        Some(why) if printed.as_ref().err().is_none_or(Failure::is_broken_pipe) => {
            let unwritten = args.output.as_deref().map(|path| match path {
                path if path == Path::new(STDOUT) => {
                    "; no scene is written to standard output".to_owned()
                }
                path => format!("; {} is not written", path.display()),
            });
            Err(Failure::NotAFit(why, unwritten.unwrap_or_default()))
        }
        _ => printed,
    }
}

/// Writes the outputs with their texts. Prints the table and their names on standard output, unless an output is written there.
fn print(title: &str, fit: &Fit, outputs: Vec<(Output, String)>) -> Result<(), Failure> {
    let is_streamed = outputs.iter().any(|(output, _)| output.is_stdout());
    if !is_streamed {
        table(title, fit)?;
    }
    for (output, text) in outputs {
        let regular = write(output, text.as_bytes())?;
        if let Some(path) = regular.filter(|_| !is_streamed) {
            writeln!(StandardOutput::open(), "{}", path.display())?;
        }
    }
    Ok(())
}

/// Returns the fit as JSON, with parameters by name.
fn document(fit: &Fit) -> Value {
    let names = fit.estimates.iter().map(|estimate| estimate.parameter.name());
    let keyed = |values: Vec<Value>| -> Map<String, Value> {
        names.clone().map(str::to_owned).zip(values).collect()
    };
    let estimates = fit.estimates.iter();
    let values = estimates.clone().map(|estimate| json!(estimate.value)).collect();
    let errors = estimates.map(|estimate| json!(estimate.standard_error)).collect();
    let rows = fit.correlation.iter().map(|row| {
        Value::Object(keyed(row.iter().map(|correlation| json!(correlation)).collect()))
    });
    let comparison = &fit.comparison;
    let traced = fit.scene.traced().map(|shape| {
        json!({
            "degree": shape.degree,
            "curvature": shape.coefficients(),
            "length_mm": shape.length_mm,
            "rms_mm": shape.rms_mm,
        })
    });
    let pulls = fit.pulls.iter().map(|pull| {
        json!({
            "line": pull.line,
            "residual_deg": pull.residual_deg,
            "weight": pull.weight,
            "parameter": pull.parameter.name(),
            "standard_errors": pull.standard_errors,
        })
    });
    let pulls: Vec<Value> = pulls.collect();
    let smooth = fit.scene.smooth_radii();
    let smooth = smooth.map(|radii| json!({ "degree": radii.degree, "rms_um": radii.rms_um }));
    json!({
        "not_a_fit": fit.not_a_fit.as_ref().map(ToString::to_string),
        "values": keyed(values),
        "standard_errors": keyed(errors),
        "correlation": keyed(rows.collect()),
        "loss": fit.loss.name(),
        "pulls": pulls,
        "chi_square": fit.chi_square,
        "degrees_of_freedom": fit.degrees_of_freedom,
        "rms_deg": comparison.rms_deg(),
        "bias_deg": comparison.bias_deg(),
        "left_out": comparison.left_out().count(),
        "points": comparison.rows,
        "traced": traced,
        "smooth_radii": smooth,
    })
}
