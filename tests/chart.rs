//! Charts show the lines they are given, the same ones as PNG and as SVG. The frame and the lines are read from the SVG
//! document; the pixels must be there too.
#![allow(
    clippy::unwrap_used,
    reason = "a test that cannot set up its files should stop"
)]

mod drawn;

use drawn::{Pixels, frame, line, polylines, single, svg, well_formed};
use std::fs;
use std::path::Path;
use whiskmap::render::{self, Chart, Disc, Dot, Format, Ink, Line, Plot, Stroke};

const WHITE: [u8; 3] = [255; 3];
const BLACK: [u8; 3] = [0x22, 0x2b, 0x33];
const BLUE: [u8; 3] = [0x1c, 0x6c, 0xc4];
const BODY: [u8; 3] = [0xdc, 0xdd, 0xde];

/// A chart as SVG and as pixels.
fn both(chart: &Chart) -> (String, Pixels) {
    (svg(&chart.picture()), Pixels::of(&chart.picture()))
}

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
    let (svg, picture) = both(&chart);
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
        let (svg, picture) = both(&chart);
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
    let svg = svg(&chart.picture());
    let stretches = polylines(&svg);
    assert_eq!([stretches[0].0.len(), stretches[1].0.len()], [2, 2]);
    assert_eq!(svg.matches("<circle").count(), 1, "the point on its own");
    let [left, _, right, bottom] = frame(&svg);
    let across = left + (right - left) * (2.0 / 5.0 + 0.04) / 1.08;
    let alone = [across, bottom - 880.0 * 0.04 / 1.08];
    let picture = Pixels::of(&chart.picture());
    for away in [-4.0, 0.0, 4.0] {
        assert_eq!(picture.at([alone[0] + away, alone[1]]), BLUE);
    }
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
    let (svg, picture) = both(&chart);
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
    let svg = |names: &[&str]| drawn::svg(&single(plot(names)).picture());
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
    let text = "a<b & \"c\"> \u{2212}\u{7}\u{fffe}";
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
    let svg = svg(&chart.picture());
    assert!(well_formed(&svg), "{svg}");
    let shown = "a&lt;b &amp; &quot;c&quot;&gt; \u{2212} \u{fffd}</text>";
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
        1.0,
        1.0 + 1e-15,
        1e-295,
        1e300,
        -1e300,
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
        let svg = svg(&single(plot.clone()).picture());
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
            Pixels::of(
                &Chart {
                    title,
                    plots,
                    columns
                }
                .picture()
            )
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
    let (svg, picture) = both(&chart);
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
            let format = Format::of(&path).unwrap();
            chart.picture().save(&path, format).unwrap();
            fs::read(path).unwrap()
        });
        assert!(bytes[0] == bytes[1] && bytes[0].len() > 1000, "{name}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    for (name, format) in [
        ("a/b.Png", Some(Format::Png)),
        ("c.svg.exr", None),
        ("svg", None),
    ] {
        assert_eq!(Format::of(Path::new(name)), format);
    }
}

#[test]
fn errors_leave_no_chart() {
    let folder = tempfile::tempdir().unwrap();
    for (name, format) in [("chart.png", Format::Png), ("chart.svg", Format::Svg)] {
        let nowhere = folder.path().join("no such folder").join(name);
        let error = single(Plot::default())
            .picture()
            .save(&nowhere, format)
            .unwrap_err();
        assert!(matches!(error, render::Error::Write { .. }), "{error}");
        // A folder in the way: the temporary file must go.
        let taken = folder.path().join(name);
        fs::create_dir(&taken).unwrap();
        let error = single(Plot::default())
            .picture()
            .save(&taken, format)
            .unwrap_err();
        assert!(matches!(error, render::Error::Write { .. }), "{error}");
        fs::remove_dir(&taken).unwrap();
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_line_of_one_point_is_a_dot_and_so_it_is_in_the_legend() {
    let point = |y: f64, ink: Ink| Line {
        name: Some("slip-off".to_owned()),
        ..line(&[[15.0, y]], ink, Stroke::Solid)
    };
    let chart = single(Plot {
        lines: vec![point(-20.0, Ink::Black), point(20.0, Ink::Black)],
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
    assert_eq!(circles.len(), 3, "two points and the legend");
    for [x, y, radius] in circles {
        assert!(radius >= 5.0);
        for away in [-0.8 * radius, 0.0, 0.8 * radius] {
            assert_eq!(picture.at([x + away, y]), BLACK);
        }
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
        .picture())
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
fn characters_that_the_font_lacks_are_named() {
    assert!(render::missing_glyphs("\u{b5}N \u{2264} \u{3b8}p\n").is_empty());
    let title = "\u{9f20} hair \u{9f20}\u{1f400}";
    assert_eq!(render::missing_glyphs(title), ['\u{9f20}', '\u{1f400}']);
    let picture = single(Plot {
        title: title.to_owned(),
        ..Plot::default()
    })
    .picture();
    assert_eq!(picture.missing_glyphs(), ['\u{9f20}', '\u{1f400}']);
    let svg = svg(&picture);
    assert!(svg.contains(title) && svg.contains("sans-serif"));
}

#[test]
fn a_line_looks_the_same_however_many_points_it_has() {
    let corners = [[0.0, 0.0], [60.0, 0.0], [60.0, 40.0]];
    let at = |part: f64| {
        let [from, to] = [corners[part as usize], corners[(part as usize + 1).min(2)]];
        [0, 1].map(|axis| from[axis] + part.fract() * (to[axis] - from[axis]))
    };
    let many: Vec<_> = (0..=4000)
        .map(|step| at(f64::from(step) / 2000.0))
        .collect();
    for stroke in [Stroke::Solid, Stroke::Dashed] {
        let [few, many] = [&corners[..], &many].map(|points| {
            let lines = vec![line(points, Ink::Black, stroke)];
            Pixels::of(
                &single(Plot {
                    lines,
                    ..Plot::default()
                })
                .picture(),
            )
        });
        let pairs = few.pixels.iter().zip(&many.pixels);
        // A point is off by rounding alone, a hundredth of a grey level.
        let most = pairs.map(|(few, many)| few[0].abs_diff(many[0])).max();
        assert!(most <= Some(1), "{stroke:?}: {most:?}");
    }
}

#[test]
fn a_large_disc_widens_both_axes() {
    let chart = |radius: f64| {
        single(Plot {
            lines: vec![line(&[[0.0, 0.0], [100.0, 0.0]], Ink::Black, Stroke::Solid)],
            discs: vec![Disc {
                centre: [50.0, 30.0],
                radius,
            }],
            equal_axes: true,
            ..Plot::default()
        })
    };
    for (radius, unit) in [(20.0, 1280.0 / 108.0), (70.0, 880.0 / 151.2)] {
        let svg = svg(&chart(radius).picture());
        let points = &polylines(&svg)[0].0;
        assert!((points[1][0] - points[0][0] - 100.0 * unit).abs() < 0.02);
    }
}
