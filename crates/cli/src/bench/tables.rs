//! Tables of the command `whiskmap bench`.

use std::io::{self, Write};
use whiskmap::bench::{NOISY, Report, Timing, named};
use whiskmap::terminal::StandardOutput;

/// Prints all measurements in at most 80 columns, except the names of adapters.
pub fn tables(report: &Report) -> io::Result<()> {
    let mut out = StandardOutput::open();
    writeln!(out, "{}: {} states\n", report.scene, report.states)?;
    for engine in &report.engines {
        let name = named(&engine.name, engine.threads);
        writeln!(out, "{name:20} first result after {:.1e} s", engine.first_result_s)?;
        if engine.threads.is_none() {
            writeln!(out, "{:20} {}", "", engine.adapter)?;
        }
    }
    writeln!(
        out,
        "\n{:47}angle, deg     arc  force\n  \
         engine          steps               us spread  worst   99 %  worst  worst",
        ""
    )?;
    for row in &report.rows {
        let errors = &row.errors;
        writeln!(
            out,
            "{} {:15} {:16} {:5.2} {} {:>5} {:>6} {:>6} {:>6}",
            if row.pareto { "*" } else { " " },
            named(&row.engine, row.threads),
            row.rung.to_string(),
            row.us_per_state,
            spread(&row.seconds),
            error(errors.angle_deg.worst),
            error(errors.angle_deg.p99),
            error(errors.arc_length.worst),
            error(errors.force.worst),
        )?;
    }
    for failure in &report.failures {
        writeln!(out, "not measured: {failure}")?;
    }
    expansions(&mut out, report)?;
    let staged = || report.rows.iter().filter(|row| row.threads.is_none());
    if staged().next().is_some() {
        writeln!(out, "\nms              steps              upload dispatch  waiting readback")?;
    }
    for row in staged() {
        let stages = &row.stages_ms;
        writeln!(
            out,
            "{:15} {:16}  {:8.2} {:8.2} {:8.2} {:8.2}",
            row.engine,
            row.rung.to_string(),
            stages["upload"],
            stages["dispatch"],
            stages["waiting"],
            stages["readback"]
        )?;
    }
    writeln!(out, "\ntrajectories, with transfers      million/s spread   pole off, lengths")?;
    for row in &report.trajectories {
        writeln!(
            out,
            "{:32} {:10.3} {:>6} {:>19}",
            row.engine,
            1e-6 * row.per_s,
            spread(&row.seconds),
            error(row.apart)
        )?;
    }
    writeln!(out, "\ndetachments, all threads    us a point spread   angle, deg: worst    99 %")?;
    for row in &report.detachments {
        writeln!(
            out,
            "nystrom8 x{:<3} {:23.1} {:>6} {:>19} {:>7}",
            row.steps,
            row.us_per_point,
            spread(&row.seconds),
            error(row.angle_deg.worst),
            error(row.angle_deg.p99)
        )?;
    }
    maps(&mut out, report)?;
    let rows = report.rows.iter().map(|row| &row.seconds);
    let ends = report.detachments.iter().map(|row| &row.seconds);
    let maps = report.maps.iter().map(|map| &map.seconds);
    if rows.chain(ends).chain(maps).any(|timing| timing.is_noisy) {
        let most = 100.0 * NOISY;
        writeln!(
            out,
            "\n! noisy: the slowest and the fastest run are more than {most:.0} % apart"
        )?;
    }
    Ok(())
}

/// Prints the one-time cost of expansions, if some were measured.
fn expansions(out: &mut impl Write, report: &Report) -> io::Result<()> {
    if report.expansions.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "\nexpansions, one thread\n  bound  states  certified  ms a side spread us a state  trajectories pays from"
    )?;
    for expansions in &report.expansions {
        let from = expansions.pays_from.map_or_else(|| "-".to_owned(), |from| format!("{from:.0}"));
        writeln!(
            out,
            "{:7.0e} {:7} {:9.2}% {:10.2} {} {:11.3} {:13.3} {from:>9}",
            expansions.bound,
            expansions.states,
            100.0 * expansions.certified,
            expansions.ms_per_side,
            spread(&expansions.seconds),
            expansions.us_per_state,
            expansions.us_by_trajectories,
        )?;
    }
    writeln!(
        out,
        "pays from: states of a whisker side; trajectories: us of the cheapest as accurate ones"
    )
}

/// Prints the table of whole maps, and the verdicts.
fn maps(out: &mut impl Write, report: &Report) -> io::Result<()> {
    writeln!(
        out,
        "\nwhole maps of {} cells, all threads\n{:20}      ms spread  host us/cell  share  for devices  fallback",
        report.map_cells, ""
    )?;
    for map in &report.maps {
        writeln!(
            out,
            "{:20} {:7.1} {} {:13.3} {:6.2} {:11.0}% {:8.2}%",
            map.engine,
            1e3 * map.seconds.median,
            spread(&map.seconds),
            map.host_us_per_cell,
            map.host_share,
            100.0 * map.device_can_take,
            100.0 * map.fallback as f64 / report.map_cells as f64
        )?;
    }
    writeln!(
        out,
        "\nms               sheets    rows  device waiting guesses refining classes packing"
    )?;
    for map in &report.maps {
        let stages = &map.stages_ms;
        writeln!(
            out,
            "{:16} {:6.1} {:7.1} {:7.1} {:7.1} {:7.1} {:8.1} {:7.1} {:7.1}",
            map.engine,
            stages["sheets"],
            stages["rows"],
            stages["device"],
            stages["waiting"],
            stages["guesses"],
            stages["refinement"],
            stages["classification"],
            stages["packing"]
        )?;
    }
    writeln!(
        out,
        "\nfor devices: part of the stages that a GPU could take over\n\
         waiting: for the GPU; device and packing run beside the other stages"
    )?;
    verdicts(out, report)
}

/// Prints which engine is the faster one of each pair, with the adapter of a GPU.
fn verdicts(out: &mut impl Write, report: &Report) -> io::Result<()> {
    for verdict in &report.verdicts {
        writeln!(out, "verdict: {verdict}")?;
        if let Some(adapter) = &verdict.adapter {
            writeln!(out, "{:20} on {adapter}", "")?;
        }
    }
    if report.maps.iter().all(|map| map.adapter.is_none()) {
        let is_measured = report.trajectories.iter().any(|row| row.adapter.is_some());
        let part = if is_measured { " with whole maps" } else { "" };
        writeln!(out, "verdict: no GPU was measured{part}")?;
    }
    Ok(())
}

/// Formats a largest error with one digit, and an infinite error, of a state that was not found, as `-`.
fn error(largest: f64) -> String {
    if largest.is_finite() { format!("{largest:.0e}") } else { "-".to_owned() }
}

/// Formats the spread of a timing in percent, or as a multiple of the median from 10 times on; `!` marks a noisy one.
fn spread(timing: &Timing) -> String {
    let mark = if timing.is_noisy { "!" } else { " " };
    match timing.spread {
        part if part < 9.995 => format!("{:4.0}%{mark}", 100.0 * part),
        times => format!("{times:4.0}x{mark}"),
    }
}

#[cfg(test)]
mod tests {
    use super::{Report, Timing, verdicts};
    use whiskmap::bench::Trajectories;

    /// A GPU integrates trajectories of scenes whose maps it does not compute.
    #[test]
    fn a_gpu_with_trajectories_alone_is_not_denied() {
        let said = |adapter: Option<&str>| {
            let timing =
                Timing { median: 1.0, fastest: 1.0, slowest: 1.0, spread: 0.0, is_noisy: false };
            let row = Trajectories {
                engine: "gpu f32".to_owned(),
                adapter: adapter.map(str::to_owned),
                count: 1,
                seconds: timing,
                per_s: 1.0,
                apart: 0.0,
            };
            let mut out = Vec::new();
            let report = Report { trajectories: vec![row], ..Report::default() };
            let written = verdicts(&mut out, &report);
            (written.is_ok(), String::from_utf8_lossy(&out).into_owned())
        };
        assert_eq!(said(None), (true, "verdict: no GPU was measured\n".to_owned()));
        let partly = "verdict: no GPU was measured with whole maps\n".to_owned();
        assert_eq!(said(Some("llvmpipe")), (true, partly));
    }
}
