//! The paper's figures, panel by panel: what each shows, on which axes, with which lines, colours and circles.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod detachment;
mod fig3;
mod motion;

use std::sync::LazyLock;
use whiskmap::paper::{Figure, Measurements, figures};
use whiskmap::render::{Chart, Dot, Ink, Line, Plot, Stroke};

/// Figure without its tables.
struct DrawnFigure {
    name: &'static str,
    chart: Chart,
    /// Number of tables.
    tables: usize,
}

/// Draws all figures.
fn drawn(measured: &Measurements) -> Vec<DrawnFigure> {
    let all = figures(measured).unwrap().into_iter();
    let draw = |figure: Figure| DrawnFigure {
        name: figure.name,
        chart: figure.chart,
        tables: figure.tables.len(),
    };
    all.map(draw).collect()
}

/// All figures without measured points, which most tests read.
static FIGURES: LazyLock<Vec<DrawnFigure>> = LazyLock::new(|| drawn(&Measurements::default()));

fn figure(name: &str) -> &'static DrawnFigure {
    FIGURES.iter().find(|figure| figure.name == name).unwrap()
}

/// Returns the plot of a figure with this letter.
fn plot(name: &str, letter: &str) -> &'static Plot {
    let mut plots = figure(name).chart.plots.iter();
    plots.find(|plot| plot.letter.as_deref() == Some(letter)).unwrap()
}

fn named<'a>(dots: &'a [Dot], name: &str) -> Vec<&'a Dot> {
    let has_name = |dot: &&Dot| dot.name.as_deref() == Some(name);
    dots.iter().filter(has_name).collect()
}

fn named_lines<'a>(plot: &'a Plot, name: &str) -> Vec<&'a Line> {
    let has_name = |line: &&Line| line.name.as_deref() == Some(name);
    plot.lines.iter().filter(has_name).collect()
}

fn looks(lines: &[Line]) -> Vec<(Ink, Stroke)> {
    lines.iter().map(|line| (line.ink, line.stroke)).collect()
}

fn near(one: [f64; 2], other: [f64; 2], tolerance: f64) -> bool {
    (one[0] - other[0]).hypot(one[1] - other[1]) < tolerance
}

fn last(line: &Line) -> [f64; 2] {
    line.points[line.points.len() - 1]
}

#[test]
fn every_panel_has_its_letter_and_a_table() {
    let letters = |figure: &DrawnFigure| -> String {
        let letters = figure.chart.plots.iter().map(|plot| plot.letter.clone().unwrap());
        letters.collect()
    };
    let shown: Vec<_> =
        FIGURES.iter().map(|figure| (figure.name, letters(figure), figure.tables)).collect();
    let expected = [
        ("fig1", "ABCD", 4),
        ("fig2", "ABCD", 4),
        ("fig3", "AFBGCHDIEJ", 10),
        ("fig4b", "BC", 2),
        ("fig4d", "D", 1),
        ("fig5b", "B", 1),
        ("fig5c", "C", 2),
        ("fig6", "BCEF", 24),
        ("fig7b", "B", 1),
    ];
    assert_eq!(shown, expected.map(|(name, letters, tables)| (name, letters.to_owned(), tables)));
}

/// Caption of Fig. 1D: the virtual contact is as far from the base as the real one.
#[test]
fn fig1_is_drawn_of_what_it_defines() {
    let plot = plot("fig1", "D");
    let [contact, base, virtual_contact] = plot.lines[0].points[..] else {
        panic!("{:?}", plot.lines[0]);
    };
    assert_eq!(base, [0.0, 0.0]);
    let [real, other] = [contact, virtual_contact].map(|at| at[0].hypot(at[1]));
    assert!((real - other).abs() < 1e-9, "{real} {other}");
    assert_eq!(
        looks(&plot.lines[2..]),
        [(Ink::Grey, Stroke::Solid), (Ink::Grey, Stroke::Dashed), (Ink::Black, Stroke::Solid)]
    );
    // Real and virtual pole touch their whiskers at their contacts; the real one is dark.
    for (disc, at, dark) in
        [(plot.discs[0], contact, true), (plot.discs[1], virtual_contact, false)]
    {
        assert!(
            near(disc.centre, at, 0.25 + 1e-9) && !near(disc.centre, at, 0.25 - 1e-9),
            "{disc:?} {at:?}"
        );
        assert_eq!(disc.dark, dark);
    }
    for letter in ["A", "B", "C", "D"] {
        let plot = self::plot("fig1", letter);
        assert!(plot.equal_axes && plot.bare, "{letter}");
    }
}

/// Caption of Fig. 2: the pole, which solutions there are, and their strokes.
#[test]
fn fig2_shows_shapes_at_the_papers_pole() {
    for (letter, strokes) in [
        ("A", &[Stroke::Solid, Stroke::Dashed][..]),
        ("B", &[Stroke::Solid]),
        ("C", &[Stroke::Solid]),
        ("D", &[Stroke::Solid]),
    ] {
        let plot = plot("fig2", letter);
        assert!(plot.equal_axes && plot.inset.is_some(), "{letter}");
        assert_eq!(
            looks(&plot.lines),
            strokes.iter().map(|stroke| (Ink::Black, *stroke)).collect::<Vec<_>>()
        );
        let [pole] = plot.discs[..] else { panic!("{letter}") };
        // The paper gives two decimals, by which the distance of first touch and the direction do not quite agree.
        assert!(near(pole.centre, [15.13, 4.29], 0.01), "{letter}: {pole:?}");
        assert_eq!(pole.radius, 0.25);
        for line in &plot.lines {
            assert!(near(line.points[0], [0.0, 0.0], 1e-9), "{letter}");
            let away =
                line.points.iter().map(|at| (at[0] - pole.centre[0]).hypot(at[1] - pole.centre[1]));
            let nearest = away.fold(f64::INFINITY, f64::min);
            assert!((nearest - 0.25).abs() < 1e-6, "{letter}: {nearest}");
        }
    }
    let name = |letter: &str| plot("fig2", letter).lines[0].name.clone().unwrap();
    assert!(name("B").ends_with("15.60 deg") && name("D").ends_with("62.75 deg"));
    let tip = last(&plot("fig2", "D").lines[0]);
    assert!(near(tip, [15.13, 4.29], 0.26), "{tip:?}");
}
