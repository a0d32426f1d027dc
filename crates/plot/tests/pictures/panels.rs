//! Panels of heat maps: cells, hatching, curves and contact sheets.

use crate::drawn::{Pixels, body, polylines, rasters, svg};
use crate::{BLACK, BLANK, WHITE};
use whiskmap_plot::{
    CellAxis, Fill, HeatMap, LegendEntry, PanelAxis, PanelCells, Picture, PictureSize, PrintSize,
    Shading, SizeError,
};

const RED: [u8; 3] = [200, 0, 0];
const GREEN: [u8; 3] = [0, 200, 0];

/// A heat map of codes: 0 is red, 1 is green, and others are blank.
fn coded(x: &[f64], y: &[f64]) -> HeatMap {
    let fills = [(0, Fill::plain(RED)), (1, Fill::plain(GREEN))];
    HeatMap {
        title: "codes".to_owned(),
        x: CellAxis::new("angle (deg)", x),
        y: CellAxis::new("distance (mm)", y),
        panel_axes: [None, None],
        shading: Shading::Codes { fills: fills.into(), other: Fill::BLANK },
        legend: vec![LegendEntry::swatch(Fill::plain(RED), "red")],
        regions: None,
    }
}

fn drawn(map: &HeatMap, mut panel: impl FnMut(usize) -> PanelCells) -> Picture {
    map.picture(PictureSize::Natural, |index| Ok::<_, SizeError>(panel(index))).unwrap()
}

#[test]
fn cells_are_where_their_values_are() {
    // Midpoints between unequal values: the cells are 45, 35 and 25 wide, from -72.5 to 32.5.
    let map = coded(&[-50.0, -5.0, 20.0], &[5.0, 15.0]);
    let cells =
        PanelCells { values: vec![0.0, 1.0, 2.0, 1.0, f64::NAN, 0.0], ..PanelCells::default() };
    let pixels = Pixels::of(&drawn(&map, |_| cells.clone()));
    for (x, [lower, upper]) in [
        (-72.0, [RED, GREEN]),
        (-28.0, [RED, GREEN]),
        (-27.0, [GREEN, BLANK]),
        (7.0, [GREEN, BLANK]),
        (8.0, [BLANK, RED]),
        (32.0, [BLANK, RED]),
    ] {
        let across = (x + 72.5) / 105.0;
        for (up, colour) in [(0.01, lower), (0.49, lower), (0.51, upper), (0.99, upper)] {
            assert_eq!(body(&pixels, across, up), colour, "{x}, {up}");
        }
    }
    let zero = body(&pixels, 72.5 / 105.0, 0.25);
    assert!(zero.iter().all(|channel| *channel > 0xe0), "the line at 0");
}

#[test]
fn missing_cells_are_blank_and_an_empty_map_is_drawn() {
    for (x, y) in [(&[][..], &[][..]), (&[1.0, 2.0], &[1.0])] {
        let picture = drawn(&coded(x, y), |_| PanelCells::default());
        assert_eq!(Pixels::of(&picture).at([200.0, 300.0]), BLANK);
    }
}

#[test]
fn hatched_cells_have_stripes_and_curves_run_where_their_points_are() {
    let map = coded(&[1.0, 3.0], &[1.0, 3.0]);
    let cells = PanelCells {
        values: vec![1.0; 4],
        hatched: vec![false, false, false, true],
        curves: vec![vec![[0.5, 0.5], [1.5, 3.5]]],
    };
    let picture = drawn(&map, |_| cells.clone());
    let pixels = Pixels::of(&picture);
    let stripes = |left: f64| {
        let row = (0..50).map(|step| body(&pixels, left + f64::from(step) / 1280.0, 0.75));
        let mut colours: Vec<_> = row.collect();
        colours.sort_unstable();
        colours.dedup();
        colours
    };
    assert_eq!(stripes(0.75), [GREEN, WHITE]);
    assert_eq!(stripes(0.01), [GREEN]);
    for [x, y] in [[0.5, 0.5], [1.0, 2.0], [1.5, 3.5]] {
        assert_eq!(body(&pixels, x / 4.0, y / 4.0), BLACK, "{x}, {y}");
    }
    let curves = polylines(&svg(&picture));
    assert!(curves.iter().filter(|(points, _)| points.len() == 2).count() > 1);
}

#[test]
fn panels_stand_along_their_axes() {
    let mut map = coded(&[1.0, 2.0], &[1.0, 2.0]);
    let axis = |label: &str| PanelAxis::of_values(label.to_owned(), &[0.5, 0.75]);
    map.panel_axes = [Some(axis("taper")), Some(axis("friction"))];
    let mut drawn_panels = Vec::new();
    let picture = drawn(&map, |index| {
        drawn_panels.push(index);
        PanelCells { values: vec![[0.0, 1.0, 2.0, 0.0][index]; 4], ..PanelCells::default() }
    });
    assert_eq!(drawn_panels, [0, 1, 2, 3]);
    let pixels = Pixels::of(&picture);
    let at = |x: usize, y: usize| pixels.at([(168 + x) as f64, (pixels.height - 180 - y) as f64]);
    assert_eq!([at(200, 200), at(760, 200)], [RED, GREEN]);
    assert_eq!([at(200, 760), at(760, 760)], [BLANK, RED]);
    let svg = svg(&picture);
    for text in [
        ">taper<",
        ">friction<",
        ">0.50<",
        ">each panel, to the right: angle (deg), 1 to 2<",
        ">each panel, upwards: distance (mm), 1 to 2<",
    ] {
        assert!(svg.contains(text), "{text}");
    }
    let narrow =
        map.picture(PictureSize::Width(700), |_| Ok::<_, SizeError>(PanelCells::default()));
    assert_eq!(narrow.unwrap().pixels()[0], 700);
}

/// Seven panels along one axis, in three columns, with their values above them.
#[test]
fn panels_along_one_axis_fill_rows() {
    let values: Vec<f64> = (0..7).map(|i| 0.25 * f64::from(i)).collect();
    for side in [0, 1] {
        let mut map = coded(&[1.0, 2.0], &[1.0, 2.0]);
        map.panel_axes[side] = Some(PanelAxis::of_values("taper".to_owned(), &values));
        let mut drawn_panels = Vec::new();
        let picture = drawn(&map, |index| {
            drawn_panels.push(index);
            PanelCells { values: vec![[0.0, 1.0][index % 2]; 4], ..PanelCells::default() }
        });
        assert_eq!(drawn_panels, [0, 1, 2, 3, 4, 5, 6]);
        let svg = svg(&picture);
        assert!(svg.contains(">above each panel: taper<"), "{svg}");
        let rasters: Vec<[f64; 4]> = rasters(&svg).into_iter().map(|(area, _)| area).collect();
        let panels = &rasters[rasters.len() - 7..];
        let column = |i: usize| (panels[i][0], panels[i][1]);
        assert!((0..7).all(|i| column(i).0 == column(i % 3).0), "{panels:?}");
        assert!((0..7).all(|i| column(i).1 == column(i / 3 * 3).1), "{panels:?}");
        assert!(column(0).1 < column(3).1 && column(0).0 < column(1).0);
        // Panels take most of the width.
        let [width, _] = picture.pixels();
        let right = panels[2][0] + panels[2][2];
        assert!(right - panels[0][0] > 0.8 * width as f64, "{panels:?}");
        assert_eq!(svg.matches(">0.75<").count(), 1, "{svg}");
    }
}

/// Above narrow panels, a label takes as many lines as it needs, between its panel and the one above.
#[test]
fn labels_of_narrow_panels_keep_their_words() {
    let texts = ["moment and transverse force", "short", "axial and transverse force", "last"];
    let mut map = coded(&[1.0, 2.0], &[1.0, 2.0]);
    let texts = texts.map(str::to_owned).to_vec();
    map.panel_axes[0] = Some(PanelAxis { label: "numbers".to_owned(), texts: texts.clone() });
    (map.title, map.legend) = (String::new(), Vec::new());
    for (width_mm, height_mm) in [(60.0, None), (60.0, Some(90.0)), (160.0, None)] {
        let print = PictureSize::Print(PrintSize { width_mm, height_mm, dpi: 300.0 });
        let cells = || PanelCells { values: vec![0.0; 4], ..PanelCells::default() };
        let picture = map.picture(print, |_| Ok::<_, SizeError>(cells())).unwrap();
        let svg = svg(&picture);
        let lines: Vec<(f64, &str)> = svg.lines().filter_map(text_line).collect();
        let rasters: Vec<[f64; 4]> = rasters(&svg).into_iter().map(|(area, _)| area).collect();
        let panels = &rasters[rasters.len() - texts.len()..];
        let words = |above: f64, below: f64| -> Vec<&str> {
            let between = lines.iter().filter(|(y, _)| above < *y && *y < below);
            between.flat_map(|(_, text)| text.split(' ')).collect()
        };
        let [[_, top, _, height], _, [_, below, ..], _] = panels else { panic!("{panels:?}") };
        let mut found = words(0.0, *top);
        found.extend(words(top + height, *below));
        let mut expected: Vec<&str> = texts.iter().flat_map(|text| text.split(' ')).collect();
        found.sort_unstable();
        expected.sort_unstable();
        assert_eq!(found, expected, "{width_mm} mm: {svg}");
    }
}

/// Height and text of a line of text in an SVG document.
fn text_line(line: &str) -> Option<(f64, &str)> {
    let (tag, rest) = line.strip_prefix("<text ")?.split_once('>')?;
    let y = tag.split_once(" y=\"")?.1.split('"').next()?.parse().ok()?;
    Some((y, rest.split('<').next()?))
}
