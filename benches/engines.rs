//! Cost of each stage of a map: `cargo bench --bench engines -- [filter]`. `whiskmap bench` measures whole maps and their accuracy.
#![allow(clippy::print_stdout, reason = "the program prints a table")]
#![allow(clippy::expect_used, reason = "a benchmark that cannot start panics")]

#[path = "../tests/support/cells.rs"]
mod cells;
mod measure;
#[path = "../tests/support/random_rods.rs"]
mod random_rods;

use cells::{RandomRows, solve};
use measure::Group;
use random_rods::{USUAL, conditions};
use std::hint::black_box;
use std::path::Path;
use whiskmap::Side;
use whiskmap::engine::gpu::{Gpu, Precision};
use whiskmap::engine::{Cpu, Engine};
use whiskmap::map;
use whiskmap::map::{Audit, EngineCells, Panel};
use whiskmap::mechanics::numerics::Unit;
use whiskmap::mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap::mechanics::shooting::{FirstVariation, Resolution, SecondVariation, ShootingMap};
use whiskmap::plan::Plan;
use whiskmap::refine::{CellTarget, refine};
use whiskmap::scene::Scene;
use whiskmap::sheet::Sheet;
use whiskmap::store::{MapDescription, MapWriter, Output, StoreError, TemporaryFiles};

const TRAJECTORIES: usize = 16_384;

fn main() {
    integrators();
    engines();
    sheets();
    files();
}

/// Trajectories by number of steps and by derivatives, scalar and in SIMD vectors.
fn integrators() {
    let conditions: Vec<InitialCondition> = conditions(USUAL, TRAJECTORIES, 6.5, 1);
    let group = Group::new("integrators");
    for resolution in Resolution::LADDER {
        let method = Method::new(resolution).with_effects(USUAL);
        let steps = resolution.least;
        let name = format!("nystrom8, first derivatives, {steps} steps");
        group.rate(name, TRAJECTORIES, || {
            Batch::new(method).shoot::<ShootingMap>(black_box(&conditions))
        });
    }
    let fine = Method::fine().with_effects(USUAL);
    group.rate("nystrom8, first derivatives and energy", TRAJECTORIES, || {
        Batch::new(fine).shoot::<FirstVariation>(black_box(&conditions))
    });
    group.rate("nystrom8, second derivatives", TRAJECTORIES, || {
        Batch::new(fine).shoot::<SecondVariation>(black_box(&conditions))
    });
    group.rate("nystrom8, first derivatives, scalar", TRAJECTORIES, || {
        Batch::new(fine).on(Unit::scalar()).shoot::<ShootingMap>(black_box(&conditions))
    });
}

/// Engines by number of cells in a batch.
fn engines() {
    let group = Group::new("engines");
    let mut engines: Vec<Box<dyn Engine>> = vec![Box::new(Cpu::default())];
    for precision in [Precision::F32, Precision::F64] {
        // Without a GPU driver only the CPU is measured.
        engines.extend(Gpu::open(None, precision).map(|gpu| Box::new(gpu) as Box<dyn Engine>));
    }
    for whiskers in [1, 8, 64] {
        let rows = RandomRows::many(96, USUAL, whiskers, 2, |_, _| ());
        for engine in &mut engines {
            let batch = rows.batch(engine.as_ref());
            let cells = batch.cells();
            let name = format!("{}, {cells} cells", engine.describe().engine);
            group.rate(name, cells, || solve(engine.as_mut(), black_box(&batch)));
        }
    }
}

fn scene() -> Scene {
    let text = include_str!("../scenes/cone.toml");
    Scene::parse(text, "cone.toml").expect("the scene is good")
}

/// Folds, net and crossings of a sheet, and refinement of its cells from the guesses of the net.
fn sheets() {
    let scene = scene();
    let rod = scene.whisker.rod(&scene.pole, Side::Cb);
    let method = Method::fine();
    let length = scene.whisker.length_mm;
    let distances: Vec<f64> = scene.grid.distance_mm.iter().map(|d| d / length).collect();
    let group = Group::new("sheets");
    group.time("fold at the tip", || Sheet::fold_at_tip(method, black_box(&rod), Side::Cb));
    for rows in [1, 32, 512] {
        let distances: Vec<f64> = distances.iter().copied().step_by(512 / rows).collect();
        group.time(format!("folds and crossings, {rows} rows"), || {
            Sheet::new(method, black_box(&rod), Side::Cb, &distances)
        });
    }
    let sheet = Sheet::new(method, &rod, Side::Cb, &distances);
    let pushes: Vec<f64> = (0..64).map(|i| 0.01 * f64::from(i)).collect();
    let mut shots = Vec::new();
    for (row, place) in sheet.rows.iter().enumerate() {
        let guesses = sheet.guesses(row, &pushes);
        for (guess, push) in guesses.iter().zip(&pushes) {
            shots.extend(guess.map(|guess| CellTarget { rod: 0, guess, pole: place.pole(*push) }));
        }
    }
    group.rate("refinement", shots.len(), || refine(method, &[&sheet], black_box(&shots)));
}

/// Writing of a map file.
fn files() {
    let scene = scene();
    let plan = Plan::new(&scene).expect("the scene is small");
    let mut kept: Option<Panel> = None;
    map::run_to_end(&scene, &plan, None, |panels| kept = panels.pop());
    let panel = kept.expect("the scene has a panel");
    let folder = tempfile::tempdir().expect("the system has a folder for temporary files");
    let about = MapDescription {
        scene: &scene,
        engine: &whiskmap::engine::EngineDescription::of(None),
        tolerances: &serde_json::json!({}),
        channels: whiskmap::map::Channels::STANDARD,
        digits: whiskmap::plan::Digits::ALL,
        arithmetic: "fma",
    };
    let write = |path: &Path| -> Result<(), StoreError> {
        let output = Output::create(path, &TemporaryFiles::default())
            .map_err(|why| StoreError::Write(path.to_owned(), why))?;
        let mut writer = MapWriter::create(output, &about)?;
        writer.write_panels(std::slice::from_ref(&panel))?;
        writer.finish(EngineCells::default(), Audit::default())?;
        Ok(())
    };
    let path = folder.path().join("map.exr");
    Group::new("files").rate("exr, 512 x 512 cells", panel.regime.len(), || {
        write(&path).expect("the folder can be written");
    });
}
