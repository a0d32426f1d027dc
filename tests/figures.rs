//! The paper's figures, panel by panel: what each shows, on which axes, with which lines, colours and circles.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use whiskmap::measured::Point;
use whiskmap::paper::{Figure, Measurements, figures};
use whiskmap::render::{Dot, Ink, Line, Plot, Stroke};
use whiskmap::rod::Side;
use whiskmap::trace::DetachmentKind;

fn figure(name: &str, measured: &Measurements) -> Figure {
    let all = figures(measured).unwrap();
    all.into_iter().find(|figure| figure.name == name).unwrap()
}

/// The plots of a figure by their letters.
fn plot(name: &str, letter: &str) -> Plot {
    let figure = figure(name, &Measurements::default());
    let mut plots = figure.chart.plots.into_iter();
    plots
        .find(|plot| plot.letter.as_deref() == Some(letter))
        .unwrap()
}

fn named<'a>(dots: &'a [Dot], name: &str) -> Vec<&'a Dot> {
    let has_name = |dot: &&Dot| dot.name.as_deref() == Some(name);
    dots.iter().filter(has_name).collect()
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
    let all = figures(&Measurements::default()).unwrap();
    let letters = |figure: &Figure| -> String {
        let letters = figure
            .chart
            .plots
            .iter()
            .map(|plot| plot.letter.clone().unwrap());
        letters.collect()
    };
    let shown: Vec<_> = all
        .iter()
        .map(|figure| (figure.name, letters(figure), figure.tables.len()))
        .collect();
    let expected = [
        ("fig1", "ABCD", 4),
        ("fig2", "ABCD", 4),
        ("fig3", "AFBGCHDIEJ", 10),
        ("fig4d", "D", 1),
        ("fig5c", "C", 2),
    ];
    assert_eq!(
        shown,
        expected.map(|(name, letters, tables)| (name, letters.to_owned(), tables))
    );
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
        [
            (Ink::Grey, Stroke::Solid),
            (Ink::Grey, Stroke::Dashed),
            (Ink::Black, Stroke::Solid)
        ]
    );
    // Real and virtual pole touch their whiskers at their contacts; the real one is dark.
    for (disc, at, dark) in [
        (plot.discs[0], contact, true),
        (plot.discs[1], virtual_contact, false),
    ] {
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
            strokes
                .iter()
                .map(|stroke| (Ink::Black, *stroke))
                .collect::<Vec<_>>()
        );
        let [pole] = plot.discs[..] else {
            panic!("{letter}")
        };
        // The paper gives two decimals, by which the distance of first touch and the direction do not quite agree.
        assert!(near(pole.centre, [15.13, 4.29], 0.01), "{letter}: {pole:?}");
        assert_eq!(pole.radius, 0.25);
        for line in &plot.lines {
            assert!(near(line.points[0], [0.0, 0.0], 1e-9), "{letter}");
            let away = line
                .points
                .iter()
                .map(|at| (at[0] - pole.centre[0]).hypot(at[1] - pole.centre[1]));
            let nearest = away.fold(f64::INFINITY, f64::min);
            assert!((nearest - 0.25).abs() < 1e-6, "{letter}: {nearest}");
        }
    }
    let name = |letter: &str| plot("fig2", letter).lines[0].name.clone().unwrap();
    assert!(name("B").ends_with("15.60 deg") && name("D").ends_with("62.75 deg"));
    let tip = last(&plot("fig2", "D").lines[0]);
    assert!(near(tip, [15.13, 4.29], 0.26), "{tip:?}");
}

/// Caption of Fig. 3: circles, strokes, sides and the two poles of the cylinder.
#[test]
fn fig3_has_bifurcation_diagrams() {
    for (letter, touch, slip_offs) in [
        // The slope of the paper's parabola at x = 15 mm is 0.6.
        ("B", 0.6_f64.atan().to_degrees(), [-38.0, 90.0]),
        ("C", 0.0, [2.96, 1.29]),
        ("D", 15.86, [16.33, 17.43]),
    ] {
        let plot = plot("fig3", letter);
        let looks = looks(&plot.lines);
        assert_eq!(
            looks,
            [(Ink::Black, Stroke::Solid), (Ink::Black, Stroke::Dashed)].repeat(2),
            "{letter}"
        );
        assert!(
            plot.lines[..2]
                .iter()
                .all(|line| line.points.iter().all(|at| at[0] <= 0.0)),
            "CF is left"
        );
        assert!(
            plot.lines[2..]
                .iter()
                .all(|line| line.points.iter().all(|at| at[0] >= 0.0)),
            "CB is right"
        );
        let first = named(&plot.dots, "first touch");
        assert!(
            first
                .iter()
                .all(|dot| dot.open && near(dot.at, [0.0, touch], 0.2)),
            "{letter}: {first:?}"
        );
        let folds = named(&plot.dots, "slip-off");
        for (fold, (push, value)) in folds.iter().zip([-24.92, 15.60].into_iter().zip(slip_offs)) {
            assert!(
                !fold.open && near(fold.at, [push, value], 0.7),
                "{letter}: {fold:?}"
            );
        }
        assert_eq!([first.len(), folds.len(), plot.dots.len()], [2, 2, 4]);
    }
    for letter in ["G", "H", "I"] {
        let plot = plot("fig3", letter);
        let blue: Vec<_> = plot
            .lines
            .iter()
            .filter(|line| line.ink == Ink::Blue)
            .collect();
        assert!(blue.len() == 2 && blue.iter().all(|line| line.stroke == Stroke::Solid));
        let (slip_offs, pull_offs) = (named(&plot.dots, "slip-off"), named(&plot.dots, "pull-off"));
        assert!(slip_offs.len() == 2 && slip_offs.iter().all(|dot| dot.ink == Ink::Black));
        for (dot, line) in pull_offs.iter().zip(&blue) {
            assert_eq!((dot.ink, dot.at), (Ink::Blue, last(line)), "{letter}");
        }
        assert_eq!(
            [pull_offs.len(), named(&plot.dots, "first touch").len()],
            [2, 4]
        );
    }
    let ends: Vec<_> = named(&plot("fig3", "I").dots, "pull-off")
        .iter()
        .map(|dot| dot.at[1])
        .collect();
    assert!(
        ends.iter().all(|s_obj| (s_obj - 20.0).abs() < 1e-6),
        "{ends:?}"
    );
}

#[test]
fn letters_in_fig3_point_to_the_states_of_fig2() {
    for (letter, states) in [
        ("D", [("a", 10.0), ("b", 15.59975)]),
        ("I", [("c", 10.0), ("d", 62.7532)]),
    ] {
        let plot = plot("fig3", letter);
        for (note, (text, push)) in plot.notes.iter().zip(states) {
            let to = note.to.unwrap();
            assert!(note.text == text && (to[0] - push).abs() < 1e-4, "{note:?}");
            // Points are half a degree apart.
            let stable = plot
                .lines
                .iter()
                .filter(|line| line.stroke == Stroke::Solid);
            let mut places = stable.flat_map(|line| line.points.iter());
            assert!(places.any(|at| near(*at, to, 1.0)), "{note:?}");
        }
        assert_eq!(plot.notes.len(), 2);
    }
}

/// Captions of Figs. 3E, 3J, 4D and 5C: the push angle across, the distance upwards, black slip-off, blue pull-off, and
/// dashes for what is no whisker. The region is closed where the tip touches first.
#[test]
fn detachment_curves_enclose_the_stable_region() {
    let panels = [
        ("fig3", "E", 1),
        ("fig3", "J", 1),
        ("fig4d", "D", 2),
        ("fig5c", "C", 2),
        ("fig5c", "", 2),
    ];
    for (name, letter, whiskers) in panels {
        let plot = plot(name, letter);
        assert!(
            plot.x_label.starts_with("push angle") && plot.y_label.starts_with("object distance")
        );
        let strokes = [Stroke::Solid, Stroke::Dashed];
        for stroke in &strokes[..whiskers] {
            let lines = || plot.lines.iter().filter(|line| line.stroke == *stroke);
            for (ink, kind) in [(Ink::Black, "slip-off"), (Ink::Blue, "pull-off")] {
                let mut of_kind = lines().filter(|line| line.ink == ink);
                assert!(of_kind.all(|line| line.name.as_deref().unwrap().ends_with(kind)));
            }
            let top = lines().find(|line| line.ink == Ink::Grey).unwrap();
            let meets =
                |at: [f64; 2]| lines().any(|line| line.ink != Ink::Grey && last(line) == at);
            assert!(
                top.points.len() == 2 && top.points.iter().all(|at| meets(*at)),
                "{name} {letter}: {top:?}"
            );
            // From the tip, a CB push leads nowhere, but where the thin end straightens first.
            assert!(
                (0.0..1.0).contains(&top.points[1][0]),
                "{name} {letter}: {top:?}"
            );
        }
        let has_dashes = plot.lines.iter().any(|line| line.stroke == Stroke::Dashed);
        assert_eq!(has_dashes, whiskers == 2);
    }
}

#[test]
fn measured_ends_are_circles_over_the_theory() {
    let end = |angle_deg, kind| Point {
        line: 1,
        side: Side::of_push(angle_deg),
        distance_mm: 9.0,
        angle_deg,
        kind: Some(kind),
        sd_deg: 1.0,
    };
    let both = vec![
        end(20.0, DetachmentKind::SlipOff),
        end(-90.0, DetachmentKind::PullOff),
    ];
    let measured = Measurements {
        fig4d: both.clone(),
        fig5c_left: both,
        fig5c_right: Vec::new(),
    };
    let dots = |name: &str, place: usize| {
        let figure = figure(name, &measured);
        let dots = figure.chart.plots[place].dots.iter();
        dots.map(|dot| (dot.at, dot.ink, dot.open))
            .collect::<Vec<_>>()
    };
    let shown = |is_open| {
        [
            ([20.0, 9.0], Ink::Black, true),
            ([-90.0, 9.0], Ink::Blue, is_open),
        ]
    };
    assert_eq!(dots("fig4d", 0), shown(false));
    assert_eq!(dots("fig5c", 0), shown(true));
    assert_eq!(dots("fig5c", 1), []);
}
