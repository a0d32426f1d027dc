//! Cost of each set of effects: `cargo bench --bench effects -- [trajectories]`.
//!
//! For each set: the instructions of one cell's shader (reachable expressions and statements of naga, each loop counted once), and the
//! time per trajectory with first derivatives on one CPU thread, at the resolution of maps. Times are medians of seven interleaved
//! runs.
#![allow(clippy::print_stdout, reason = "the program prints a table")]
#![allow(clippy::expect_used, reason = "a benchmark that cannot start panics")]

use naga::back::pipeline_constants::process_overrides;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Block, Expression, Function, Handle, Literal, Module, Statement};
use std::time::Instant;
use whiskmap::engine::gpu::{Precision, shaders};
use whiskmap::rod::Effects;
use whiskmap::shooting::ShootingMap;
use whiskmap::shooting::batch::{Batch, InitialCondition, Method};

#[path = "../tests/effect_sets/mod.rs"]
mod effect_sets;
#[path = "../tests/random_rods/mod.rs"]
mod random_rods;

use random_rods::{Random, condition, rod};

const RUNS: usize = 7;

fn main() {
    let count = std::env::args()
        .nth(1)
        .and_then(|text| text.parse().ok())
        .unwrap_or(20_000);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1);
    pool.build_global()
        .expect("the global pool is not built yet");

    let sets: Vec<(Effects, Vec<InitialCondition<'static>>)> = effect_sets::all()
        .map(|effects| {
            let mut random = Random(31);
            let conditions = (0..count).map(|_| {
                let rod = Box::leak(Box::new(rod(effects, &mut random)));
                condition(rod, 6.5, &mut random)
            });
            (effects, conditions.collect())
        })
        .collect();
    let mut times = vec![Vec::new(); sets.len()];
    for _ in 0..RUNS {
        for ((effects, conditions), times) in sets.iter().zip(&mut times) {
            times.push(microseconds(*effects, conditions));
        }
    }
    let medians: Vec<f64> = times
        .iter_mut()
        .map(|times| {
            times.sort_by(f64::total_cmp);
            times[RUNS / 2]
        })
        .collect();
    println!("instructions  us/trajectory  ratio  spread  effects");
    for (i, (effects, _)) in sets.iter().enumerate() {
        let on_gpu = effect_sets::on_gpu().any(|own| own == *effects);
        let instructions = on_gpu.then(|| instructions(*effects).to_string());
        println!(
            "{:>12}  {:13.3}  {:5.2}  {:5.0} %  {}",
            instructions.unwrap_or_default(),
            medians[i],
            medians[i] / medians[0],
            100.0 * (times[i][RUNS - 1] / times[i][0] - 1.0),
            name(*effects),
        );
    }
}

fn microseconds(effects: Effects, conditions: &[InitialCondition]) -> f64 {
    let method = Method::fine().with_effects(effects);
    let start = Instant::now();
    let maps = Batch::new(method).shoot::<ShootingMap>(conditions);
    let micros = start.elapsed().as_secs_f64() * 1e6;
    assert!(maps.iter().all(|map| map.pole.is_finite()));
    micros / conditions.len() as f64
}

fn name(effects: Effects) -> String {
    let names = [
        (effects.taper && !effects.profile, "taper"),
        (effects.profile, "profile"),
        (effects.curvature, "parabola"),
        (effects.spiral, "euler spiral"),
        (effects.gradient, "modulus gradient"),
    ];
    let on: Vec<&str> = names
        .iter()
        .filter(|(on, _)| *on)
        .map(|(_, name)| *name)
        .collect();
    if on.is_empty() {
        "none: a straight cylinder".to_owned()
    } else {
        on.join(", ")
    }
}

/// Number of instructions that `solve_cells` can reach with these effects.
fn instructions(effects: Effects) -> usize {
    let text = shaders::cells(Precision::F32);
    let module = naga::front::wgsl::parse_str(&text).expect("the shader parses");
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    let info = validator.validate(&module).expect("the shader is valid");
    let entry = &module.entry_points[0];
    let constants = shaders::overrides(effects)
        .map(|(name, value)| (name.to_owned(), value))
        .into_iter()
        .collect();
    let entry_point = Some((entry.stage, entry.name.as_str()));
    let (module, _) = process_overrides(&module, &info, entry_point, &constants)
        .expect("every override constant has a value");
    let entry = &module.entry_points[0].function;
    in_block(&module, entry, &entry.body)
}

/// Number of expressions and statements of a block and of the functions that it calls, without branches that are never taken.
fn in_block(module: &Module, function: &Function, block: &Block) -> usize {
    block
        .iter()
        .map(|statement| match statement {
            Statement::Emit(range) => range.clone().count(),
            Statement::Block(block) => in_block(module, function, block),
            Statement::If {
                condition,
                accept,
                reject,
            } => match known(module, function, *condition) {
                Some(true) => in_block(module, function, accept),
                Some(false) => in_block(module, function, reject),
                None => 1 + in_block(module, function, accept) + in_block(module, function, reject),
            },
            Statement::Loop {
                body, continuing, ..
            } => in_block(module, function, body) + in_block(module, function, continuing),
            Statement::Call {
                function: callee, ..
            } => {
                let callee = &module.functions[*callee];
                1 + in_block(module, callee, &callee.body)
            }
            _ => 1,
        })
        .sum()
}

/// Value of a constant condition; `None` for other conditions.
fn known(module: &Module, function: &Function, condition: Handle<Expression>) -> Option<bool> {
    match function.expressions[condition] {
        Expression::Literal(Literal::Bool(value)) => Some(value),
        Expression::Constant(constant) => {
            match module.global_expressions[module.constants[constant].init] {
                Expression::Literal(Literal::Bool(value)) => Some(value),
                _ => None,
            }
        }
        _ => None,
    }
}
