//! Insets, notes, open dots and drawings without axes.

use crate::drawn::{frame, line, polylines, single, svg, well_formed};
use crate::{BLACK, BLUE, WHITE, both};
use whiskmap_plot::{Disc, Dot, Ink, Inset, Note, PictureSize, Plot, Stroke};

const DIAGONAL: [[f64; 2]; 2] = [[0.0, 0.0], [20.0, 10.0]];

/// A line and a disc, and the square around (10, 5) with sides of 2 enlarged.
fn enlarged() -> Plot {
    Plot {
        lines: vec![line(&DIAGONAL, Ink::Blue, Stroke::Solid)],
        discs: vec![
            Disc { centre: [10.5, 4.5], radius: 0.25, dark: false },
            Disc { centre: [9.0, 5.0], radius: 0.25, dark: false },
        ],
        inset: Some(Inset {
            centre: [10.0, 5.0],
            half: 1.0,
            place: [0.25, 0.75],
            ..Inset::default()
        }),
        equal_axes: true,
        ..Plot::default()
    }
}

/// The SVG document of [`enlarged`] without the inset.
fn plain() -> String {
    let plot = Plot { inset: None, ..enlarged() };
    svg(&single(plot).picture(PictureSize::Natural).unwrap())
}

#[test]
fn an_inset_shows_its_square_larger_and_nothing_beyond() {
    let chart = single(enlarged());
    let (svg, picture) = both(&chart);
    let [left, top, ..] = frame(&plain());
    // Half the height of the body; a quarter of the body from the left and from above.
    let (side, middle) = (440.0, [left + 320.0, top + 220.0]);
    let place = |x: f64, y: f64| {
        let scale = 0.5 * side;
        [middle[0] + scale * (x - 10.0), middle[1] - scale * (y - 5.0)]
    };
    let near = |one: [f64; 2], other: [f64; 2]| (one[0] - other[0]).hypot(one[1] - other[1]) < 0.02;
    let lines = polylines(&svg);
    let whole =
        lines.iter().filter(|(points, _)| points.len() == 2 && near(points[0], place(9.0, 4.5)));
    let clipped: Vec<_> = whole.collect();
    assert_eq!(clipped.len(), 1, "{lines:?}");
    assert!(near(clipped[0].0[1], place(11.0, 5.5)), "{clipped:?}");
    assert_eq!(picture.at(place(10.4, 5.2)), BLUE);
    for beyond in [[8.9, 4.45], [11.1, 5.55]] {
        assert_eq!(picture.at(place(beyond[0], beyond[1])), WHITE);
    }
    // The disc inside is there twice, the one on the square's edge once.
    let circles: Vec<&str> = svg.lines().filter(|line| line.starts_with("<circle")).collect();
    assert_eq!(circles.len(), 3, "{circles:?}");
    let radius = format!("r=\"{}\"", 0.25 * 0.5 * side);
    assert!(circles.iter().any(|circle| circle.contains(&radius)), "{circles:?}");
}

#[test]
fn an_inset_without_room_is_left_out() {
    for (centre, half) in [
        ([10.0, 5.0], 0.0),
        ([10.0, 5.0], -1.0),
        ([10.0, 5.0], f64::NAN),
        ([10.0, 5.0], f64::INFINITY),
        ([f64::NAN, 5.0], 1.0),
        ([1e12, 5.0], 1e-12),
    ] {
        let inset = Some(Inset { centre, half, ..Inset::default() });
        let svg = svg(&single(Plot { inset, ..enlarged() }).picture(PictureSize::Natural).unwrap());
        assert_eq!(svg, plain(), "{centre:?} {half}");
    }
}

#[test]
fn notes_stand_above_their_point_or_behind_their_arrow() {
    let note = |text: &str, to| Note { at: [10.0, 5.0], text: text.to_owned(), to, ink: Ink::Blue };
    let document = |note: Note| {
        svg(&single(Plot { notes: vec![note], inset: None, ..enlarged() })
            .picture(PictureSize::Natural)
            .unwrap())
    };
    let place = |svg: &str, text: &str| {
        let tag = svg.lines().find(|line| line.ends_with(&format!(">{text}</text>"))).unwrap();
        let quoted: Vec<&str> = tag.split('"').collect();
        [1, 3].map(|value| quoted[value].parse::<f64>().unwrap())
    };
    let alone = document(note("a", None));
    let [left, top, right, bottom] = frame(&alone);
    let point = [0.5 * (left + right), 0.5 * (top + bottom)];
    let above = place(&alone, "a");
    assert!((above[0] - point[0]).abs() < 0.02 && above[1] < point[1] - 8.0, "{above:?}");
    // An arrow upwards: the text is below, and the arrow has two strokes at its head.
    let up = document(note("a", Some([10.0, 8.0])));
    assert!(place(&up, "a")[1] > point[1] + 8.0);
    let added = polylines(&up).len() - polylines(&alone).len();
    assert_eq!(added, 2);
    let head = polylines(&up).into_iter().find(|(points, _)| points.len() == 3).unwrap().0;
    assert!(head[0][1] > head[1][1] && head[2][1] > head[1][1] && head[1][1] < point[1] - 50.0);
    // What cannot be placed is not drawn.
    let nowhere = document(Note { at: [f64::NAN, 0.0], ..note("a", None) });
    assert!(!nowhere.contains(">a<") && well_formed(&nowhere));
}

#[test]
fn an_open_dot_is_a_rim_and_so_it_is_in_the_legend() {
    let chart = single(Plot {
        lines: vec![line(&DIAGONAL, Ink::Blue, Stroke::Solid)],
        dots: vec![Dot {
            at: [10.0, 5.0],
            open: true,
            name: Some("first touch".to_owned()),
            ..Dot::default()
        }],
        ..Plot::default()
    });
    let (svg, picture) = both(&chart);
    let circles: Vec<[f64; 3]> = svg
        .lines()
        .filter(|line| line.starts_with("<circle"))
        .map(|tag| {
            let quoted: Vec<&str> = tag.split('"').collect();
            [1, 3, 5].map(|value| quoted[value].parse().unwrap())
        })
        .collect();
    assert_eq!(circles.len(), 2, "the dot and the legend");
    for [x, y, radius] in circles {
        assert_eq!([picture.at([x, y]), picture.at([x + radius, y])], [WHITE, BLACK]);
    }
}

#[test]
fn a_drawing_has_no_axes_and_a_caption_is_below_the_title() {
    let mut chart = single(Plot { bare: true, x_label: "across".to_owned(), ..enlarged() });
    let bare = svg(&chart.picture(PictureSize::Natural).unwrap());
    chart.plots[0].bare = false;
    let framed = svg(&chart.picture(PictureSize::Natural).unwrap());
    assert!(framed.contains(">across<") && !bare.contains(">across<"));
    assert!(!bare.contains(">10<") && framed.contains(">10<"));
    chart.title = "title".to_owned();
    let titled = frame(&svg(&chart.picture(PictureSize::Natural).unwrap()))[1];
    chart.caption = vec!["one line".to_owned(), "another".to_owned()];
    let captioned = svg(&chart.picture(PictureSize::Natural).unwrap());
    assert!(captioned.contains(">one line<") && captioned.contains(">another<"));
    assert_eq!(frame(&captioned)[1] - titled, 2.0 * 28.0);
}
