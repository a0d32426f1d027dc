//! Plot of the command `whiskmap bench`.

use whiskmap::bench::{Measurement, NOISY, named};
use whiskmap::render::{Dot, Ink, Line, Plot, Stroke};

/// Plots error against time of all measurements, with one line per engine and integrator.
pub fn plot(rows: &[Measurement]) -> Plot {
    let looks = [
        (Ink::Grey, Stroke::Solid),
        (Ink::Black, Stroke::Solid),
        (Ink::Black, Stroke::Dashed),
        (Ink::Grey, Stroke::Dashed),
        (Ink::Blue, Stroke::Solid),
        (Ink::Blue, Stroke::Dashed),
    ];
    let kind = |row: &Measurement| (row.engine.clone(), row.threads, row.rung.integrator);
    let engines = rows.chunk_by(|a, b| kind(a) == kind(b));
    let (mut lines, mut dots) = (Vec::new(), Vec::new());
    for (rows, &(ink, stroke)) in engines.zip(looks.iter().cycle()) {
        let engine = named(&rows[0].engine, rows[0].threads);
        let name = format!("{engine}, {}", rows[0].rung.integrator);
        let points = rows.iter().map(point).collect();
        lines.push(Line::new(points, ink, stroke).named(name));
        dots.extend(rows.iter().filter_map(|row| dot(row, ink)));
    }
    Plot {
        x_label: "time per state (\u{b5}s)".to_owned(),
        y_label: "worst error of the push angle (deg)".to_owned(),
        lines,
        dots,
        logarithmic: true,
        ..Plot::default()
    }
}

/// Time per state in microseconds, and worst push-angle error in degrees.
fn point(row: &Measurement) -> [f64; 2] {
    [row.us_per_state, row.errors.angle_deg.worst]
}

/// Returns the dot of a row, if it has one: open and in the `ink` of its line if the row is noisy, black if no other row beats it.
fn dot(row: &Measurement, ink: Ink) -> Option<Dot> {
    let (ink, name) = match (row.pareto, row.seconds.is_noisy) {
        (true, false) => (
            Ink::Black,
            "no other is faster and more accurate".to_owned(),
        ),
        (true, true) => (
            ink,
            "no other is faster and more accurate, but noisy".to_owned(),
        ),
        (false, true) => {
            let most = 100.0 * NOISY;
            (ink, format!("noisy: runs more than {most:.0} % apart"))
        }
        (false, false) => return None,
    };
    Some(Dot {
        at: point(row),
        ink,
        open: row.seconds.is_noisy,
        name: Some(name),
    })
}

#[cfg(test)]
mod tests {
    use super::plot;
    use whiskmap::bench::{Errors, Measurement, Rung, Spread, StageTimes, Timing};
    use whiskmap::render::Ink;

    const EXACT: Spread = Spread {
        worst: 0.0,
        p99: 0.0,
    };

    fn row(engine: &str, pareto: bool, is_noisy: bool) -> Measurement {
        Measurement {
            engine: engine.to_owned(),
            threads: None,
            rung: Rung {
                integrator: "nystrom8",
                steps: 10,
            },
            seconds: Timing {
                median: 1.0,
                fastest: 1.0,
                slowest: 1.0,
                spread: 0.0,
                is_noisy,
            },
            stages_ms: StageTimes::new(),
            us_per_state: 1.0,
            states_per_s: 1.0,
            trajectories_per_s: 1.0,
            gflops: None,
            of_peak: None,
            errors: Errors {
                states: 1,
                angle_deg: EXACT,
                arc_length: EXACT,
                force: EXACT,
            },
            pareto,
        }
    }

    #[test]
    fn a_noisy_point_keeps_the_colour_of_its_engine() {
        let engines = ["scalar", "one thread", "all threads", "gpu f32", "gpu f64"];
        let kinds = [(false, true), (true, true), (true, false), (false, false)];
        let rows = engines.map(|engine| kinds.map(|(pareto, noisy)| row(engine, pareto, noisy)));
        let plot = plot(&rows.concat());
        assert_eq!(plot.lines.len(), engines.len());
        for (line, dots) in plot.lines.iter().zip(plot.dots.chunks(3)) {
            let found: Vec<_> = dots.iter().map(|dot| (dot.ink, dot.open)).collect();
            let wanted = [(line.ink, true), (line.ink, true), (Ink::Black, false)];
            assert_eq!(found, wanted, "{:?}", line.name);
        }
    }
}
