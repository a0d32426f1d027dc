//! Draws the pushes of `benches/peers/pyelastica` beside the quasi-static model, as `outputs/dynamics.svg`.
//!
//! `cargo run --release --example dynamics`

use std::error::Error;
use std::fs;
use std::path::Path;
use whiskmap::Side;
use whiskmap::input::CsvTable;
use whiskmap::render::{Band, Chart, Dot, Ink, Line, PictureFormat, PictureSize, Plot, Stroke};
use whiskmap::scene::Scene;
use whiskmap::trace::BranchPoint;

/// Folder of the tables.
const FOLDER: &str = "benches/peers/pyelastica";

/// Damping of the pushes in each plot of lags, per second, and that of the plots of forces.
const DAMPINGS: [f64; 2] = [100.0, 600.0];

/// Rates of the pushes in plots of forces, in degrees per second.
const RATES: [f64; 4] = [60.0, 250.0, 500.0, 1000.0];

/// Peak speeds of the base in degrees per second, for a sine of 8 to 20 Hz with an amplitude of 20 degrees.
const WHISKING: [f64; 2] = [1005.0, 2513.0];

/// A whisker, its touch on CB in mm, its name in titles, and its unit of force, by uN.
struct Case {
    stem: &'static str,
    distance_mm: f64,
    title: &'static str,
    unit: (&'static str, f64),
}

const CASES: [Case; 2] = [
    Case { stem: "cone", distance_mm: 15.6604597633658, title: "mouse, 20 mm", unit: ("µN", 1.0) },
    Case { stem: "robot", distance_mm: 80.0, title: "robot, 100 mm", unit: ("mN", 1e-3) },
];

fn main() -> Result<(), Box<dyn Error>> {
    let mut plots = Vec::new();
    for case in &CASES {
        plots.push(lags(case)?);
    }
    for case in &CASES {
        plots.push(forces(case)?);
    }
    let chart = Chart {
        title: "Pushes with inertia (PyElastica), and the quasi-static model".to_owned(),
        plots,
        columns: 2,
        ..Chart::default()
    };
    let picture = chart.picture(PictureSize::Natural)?;
    fs::write("outputs/dynamics.svg", picture.encode(PictureFormat::Svg)?)?;
    Ok(())
}

/// Rows of a table that belong to a case on CB: `[damping in 1/s, rate in deg/s, last columns ...]`.
fn rows(table: &str, case: &Case, columns: &[&str]) -> Result<Vec<Vec<f64>>, Box<dyn Error>> {
    let table = CsvTable::read(Path::new(FOLDER).join(table))?;
    let words = |name| table.values(name, "a word", |cell| Some(cell.to_owned()));
    let (scenes, sides) = (words("scene")?, words("side")?);
    let pairs = scenes.into_iter().flatten().zip(sides.into_iter().flatten());
    let of_case: Vec<bool> =
        pairs.map(|(scene, side)| scene == case.stem && side == "cb").collect();
    let mut rows = vec![Vec::new(); of_case.len()];
    for column in columns {
        let numbers = table.numbers(column, "a number", f64::is_finite)?;
        let numbers = numbers.ok_or_else(|| format!("no column {column}"))?;
        for (row, number) in rows.iter_mut().zip(numbers) {
            row.push(number);
        }
    }
    let kept = rows.into_iter().zip(of_case).filter(|(_, is_of_case)| *is_of_case);
    Ok(kept.map(|(row, _)| row).collect())
}

fn branch(case: &Case) -> Result<Vec<BranchPoint>, Box<dyn Error>> {
    let scene = Scene::read(format!("scenes/{}.toml", case.stem))?;
    let points = whiskmap::branch(&scene, case.distance_mm, Side::Cb)?.points(200)?;
    Ok(points.into_iter().filter(|point| point.stable).collect())
}

/// Lag of the detachment behind the quasi-static one by the rate of the push, on logarithmic axes.
fn lags(case: &Case) -> Result<Plot, Box<dyn Error>> {
    let points = branch(case)?;
    let end = points.last().ok_or("no branch")?.push_angle_deg;
    let columns = ["damping_per_s", "elements", "rate_deg_per_s", "push_angle_deg"];
    let all = rows("detachments.csv", case, &columns)?;
    let mut dots = Vec::new();
    for row in &all {
        let [damping, elements, rate, push] = row[..] else {
            continue;
        };
        let Some(index) = DAMPINGS.iter().position(|series_damping| *series_damping == damping)
        else {
            continue;
        };
        let finer = if elements > 40.0 { ", 80 elements" } else { "" };
        dots.push(Dot {
            at: [rate, push - end],
            ink: Ink::Series(index),
            open: elements > 40.0,
            name: Some(format!("damping {damping} per s{finer}")),
        });
    }
    // The law of a delayed saddle-node, through the middle of the slow pushes.
    let slow = dots.iter().filter(|dot| dot.at[0] <= 8.0 && dot.at[1] > 0.0);
    let (logs, count) = slow.fold((0.0, 0.0), |(sum, count), dot| {
        (sum + (dot.at[1] / dot.at[0].powf(2.0 / 3.0)).ln(), count + 1.0)
    });
    let factor = f64::exp(logs / f64::max(count, 1.0));
    let law = [0.4, 3000.0].map(|rate: f64| [rate, factor * rate.powf(2.0 / 3.0)]);
    let [low, high] = WHISKING;
    Ok(Plot {
        title: format!("{}: slip-off at {end:.2}° without inertia", case.title),
        x_label: "rate of the base (°/s)".to_owned(),
        y_label: "lag of the slip-off (°)".to_owned(),
        bands: vec![Band {
            points: vec![[[low, 0.01], [low, 20.0]], [[high, 0.01], [high, 20.0]]],
            name: Some("8 to 20 Hz, ±20°".to_owned()),
            ..Band::default()
        }],
        lines: vec![Line::new(law.to_vec(), Ink::Grey, Stroke::Dashed).named("slope 2/3")],
        dots,
        logarithmic: [true, true],
        ..Plot::default()
    })
}

/// Force by the push angle, at rest and at several rates, beside the quasi-static one.
fn forces(case: &Case) -> Result<Plot, Box<dyn Error>> {
    let points = branch(case)?;
    let (unit, factor) = case.unit;
    let curve = points.iter().map(|point| [point.push_angle_deg, factor * point.force_un]);
    let mut lines =
        vec![Line::new(curve.collect(), Ink::Black, Stroke::Solid).named("quasi-static")];
    let columns = ["damping_per_s", "rate_deg_per_s", "push_angle_deg", "force_un"];
    let all = rows("forces.csv", case, &columns)?;
    for (index, rate) in RATES.into_iter().enumerate() {
        let pushes = all.iter().filter(|row| row[0] == DAMPINGS[0] && row[1] == rate);
        let points: Vec<_> = pushes.map(|row| [row[2], factor * row[3]]).collect();
        lines
            .push(Line::new(points, Ink::Series(index), Stroke::Solid).named(format!("{rate}°/s")));
    }
    let held = rows("held.csv", case, &["push_angle_deg", "force_un"])?;
    let dots = held.into_iter().map(|row| Dot {
        at: [row[0], factor * row[1]],
        open: true,
        name: Some("held".to_owned()),
        ..Dot::default()
    });
    Ok(Plot {
        title: format!("{}, damping {} per s", case.title, DAMPINGS[0]),
        x_label: "push angle (°)".to_owned(),
        y_label: format!("contact force ({unit})"),
        lines,
        dots: dots.collect(),
        ..Plot::default()
    })
}
