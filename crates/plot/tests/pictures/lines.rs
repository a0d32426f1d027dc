//! Lines, dots and discs are where their numbers are.

use crate::drawn::{Pixels, frame, line, polylines, single, svg};
use crate::{BLACK, BLANK, BLUE, WHITE, arc, both};
use whiskmap_plot::{Disc, Dot, Ink, Line, PictureSize, Plot, Stroke};

#[test]
fn a_line_is_where_its_numbers_are() {
    let corners = [[-20.0, 3.0], [30.0, 3.0], [80.0, 8.0]];
    let chart =
        single(Plot { lines: vec![line(&corners, Ink::Blue, Stroke::Solid)], ..Plot::default() });
    let (svg, picture) = both(&chart);
    let [left, top, right, bottom] = frame(&svg);
    assert_eq!([right - left, bottom - top], [1280.0, 880.0]);
    // The data take 1 of 1.08 parts of the axes.
    let place = |x: f64, y: f64| {
        let across = ((x + 20.0) / 100.0 + 0.04) / 1.08;
        let up = ((y - 3.0) / 5.0 + 0.04) / 1.08;
        [left + 1280.0 * across, bottom - 880.0 * up]
    };
    for [x, y] in [[-20.0, 3.0], [5.0, 3.0], [40.0, 4.0], [60.0, 6.0], [80.0, 8.0]] {
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
        let blue: Vec<bool> = points.iter().map(|point| picture.at(*point)[0] < 0x8d).collect();
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
            assert!((length - expected).abs() < 2.6, "{length} is not {expected}");
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
        dots: vec![Dot { at: [f64::NAN, 0.0], ..Dot::default() }],
        ..Plot::default()
    });
    let svg = svg(&chart.picture(PictureSize::Natural).unwrap());
    let stretches = polylines(&svg);
    assert_eq!([stretches[0].0.len(), stretches[1].0.len()], [2, 2]);
    assert_eq!(svg.matches("<circle").count(), 1, "the point on its own");
    let [left, _, right, bottom] = frame(&svg);
    let across = left + (right - left) * (2.0 / 5.0 + 0.04) / 1.08;
    let alone = [across, bottom - 880.0 * 0.04 / 1.08];
    let picture = Pixels::of(&chart.picture(PictureSize::Natural).unwrap());
    for away in [-4.0, 0.0, 4.0] {
        assert_eq!(picture.at([alone[0] + away, alone[1]]), BLUE);
    }
    assert_eq!(picture.at([alone[0] + 20.0, alone[1]]), WHITE);
}

#[test]
fn dots_and_discs_are_drawn_and_axes_are_equal() {
    let chart = single(Plot {
        lines: vec![line(&[[0.0, 0.0], [10.0, 0.0]], Ink::Grey, Stroke::Solid)],
        dots: vec![Dot { at: [10.0, 0.0], ..Dot::default() }],
        discs: vec![
            Disc { centre: [4.0, 3.0], radius: 1.0, dark: false },
            Disc { centre: [8.0, 3.0], radius: 1e-9, dark: false },
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
        assert_eq!([around(0.0), around(0.96), around(1.04)], [BLANK, BLANK, WHITE]);
        assert!(around(1.0)[0] < 0xa0, "the outline");
    }
    let [x, y] = place(8.0, 3.0);
    for away in [-3.0, 3.0] {
        assert!(picture.at([x + away, y])[0] < 0xb0, "the small disc");
    }
}

/// Places and radii of the circles of a document.
fn circles(svg: &str) -> Vec<[f64; 3]> {
    let tags = svg.lines().filter(|line| line.starts_with("<circle"));
    tags.map(|tag| {
        let quoted: Vec<&str> = tag.split('"').collect();
        [1, 3, 5].map(|value| quoted[value].parse().unwrap())
    })
    .collect()
}

#[test]
fn a_line_of_one_point_is_a_dot_and_so_it_is_in_the_legend() {
    let point = |y: f64, ink: Ink| line(&[[15.0, y]], ink, Stroke::Solid).named("slip-off");
    let chart = single(Plot {
        lines: vec![point(-20.0, Ink::Black), point(20.0, Ink::Black)],
        ..Plot::default()
    });
    let (svg, picture) = both(&chart);
    let circles = circles(&svg);
    assert_eq!(circles.len(), 3, "two points and the legend");
    for [x, y, radius] in circles {
        assert!(radius >= 5.0);
        for away in [-0.8 * radius, 0.0, 0.8 * radius] {
            assert_eq!(picture.at([x + away, y]), BLACK);
        }
    }
}

#[test]
fn a_line_looks_the_same_however_many_points_it_has() {
    let corners = [[0.0, 0.0], [60.0, 0.0], [60.0, 40.0]];
    let at = |part: f64| {
        let [from, to] = [corners[part as usize], corners[(part as usize + 1).min(2)]];
        [0, 1].map(|axis| from[axis] + part.fract() * (to[axis] - from[axis]))
    };
    let many: Vec<_> = (0..=4000).map(|step| at(f64::from(step) / 2000.0)).collect();
    for stroke in [Stroke::Solid, Stroke::Dashed] {
        let [few, many] = [&corners[..], &many].map(|points| {
            let lines = vec![line(points, Ink::Black, stroke)];
            Pixels::of(
                &single(Plot { lines, ..Plot::default() }).picture(PictureSize::Natural).unwrap(),
            )
        });
        let pairs = few.pixels.iter().zip(&many.pixels);
        // A point is off by rounding alone, a hundredth of a grey level.
        let most = pairs.map(|(few, many)| few[0].abs_diff(many[0])).max();
        assert!(most <= Some(1), "{stroke:?}: {most:?}");
    }
}

#[test]
fn an_open_dot_is_a_ring_and_so_it_is_in_the_legend() {
    let chart = single(Plot {
        dots: vec![Dot {
            at: [1.0, 1.0],
            ink: Ink::Blue,
            open: true,
            name: Some("slip-off".to_owned()),
        }],
        ..Plot::default()
    });
    let (svg, picture) = both(&chart);
    let circles = circles(&svg);
    assert_eq!(circles.len(), 2, "the point and the legend");
    for [x, y, radius] in circles {
        assert_eq!(picture.at([x, y]), WHITE);
        for away in [-radius, radius] {
            assert_eq!(picture.at([x + away, y]), BLUE);
        }
    }
}

/// A bar shorter than its dot is seen on it: drawn after the dot, with a white rim.
#[test]
fn bars_are_drawn_over_dots() {
    let bar = |half: f64| line(&[[5.0 - half, 0.5], [5.0 + half, 0.5]], Ink::Blue, Stroke::Solid);
    let chart = |bars: Vec<Line>| {
        single(Plot {
            lines: vec![line(&[[0.0, 0.0], [10.0, 1.0]], Ink::Grey, Stroke::Solid)],
            dots: vec![Dot { at: [5.0, 0.5], ink: Ink::Blue, ..Dot::default() }],
            bars,
            ..Plot::default()
        })
    };
    let after_dot = |bars| {
        let svg = svg(&chart(bars).picture(PictureSize::Natural).unwrap());
        svg[svg.find("<circle").unwrap()..].matches("<polyline").count()
    };
    assert_eq!(after_dot(vec![bar(0.02)]), after_dot(Vec::new()) + 2, "the rim and the bar");
    // A bar beyond all other contents widens the axis.
    let pixels = |bars| Pixels::of(&chart(bars).picture(PictureSize::Natural).unwrap()).pixels;
    assert!(pixels(vec![bar(20.0)]) != pixels(Vec::new()));
}
