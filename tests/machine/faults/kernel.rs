//! Kernels that are spoilt.

use super::{assert_same, cone};
use crate::compute::{
    all_cells, assert_identical, assert_same_states, compute, compute_as, open, open_with, works,
};
use whiskmap::engine::EngineError;
use whiskmap::engine::gpu::{Gpu, Precision, shaders};
use whiskmap::map::{EngineCells, Panel, Summary};
use whiskmap::plan::Plan;
use whiskmap::scene::Scene;

tests! {
    Precision:
        numbers_that_are_none_are_refined_in_f64_and_counted,
        a_kernel_that_is_wrong_everywhere_is_caught,
        a_sound_kernel_passes_its_audit;
    Adapter:
        a_kernel_that_does_nothing_is_noticed,
        a_kernel_that_is_wrong_in_one_cell_of_a_thousand_is_caught,
        a_kernel_that_the_driver_refuses_leaves_all_to_the_cpu;
}

/// The last line of the entry point.
const LAST: &str = "write_cell(id, cell);";

/// The GPU engine with `LAST` replaced; `cell` is the sound cell, `wrong` a copy of it.
fn spoilt(precision: Precision, with: &str) -> Gpu {
    let text = shaders::cells(precision);
    assert_eq!(text.matches(LAST).count(), 1);
    let numbers = "let nan = bitcast<f32>(0x7fc00000u | (id >> 31u));
        let infinite = bitcast<f32>(0x7f800000u | (id >> 31u));
        var wrong = cell;";
    open_with(precision, text.replace(LAST, &format!("{numbers}\n{with}")))
}

/// The map of `scene` in one row batch by `gpu`.
fn at_once(scene: &Scene, gpu: &mut Gpu) -> (Summary, Vec<Panel>) {
    let mut plan = Plan::new(scene).unwrap();
    plan.rows_at_once = 2 * scene.grid.distance_mm.len();
    compute_as(scene, &plan, Some(gpu))
}

/// The part of the cells that a sound kernel solves at least.
const SOLVED: f64 = 0.9;

/// Claims of having solved a cell with a number that is none. All of those cells are refined, and counted.
fn numbers_that_are_none_are_refined_in_f64_and_counted(precision: Precision) {
    let scene = cone(128);
    let (_, cpu) = compute(&scene, None);
    let (sound, _) = compute(&scene, Some(&mut open(precision)));
    works(&sound, SOLVED).unwrap();
    let sound = sound.engine_cells;
    assert_eq!(sound.not_finite, 0);
    // The host evaluates cells near touch.
    let (idle, refined) = compute(&scene, Some(&mut spoilt(precision, "")));
    let on_host = idle.engine_cells.solved;
    assert_eq!(on_host > 0, precision == Precision::F32);
    let asked = sound.solved + sound.fallback() - on_host;
    for (none, part) in [
        ("wrong.numbers[8] = nan;", 1.0),
        ("wrong.residual = infinite;", 1.0),
        ("if id % 7u == 0u { wrong.numbers[0] = infinite; }", 1.0 / 7.0),
    ] {
        let mut gpu = spoilt(precision, &format!("{none} write_cell(id, wrong);"));
        let (summary, panels) = compute(&scene, Some(&mut gpu));
        assert!(summary.engine_failure.is_none(), "{summary:?}");
        let cells = summary.engine_cells;
        // Each submission, of thousands of cells, counts its cells from 0.
        let missing = cells.not_finite as f64 - part * asked as f64;
        assert!(missing.abs() <= 0.01 * asked as f64, "{none}: {cells:?}");
        assert_eq!(all_cells(&cells), all_cells(&sound));
        assert_same(&cpu, &panels);
        if part == 1.0 {
            assert_same_states(&refined, &panels);
        }
    }
}

/// The map is right, so only the counts show the fault.
fn a_kernel_that_does_nothing_is_noticed() {
    let scene = cone(128);
    let (_, cpu) = compute(&scene, None);
    for writes in [
        "if id == 0xffffffffu { write_cell(id, wrong); }",
        "wrong = Cell(); write_cell(id, wrong);",
    ] {
        let mut gpu = spoilt(Precision::F32, writes);
        let (summary, panels) = compute(&scene, Some(&mut gpu));
        let EngineCells { solved, not_finite, without_row, .. } = summary.engine_cells;
        let only = EngineCells { solved, not_finite, without_row, ..EngineCells::default() };
        // The host evaluates cells near touch.
        assert!(not_finite > 1000 && solved * 8 < not_finite);
        assert_eq!(summary.engine_cells, only);
        assert!(works(&summary, SOLVED).is_err());
        assert_same(&cpu, &panels);
    }
}

/// Asserts that the audit has caught `gpu`, and that the map is the CPU's.
fn assert_caught(scene: &Scene, gpu: &mut Gpu) {
    let (summary, panels) = at_once(scene, gpu);
    let audit = summary.audit;
    let failed = EngineError::FailedAudit { differing: audit.differing, cells: audit.cells };
    let failure = summary.engine_failure.unwrap();
    assert_eq!(failure.to_string(), failed.to_string());
    assert!(audit.differing > 0 && audit.turned_over > audit.cells, "{audit:?}");
    let on_cpu_instead = summary.engine_cells.on_cpu_instead;
    assert_eq!(all_cells(&summary.engine_cells), on_cpu_instead);
    assert_identical(&compute(scene, None).1, &panels);
}

/// Contacts and base moments that are wrong by 1e-5, and whole cells.
const WRONG: [&str; 3] = [
    "wrong.numbers[0] *= 1.00002;",
    "wrong.numbers[5] += 1e-5 * f32(terms_at(head.z).last.x);",
    "wrong = solve(rows[run], push + vec2<real>(real(1e-4), real(0.0)), head.z + 1u, head.w - 1u);",
];

fn a_kernel_that_is_wrong_everywhere_is_caught(precision: Precision) {
    let scene = cone(128);
    for wrong in WRONG {
        let mut gpu = spoilt(precision, &format!("{wrong} write_cell(id, wrong);"));
        assert_caught(&scene, &mut gpu);
    }
}

/// A sound kernel is not.
fn a_sound_kernel_passes_its_audit(precision: Precision) {
    let scene = cone(128);
    let (_, cpu) = compute(&scene, None);
    let (summary, panels) = at_once(&scene, &mut open(precision));
    works(&summary, SOLVED).unwrap();
    assert!(summary.audit.cells > 32 && summary.audit.turned_over == 0);
    assert_same(&cpu, &panels);
}

/// Which one of a thousand cells is wrong, whatever submission it is in. The audit looks at 137 of 36,700 cells with a state, so that it has
/// one of 37 with a probability of 13 %, and the first choice is the eighth. It has one of those in a map of a million cells with 98 %.
const CHOSEN: u32 = 7;

/// The sample of the audit is the same in every run, and so are the cells that are wrong.
fn a_kernel_that_is_wrong_in_one_cell_of_a_thousand_is_caught() {
    let scene = cone(256);
    let wrong = format!(
        "let mixed = (bitcast<u32>(f32(push.x)) ^ bitcast<u32>(f32(terms_at(head.z).state.y))) * 2654435761u;
         if (mixed >> 8u) % 1000u == {CHOSEN}u {{ {} }}
         write_cell(id, wrong);",
        WRONG[0]
    );
    assert_caught(&scene, &mut spoilt(Precision::F32, &wrong));
}

fn a_kernel_that_the_driver_refuses_leaves_all_to_the_cpu() {
    let scene = cone(128);
    for (shader, why) in [("fn solve_cells() {", "expected"), ("fn other() {}", "solve_cells")] {
        let mut gpu = open_with(Precision::F32, shader.to_owned());
        let (summary, panels) = compute(&scene, Some(&mut gpu));
        let failure = summary.engine_failure.unwrap().to_string();
        assert!(failure.contains(why), "{failure}");
        let on_cpu_instead = summary.engine_cells.on_cpu_instead;
        assert_eq!(all_cells(&summary.engine_cells), on_cpu_instead);
        assert_identical(&compute(&scene, None).1, &panels);
    }
}
