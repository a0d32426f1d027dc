//! The picture of `whiskmap bench`.

use whiskmap::bench::{Measurement, NOISY, Report, named};
use whiskmap::render::{Dot, Ink, Line, Plot, Stroke};

/// Error against time, a line per engine and integrator.
pub fn plot(report: &Report) -> Plot {
    let place = |row: &Measurement| [row.us_per_state, row.errors.angle_deg.worst];
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
    let noisy = format!("noisy: runs more than {:.0} % apart", 100.0 * NOISY);
    let marked = report.rows.iter().filter_map(|row| {
        let (ink, name) = match (row.pareto, row.seconds.is_noisy) {
            (true, false) => (Ink::Black, "no other is faster and closer"),
            (true, true) => (Ink::Black, "no other is faster and closer, but noisy"),
            (false, true) => (Ink::Grey, noisy.as_str()),
            (false, false) => return None,
        };
        Some(Dot {
            at: place(row),
            ink,
            open: row.seconds.is_noisy,
            name: Some(name.to_owned()),
        })
    });
    Plot {
        x_label: "time per state (\u{b5}s)".to_owned(),
        y_label: "worst error of the push angle (deg)".to_owned(),
        lines: lines.collect(),
        dots: marked.collect(),
        logarithmic: true,
        ..Plot::default()
    }
}
