//! Marks of states and pushes beyond the yield strain, in rows of tables and cells of maps.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::compute::{compute, compute_as, is_contact};
use whiskmap::engine::{Engine, Spectral};
use whiskmap::friction::Sliding;
use whiskmap::map::Panel;
use whiskmap::mechanics::shooting::batch::Method;
use whiskmap::plan::Plan;
use whiskmap::scene::{Parameter, Scene, Whisker, WhiskerRow};
use whiskmap::sheet::Sheet;
use whiskmap::trace::{Branch, BranchPoint, corner, curve};
use whiskmap::yields::{PushMark, StrainMark, YieldMark};
use whiskmap::{Channel, Channels, Side};

/// Scene of a whisker with these lines more in its file, and this yield strain.
fn scene(more: &str, yield_strain: Option<f64>) -> Scene {
    let text = format!(
        "title = 'y'\n[whisker]\nlength_mm = 20\nyoungs_modulus_gpa = 3\n{more}\n\
         [grid]\npush_angle_deg = {{ from = -60, to = 60, count = 41 }}\ndistance_mm = {{ from = 3, to = 19.5, count = 12 }}"
    );
    let scene = Scene::parse(&text, "y.toml").unwrap();
    scene.to_builder().yield_strain(yield_strain).build().unwrap()
}

const CONE: &str = "base_radius_um = 30\ntip_radius_um = 1.5";
const CYLINDER: &str = "base_radius_um = 30\ntip_radius_um = 30";
const CURVED: &str = "base_radius_um = 30\ntip_radius_um = 1.5\ncurvature.parabola_per_mm = 0.02\n[pole]\nradius_mm = 0.25";
const ROUGH: &str = "base_radius_um = 30\ntip_radius_um = 1.5\ncurvature.parabola_per_mm = 0.02\n\
     [pole]\nradius_mm = 0.25\n[contact]\nfriction = 0.3";
const ROUGH_IN_FOLLICLE: &str = "base_radius_um = 30\ntip_radius_um = 1.5\ncurvature.parabola_per_mm = 0.02\n\
     follicle.stiffness_nnm_per_rad = 500\n[pole]\nradius_mm = 0.25\n[contact]\nfriction = 0.3";
const MEASURED: &str =
    "profile.rows = [[0, 30], [5, 20], [12, 14], [20, 2]]\n[pole]\nradius_mm = 0.2";
const SWELLING: &str = "profile.rows = [[0, 30], [6, 10], [9, 28], [14, 6], [17, 12], [20, 2]]\n[pole]\nradius_mm = 0.2";
const PERFECT: &str = "base_radius_um = 30\ntip_radius_um = 0\n[pole]\nradius_mm = 0.1";

/// Largest strain of a straight whisker in one state, from its bent shape alone: radius times curvature at 20,001 points.
fn strain_of_shape(whisker: &Whisker, branch: &Branch, push_deg: f64) -> f64 {
    let state = branch.state(push_deg.to_radians(), true).unwrap();
    let shape = branch.shape(&state, 20_001);
    let strains = shape.points.iter().map(|point| {
        let part = point.arc_length_mm / whisker.length_mm;
        let radius_um = whisker.base_radius_um * (1.0 - whisker.taper() * part);
        1e-3 * radius_um * point.curvature_per_mm.abs()
    });
    strains.fold(0.0, f64::max)
}

/// States are marked from the push on at which radius times curvature of the shape exceeds the yield strain. Points of the shape miss the
/// largest strain by 1e-9 of it, and so the push by 1e-7 deg.
#[test]
fn states_are_marked_from_the_yield_strain_on() {
    const YIELD: f64 = 0.002;
    let scene = scene(CONE, Some(YIELD));
    let branch = Branch::new(&scene.whisker, &scene.pole, Side::Cb, 10.0).unwrap();
    let (mut below, mut above) = (0.0, branch.stable_end_deg());
    for _ in 0..40 {
        let middle = 0.5 * (below + above);
        match strain_of_shape(&scene.whisker, &branch, middle) > YIELD {
            true => above = middle,
            false => below = middle,
        }
    }
    assert!(1.0 < below && below < branch.stable_end_deg() - 1.0, "{below}");
    let mark = |push_deg: f64| {
        let state = branch.state(f64::to_radians(push_deg), true).unwrap();
        YieldMark::new(&scene.whisker, branch.point_of(&state).peak_strain).unwrap()
    };
    for (push_deg, yields) in [(below - 1e-6, false), (above + 1e-6, true)] {
        assert_eq!(mark(push_deg).yields, Some(yields), "{push_deg}");
    }
    let elastic = without_yield_strain(&scene);
    assert_eq!(YieldMark::of_rows(&elastic.whisker, [0.1; 9]), None);
}

/// The scene without a yield strain.
fn without_yield_strain(scene: &Scene) -> Scene {
    scene.to_builder().yield_strain(None).build().unwrap()
}

/// Contact and force on the base of a row give the strain of its state, also with friction, whatever its direction. The difference is
/// 2e-13 at most; that of the force ratio of a contact that hardly pushes is larger.
#[test]
fn contact_and_force_of_a_row_give_its_strain() {
    let mut slidings = [0; 3];
    for (more, most) in [
        (CONE, 1e-11),
        (CYLINDER, 1e-11),
        (CURVED, 1e-11),
        (MEASURED, 1e-11),
        (ROUGH, 1e-9),
        (ROUGH_IN_FOLLICLE, 1e-9),
    ] {
        let scene = scene(more, Some(0.003));
        for side in Side::BOTH {
            let branch = Branch::new(&scene.whisker, &scene.pole, side, 15.66).unwrap();
            let points = branch.points(120).unwrap();
            let points = points.into_iter().filter(|point| point.stable);
            let rows: Vec<BranchPoint> = points.collect();
            let marks = StrainMark::of_rows(&scene.whisker, &scene.pole, &rows).unwrap();
            assert_eq!(marks.len(), rows.len());
            for (point, mark) in rows.iter().zip(marks) {
                let strain = mark.peak_strain.unwrap();
                let apart = (strain - point.peak_strain).abs();
                assert!(apart <= most * point.peak_strain, "{more}: {point:?} {strain}");
                assert_eq!(mark.yields, Some(strain > 0.003));
                if let Some(sliding) = point.sliding {
                    slidings[sliding as usize] += 1;
                }
            }
        }
        assert_eq!(
            StrainMark::of_rows(
                &without_yield_strain(&scene).whisker,
                &scene.pole,
                &[] as &[BranchPoint]
            ),
            None
        );
    }
    let [tip, base, sticks] =
        [Sliding::Tip, Sliding::Base, Sliding::Sticks].map(|sliding| slidings[sliding as usize]);
    assert!(tip > 100 && base > 3 && sticks > 3, "{slidings:?}");
}

/// The strain of a cylinder falls before it slips off: the push yields although its last state does not.
#[test]
fn a_push_is_marked_by_its_largest_strain() {
    let elastic = scene(CYLINDER, None);
    let end = curve(&elastic.whisker, &elastic.pole, Side::Cb, &[8.0])[0];
    let branch = Branch::new(&elastic.whisker, &elastic.pole, Side::Cb, 8.0).unwrap();
    let last = branch.stable_end_deg();
    let pushes = (1..400).map(|i| last * f64::from(i) / 400.0);
    let strains = pushes.map(|push_deg| strain_of_shape(&elastic.whisker, &branch, push_deg));
    let largest = strains.fold(0.0, f64::max);
    assert!(end.peak_strain.unwrap() < 0.98 * largest);
    let cylinder = |yield_strain| scene(CYLINDER, Some(yield_strain));
    for (yield_strain, yields) in [(largest * (1.0 - 1e-4), true), (largest * (1.0 + 1e-4), false)]
    {
        let scene = cylinder(yield_strain);
        let mark = PushMark::of_end(&scene.whisker, &scene.pole, &end).unwrap();
        // 400 pushes miss the maximum by 3e-6.
        assert!((mark.max_strain.unwrap() / largest - 1.0).abs() < 1e-5, "{mark:?} {largest}");
        assert_eq!(mark.yields, Some(yields), "{mark:?}");
    }
    // A corner has the mark of the push that ends at it.
    let scene = scene(CONE, Some(largest));
    let corner = corner(&scene.whisker, &scene.pole, Side::Cb);
    let end = curve(&scene.whisker, &scene.pole, Side::Cb, &[corner.distance_mm.unwrap()])[0];
    let marks = [
        PushMark::of_corner(&scene.whisker, &scene.pole, &corner),
        PushMark::of_end(&scene.whisker, &scene.pole, &end),
    ];
    assert!(marks[0].unwrap().max_strain.unwrap() > 1e-4 && marks[0] == marks[1], "{marks:?}");
    // Without a detachment there is no push.
    let scene = cylinder(1e-3);
    let beyond = curve(&scene.whisker, &scene.pole, Side::Cb, &[20.5])[0];
    let none = PushMark::of_end(&scene.whisker, &scene.pole, &beyond);
    assert_eq!(none, Some(PushMark::default()));
    assert_eq!(PushMark::of_end(&elastic.whisker, &elastic.pole, &end), None);
}

/// Returns true if the rows of a side of the scene's whisker are followed by continuation.
fn is_continued(scene: &Scene) -> bool {
    let length = scene.whisker.length_mm;
    let distances: Vec<f64> =
        scene.grid.distance_mm.iter().map(|distance| distance / length).collect();
    let rod = |side| scene.whisker.rod(&scene.pole, side);
    let mut sheets =
        Side::BOTH.map(|side| Sheet::new(Method::fine(), &rod(side), side, &distances)).into_iter();
    sheets.any(|sheet| sheet.is_continued())
}

fn panel(scene: &Scene, engine: Option<&mut dyn Engine>) -> Panel {
    compute(scene, engine).1.remove(0)
}

/// Cells have the largest strain of the state of the branch, by every engine on the CPU, on rows of nets and of continuation, and in each
/// direction of friction.
#[test]
fn cells_have_the_strains_of_their_states() {
    for more in [CONE, CURVED, ROUGH, MEASURED, SWELLING, PERFECT] {
        let scene = scene(more, Some(0.003));
        let mut spectral = Spectral::default();
        let panels = [panel(&scene, None), panel(&scene, Some(&mut spectral))];
        if more == SWELLING {
            assert!(is_continued(&scene));
        }
        let pushes = &scene.grid.push_angle_deg;
        let mut compared = 0;
        for (row, distance) in scene.grid.distance_mm.iter().enumerate() {
            for side in Side::BOTH {
                let Ok(branch) = Branch::new(&scene.whisker, &scene.pole, side, *distance) else {
                    continue;
                };
                for (column, push) in pushes.iter().enumerate() {
                    let at = row * pushes.len() + column;
                    if Side::of_push(*push) != side || !is_contact(panels[0].regime[at]) {
                        continue;
                    }
                    let Ok(state) = branch.state(push.to_radians(), true) else {
                        continue;
                    };
                    let wanted = branch.point_of(&state).peak_strain;
                    for panel in &panels {
                        let found = f64::from(panel.peak_strain[at]);
                        // Single precision.
                        let most = 2e-7 * wanted + 1e-12;
                        assert!(
                            (found - wanted).abs() <= most,
                            "{more}: {distance} {push}: {found} {wanted}"
                        );
                    }
                    compared += 1;
                }
            }
        }
        assert!(compared > 80, "{more}: {compared}");
        for panel in &panels {
            let cells = panel.peak_strain.iter().zip(panel.channel(Channel::Force));
            assert!(cells.into_iter().all(|(strain, force)| strain.is_nan() == force.is_nan()));
        }
    }
}

/// A run counts the cells beyond the yield strain.
#[test]
fn cells_beyond_the_yield_strain_are_counted() {
    for more in [CONE, ROUGH] {
        let marked = scene(more, Some(0.003));
        let (summary, panels) = compute(&marked, None);
        let beyond = panels[0].peak_strain.iter().filter(|strain| **strain > 0.003);
        assert_eq!(summary.yielding, beyond.count() as u64);
        assert!(0 < summary.yielding && summary.yielding < summary.refined, "{more}");
        let channels: Channels = "regime,peak_strain".parse().unwrap();
        let plain = scene(more, None);
        let plan = Plan::new(&plain).unwrap().with_channels(channels, &plain).unwrap();
        assert_eq!(compute_as(&plain, &plan, None).0.yielding, 0);
    }
}

/// Strains change no other value, and are computed only if the channel is selected or the scene has a yield strain.
#[test]
fn strains_are_computed_on_demand() {
    let (marked, plain) = (scene(ROUGH, Some(0.003)), scene(ROUGH, None));
    let [mut with, without] = [&marked, &plain].map(|scene| panel(scene, None));
    assert!(without.peak_strain.is_empty());
    let strains = std::mem::take(&mut with.peak_strain);
    assert_eq!(format!("{with:?}"), format!("{without:?}"));
    // Without other channels of states, the strains are the same.
    let channels: Channels = "regime,peak_strain".parse().unwrap();
    let plan = Plan::new(&plain).unwrap().with_channels(channels, &plain).unwrap();
    let alone = compute_as(&plain, &plan, None).1.remove(0);
    assert!(alone.channel(Channel::Force).is_empty());
    let bits = |strains: &[f32]| strains.iter().map(|strain| strain.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&alone.peak_strain), bits(&strains));
    let few = Plan::new(&plain).unwrap();
    assert!(plan.bytes > few.bytes && few.channels == Channels::STANDARD);
}

/// Whiskers of a sweep and of a table have the yield strain of the scene, and the text of a changed scene keeps it.
#[test]
fn every_whisker_of_a_scene_has_its_yield_strain() {
    let scene = scene(CONE, Some(0.0125));
    let swept = scene.to_builder().sweep(Parameter::LengthMm, [15.0, 20.0]).build().unwrap();
    let rows = ["a", "b"].map(WhiskerRow::new);
    let table = scene.to_builder().whiskers(rows).build().unwrap();
    for scene in [&swept, &table] {
        let strains = scene.whiskers().map(|swept| swept.unwrap().whisker.yield_strain);
        assert_eq!(strains.collect::<Vec<_>>(), [Some(0.0125); 2]);
        let one = scene.of_whisker(1).unwrap();
        assert_eq!(one.whisker.yield_strain, Some(0.0125));
        let again = Scene::parse(&scene.to_toml(), "y.toml").unwrap();
        assert_eq!(again.whisker, scene.whisker);
    }
    // A row of a table may have its own, which the scene's does not replace.
    let rows = [("a", 0.02), ("b", f64::NAN)];
    let rows = rows.map(|(name, strain)| WhiskerRow::new(name).yield_strain(strain));
    let table = scene.to_builder().whiskers(rows).build().unwrap();
    let strains = table.whiskers().map(|swept| swept.unwrap().whisker.yield_strain);
    assert_eq!(strains.collect::<Vec<_>>(), [Some(0.02), None]);
    let one = table.of_whisker(0).unwrap();
    assert_eq!(one.whisker.yield_strain, Some(0.02));
    let again = Scene::parse(&table.to_toml(), "y.toml").unwrap();
    assert_eq!(again.table, table.table);
    let refused = table.to_builder().yield_strain(0.1).build();
    let why = "whisker.yield_strain: must be left out: whiskers.table has the column yield_strain";
    assert!(refused.unwrap_err().to_string().contains(why));
    let text = scene.to_toml_with(&[(Parameter::LengthMm, 21.0)]).unwrap();
    assert!(text.contains("yield_strain = 0.0125"), "{text}");
    let why = scene.to_builder().yield_strain(0.0).build().unwrap_err().to_string();
    assert!(why.contains("whisker.yield_strain = 0: must be more than 0 and at most 1"), "{why}");
}
