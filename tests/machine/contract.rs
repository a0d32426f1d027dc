//! The contract that every engine passes.

use crate::cells::{RandomRows, near_touch, places, solve};
use crate::compute::open;
use crate::random_rods::USUAL;
use std::sync::Arc;
use whiskmap::classify::Outcome;
use whiskmap::engine::gpu::{Precision, adapters, preferred};
use whiskmap::engine::{Cells, Cpu, Engine, RowExpansion};
use whiskmap::mechanics::shooting::ShootingMap;
use whiskmap::mechanics::shooting::batch::{Batch, InitialCondition};
use whiskmap::plan::{Channels, STATE_CHANNELS};

tests! {
    Engine:
        a_response_does_not_depend_on_the_batch,
        a_response_does_not_depend_on_what_else_is_submitted,
        a_response_has_the_columns_wanted,
        solved_cells_are_those_of_the_cpu,
        residuals_are_below_the_bound,
        nothing_in_nothing_out,
        a_batch_without_expansions_is_no_failure;
    Precision:
        a_nan_hurts_only_the_cells_of_its_row;
    Adapter:
        the_engine_runs_on_the_preferred_adapter;
}

/// Rows of two whiskers: so many that a net takes less time than their cells.
fn some() -> RandomRows {
    RandomRows::many(160, USUAL, 2, 9, |_, _| ())
}

/// A cell as bits; only the outcome if it is not solved.
type CellBits = (Outcome, Option<([u32; STATE_CHANNELS.len()], u32, [u64; 2])>);

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
    let solved = cells.outcome.iter().filter(|outcome| **outcome == Outcome::Solved);
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
    let other = RandomRows::many(90, USUAL, 3, 2, |_, _| ());
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
    let has_few = |name: &str| ["arc_length_mm", "energy_nj"].contains(&name);
    let channels = [
        Channels::STANDARD.with("peak_strain"),
        Channels::STANDARD,
        Channels::those(has_few).with("peak_strain"),
        Channels::those(has_few),
        Channels::those(|name| name == "force_un"),
        Channels::those(|name| name == "regime").with("peak_strain"),
        Channels::those(|name| name == "regime"),
    ];
    for channels in channels {
        batch.channels = channels;
        let cells = solve(engine, &batch);
        assert!(cells.fit(&batch));
        assert_eq!(cells.points.is_empty(), !channels.has_strain());
        let solved = |cells: &Cells, values: &[f32]| {
            let each = cells.outcome.iter().zip(values);
            let solved = each.filter(|(outcome, _)| **outcome == Outcome::Solved);
            solved.map(|(_, value)| *value).collect::<Vec<f32>>()
        };
        for (channel, name) in STATE_CHANNELS.into_iter().enumerate() {
            let found = solved(&cells, &cells.values[channel]);
            if channels.contains(name) {
                assert!(found == solved(&all, &all.values[channel]), "{name}");
            } else {
                assert!(cells.values[channel].is_empty(), "{name}");
            }
        }
        assert!(cells.outcome == all.outcome && cells.steps == all.steps);
    }
}

/// Values agree to what an engine may be off in a map.
fn solved_cells_are_those_of_the_cpu(engine: &mut dyn Engine) {
    let batch = some().batch(engine);
    let (cells, wanted) = (solve(engine, &batch), Cpu::default().solve(&batch));
    assert!(solved(&cells) > 1000);
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
    assert!(solved(&cells) > 1000);
    let solved = places(&batch).into_iter().zip(0..);
    let solved = solved.filter(|(_, i)| cells.outcome[*i] == Outcome::Solved);
    let solved: Vec<_> = solved.collect();
    let conditions = solved.iter().map(|((side, ..), i)| {
        InitialCondition::new(&batch.sides[*side].sheet.rod, cells.points[*i])
    });
    let conditions: Vec<InitialCondition> = conditions.collect();
    let maps = Batch::new(batch.method).shoot::<ShootingMap>(&conditions);
    for (((side, row, push), i), map) in solved.into_iter().zip(maps) {
        let residual = f64::from(cells.residual[i]);
        assert!(residual <= engine.residual_bound(), "{residual:e}");
        let pole = batch.sides[side].sheet.rows[row].pole(push);
        let miss = map.pole.distance(pole);
        assert!(miss <= residual.max(1e-11), "{miss:e} {residual:e}");
    }
}

fn nothing_in_nothing_out(engine: &mut dyn Engine) {
    let batch = some().part(engine, 0..0);
    assert!(solve(engine, &batch).is_empty());
}

/// Only the CPU engine computes cells without expansions of their rows.
fn a_batch_without_expansions_is_no_failure(engine: &mut dyn Engine) {
    let is_cpu = engine.describe().engine.starts_with("cpu");
    let mut batch = some().part(engine, 0..16);
    batch.expansions.clear();
    let cells = solve(engine, &batch);
    assert!(cells.fit(&batch));
    assert_eq!(solved(&cells) > 0, is_cpu);
}

fn a_nan_hurts_only_the_cells_of_its_row(precision: Precision) {
    let mut gpu = open(precision);
    let batch = some().batch(&gpu);
    let number =
        (0..batch.rows.len()).filter(|row| batch.expansions[*row].is_some()).nth(40).unwrap();
    let sound = bits(&solve(&mut gpu, &batch));
    type Spoil = fn(&mut RowExpansion);
    let spoils: [(&str, Spoil); 4] = [
        ("push angle", |row| row.inverse.functions.coefficients[3][0] = f64::NAN),
        ("tau", |row| row.inverse.functions.coefficients[2][1] = f64::INFINITY),
        ("channel", |row| row.inverse.functions.coefficients[1][7] = f64::NAN),
        ("residual", |row| row.residual = f64::NAN),
    ];
    for (what, spoil) in spoils {
        let mut spoilt = batch.clone();
        spoil(spoilt.expansions[number].as_mut().unwrap());
        let cells = bits(&solve(&mut gpu, &spoilt));
        let row = &batch.rows[number];
        let mut on_device = row.cells();
        let on_host = on_device.start..on_device.start + near_touch(&batch, number, precision);
        on_device.start = on_host.end;
        for (index, (cell, sound)) in cells.iter().zip(&sound).enumerate() {
            // The host evaluates only rows of finite numbers.
            if on_host.contains(&index) {
                continue;
            }
            match on_device.contains(&index) {
                true => assert!(cell.1.is_none(), "{what}"),
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
