//! Fig. 3: bifurcation diagrams, and the states of Fig. 2 in them.

use super::{last, looks, named, near, plot};
use whiskmap::render::{Ink, Stroke};

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
            plot.lines[..2].iter().all(|line| line.points.iter().all(|at| at[0] <= 0.0)),
            "CF is left"
        );
        assert!(
            plot.lines[2..].iter().all(|line| line.points.iter().all(|at| at[0] >= 0.0)),
            "CB is right"
        );
        let first = named(&plot.dots, "first touch");
        assert!(
            first.iter().all(|dot| dot.open && near(dot.at, [0.0, touch], 0.2)),
            "{letter}: {first:?}"
        );
        let folds = named(&plot.dots, "slip-off");
        for (fold, (push, value)) in folds.iter().zip([-24.92, 15.60].into_iter().zip(slip_offs)) {
            assert!(!fold.open && near(fold.at, [push, value], 0.7), "{letter}: {fold:?}");
        }
        assert_eq!([first.len(), folds.len(), plot.dots.len()], [2, 2, 4]);
    }
    for letter in ["G", "H", "I"] {
        let plot = plot("fig3", letter);
        let blue: Vec<_> = plot.lines.iter().filter(|line| line.ink == Ink::Blue).collect();
        assert!(blue.len() == 2 && blue.iter().all(|line| line.stroke == Stroke::Solid));
        let (slip_offs, pull_offs) = (named(&plot.dots, "slip-off"), named(&plot.dots, "pull-off"));
        assert!(slip_offs.len() == 2 && slip_offs.iter().all(|dot| dot.ink == Ink::Black));
        for (dot, line) in pull_offs.iter().zip(&blue) {
            assert_eq!((dot.ink, dot.at), (Ink::Blue, last(line)), "{letter}");
        }
        assert_eq!([pull_offs.len(), named(&plot.dots, "first touch").len()], [2, 4]);
    }
    let ends: Vec<_> =
        named(&plot("fig3", "I").dots, "pull-off").iter().map(|dot| dot.at[1]).collect();
    assert!(ends.iter().all(|s_obj| (s_obj - 20.0).abs() < 1e-6), "{ends:?}");
}

#[test]
fn letters_in_fig3_point_to_the_states_of_fig2() {
    for (letter, states) in
        [("D", [("a", 10.0), ("b", 15.59975)]), ("I", [("c", 10.0), ("d", 62.7532)])]
    {
        let plot = plot("fig3", letter);
        for (note, (text, push)) in plot.notes.iter().zip(states) {
            let to = note.to.unwrap();
            assert!(note.text == text && (to[0] - push).abs() < 1e-4, "{note:?}");
            // Points are half a degree apart.
            let stable = plot.lines.iter().filter(|line| line.stroke == Stroke::Solid);
            let mut places = stable.flat_map(|line| line.points.iter());
            assert!(places.any(|at| near(*at, to, 1.0)), "{note:?}");
        }
        assert_eq!(plot.notes.len(), 2);
    }
}
