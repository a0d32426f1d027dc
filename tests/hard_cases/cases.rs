//! Maps of the named hard cases, and cells exactly at the ends of their pushes.

use super::case::{Case, compute};
use super::named::named;
use crate::compute::is_contact;
use whiskmap::Side;
use whiskmap::classify::{Regime, Status};
use whiskmap::map::Panel;
use whiskmap::refine::TOLERANCE;
use whiskmap::scene::Scene;
use whiskmap::trace::{DetachmentKind, corner, curve};

/// Returns true if every cell has either all its values or none. Where the course of a contact with friction is not found, cells in contact
/// have none.
pub fn is_complete(panel: &Panel) -> bool {
    panel.regime.iter().enumerate().all(|(cell, regime)| {
        let finite = panel.state.iter().all(|channel| channel[cell].is_finite());
        let sound = f64::from(panel.residual[cell]) <= TOLERANCE && panel.margin_deg[cell] >= 0.0;
        let has_state = panel.status[cell] != Status::NoState.code();
        (is_contact(*regime) && has_state) == (finite && sound)
    })
}

/// Map of `case`; panics if a cell is unresolved or doubtful.
fn certain(name: &str, case: &Case) -> Panel {
    let (summary, panel) = compute(&case.scene(), None);
    let doubt = (summary.unresolved(), summary.disagreements);
    assert_eq!(doubt, (0, 0), "{name}: {case:?}\n{:?}", panel.status);
    assert!(is_complete(&panel), "{name}");
    panel
}

#[test]
fn every_named_case_is_certain() {
    for (name, case) in named() {
        certain(name, &case);
    }
}

/// Distances of cells from the end of a push, in degrees. The ends are accurate to 1e-8 degrees.
const BESIDE: [f64; 2] = [1e-5, 1e-7];

/// Checks the map of one row next to `end_deg`: contact before it, detachment by `kind` beyond it, and no unresolved cell at it. With
/// friction two branches can exchange their ends. A state of the other branch then exists beyond the end.
fn ends_at(name: &str, case: &Case, distance: f64, end_deg: f64, kind: DetachmentKind) {
    let detached = if kind == DetachmentKind::SlipOff { Regime::SlipOff } else { Regime::PullOff };
    let beside = BESIDE.iter().flat_map(|by| [end_deg - by, end_deg + by]);
    let mut pushes: Vec<f64> = beside.chain([end_deg]).collect();
    pushes.sort_by(f64::total_cmp);
    let row = Case { pushes_deg: pushes.clone(), distances: vec![distance], ..case.clone() };
    let panel = certain(name, &row);
    for (push, regime) in pushes.iter().zip(&panel.regime) {
        let swapped = case.friction > 0.0 && *regime == Regime::Unreachable.code();
        let right = if push.abs() < end_deg.abs() {
            *regime == Regime::Contact.code()
        } else {
            *push == end_deg || swapped || *regime == detached.code()
        };
        assert!(right, "{name} at {distance}: {push}: {regime}");
    }
}

#[test]
fn pushes_up_to_the_edge_and_past_it() {
    let mut ends = 0;
    for (name, case) in named() {
        let scene = case.scene();
        for side in Side::BOTH {
            for end in curve(&scene.whisker, &scene.pole, side, &scene.grid.distance_mm) {
                assert_ne!(end.kind, DetachmentKind::Unresolved, "{name}");
                let Some(push) =
                    end.push_angle_deg.filter(|push| (0.1..359.0).contains(&push.abs()))
                else {
                    continue;
                };
                ends += 1;
                ends_at(name, &case, end.distance_mm / case.length_mm, push, end.kind);
            }
        }
    }
    assert!(ends > 300, "{ends}");
}

/// Just before the corner of fold and tip a whisker slips off; just beyond it is pulled off. The corner of a straight cylinder is
/// at 0.5585395 of its length.
#[test]
fn both_sides_of_the_corner() {
    let mut corners = 0;
    for (name, case) in named() {
        let scene = case.scene();
        for side in Side::BOTH {
            let Some(distance) = corner(&scene.whisker, &scene.pole, side).distance_mm else {
                continue;
            };
            corners += 1;
            let beside = [-1e-6, -1e-8, 1e-8, 1e-6];
            let distances = beside.map(|by| distance + by * case.length_mm);
            let ends = curve(&scene.whisker, &scene.pole, side, &distances);
            for (by, end) in beside.iter().zip(ends) {
                let kind =
                    if *by < 0.0 { DetachmentKind::SlipOff } else { DetachmentKind::PullOff };
                assert_eq!(end.kind, kind, "{name}");
                let push = end.push_angle_deg.unwrap();
                if push.abs() < 359.0 {
                    ends_at(name, &case, end.distance_mm / case.length_mm, push, kind);
                }
            }
        }
    }
    assert!(corners > 20, "{corners}");
}

/// A dimensionless curvature between 0 and 1e-9 would underflow in `f32`.
#[test]
fn fainter_bends_are_refused() {
    let case = &named()[0].1;
    for (bend, fits) in [(1e-12, false), (0.99e-9, false), (1e-9, true)] {
        let text = Case { bend, ..case.clone() }.text();
        assert_eq!(Scene::parse(&text, "hard").is_ok(), fits, "{bend}");
    }
}
