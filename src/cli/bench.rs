//! `whiskmap bench`.

use super::failure::{Failure, say};
use super::outputs::{STDOUT, open, write};
use clap::Args;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use whiskmap::bench::{self, Effort, Measurement, Report};
use whiskmap::render::{Dot, Ink, Line, Plot, Stroke};
use whiskmap::scene::Scene;

/// Options of `bench`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap bench scenes/cone.toml
  whiskmap bench scenes/cone.toml --quick --json bench.json --plot bench.svg

A sample of the scene's states, at most 128 x 128 cells and two values per sweep axis, is solved by every engine: the CPU \
with one number at a time, with vectors on one thread and on all, from 3 to 30 steps of order 8 at the fold, fewer below; \
each GPU adapter in f32 and, where it can, in f64, by differences from references along each row; the references are made \
before, and cells that it hands over do not count. \
Errors are judged with four times the default steps: the push angle that a state really belongs to, the arc length \
of its contact in whisker lengths, and its force. * marks the rows that no other beats in time and in the worst error of \
the angle. Times, also of the stages, are medians of at least 5 runs after one that does not count; +- is the slowest less \
the fastest run.")]
pub struct Options {
    /// Scene file; - reads it from standard input
    scene: PathBuf,
    /// Everything measured, as JSON; - is standard output, in place of the tables
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Picture of error against time, PNG or SVG by its ending
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// A smaller sample and fewer runs
    #[arg(long)]
    quick: bool,
}

/// Runs `bench`.
pub fn run(options: &Options) -> Result<(), Failure> {
    let scene = Scene::read(&options.scene)?;
    let json = options.json.as_deref();
    let (output, picture) = open("--json", json, options.plot.as_deref())?;
    let effort = if options.quick {
        Effort::QUICK
    } else {
        Effort::FULL
    };
    let watched = io::stderr().is_terminal();
    let report = bench::run(&scene, effort, &mut |next| {
        if watched {
            say(&format!("measuring {next}"));
        }
    })?;
    let report = report.ok_or_else(|| {
        Failure::Input(
            "grid: no cell of the sample has a state; give push angles and distances that keep the contact".to_owned(),
        )
    })?;
    if let Some((output, path)) = output.zip(json) {
        let text = serde_json::to_string_pretty(&report).unwrap_or_default() + "\n";
        write(output, path, &text)?;
    }
    if let Some(picture) = picture {
        let title = format!("What accuracy costs: {}", report.scene);
        picture.save(title, plot(&report))?;
    }
    if json != Some(Path::new(STDOUT)) {
        tables(&report)?;
    }
    Ok(())
}

/// At most 80 columns, but for the adapters' names.
fn tables(report: &Report) -> io::Result<()> {
    let mut out = io::stdout().lock();
    writeln!(out, "{}: {} states\n", report.scene, report.states)?;
    for engine in &report.engines {
        let name = named(&engine.name, engine.threads);
        writeln!(
            out,
            "{name:20} peak {:.1} GFLOP/s, first result after {:.1e} s",
            engine.peak_gflops, engine.first_result_s
        )?;
        if engine.threads.is_none() {
            writeln!(out, "{:20} {}", "", engine.adapter)?;
        }
    }
    writeln!(
        out,
        "\n{:46}angle, deg     arc  force   of\n  \
         engine          steps               us  +-%  worst   99 %  worst  worst peak",
        ""
    )?;
    for row in &report.rows {
        let errors = &row.errors;
        let of_peak = row
            .of_peak
            .map_or_else(|| "-".to_owned(), |part| format!("{:.0}%", 100.0 * part));
        writeln!(
            out,
            "{} {:15} {:16} {:5.2} {:4.0} {:6.0e} {:6.0e} {:6.0e} {:6.0e} {of_peak:>4}",
            if row.pareto { "*" } else { " " },
            named(&row.engine, row.threads),
            row.rung.to_string(),
            row.us_per_state,
            100.0 * row.seconds.spread,
            errors.angle_deg.worst,
            errors.angle_deg.p99,
            errors.arc_length.worst,
            errors.force.worst,
        )?;
    }
    for failure in &report.failures {
        writeln!(out, "not measured: {failure}")?;
    }
    let staged = || report.rows.iter().filter(|row| row.threads.is_none());
    if staged().next().is_some() {
        writeln!(
            out,
            "\nms              steps              upload dispatch  waiting readback"
        )?;
    }
    for row in staged() {
        let stages = &row.stages_ms;
        writeln!(
            out,
            "{:15} {:16}  {:8.2} {:8.2} {:8.2} {:8.2}",
            row.engine,
            row.rung.to_string(),
            stages.upload,
            stages.dispatch,
            stages.waiting,
            stages.readback
        )?;
    }
    writeln!(
        out,
        "\ndetachments, all threads    us a point  +-%   angle, deg: worst    99 %"
    )?;
    for row in &report.detachments {
        writeln!(
            out,
            "nystrom8 x{:<3} {:23.1} {:5.0} {:19.0e} {:7.0e}",
            row.steps,
            row.us_per_point,
            100.0 * row.seconds.spread,
            row.angle_deg.worst,
            row.angle_deg.p99
        )?;
    }
    Ok(())
}

/// An engine with its threads.
fn named(engine: &str, threads: Option<usize>) -> String {
    match threads {
        Some(threads) => format!("{engine} x {threads}"),
        None => engine.to_owned(),
    }
}

/// Error against time, a line per engine and integrator.
fn plot(report: &Report) -> Plot {
    let place = |row: &Measurement| {
        let error = row.errors.angle_deg.worst;
        [row.us_per_state.log10(), error.log10()]
    };
    let looks = [
        (Ink::Grey, Stroke::Solid),
        (Ink::Black, Stroke::Solid),
        (Ink::Black, Stroke::Dashed),
        (Ink::Grey, Stroke::Dashed),
        (Ink::Blue, Stroke::Solid),
        (Ink::Blue, Stroke::Dashed),
    ];
    let kind = |row: &Measurement| (row.engine.clone(), row.threads, row.rung.integrator);
    let engines = report.rows.chunk_by(|a, b| kind(a) == kind(b));
    let lines = engines.zip(looks.iter().cycle());
    let lines = lines.map(|(rows, &(ink, stroke))| {
        let engine = named(&rows[0].engine, rows[0].threads);
        let name = format!("{engine}, {}", rows[0].rung.integrator);
        Line::new(rows.iter().map(place).collect(), ink, stroke, name)
    });
    let front = report.rows.iter().filter(|row| row.pareto);
    let front = front.map(|row| Dot {
        at: place(row),
        name: Some("no other is faster and closer".to_owned()),
        ..Dot::default()
    });
    Plot {
        x_label: "log10 of microseconds per state".to_owned(),
        y_label: "log10 of the worst error of the push angle (deg)".to_owned(),
        lines: lines.collect(),
        dots: front.collect(),
        ..Plot::default()
    }
}
