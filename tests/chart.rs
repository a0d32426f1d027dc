//! Charts show the lines they are given, the same ones as PNG and as SVG. The frame and the lines are read from the SVG
//! document; the pixels must be there too.
#![allow(
    clippy::unwrap_used,
    reason = "a test that cannot set up its files should stop"
)]

mod drawn;

use drawn::{Picture, frame, line, polylines, single, well_formed};
use std::fs;
use std::path::Path;
use whiskmap::render::{self, Chart, ChartFormat, Disc, Dot, Ink, Line, Plot, Stroke};

const WHITE: [u8; 3] = [255; 3];
const BLACK: [u8; 3] = [0x22, 0x2b, 0x33];
const BLUE: [u8; 3] = [0x1c, 0x6c, 0xc4];
const BODY: [u8; 3] = [0xdc, 0xdd, 0xde];

/// A quarter of a circle of radius 100 in a thousand pieces.
fn arc() -> Vec<[f64; 2]> {
    let angle = |step: i32| f64::from(step) / 1000.0 * std::f64::consts::FRAC_PI_2;
    (0..=1000)
        .map(|step| [100.0 * angle(step).cos(), 100.0 * angle(step).sin()])
        .collect()
}

#[test]
fn a_line_is_where_its_numbers_are() {
    let corners = [[-20.0, 3.0], [30.0, 3.0], [80.0, 8.0]];
    let chart = single(Plot {
        lines: vec![line(&corners, Ink::Blue, Stroke::Solid)],
        ..Plot::default()
    });
    let (svg, picture) = (chart.svg().unwrap(), Picture::of(&chart));
    let [left, top, right, bottom] = frame(&svg);
    assert_eq!([right - left, bottom - top], [1280.0, 880.0]);
    // The data take 1 of 1.08 parts of the axes.
    let place = |x: f64, y: f64| {
        let across = ((x + 20.0) / 100.0 + 0.04) / 1.08;
        let up = ((y - 3.0) / 5.0 + 0.04) / 1.08;
        [left + 1280.0 * across, bottom - 880.0 * up]
    };
    for [x, y] in [
        [-20.0, 3.0],
        [5.0, 3.0],
        [40.0, 4.0],
        [60.0, 6.0],
        [80.0, 8.0],
    ] {
        let at = place(x, y);
        assert_eq!(picture.at(at), BLUE, "{x}, {y}");
        for away in [-7.0, 7.0] {
            assert_eq!(picture.at([at[0], at[1] + away]), WHITE, "{x}, {y}");
        }
    }
    let drawn = &polylines(&svg)[0].0;
    for (drawn, corner) in drawn.iter().zip(corners) {
        let expected = place(corner[0], corner[1]);
        let off = (drawn[0] - expected[0]).hypot(drawn[1] - expected[1]);
        assert!(off < 0.01, "{drawn:?} is not {expected:?}");
    }
}

#[test]
fn dashes_are_even_along_a_curve_and_solid_lines_have_none() {
    for stroke in [Stroke::Solid, Stroke::Dashed] {
        let chart = single(Plot {
            lines: vec![line(&arc(), Ink::Blue, stroke)],
            equal_axes: true,
            ..Plot::default()
        });
        let (svg, picture) = (chart.svg().unwrap(), Picture::of(&chart));
        let (points, dashed) = &polylines(&svg)[0];
        assert_eq!(*dashed, stroke == Stroke::Dashed);
        assert_eq!(points.len(), 1001);
        // A thousand points along some 1280 pixels: how many in a row are blue, how many white.
        let blue: Vec<bool> = points
            .iter()
            .map(|point| picture.at(*point)[0] < 0x8d)
            .collect();
        let runs: Vec<_> = blue.chunk_by(|one, next| one == next).collect();
        if stroke == Stroke::Solid {
            assert!(runs.len() == 1 && blue[0]);
            continue;
        }
        let pixels = std::f64::consts::FRAC_PI_2 * (880.0 / 1.08) / 1000.0;
        assert!((50..=130).contains(&runs.len()), "{} runs", runs.len());
        for run in &runs[1..runs.len() - 1] {
            let length = run.len() as f64 * pixels;
            // 14 on and 10 off; the round ends move 3 from the gap to the dash.
            let expected = if run[0] { 17.0 } else { 7.0 };
            assert!(
                (length - expected).abs() < 2.6,
                "{length} is not {expected}"
            );
        }
    }
}

#[test]
fn points_that_are_not_finite_break_a_line() {
    let points = [
        [0.0, 0.0],
        [1.0, 1.0],
        [f64::NAN, 1.0],
        [2.0, 0.0],
        [3.0, f64::INFINITY],
        [4.0, 1.0],
        [5.0, 0.0],
    ];
    let chart = single(Plot {
        lines: vec![line(&points, Ink::Blue, Stroke::Solid)],
        dots: vec![Dot {
            at: [f64::NAN, 0.0],
            ..Dot::default()
        }],
        ..Plot::default()
    });
    let svg = chart.svg().unwrap();
    let stretches = polylines(&svg);
    assert_eq!([stretches[0].0.len(), stretches[1].0.len()], [2, 2]);
    assert_eq!(svg.matches("<circle").count(), 1, "the point on its own");
    let [left, _, right, bottom] = frame(&svg);
    let across = left + (right - left) * (2.0 / 5.0 + 0.04) / 1.08;
    let alone = [across, bottom - 880.0 * 0.04 / 1.08];
    let picture = Picture::of(&chart);
    assert_eq!(picture.at(alone), BLUE);
    assert_eq!(picture.at([alone[0] + 20.0, alone[1]]), WHITE);
}

#[test]
fn dots_and_discs_are_drawn_and_axes_are_equal() {
    let chart = single(Plot {
        lines: vec![line(&[[0.0, 0.0], [10.0, 0.0]], Ink::Grey, Stroke::Solid)],
        dots: vec![Dot {
            at: [10.0, 0.0],
            ink: Ink::Black,
            name: None,
        }],
        discs: vec![
            Disc {
                centre: [4.0, 3.0],
                radius: 1.0,
            },
            Disc {
                centre: [8.0, 3.0],
                radius: 1e-9,
            },
        ],
        equal_axes: true,
        ..Plot::default()
    });
    let (svg, picture) = (chart.svg().unwrap(), Picture::of(&chart));
    let [left, top, _, bottom] = frame(&svg);
    let unit = 1280.0 / 10.8;
    let place = |x: f64, y: f64| {
        let middle = 0.5 * (top + bottom);
        [left + unit * (x + 0.4), middle - unit * (y - 2.0)]
    };
    assert_eq!(picture.at(place(10.0, 0.0)), BLACK);
    for angle in 0..12 {
        let (sine, cosine) = (f64::from(angle) * 0.5).sin_cos();
        let around = |radius: f64| picture.at(place(4.0 + radius * cosine, 3.0 + radius * sine));
        assert_eq!(
            [around(0.0), around(0.96), around(1.04)],
            [BODY, BODY, WHITE]
        );
        assert!(around(1.0)[0] < 0xa0, "the outline");
    }
    let [x, y] = place(8.0, 3.0);
    for away in [-3.0, 3.0] {
        assert!(picture.at([x + away, y])[0] < 0xb0, "the small disc");
    }
}

#[test]
fn the_legend_has_each_name_once_and_wraps() {
    let named = |name: &str, stroke: Stroke| Line {
        name: Some(name.to_owned()),
        ..line(&[[0.0, 0.0], [1.0, 1.0]], Ink::Black, stroke)
    };
    let plot = |names: &[&str]| Plot {
        lines: names
            .iter()
            .map(|name| named(name, Stroke::Dashed))
            .collect(),
        ..Plot::default()
    };
    let long = [
        "a long name that takes much room ",
        "another one of the same kind ",
        "stable",
    ]
    .map(|name| name.repeat(2));
    let names: Vec<&str> = long.iter().map(String::as_str).collect();
    let svg = |names: &[&str]| single(plot(names)).svg().unwrap();
    let twice = svg(&["stable", "unstable", "stable"]);
    assert_eq!(twice.matches(">stable<").count(), 1);
    assert_eq!(twice.matches(">unstable<").count(), 1);
    let lines = |names: &[&str]| (frame(&svg(names))[1] - frame(&svg(&[]))[1]) / 38.0;
    assert_eq!(lines(&["stable"]), 1.0);
    assert_eq!(lines(&names), 2.0);
    assert_eq!(lines(&[&"x".repeat(300)]), 1.0, "cut");
    assert!(!svg(&[&"x".repeat(300)]).contains(&"x".repeat(300)));
}

#[test]
fn a_document_is_well_formed_whatever_the_texts() {
    let text = "a<b & \"c\"> \u{2212}\u{7}";
    let chart = Chart {
        title: text.to_owned(),
        plots: vec![Plot {
            letter: Some(text[..3].to_owned()),
            title: text.to_owned(),
            x_label: text.to_owned(),
            y_label: text.to_owned(),
            lines: vec![Line {
                name: Some(text.to_owned()),
                ..line(&arc(), Ink::Grey, Stroke::Dashed)
            }],
            dots: vec![Dot::default()],
            discs: vec![Disc::default()],
            equal_axes: false,
        }],
        columns: 3,
    };
    let svg = chart.svg().unwrap();
    assert!(well_formed(&svg), "{svg}");
    let shown = "a&lt;b &amp; &quot;c&quot;&gt; \u{2212}\u{fffd}</text>";
    assert_eq!(svg.matches(shown).count(), 5);
    for damage in ["</text>", "</svg>", "amp;", "/>"] {
        assert!(
            !well_formed(&svg.replacen(damage, "", 1)),
            "without {damage}"
        );
    }
    let numbers = svg
        .split(['"', ' ', ','])
        .filter(|part| part.parse::<f64>().is_ok());
    for number in numbers {
        let decimals = number
            .split_once('.')
            .map_or(0, |(_, decimals)| decimals.len());
        assert!(decimals <= 2 && number != "-0", "{number}");
    }
}

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
    ];
    let mut plots = vec![Plot::default()];
    for equal_axes in [false, true] {
        for (one, other) in values
            .iter()
            .flat_map(|one| values.map(|other| (*one, other)))
        {
            plots.push(Plot {
                lines: vec![
                    line(&[], Ink::Black, Stroke::Dashed),
                    line(&[[one, other]], Ink::Blue, Stroke::Dashed),
                    line(
                        &[[one, one], [other, other], [one, one]],
                        Ink::Grey,
                        Stroke::Dashed,
                    ),
                ],
                dots: vec![Dot {
                    at: [other, one],
                    ..Dot::default()
                }],
                discs: vec![Disc {
                    centre: [one, one],
                    radius: other,
                }],
                equal_axes,
                ..Plot::default()
            });
        }
    }
    for plot in plots {
        let svg = single(plot.clone()).svg().unwrap();
        assert!(
            well_formed(&svg) && !svg.contains("NaN") && !svg.contains("inf"),
            "{plot:?}"
        );
        let [left, top, right, bottom] = frame(&svg);
        let places = polylines(&svg).into_iter().flat_map(|(points, _)| points);
        for [x, y] in places {
            assert!(
                x >= left - 9.0 && x <= right && y >= top && y <= bottom + 9.0,
                "{plot:?}"
            );
        }
    }
    for plots in [0, 1, 3] {
        let plots = vec![Plot::default(); plots];
        let (title, columns) = (String::new(), 0);
        assert!(
            Picture::of(&Chart {
                title,
                plots,
                columns
            })
            .width
                > 500
        );
    }
}

#[test]
fn plots_stand_in_rows() {
    let plot = |letter: char| Plot {
        letter: Some(letter.to_string()),
        lines: vec![line(&[[0.0, 0.0], [1.0, 1.0]], Ink::Black, Stroke::Solid)],
        ..Plot::default()
    };
    let chart = Chart {
        title: "eight".to_owned(),
        plots: ('A'..='H').map(plot).collect(),
        columns: 2,
    };
    let (svg, picture) = (chart.svg().unwrap(), Picture::of(&chart));
    let size = format!("width=\"{}\" height=\"{}\"", picture.width, picture.height);
    assert!(svg.contains(&size), "{size}");
    let lines = polylines(&svg)
        .into_iter()
        .filter(|(points, _)| points.len() == 5);
    let frames: Vec<[f64; 2]> = lines.map(|(points, _)| points[0]).collect();
    assert_eq!(frames.len(), 8);
    for (place, frame) in frames.iter().enumerate() {
        let (column, row) = (place % 2, place / 2);
        assert_eq!(*frame, [frames[column][0], frames[2 * row][1]]);
    }
    assert!(frames[1][0] - frames[0][0] > 760.0 && frames[2][1] - frames[0][1] > 520.0);
}

#[test]
fn equal_charts_give_equal_bytes() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["chart.png", "chart.SVG"] {
        let bytes = [0, 1].map(|_| {
            let chart = single(Plot {
                lines: vec![line(&arc(), Ink::Blue, Stroke::Dashed)],
                title: "arc".to_owned(),
                ..Plot::default()
            });
            let path = folder.path().join(name);
            chart.save(&path, ChartFormat::of(&path).unwrap()).unwrap();
            fs::read(path).unwrap()
        });
        assert!(bytes[0] == bytes[1] && bytes[0].len() > 1000, "{name}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    for (name, format) in [
        ("a/b.Png", Some(ChartFormat::Png)),
        ("c.svg.exr", None),
        ("svg", None),
    ] {
        assert_eq!(ChartFormat::of(Path::new(name)), format);
    }
}

#[test]
fn errors_leave_no_chart() {
    let folder = tempfile::tempdir().unwrap();
    for (name, format) in [
        ("chart.png", ChartFormat::Png),
        ("chart.svg", ChartFormat::Svg),
    ] {
        let nowhere = folder.path().join("no such folder").join(name);
        let error = single(Plot::default()).save(&nowhere, format).unwrap_err();
        assert!(matches!(error, render::Error::Write { .. }), "{error}");
        // A folder in the way: the temporary file must go.
        let taken = folder.path().join(name);
        fs::create_dir(&taken).unwrap();
        let error = single(Plot::default()).save(&taken, format).unwrap_err();
        assert!(matches!(error, render::Error::Write { .. }), "{error}");
        fs::remove_dir(&taken).unwrap();
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}
