//! Colour scales: colours, ranges, logarithms and units.

use crate::BLANK;
use crate::drawn::{Pixels, body, svg};
use whiskmap_plot::{
    CellAxis, ColourScale, HeatMap, PanelCells, Picture, PictureSize, ScaleError, ScaleOptions,
    Shading, SizeError, ValueSummary,
};

/// Options of a scale of forces.
fn force() -> ScaleOptions {
    ScaleOptions {
        label: "force (\u{b5}N)".to_owned(),
        log: Some(false),
        blank: "no contact".to_owned(),
        ..ScaleOptions::default()
    }
}

/// Draws cells side by side.
fn drawn(values: &[f64], options: ScaleOptions) -> Result<Picture, ScaleError> {
    let mut summary = ValueSummary::default();
    summary.extend(values.iter().copied());
    let places: Vec<f64> = (0..values.len()).map(|place| place as f64).collect();
    let map = HeatMap {
        title: String::new(),
        x: CellAxis::new("", &places),
        y: CellAxis::new("", &[1.0]),
        panel_axes: [None, None],
        shading: Shading::Quantities(ColourScale::new(&summary, options)?),
        legend: Vec::new(),
        regions: None,
    };
    let values = values.to_vec();
    let picture = map.picture(PictureSize::Natural, |_| {
        Ok::<_, SizeError>(PanelCells { values: values.clone(), ..PanelCells::default() })
    });
    Ok(picture.unwrap())
}

/// The colours of three cells side by side.
fn colours(picture: &Picture) -> [[u8; 3]; 3] {
    let pixels = Pixels::of(picture);
    [0.1, 0.4, 0.9].map(|across| body(&pixels, across, 0.5))
}

#[test]
fn a_scale_is_white_at_zero_when_both_signs_occur() {
    let [negative, zero, positive] = colours(&drawn(&[-1.0, 0.0, 4.0], force()).unwrap());
    assert_eq!(zero, [0xf7; 3]);
    assert_eq!(positive, [0xb2, 0x18, 0x2b]);
    assert!(negative[2] > negative[0] && negative[0] > 0xb0, "a quarter of the way to blue");
    let [least, none, most] = colours(&drawn(&[1.0, f64::INFINITY, 4.0], force()).unwrap());
    assert_eq!(none, BLANK);
    assert!(least[2] > least[1] && most[1] > most[2], "viridis: {least:?} to {most:?}");
}

#[test]
fn a_logarithmic_scale_has_equal_ratios_at_equal_distances() {
    let log = || ScaleOptions { log: Some(true), ..force() };
    let linear = drawn(&[0.0, 5.0, 10.0], force()).unwrap();
    let decades = drawn(&[1.0, 100.0, 1e4], log()).unwrap();
    assert_eq!(colours(&decades), colours(&linear));
    assert!(svg(&decades).contains(">0.1<"), "in mN");

    let some = drawn(&[-3.0, 0.0, 7.0], log()).unwrap();
    assert_eq!(colours(&some)[..2], [BLANK; 2]);
    assert!(svg(&some).contains(">\u{2264} 0 (cells: 2)<"));
    let both = drawn(&[f64::NAN, -1.0, 7.0], log()).unwrap();
    assert!(svg(&both).contains(">no contact, or \u{2264} 0 (cells: 1)<"));
}

#[test]
fn a_logarithmic_scale_starts_at_the_1st_percentile() {
    let zeros = [0.0; 10].into_iter().chain([1e-30; 3]);
    let values: Vec<f64> = zeros.chain((13..400).map(f64::from)).collect();
    let log = ScaleOptions { log: Some(true), ..force() };
    let svg = svg(&drawn(&values, log).unwrap());
    for name in ["\u{2264} 0 (cells: 10)", "> 0, below the scale (cells: 3)"] {
        let name = name.replace('>', "&gt;");
        assert!(svg.contains(&format!(">{name}<")), "{name}");
    }
    for tick in [">20<", ">50<", ">100<", ">200<"] {
        assert!(svg.contains(tick), "{tick}");
    }
}

/// The powers of ten between the ends are few, whatever the ends and the unit.
#[test]
fn a_logarithmic_scale_takes_all_positive_numbers() {
    let options = ScaleOptions { log: Some(true), range: Some([1e-320, 1e308]), ..force() };
    let svg = svg(&drawn(&[1.0, 100.0, 1e4], options).unwrap());
    assert!(svg.contains(">force (N)<") && !svg.contains("NaN") && !svg.contains("inf"));
}

#[test]
fn values_beyond_the_range_take_the_colours_of_its_ends() {
    let ranged = |values: [f64; 3], range, log| {
        let range = Some(range);
        let options = ScaleOptions { log: Some(log), range, ..force() };
        colours(&drawn(&values, options).unwrap())
    };
    for log in [false, true] {
        let [low, _, high] = ranged([1.0, 2.0, 100.0], [1.0, 100.0], log);
        assert_ne!(low, high);
        assert_eq!(ranged([0.5, 1e3, 1e30], [1.0, 100.0], log), [low, high, high]);
    }
    let [_, white, red] = ranged([-9.0, 0.0, 9.0], [-1.0, 4.0], false);
    assert_eq!([white, red], [[0xf7; 3], [0xb2, 0x18, 0x2b]]);
}

#[test]
fn impossible_scales_are_refused() {
    let refused = |values: [f64; 3], range, log, what: &str| {
        let options = ScaleOptions { log: Some(log), range, ..force() };
        let error = drawn(&values, options).unwrap_err();
        assert!(error.to_string().contains(what), "{error}");
    };
    let some = [1.0, 2.0, 3.0];
    for (range, text) in [
        ([5.0, 2.0], "range 5,2:"),
        ([2.0, 2.0], "range 2,2:"),
        ([f64::NAN, 1.0], "range NaN,1:"),
        ([0.0, f64::INFINITY], "range 0,inf:"),
        ([-f64::MAX, f64::MAX], "two finite numbers"),
    ] {
        refused(some, Some(range), false, "two finite numbers");
        refused(some, Some(range), false, text);
    }
    refused(some, Some([0.0, 1.0]), true, "must begin above 0");
    let none = [-1.0, 0.0, f64::NAN];
    refused(none, None, true, "no cell has a value above 0");
}

#[test]
fn a_colour_bar_chooses_the_unit_that_suits_it() {
    for (values, label, tick) in [
        ([1e6, 5e6, 1e7], ">force (N)<", ">10<"),
        ([1.0, 2.0, 8e3], ">force (mN)<", ">8<"),
        ([1.0, 2.0, 500.0], ">force (\u{b5}N)<", ">500<"),
        ([0.0, 0.0, 0.0], ">force (\u{b5}N)<", ">0.0<"),
        ([0.0, 0.0, 2e-3], ">force (nN)<", ">2.0<"),
    ] {
        let svg = svg(&drawn(&values, force()).unwrap());
        assert!(svg.contains(label) && svg.contains(tick), "{label} {tick}");
    }
    let counts = ScaleOptions { whole: true, ..force() };
    let svg = svg(&drawn(&[0.0, 1.0, 2.0], counts).unwrap());
    assert!(svg.contains(">1<") && !svg.contains(">0.5<"), "whole ticks");
}

/// Two decades, from the 1st percentile on; a negative value, or a range of less, keeps the scale linear.
#[test]
fn a_scale_becomes_logarithmic_by_itself_over_two_decades() {
    let is_log = |values: &[f64], range| {
        let options = ScaleOptions { log: None, range, ..force() };
        let document = |log| {
            let picture = drawn(values, ScaleOptions { log, ..options.clone() });
            picture.ok().map(|picture| svg(&picture))
        };
        let chosen = document(None);
        assert!(chosen == document(Some(true)) || chosen == document(Some(false)));
        chosen == document(Some(true))
    };
    assert!(is_log(&[1.0, 10.0, 101.0], None) && is_log(&[0.0, 1.0, 101.0], None));
    assert!(!is_log(&[1.0, 10.0, 99.0], None) && !is_log(&[0.0, 0.0, 0.0], None));
    assert!(is_log(&[1.0, 10.0, 20.0], Some([1.0, 101.0])));
    assert!(!is_log(&[1.0, 10.0, 2000.0], Some([1.0, 99.0])));
    assert!(!is_log(&[-1.0, 1.0, 1000.0], None));
}
