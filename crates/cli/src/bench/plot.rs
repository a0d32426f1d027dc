//! Plot of the command `whiskmap bench`.

use whiskmap::bench::{Measurement, NOISY, Peers, named};
use whiskmap::render::{Chart, Dot, Ink, Line, Note, Plot, Stroke};

/// Draws error against time of engines, and of other programs if there are some.
pub fn chart(scene: &str, rows: &[Measurement], peers: Option<&Peers>) -> Chart {
    let caption = peers.map(|peers| {
        format!(
            "Grey with names: other programs, on one thread of {}. States are of the map; heyoka's are trajectories.",
            peers.machine
        )
    });
    Chart {
        caption: caption.into_iter().collect(),
        ..Chart::single(format!("What accuracy costs: {scene}"), plot(rows, peers))
    }
}

/// Plots error against time, with one line per engine and integrator, and a named one per peer. A single row is a dot with a name.
fn plot(rows: &[Measurement], peers: Option<&Peers>) -> Plot {
    let kind = |row: &Measurement| (row.engine.clone(), row.threads, row.rung.integrator);
    let engines = rows.chunk_by(|a, b| kind(a) == kind(b));
    let mut plot = Plot {
        x_label: "time per state (\u{b5}s)".to_owned(),
        y_label: "worst error of the push angle (deg)".to_owned(),
        logarithmic: [true; 2],
        ..Plot::default()
    };
    for rows in engines {
        let engine = named(&rows[0].engine, rows[0].threads);
        let (ink, stroke) = look(&rows[0]);
        let points: Vec<[f64; 2]> = rows.iter().map(point).collect();
        if let [only] = points[..] {
            plot.notes.push(Note::text(only, engine));
        } else {
            let name = format!("{engine}, {}", rows[0].rung.integrator);
            plot.lines.push(Line::new(points, ink, stroke).named(name));
        }
        plot.dots.extend(rows.iter().filter_map(|row| dot(row, ink, rows.len() == 1)));
    }
    for peer in peers.iter().flat_map(|peers| &peers.programs) {
        plot.notes.extend(peer.points.first().map(|at| Note::text(*at, peer.name)));
        let dots = peer.points.iter().map(|at| Dot { at: *at, ink: Ink::Grey, ..Dot::default() });
        plot.dots.extend(dots);
        plot.lines.push(Line::new(peer.points.clone(), Ink::Grey, Stroke::Dashed));
    }
    plot
}

/// Colour and stroke of an engine: trajectories on one scalar, on vectors and on threads, expansions, and GPUs.
fn look(row: &Measurement) -> (Ink, Stroke) {
    let ink = match &*row.engine {
        "cpu scalar" => Ink::Grey,
        "spectral" => Ink::Blue,
        _ => Ink::Black,
    };
    let stroke = match row.threads {
        None | Some(1) => Stroke::Solid,
        Some(_) => Stroke::Dashed,
    };
    (ink, stroke)
}

/// Time per state in microseconds, and worst push-angle error in degrees.
fn point(row: &Measurement) -> [f64; 2] {
    [row.us_per_state, row.errors.angle_deg.worst]
}

/// Returns the dot of a row in the `ink` of its engine, open if the row is noisy; a row in a line has one only if it is noisy.
fn dot(row: &Measurement, ink: Ink, is_single: bool) -> Option<Dot> {
    let most = 100.0 * NOISY;
    let is_noisy = row.seconds.is_noisy;
    (is_noisy || is_single).then(|| Dot {
        at: point(row),
        ink,
        open: is_noisy,
        name: is_noisy.then(|| format!("noisy: runs more than {most:.0} % apart")),
    })
}

#[cfg(test)]
mod tests {
    use super::plot;
    use whiskmap::bench::{Errors, Measurement, Peer, Peers, Rung, Spread, StageTimes, Timing};
    use whiskmap::render::Ink;

    const EXACT: Spread = Spread { worst: 0.0, p99: 0.0 };

    fn row(engine: &str, is_noisy: bool) -> Measurement {
        Measurement {
            engine: engine.to_owned(),
            threads: None,
            rung: Rung { integrator: "nystrom8", steps: 10 },
            seconds: Timing { median: 1.0, fastest: 1.0, slowest: 1.0, spread: 0.0, is_noisy },
            stages_ms: StageTimes::new(),
            us_per_state: 1.0,
            states_per_s: 1.0,
            trajectories_per_s: Some(1.0),
            errors: Errors { states: 1, angle_deg: EXACT, arc_length: EXACT, force: EXACT },
            pareto: false,
        }
    }

    #[test]
    fn a_noisy_point_keeps_the_colour_of_its_engine() {
        let engines = ["cpu scalar", "spectral", "cpu AVX2", "gpu f32"];
        let inks = [Ink::Grey, Ink::Blue, Ink::Black, Ink::Black];
        let rows = engines.map(|engine| [true, false].map(|noisy| row(engine, noisy)));
        let plot = plot(&rows.concat(), None);
        assert_eq!(plot.lines.iter().map(|line| line.ink).collect::<Vec<_>>(), inks);
        let dots = plot.dots.iter().map(|dot| (dot.ink, dot.open));
        assert_eq!(dots.collect::<Vec<_>>(), inks.map(|ink| (ink, true)));
    }

    #[test]
    fn a_single_row_and_each_peer_have_a_dot_and_a_name() {
        let peers = Peers {
            machine: "M".to_owned(),
            programs: vec![Peer { name: "AUTO-07p", points: vec![[300.0, 1e-9], [500.0, 1e-10]] }],
        };
        let plot = plot(&[row("gpu f32", false)], Some(&peers));
        assert_eq!(plot.dots.len(), 3);
        assert_eq!(plot.lines.len(), 1);
        let notes: Vec<&str> = plot.notes.iter().map(|note| &*note.text).collect();
        assert_eq!(notes, ["gpu f32", "AUTO-07p"]);
    }
}
