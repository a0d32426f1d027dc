//! Pictures on paper: their size, the size of their text, and PDF.

use crate::arc;
use crate::drawn::{frame, line, svg};
use whiskmap_plot::{
    CellAxis, Chart, ColourScale, HeatMap, Ink, PanelCells, Picture, PictureFormat, PictureSize,
    Plot, PrintSize, ScaleOptions, Shading, SizeError, Stroke, ValueSummary,
};

fn print(width_mm: f64, height_mm: Option<f64>) -> PictureSize {
    PictureSize::Print(PrintSize { width_mm, height_mm, dpi: 300.0 })
}

fn chart() -> Chart {
    let plot = Plot {
        x_label: "push angle \u{3b8}_{p} at detachment (deg)".to_owned(),
        y_label: "a long name of a distance of the pole from the base (mm)".to_owned(),
        lines: vec![line(&arc(), Ink::Black, Stroke::Solid).named("x".repeat(90))],
        ..Plot::default()
    };
    Chart::single("A title that is far too long for one line of a narrow picture", plot)
}

fn heat_map() -> HeatMap {
    let mut summary = ValueSummary::default();
    summary.extend([1.0, 2.0, f64::NAN]);
    let options = ScaleOptions {
        label: "force (nN)".to_owned(),
        blank: "no contact".to_owned(),
        ..ScaleOptions::default()
    };
    HeatMap {
        title: "map".to_owned(),
        x: CellAxis::new("angle (deg)", &[1.0, 2.0]),
        y: CellAxis::new("distance (mm)", &[1.0]),
        panel_axes: [None, None],
        shading: Shading::Quantities(ColourScale::new(&summary, options).unwrap()),
        regions: None,
        legend: Vec::new(),
    }
}

/// A chart and a heat map of one size.
fn both(size: PictureSize) -> [Result<Picture, SizeError>; 2] {
    let cells = || PanelCells { values: vec![1.0, 2.0], ..PanelCells::default() };
    [chart().picture(size), heat_map().picture(size, |_| Ok(cells()))]
}

/// The numbers after an attribute in a document.
fn numbers(document: &str, attribute: &str) -> Vec<f64> {
    let parts = document.split(attribute).skip(1);
    parts.map(|part| part.split('"').next().unwrap().parse().unwrap()).collect()
}

/// 7 pt are 7/72 inch; an SVG of 85 mm has 85/25.4 inch over the width of its view box.
#[test]
fn text_has_at_least_7_pt_on_paper() {
    for (width, height) in [(85.0, None), (85.0, Some(70.0)), (180.0, None), (60.0, Some(120.0))] {
        for picture in both(print(width, height)) {
            let document = svg(&picture.unwrap());
            let view: Vec<f64> = document
                .split("viewBox=\"0 0 ")
                .nth(1)
                .unwrap()
                .split('"')
                .next()
                .unwrap()
                .split(' ')
                .map(|side| side.parse().unwrap())
                .collect();
            let points = width / 25.4 * 72.0 / view[0];
            let sizes = numbers(&document.replace("<tspan font-size", "<tspan"), "font-size=\"");
            let least = sizes.iter().copied().fold(f64::INFINITY, f64::min) * points;
            assert!(sizes.len() > 6 && least > 6.999, "{width} mm: {least} pt");
            assert!(document.contains(&format!(" width=\"{width}mm\"")));
            if let Some(height) = height {
                assert!(document.contains(&format!(" height=\"{height}mm\"")), "{document}");
            }
            let [left, top, right, bottom] = frame(&document);
            assert!(left > 0.0 && right < view[0] && top > 0.0 && bottom < view[1]);
        }
    }
}

/// One column of a page, with a title of two lines and five names in the legend.
#[test]
fn a_plot_takes_most_of_a_column() {
    let names = [
        "slip-off",
        "pull-off",
        "first touch at the tip",
        "5 to 95 % of samples",
        "25 to 75 % of samples",
    ];
    let lines = names.map(|name| line(&arc(), Ink::Black, Stroke::Solid).named(name));
    let plot = Plot {
        x_label: "push angle at detachment (deg)".to_owned(),
        y_label: "distance at first touch (mm)".to_owned(),
        lines: lines.to_vec(),
        ..Plot::default()
    };
    let title = "Conical mouse whisker (Hires et al. 2013, Fig. 3A-E), taper = 0.95";
    let picture = Chart::single(title, plot).picture(print(85.0, None));
    let document = svg(&picture.unwrap());
    let [left, top, right, bottom] = frame(&document);
    let view = document.split("viewBox=\"0 0 ").nth(1).unwrap();
    let view = view.split('"').next().unwrap().split(' ');
    let view: Vec<f64> = view.map(|side| side.parse().unwrap()).collect();
    // Measured: 0.79 and 0.64; with the distances of a screen, 0.76 and 0.46.
    let part = [(right - left) / view[0], (bottom - top) / view[1]];
    assert!(part[0] > 0.75 && part[1] > 0.6, "{part:?}");
    assert!(document.contains("taper = 0.95<"), "{document}");
}

#[test]
fn a_png_has_the_pixels_and_the_density_of_its_size() {
    for picture in both(print(85.0, Some(60.0))) {
        let picture = picture.unwrap();
        assert_eq!(picture.pixels(), [1004, 709]);
        let png = picture.encode(PictureFormat::Png).unwrap();
        let reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap();
        let density = reader.info().pixel_dims.unwrap();
        assert_eq!((density.xppu, density.yppu, density.unit), (11811, 11811, png::Unit::Meter));
    }
}

#[test]
fn a_size_without_room_is_refused_with_one_that_has_room() {
    for (width, height) in [(10.0, None), (85.0, Some(20.0))] {
        for which in [0, 1] {
            let picture = |size| both(size).into_iter().nth(which).unwrap();
            let error = picture(print(width, height)).unwrap_err();
            let (side, larger) = match height {
                None => ("width", print(error.least_mm, None)),
                Some(_) => ("height", print(width, Some(error.least_mm))),
            };
            assert_eq!(error.side, side);
            assert!(picture(larger).is_ok(), "{error}");
        }
    }
}

/// The page has the size of the picture; text is outlines, and equal pictures give equal bytes.
#[test]
fn a_pdf_has_one_page_of_the_size() {
    for (picture, images) in both(print(85.0, Some(60.0))).into_iter().zip([0, 3]) {
        let picture = picture.unwrap();
        let pdf = picture.encode(PictureFormat::Pdf).unwrap();
        assert!(pdf == picture.encode(PictureFormat::Pdf).unwrap());
        let text = String::from_utf8_lossy(&pdf);
        let size: Vec<f64> = text
            .split("/MediaBox [")
            .nth(1)
            .unwrap()
            .split(']')
            .next()
            .unwrap()
            .split(' ')
            .map(|number| number.parse().unwrap())
            .collect();
        let expected = [0.0, 0.0, 85.0, 60.0].map(|mm| mm / 25.4 * 72.0);
        assert!(
            size.iter().zip(expected).all(|(one, other)| (one - other).abs() < 1e-3),
            "{size:?}"
        );
        assert!(
            text.starts_with("%PDF-1.7") && text.contains("/Count 1") && !text.contains("/Font")
        );
        assert_eq!(text.matches("/Subtype /Image").count(), images);
    }
}
