//! Charts as documents: legend, texts, files.

use crate::drawn::{frame, line, polylines, single, svg, well_formed};
use crate::{arc, both};
use std::path::Path;
use whiskmap_plot::{
    Chart, Disc, Dot, Ink, Note, PictureFormat, PictureSize, Plot, Stroke, missing_glyphs,
};

#[test]
fn the_legend_has_each_name_once_and_wraps() {
    let diagonal = || line(&[[0.0, 0.0], [1.0, 1.0]], Ink::Black, Stroke::Dashed);
    let plot = |names: &[&str]| Plot {
        lines: names.iter().map(|name| diagonal().named(*name)).collect(),
        ..Plot::default()
    };
    let long = ["a long name that takes much room ", "another one of the same kind ", "stable"]
        .map(|name| name.repeat(2));
    let names: Vec<&str> = long.iter().map(String::as_str).collect();
    let document =
        |names: &[&str]| svg(&single(plot(names)).picture(PictureSize::Natural).unwrap());
    let twice = document(&["stable", "unstable", "stable"]);
    assert_eq!(twice.matches(">stable<").count(), 1);
    assert_eq!(twice.matches(">unstable<").count(), 1);
    let lines = |names: &[&str]| (frame(&document(names))[1] - frame(&document(&[]))[1]) / 38.0;
    assert_eq!(lines(&["stable"]), 1.0);
    assert_eq!(lines(&names), 2.0);
    assert_eq!(lines(&[&"x".repeat(300)]), 1.0, "cut");
    assert!(!document(&[&"x".repeat(300)]).contains(&"x".repeat(300)));
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
            lines: vec![line(&arc(), Ink::Grey, Stroke::Dashed).named(text)],
            dots: vec![Dot::default()],
            discs: vec![Disc::default()],
            notes: vec![Note { text: text.to_owned(), ..Note::default() }],
            ..Plot::default()
        }],
        caption: vec![text.to_owned()],
        columns: 3,
    };
    let svg = svg(&chart.picture(PictureSize::Natural).unwrap());
    assert!(well_formed(&svg), "{svg}");
    let shown = "a&lt;b &amp; &quot;c&quot;&gt; \u{2212} \u{fffd}</text>";
    assert_eq!(svg.matches(shown).count(), 7);
    for damage in ["</text>", "</svg>", "amp;", "/>"] {
        assert!(!well_formed(&svg.replacen(damage, "", 1)), "without {damage}");
    }
    let numbers = svg.split(['"', ' ', ',']).filter(|part| part.parse::<f64>().is_ok());
    for number in numbers {
        let decimals = number.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        assert!(decimals <= 2 && number != "-0", "{number}");
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
        ..Chart::default()
    };
    let (svg, picture) = both(&chart);
    let size = format!("width=\"{}\" height=\"{}\"", picture.width, picture.height);
    assert!(svg.contains(&size), "{size}");
    let lines = polylines(&svg).into_iter().filter(|(points, _)| points.len() == 5);
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
    let chart = || {
        let plot = Plot {
            lines: vec![line(&arc(), Ink::Blue, Stroke::Dashed)],
            title: "arc".to_owned(),
            ..Plot::default()
        };
        single(plot).picture(PictureSize::Natural).unwrap()
    };
    for format in [PictureFormat::Png, PictureFormat::Svg] {
        let [one, other] = [0, 1].map(|_| chart().encode(format).unwrap());
        assert!(one == other && one.len() > 1000, "{format:?}");
    }
    for (name, format) in [
        ("a/b.Png", Some(PictureFormat::Png)),
        ("chart.SVG", Some(PictureFormat::Svg)),
        ("c.svg.exr", None),
        ("svg", None),
    ] {
        assert_eq!(PictureFormat::of(Path::new(name)), format);
    }
}

#[test]
fn characters_that_the_font_lacks_are_named() {
    assert!(missing_glyphs("\u{b5}N \u{2264} \u{3b8}p\n").is_empty());
    let title = "\u{9f20} hair \u{9f20}\u{1f400}";
    assert_eq!(missing_glyphs(title), ['\u{9f20}', '\u{1f400}']);
    let picture = single(Plot { title: title.to_owned(), ..Plot::default() })
        .picture(PictureSize::Natural)
        .unwrap();
    assert_eq!(picture.missing_glyphs(), ['\u{9f20}', '\u{1f400}']);
    let svg = svg(&picture);
    assert!(svg.contains(title) && svg.contains("sans-serif"));
}
