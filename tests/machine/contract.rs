//! What holds for every call.

use crate::cells::Cells;
use crate::compute::{compute, open};
use crate::random_rods::USUAL;
use std::sync::Arc;
use whiskmap::engine::gpu::{Gpu, Precision, adapters, preferred};
use whiskmap::engine::{BasePoint, CellDifference, Engine, Outcome};
use whiskmap::plan::STATE_CHANNELS;
use whiskmap::scene::Scene;

tests! {
    Precision:
        answers_do_not_depend_on_the_calls_that_they_come_from,
        answers_do_not_depend_on_what_else_is_under_way,
        effects_that_a_whisker_lacks_do_no_harm,
        no_number_hurts_only_its_own_cells,
        nothing_in_nothing_out;
    Adapter:
        the_engine_runs_on_the_preferred_adapter;
}

fn some() -> Cells {
    Cells::random(USUAL, 40, 9, |_, _| ())
}

/// A cell to the bit.
fn bits(cell: &CellDifference) -> ([u32; STATE_CHANNELS.len()], u32, Outcome) {
    let numbers = cell.numbers.map(f32::to_bits);
    (numbers, cell.residual.to_bits(), cell.outcome)
}

fn answers_do_not_depend_on_the_calls_that_they_come_from(precision: Precision) {
    let cells = some();
    let mut gpu = open(precision);
    let at_once: Vec<_> = cells.solve(&mut gpu).iter().map(bits).collect();
    assert!(at_once.len() > 1000);
    for size in [1, 7, 64, 1001] {
        let mut in_groups = Vec::new();
        for references in cells.references.chunks(size) {
            let solved = gpu.solve(cells.question(&gpu, references));
            in_groups.extend(solved.unwrap().iter().map(bits));
        }
        assert!(in_groups == at_once, "{size} references at once");
    }
}

/// Questions that are asked before the ones before them are answered, one of them about nothing, another at other push angles.
fn answers_do_not_depend_on_what_else_is_under_way(precision: Precision) {
    let cells = some();
    let other = Cells::random(USUAL, 3, 2, |_, _| ());
    let mut gpu = open(precision);
    let (few, many) = cells.references.split_at(cells.references.len() / 5);
    let questions = [
        cells.question(&gpu, few),
        other.question(&gpu, &other.references),
        cells.question(&gpu, &[]),
        cells.question(&gpu, many),
    ];
    let of = |answers: Vec<CellDifference>| answers.iter().map(bits).collect::<Vec<_>>();
    let alone = questions
        .each_ref()
        .map(|one| of(gpu.solve(Arc::clone(one)).unwrap()));
    for one in &questions {
        gpu.ask(Arc::clone(one)).unwrap();
    }
    for alone in alone {
        assert!(of(gpu.answer().unwrap()) == alone);
    }
    assert!(gpu.answer().unwrap().is_empty());
}

/// Sweeps share kernels: a cylinder is integrated as a cone that does not taper, a straight whisker as one that hardly bends.
fn effects_that_a_whisker_lacks_do_no_harm(precision: Precision) {
    let text = "title = \"sweep\"\nwhisker.length_mm = 20\nwhisker.base_radius_um = 30\nwhisker.youngs_modulus_gpa = 3\n\
        pole.radius_mm = 0.25\n[grid]\npush_angle_deg = { from = -60, to = 60, count = 64 }\n\
        distance_mm = { from = 4, to = 18, count = 8 }\ntaper = [0, 0.5]\ncurvature_per_mm = [0, 0.02]\n";
    let scene = Scene::parse(text, "sweep").unwrap();
    let mut gpu = open(precision);
    let cells = compute(&scene, Some(&mut gpu)).0.engine_cells;
    assert_eq!(cells.not_finite, 0);
    assert!(cells.solved > 20 * (cells.near_edge + cells.far + cells.missed));
}

/// The answers if number `spoilt` of the references is spoilt.
fn spoilt(
    cells: &Cells,
    gpu: &mut Gpu,
    spoilt: usize,
    spoil: fn(&mut BasePoint),
) -> Vec<CellDifference> {
    let mut references = cells.references.clone();
    spoil(&mut references[spoilt]);
    gpu.solve(cells.question(gpu, &references)).unwrap()
}

fn no_number_hurts_only_its_own_cells(precision: Precision) {
    let cells = some();
    let number = cells.references.len() / 2;
    let mut gpu = open(precision);
    let sound = cells.solve(&mut gpu);
    type Spoil = fn(&mut BasePoint);
    let spoils: [(&str, Spoil); 8] = [
        ("tau", |r| r.tau = f64::NAN),
        ("load", |r| r.load = f64::INFINITY),
        ("push angle", |r| r.push = f64::NAN),
        ("way", |r| r.per_way = f64::NAN),
        ("row", |r| r.row[3][1] = f64::NAN),
        ("position", |r| r.state.full.position.y = f64::NAN),
        ("derivative", |r| r.state.by_tau.position.x = f64::INFINITY),
        ("energy", |r| r.state.full.energy = f64::NAN),
    ];
    for (what, spoil) in spoils {
        let answers = spoilt(&cells, &mut gpu, number, spoil);
        let places = cells.places();
        for ((cell, sound), (reference, _)) in answers.iter().zip(&sound).zip(places) {
            if reference == number {
                assert_eq!(cell.outcome, Outcome::NotFinite, "{what}: {cell:?}");
            } else {
                assert_eq!(bits(cell), bits(sound), "{what}");
            }
        }
    }
}

fn nothing_in_nothing_out(precision: Precision) {
    let cells = some();
    let mut gpu = open(precision);
    let nothing = gpu.solve(cells.question(&gpu, &[]));
    assert_eq!(nothing.unwrap(), []);
}

fn the_engine_runs_on_the_preferred_adapter() {
    let gpu = open(Precision::F32);
    let reports = adapters();
    let chosen = &reports[preferred(&reports, Precision::F32).unwrap()];
    assert!(gpu.describe().adapter.starts_with(&chosen.info.name));
    assert_eq!(gpu.describe().engine, "gpu f32");
}
