//! Whole maps: every engine with the same answer.

use crate::compute::{
    assert_close, assert_identical, assert_no_load_at_touch, compute, compute_as, open, shipped,
    works,
};
use whiskmap::engine::gpu::Precision;
use whiskmap::engine::{Engine, on_gpu};
use whiskmap::map::EngineCells;
use whiskmap::plan::Plan;
use whiskmap::scene::{Parameter, Scene};

tests! {
    Engine:
        a_map_of_regimes_passes_its_audit;
    Precision:
        engines_agree_on_every_cell,
        first_touch_is_without_a_load,
        what_an_engine_cannot_is_done_by_the_cpu;
}

/// The part of the cells that a GPU solves at least where rows have references.
const SOLVED: f64 = 0.9;

fn engines_agree_on_every_cell(precision: Precision) {
    let mut gpu = open(precision);
    for scene in shipped() {
        let scene = scene.thinned(128, 4);
        let effects = Plan::new(&scene).unwrap().method.effects;
        let (_, cpu) = compute(&scene, None);
        let (summary, panels) = compute(&scene, Some(&mut gpu));
        let title = &scene.title;
        assert_eq!(summary.unresolved(), 0, "{title}");
        if on_gpu(effects).is_ok() {
            // A single row has few base points for its push angles.
            let least = if scene.grid.distance_mm.len() > 1 {
                SOLVED
            } else {
                0.0
            };
            works(&summary, least).unwrap_or_else(|why| panic!("{title}: {why}"));
            assert_close(&cpu, &panels, title);
        } else {
            assert_identical(&cpu, &panels);
        }
    }
}

fn first_touch_is_without_a_load(precision: Precision) {
    let mut gpu = open(precision);
    assert_no_load_at_touch(|scene| compute(scene, Some(&mut gpu)).1.remove(0));
}

/// What the shaders lack, the CPU does: every cell of the map.
fn what_an_engine_cannot_is_done_by_the_cpu(precision: Precision) {
    let mut gpu = open(precision);
    let cone = Scene::read("scenes/cone.toml").unwrap().thinned(48, 1);
    let graded = cone.with(Parameter::ModulusTipToBase, 1.5).unwrap();
    let measured = Scene::read("scenes/measured.toml").unwrap().thinned(48, 1);
    for (scene, why) in [(graded, "a modulus gradient"), (measured, "measured radii")] {
        let effects = Plan::new(&scene).unwrap().method.effects;
        assert!(on_gpu(effects).unwrap_err().contains(why));
        let (_, cpu) = compute(&scene, None);
        let (summary, panels) = compute(&scene, Some(&mut gpu));
        let without_base_point = summary.engine_cells.without_base_point;
        assert!(without_base_point > 0);
        let only = EngineCells {
            without_base_point,
            ..EngineCells::default()
        };
        assert_eq!(summary.engine_cells, only);
        assert_identical(&cpu, &panels);
    }
}

/// Without stored states an engine returns no values, and the audit compares outcomes alone.
fn a_map_of_regimes_passes_its_audit(engine: &mut dyn Engine) {
    let cone = Scene::read("scenes/cone.toml").unwrap().thinned(256, 1);
    let mut plan = Plan::new(&cone).unwrap();
    plan.channels = "regime".parse().unwrap();
    let (summary, panels) = compute_as(&cone, &plan, Some(engine));
    assert!(summary.engine_failure.is_none());
    assert!(summary.engine_cells.solved > 0 && summary.audit.cells > 0);
    let (_, wanted) = compute(&cone, None);
    assert!(panels[0].regime == wanted[0].regime);
}
