//! The contract that every engine passes.

use crate::cells::{RandomRows, places, solve};
use crate::compute::{compute, open};
use crate::random_rods::USUAL;
use std::sync::Arc;
use whiskmap::engine::gpu::{Gpu, Precision, adapters, preferred};
use whiskmap::engine::{BasePoint, Cells, Cpu, Engine, Outcome, RowBatch};
use whiskmap::plan::STATE_CHANNELS;
use whiskmap::scene::Scene;
use whiskmap::shooting::ShootingMap;
use whiskmap::shooting::batch::{Batch, InitialCondition};

tests! {
    Engine:
        a_response_does_not_depend_on_the_batch,
        a_response_does_not_depend_on_what_else_is_submitted,
        a_response_has_the_columns_wanted,
        solved_cells_are_those_of_the_cpu,
        residuals_are_below_the_bound,
        nothing_in_nothing_out;
    Precision:
        effects_that_a_whisker_lacks_do_no_harm,
        a_nan_hurts_only_the_cells_of_its_base_point;
    Adapter:
        the_engine_runs_on_the_preferred_adapter;
}

/// Rows of two whiskers: so many that a patch has fewer states than their cells.
fn some() -> RandomRows {
    RandomRows::many(160, USUAL, 2, 9, |_, _| ())
}

/// A cell as bits; only the outcome if it is not solved.
type CellBits = (
    Outcome,
    Option<([u32; STATE_CHANNELS.len()], u32, [u64; 2])>,
);

fn bits(cells: &Cells) -> Vec<CellBits> {
    let bits = |index: usize| {
        let cell = cells.get(index);
        let numbers = (
            cell.values.map(f32::to_bits),
            cell.residual.to_bits(),
            cell.point.to_array().map(f64::to_bits),
        );
        let is_solved = cell.outcome == Outcome::Solved;
        (cell.outcome, is_solved.then_some(numbers))
    };
    (0..cells.len()).map(bits).collect()
}

fn solved(cells: &Cells) -> usize {
    let solved = cells.outcome.iter().filter(|own| **own == Outcome::Solved);
    solved.count()
}

fn a_response_does_not_depend_on_the_batch(engine: &mut dyn Engine) {
    let rows = some();
    let batch = rows.batch(engine);
    let whole = solve(engine, &batch);
    assert!(solved(&whole) > 1000);
    let whole = bits(&whole);
    for size in [1, 7, 64] {
        let mut parts = Vec::new();
        for from in (0..rows.len()).step_by(size) {
            let part = rows.part(engine, from..rows.len().min(from + size));
            parts.extend(bits(&solve(engine, &part)));
        }
        assert!(parts == whole, "{size} rows at once");
    }
}

/// Batches that are submitted before the ones before them are collected, one of them empty, another with other push angles.
fn a_response_does_not_depend_on_what_else_is_submitted(engine: &mut dyn Engine) {
    let rows = some();
    let other = RandomRows::new(USUAL, 3, 2, |_, _| ());
    let few = rows.len() / 5;
    let batches = [
        rows.part(engine, 0..few),
        other.batch(engine),
        rows.part(engine, 0..0),
        rows.part(engine, few..rows.len()),
    ];
    let alone = batches.each_ref().map(|batch| bits(&solve(engine, batch)));
    for batch in batches {
        engine.submit(Arc::new(batch)).unwrap();
    }
    for alone in alone {
        assert!(bits(&engine.collect().unwrap()) == alone);
    }
    assert!(engine.collect().unwrap().is_empty());
}

fn a_response_has_the_columns_wanted(engine: &mut dyn Engine) {
    let mut batch = some().part(engine, 0..16);
    let all = solve(engine, &batch);
    for (has_values, has_points) in [(true, true), (true, false), (false, true), (false, false)] {
        (batch.has_values, batch.has_points) = (has_values, has_points);
        let cells = solve(engine, &batch);
        assert!(cells.fit(&batch));
        assert_eq!(cells.values[0].is_empty(), !has_values);
        assert_eq!(cells.points.is_empty(), !has_points);
        assert!(cells.outcome == all.outcome && cells.steps == all.steps);
    }
}

/// Values agree to what an engine may be off in a map.
fn solved_cells_are_those_of_the_cpu(engine: &mut dyn Engine) {
    let batch = some().batch(engine);
    let (cells, wanted) = (solve(engine, &batch), Cpu::default().solve(&batch));
    for (values, wanted_values) in cells.values.iter().zip(&wanted.values) {
        let places = (0..cells.len()).filter(|i| cells.outcome[*i] == Outcome::Solved);
        let places: Vec<usize> = places.collect();
        let largest = places.iter().map(|i| wanted_values[*i].abs());
        let largest = largest.fold(0.0, f32::max);
        for i in places {
            assert_eq!(wanted.outcome[i], Outcome::Solved);
            let apart = (values[i] - wanted_values[i]).abs() / largest;
            assert!(apart <= crate::compute::WORST, "{apart:.1e}");
        }
    }
}

/// The pole of a solved cell is where its residual says, up to what the integrator leaves.
fn residuals_are_below_the_bound(engine: &mut dyn Engine) {
    let batch = some().batch(engine);
    let cells = solve(engine, &batch);
    let solved = places(&batch).into_iter().zip(0..);
    let solved = solved.filter(|(_, i)| cells.outcome[*i] == Outcome::Solved);
    let solved: Vec<_> = solved.collect();
    let conditions = solved.iter().map(|((side, ..), i)| InitialCondition {
        rod: &batch.sides[*side].sheet.rod,
        tau: cells.points[*i].x,
        load: cells.points[*i].y,
    });
    let conditions: Vec<InitialCondition> = conditions.collect();
    let maps = Batch::new(batch.method).shoot::<ShootingMap>(&conditions);
    for (((side, row, push, _), i), map) in solved.into_iter().zip(maps) {
        let residual = f64::from(cells.residual[i]);
        assert!(residual <= engine.residual_bound(), "{residual:e}");
        let pole = batch.sides[side].sheet.rows[row].pole(push);
        // Points are base points plus differences in `f32`.
        let miss = map.pole.distance(pole);
        assert!(miss <= 1e-7, "{miss:e}");
    }
}

fn nothing_in_nothing_out(engine: &mut dyn Engine) {
    let batch = some().part(engine, 0..0);
    assert!(solve(engine, &batch).is_empty());
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
    assert!(cells.solved > 20 * cells.fallback());
}

/// The batch with one base point changed.
fn spoilt(batch: &RowBatch, gpu: &Gpu, number: usize, spoil: fn(&mut BasePoint)) -> RowBatch {
    let mut batch = batch.clone();
    let mut base_points = batch.base_points.clone();
    spoil(&mut base_points[number]);
    let resolution = gpu.resolution(batch.method.resolution);
    batch.set_base_points(base_points, resolution);
    batch
}

fn a_nan_hurts_only_the_cells_of_its_base_point(precision: Precision) {
    let mut gpu = open(precision);
    let batch = some().batch(&gpu);
    let number = batch.base_points.len() / 2;
    let sound = bits(&solve(&mut gpu, &batch));
    type Spoil = fn(&mut BasePoint);
    let spoils: [(&str, Spoil); 8] = [
        ("tau", |base| base.tau = f64::NAN),
        ("load", |base| base.load = f64::INFINITY),
        ("push angle", |base| base.push = f64::NAN),
        ("row parameter", |base| base.load_per_w = f64::NAN),
        ("row", |base| base.row[3][1] = f64::NAN),
        ("position", |base| base.state.full.position.y = f64::NAN),
        ("derivative", |base| {
            base.state.by_tau.position.x = f64::INFINITY
        }),
        ("energy", |base| base.state.full.energy = f64::NAN),
    ];
    for (what, spoil) in spoils {
        let spoilt = spoilt(&batch, &gpu, number, spoil);
        let cells = bits(&solve(&mut gpu, &spoilt));
        for ((cell, sound), (.., base)) in cells.iter().zip(&sound).zip(places(&batch)) {
            match base == Some(number) {
                true => assert_eq!(cell.0, Outcome::NotFinite, "{what}"),
                false => assert_eq!(cell, sound, "{what}"),
            }
        }
    }
}

fn the_engine_runs_on_the_preferred_adapter() {
    let gpu = open(Precision::F32);
    let reports = adapters();
    let chosen = &reports[preferred(&reports, Precision::F32).unwrap()];
    assert!(gpu.describe().adapter.starts_with(&chosen.info.name));
    assert_eq!(gpu.describe().engine, "gpu f32");
}
