//! Figures of courses: 4B, 5B, 6 and 7B.

use super::{figure, last, named_lines, near, plot};
use whiskmap::render::{Ink, Line};

/// The red line of Fig. 4B is in contact: the whisker slips off with its contact before the tip, the hair with its tip at the pole.
#[test]
fn fig4b_shows_the_last_frame_before_the_detachment() {
    for (letter, is_pulled_off) in [("B", false), ("C", true)] {
        let plot = plot("fig4b", letter);
        let [pole] = plot.discs[..] else {
            panic!("{letter}");
        };
        let away = |at: &[f64; 2]| (at[0] - pole.centre[0]).hypot(at[1] - pole.centre[1]);
        let nearest = |line: &Line| line.points.iter().map(away).fold(f64::INFINITY, f64::min);
        let [before] = named_lines(plot, "last frame before detachment")[..] else {
            panic!("{letter}");
        };
        let [after] = named_lines(plot, "next frame")[..] else {
            panic!("{letter}");
        };
        assert!((nearest(before) - pole.radius).abs() < 1e-6, "{letter}");
        // Beyond the pole the whisker is free.
        assert!(nearest(after) > 2.0 * pole.radius, "{letter}");
        // The hair is pulled off within the step of one frame, 0.6 degrees, so that its tip is within 0.3 mm of the contact.
        let from_tip = away(&last(before)) - pole.radius;
        assert_eq!(from_tip < 0.6, is_pulled_off, "{letter}: {from_tip}");
        for line in &plot.lines {
            assert!(near(line.points[0], [0.0; 2], 1e-9), "{letter}");
        }
    }
}

#[test]
fn fig5b_has_one_red_frame() {
    let plot = plot("fig5b", "B");
    assert_eq!(named_lines(plot, "last frame before detachment").len(), 1);
    assert!(plot.lines.len() > 10);
}

/// The cone slips on at 0.33 and 1.5 mm and the hair is caught, as in the paper. The caption says where the model differs.
#[test]
fn fig6_says_where_the_model_differs() {
    let fig6 = figure("fig6");
    let parts = |plot: usize, ink: Ink| {
        let lines = fig6.chart.plots[plot].lines.iter().filter(|line| line.ink == ink);
        let points = lines.flat_map(|line| &line.points).filter(|at| at[0].is_finite());
        points.count()
    };
    let red = Ink::Series(1);
    // Frames in red of 481 in the rows of panels C and F, after those of B and E: slipping or free frames are not.
    let cone: Vec<usize> = (4..8).map(|plot| parts(plot, red)).collect();
    let hair: Vec<usize> = (16..20).map(|plot| parts(plot, red)).collect();
    assert_eq!([cone[0], hair[0]], [0, 0]);
    assert!(hair[1..].iter().all(|stuck| *stuck > 460), "{hair:?}");
    assert!(cone[3] > 460, "{cone:?}");
    // The cone slips in more than a tenth of the frames, at 0.33 mm in most of them.
    assert!(cone[1] < 240 && (240..430).contains(&cone[2]), "{cone:?}");
    let caption = fig6.chart.caption.join(" ");
    assert!(
        caption.contains("no model for this") && caption.contains("At 4.5 mm the model differs")
    );
}

/// The errors of the curvature make both forces scatter around the true one. Without errors, `force` returns it (`tests/force.rs`).
#[test]
fn fig7b_scatters_around_the_true_force() {
    let plot = plot("fig7b", "B");
    let [lever] = named_lines(plot, "moment over lever")[..] else {
        panic!();
    };
    let [model] = named_lines(plot, "full model")[..] else {
        panic!();
    };
    let [truth] = named_lines(plot, "true force")[..] else {
        panic!();
    };
    for line in [lever, model] {
        let pairs = line.points.iter().zip(&truth.points);
        let misses: Vec<f64> = pairs
            .filter(|(point, _)| point[1].is_finite())
            .map(|(point, truth)| point[1] - truth[1])
            .collect();
        let rms = (misses.iter().map(|miss| miss * miss).sum::<f64>() / misses.len() as f64).sqrt();
        let mean = misses.iter().sum::<f64>() / misses.len() as f64;
        // Measured: root mean squares of 0.024 and 0.034 uN, means of -0.002 and -0.003 uN.
        assert!(misses.len() > 450 && rms < 0.05 && mean.abs() < 0.01, "{rms} {mean}");
        assert!(rms > 0.01, "{rms}");
    }
}
