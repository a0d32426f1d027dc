//! Axes: their units and ranges, whatever the data.

use crate::drawn::{Pixels, frame, line, polylines, single, svg, well_formed};
use whiskmap_plot::{Chart, Disc, Dot, Ink, Note, PictureSize, Plot, Stroke};

#[test]
fn degenerate_data_give_pictures_without_nan() {
    let values = [
        0.0,
        -7.5,
        1e-320,
        1e-12,
        1e12,
        f64::MAX,
        f64::MIN_POSITIVE,
        f64::NAN,
        f64::NEG_INFINITY,
        1.0,
        1.0 + 1e-15,
        1e-295,
        1e300,
        -1e300,
    ];
    let mut plots = vec![Plot::default()];
    let kinds = [(false, false), (true, false), (false, true), (true, true)];
    for (equal_axes, logarithmic) in kinds {
        for (one, other) in values.iter().flat_map(|one| values.map(|other| (*one, other))) {
            plots.push(Plot {
                lines: vec![
                    line(&[], Ink::Black, Stroke::Dashed),
                    line(&[[one, other]], Ink::Blue, Stroke::Dashed),
                    line(&[[one, one], [other, other], [one, one]], Ink::Grey, Stroke::Dashed),
                ],
                dots: vec![Dot { at: [other, one], ..Dot::default() }],
                discs: vec![Disc { centre: [one, one], radius: other, dark: false }],
                notes: vec![Note {
                    at: [one, other],
                    to: Some([other, other]),
                    text: "note".to_owned(),
                    ..Note::default()
                }],
                equal_axes,
                logarithmic: [logarithmic; 2],
                ..Plot::default()
            });
        }
    }
    for plot in plots {
        let svg = svg(&single(plot.clone()).picture(PictureSize::Natural).unwrap());
        assert!(well_formed(&svg) && !svg.contains("NaN") && !svg.contains("inf"), "{plot:?}");
        let [left, top, right, bottom] = frame(&svg);
        let places = polylines(&svg).into_iter().flat_map(|(points, _)| points);
        for [x, y] in places {
            assert!(x >= left - 9.0 && x <= right && y >= top && y <= bottom + 9.0, "{plot:?}");
        }
    }
    for plots in [0, 1, 3] {
        let plots = vec![Plot::default(); plots];
        let (title, columns) = (String::new(), 0);
        assert!(
            Pixels::of(
                &Chart { title, plots, columns, ..Chart::default() }
                    .picture(PictureSize::Natural)
                    .unwrap()
            )
            .width
                > 500
        );
    }
}

#[test]
fn axes_choose_the_unit_that_suits_their_numbers() {
    let chart = |points: &[[f64; 2]], equal_axes: bool| {
        svg(&single(Plot {
            x_label: "x (mm)".to_owned(),
            y_label: "force (\u{b5}N)".to_owned(),
            lines: vec![line(points, Ink::Black, Stroke::Solid)],
            equal_axes,
            ..Plot::default()
        })
        .picture(PictureSize::Natural)
        .unwrap())
    };
    let large = chart(&[[0.0, 0.0], [2000.0, 4e7]], false);
    for text in [">x (m)<", ">force (N)<", ">2.0<", ">40<"] {
        assert!(large.contains(text), "{text}");
    }
    let usual = chart(&[[0.0, 0.0], [20.0, 400.0]], false);
    for text in [">x (mm)<", ">force (\u{b5}N)<", ">400<"] {
        assert!(usual.contains(text), "{text}");
    }
    // A whisker that is hardly bent: both axes stay in millimetres.
    let equal = chart(&[[0.0, 0.0], [20.0, 0.01]], true);
    assert!(equal.contains(">x (mm)<") && equal.contains(">force (\u{b5}N)<"));
}

#[test]
fn a_large_disc_widens_both_axes() {
    let chart = |radius: f64| {
        single(Plot {
            lines: vec![line(&[[0.0, 0.0], [100.0, 0.0]], Ink::Black, Stroke::Solid)],
            discs: vec![Disc { centre: [50.0, 30.0], radius, dark: false }],
            equal_axes: true,
            ..Plot::default()
        })
    };
    for (radius, unit) in [(20.0, 1280.0 / 108.0), (70.0, 880.0 / 151.2)] {
        let svg = svg(&chart(radius).picture(PictureSize::Natural).unwrap());
        let points = &polylines(&svg)[0].0;
        assert!((points[1][0] - points[0][0] - 100.0 * unit).abs() < 0.02);
    }
}

#[test]
fn logarithmic_axes_are_labelled_with_the_numbers_themselves() {
    let points = [[0.1, 1e-8], [1.0, 1e-5], [10.0, 1e-2]];
    let plot = |points: &[[f64; 2]]| Plot {
        x_label: "time (mm)".to_owned(),
        lines: vec![line(points, Ink::Black, Stroke::Solid)],
        logarithmic: [true; 2],
        ..Plot::default()
    };
    let document = svg(&single(plot(&points)).picture(PictureSize::Natural).unwrap());
    for text in ["0.1", "1", "10", "1e\u{2212}8", "1e\u{2212}5", "0.01"] {
        assert!(document.contains(&format!(">{text}<")), "{text}");
    }
    // The middle of the axis is 1 mm.
    assert!(document.contains(">time (mm)<"));
    let places = |svg: &str| polylines(svg)[0].0.clone();
    let [left, middle, right] = places(&document)[..] else {
        panic!("{document}");
    };
    for axis in [0, 1] {
        // Places have two decimals.
        let off = left[axis] + right[axis] - 2.0 * middle[axis];
        assert!(off.abs() < 0.03, "{off}");
    }
    // Numbers without a logarithm, and what has a size, are not there.
    let mut more = plot(&[points[0], points[1], points[2], [0.0, 1.0], [-1.0, 1e300]]);
    more.discs = vec![Disc { centre: [1e9, 1.0], radius: 1e8, dark: true }];
    more.dots = vec![Dot { at: [1.0, -1.0], ..Dot::default() }];
    assert_eq!(svg(&single(more).picture(PictureSize::Natural).unwrap()), document);
}

/// Moments from 1e4 to 1e9 nN m are shown in mN m, as their middle is 3 mN m.
#[test]
fn logarithmic_axes_have_the_unit_of_their_middle() {
    let document = svg(&single(Plot {
        y_label: "moment (nN m)".to_owned(),
        lines: vec![line(&[[1.0, 1e4], [2.0, 1e9]], Ink::Black, Stroke::Solid)],
        logarithmic: [false, true],
        ..Plot::default()
    })
    .picture(PictureSize::Natural)
    .unwrap());
    for text in ["moment (mN m)", "0.01", "0.1", "1", "10", "100", "1000"] {
        assert!(document.contains(&format!(">{text}<")), "{text}: {document}");
    }
    assert_eq!(whiskmap_plot::readable_value(2e7, "nN m"), (20.0, "mN m".to_owned()));
    assert_eq!(whiskmap_plot::readable_value(-2.0, "deg"), (-2.0, "deg".to_owned()));
}

/// Powers of ten where there are some, and never two labels on each other.
#[test]
fn logarithmic_axes_have_ticks_whatever_they_span() {
    for (from, to) in [(1.0, 1.0), (0.15, 5.4), (6.1, 6.9), (3e-12, 2e-5), (1e-280, 1e280)] {
        let svg = svg(&single(Plot {
            lines: vec![line(&[[from, from], [to, to]], Ink::Black, Stroke::Solid)],
            logarithmic: [true; 2],
            ..Plot::default()
        })
        .picture(PictureSize::Natural)
        .unwrap());
        let labels = svg.matches("<text").count();
        assert!((6..=30).contains(&labels), "{from} {to}: {labels}");
    }
}
