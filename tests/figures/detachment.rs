//! Detachment curves of Figs. 3E, 3J, 4D and 5C, and measured ends over them.

use super::{drawn, last, plot};
use whiskmap::Side;
use whiskmap::measured::MeasuredPoint;
use whiskmap::paper::Measurements;
use whiskmap::render::{Ink, Stroke};
use whiskmap::trace::DetachmentKind;

/// Captions of Figs. 3E, 3J, 4D and 5C: the push angle across, the distance upwards, black slip-off, blue pull-off, and
/// dashes for what is no whisker. The region is closed where the tip touches first.
#[test]
fn detachment_curves_enclose_the_stable_region() {
    let panels = [
        ("fig3", "E", 1),
        ("fig3", "J", 1),
        ("fig4d", "D", 2),
        ("fig5c", "C", 2),
        ("fig5c", "", 2),
    ];
    for (name, letter, whiskers) in panels {
        let plot = plot(name, letter);
        assert!(
            plot.x_label.starts_with("push angle") && plot.y_label.starts_with("object distance")
        );
        let strokes = [Stroke::Solid, Stroke::Dashed];
        for stroke in &strokes[..whiskers] {
            let lines = || plot.lines.iter().filter(|line| line.stroke == *stroke);
            for (ink, kind) in [(Ink::Black, "slip-off"), (Ink::Blue, "pull-off")] {
                let mut of_kind = lines().filter(|line| line.ink == ink);
                assert!(of_kind.all(|line| line.name.as_deref().unwrap().ends_with(kind)));
            }
            let top = lines().find(|line| line.ink == Ink::Grey).unwrap();
            let meets =
                |at: [f64; 2]| lines().any(|line| line.ink != Ink::Grey && last(line) == at);
            assert!(
                top.points.len() == 2 && top.points.iter().all(|at| meets(*at)),
                "{name} {letter}: {top:?}"
            );
            // From the tip, a CB push leads nowhere, but where the thin end straightens first.
            assert!((0.0..1.0).contains(&top.points[1][0]), "{name} {letter}: {top:?}");
        }
        let has_dashes = plot.lines.iter().any(|line| line.stroke == Stroke::Dashed);
        assert_eq!(has_dashes, whiskers == 2);
    }
}

#[test]
fn measured_ends_are_circles_over_the_theory() {
    let end = |angle_deg, kind| MeasuredPoint {
        line: 1,
        whisker: 0,
        side: Side::of_push(angle_deg),
        distance_mm: 9.0,
        angle_deg,
        kind: Some(kind),
        sd_deg: 1.0,
    };
    let both = vec![end(20.0, DetachmentKind::SlipOff), end(-90.0, DetachmentKind::PullOff)];
    let measured = Measurements { fig4d: both.clone(), fig5c_left: both, fig5c_right: Vec::new() };
    let all = drawn(&measured);
    let dots = |name: &str, place: usize| {
        let figure = all.iter().find(|figure| figure.name == name).unwrap();
        let dots = figure.chart.plots[place].dots.iter();
        dots.map(|dot| (dot.at, dot.ink, dot.open)).collect::<Vec<_>>()
    };
    let shown = |is_open| [([20.0, 9.0], Ink::Black, true), ([-90.0, 9.0], Ink::Blue, is_open)];
    assert_eq!(dots("fig4d", 0), shown(false));
    assert_eq!(dots("fig5c", 0), shown(true));
    assert_eq!(dots("fig5c", 1), []);
}
