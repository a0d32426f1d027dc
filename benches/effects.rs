//! Cost of each set of effects: `cargo bench --bench effects -- [trajectories]`.
//!
//! For each set: the floating-point operations of a cell in the shaders, beside its steps and of each step, and the time per trajectory with
//! first derivatives on one CPU thread, at the resolution of maps. Times are medians of seven interleaved runs.
#![allow(clippy::print_stdout, reason = "the program prints a table")]
#![allow(clippy::expect_used, reason = "a benchmark that cannot start panics")]

use naga::back::pipeline_constants::process_overrides;
use naga::valid::{Capabilities, FunctionInfo, ModuleInfo, ValidationFlags, Validator};
use naga::{
    BinaryOperator, Block, Expression, Function, Handle, Literal, MathFunction, Module, ScalarKind,
    Statement, TypeInner,
};
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
    println!("operations of a cell: beside its steps + of a step");
    println!("        f32          f64  us/trajectory  ratio  spread  effects");
    for (i, (effects, _)) in sets.iter().enumerate() {
        let on_gpu = effect_sets::on_gpu().any(|own| own == *effects);
        let counted = [Precision::F32, Precision::F64].map(|precision| {
            let operations = on_gpu.then(|| operations(precision, *effects));
            let text = |own: CellOperations| format!("{} + {}", own.beside, own.per_step);
            operations.map(text).unwrap_or_default()
        });
        println!(
            "{:>11}  {:>11}  {:13.3}  {:5.2}  {:5.0} %  {}",
            counted[0],
            counted[1],
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
        (effects.polynomial, "traced shape"),
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

/// Floating-point operations of a cell: beside its steps, and of each step. An addition, multiplication, division or root counts 1 for each
/// component.
#[derive(Clone, Copy, Default)]
struct CellOperations {
    beside: usize,
    per_step: usize,
}

/// Rounds of Newton's method in the function `w_at` of `shaders/row.wgsl`, the only loop that is not along the steps.
const ROUNDS: usize = 4;

/// Operations of `solve_cells` with these effects.
fn operations(precision: Precision, effects: Effects) -> CellOperations {
    let text = shaders::cells(precision);
    let module = naga::front::wgsl::parse_str(&text).expect("the shader parses");
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::FLOAT64);
    let info = validator.validate(&module).expect("the shader is valid");
    let entry = &module.entry_points[0];
    let constants = shaders::overrides(effects)
        .map(|(name, value)| (name.to_owned(), value))
        .into_iter()
        .collect();
    let entry_point = Some((entry.stage, entry.name.as_str()));
    let (module, info) = process_overrides(&module, &info, entry_point, &constants)
        .expect("every override constant has a value");
    let entry = &module.entry_points[0].function;
    let scope = Scope {
        module: &module,
        info: &info,
        function: entry,
        types: info.get_entry_point(0),
    };
    scope.of(&entry.body)
}

/// A function whose operations are counted.
#[derive(Clone, Copy)]
struct Scope<'a> {
    module: &'a Module,
    info: &'a ModuleInfo,
    function: &'a Function,
    types: &'a FunctionInfo,
}

impl Scope<'_> {
    /// Operations of a block and of the functions that it calls, without branches that are never taken.
    fn of(self, block: &Block) -> CellOperations {
        let mut sum = CellOperations::default();
        for statement in block {
            let more = match statement {
                Statement::Emit(range) => CellOperations {
                    beside: range.clone().map(|one| self.of_expression(one)).sum(),
                    per_step: 0,
                },
                Statement::Block(block) => self.of(block),
                Statement::If {
                    condition,
                    accept,
                    reject,
                } => match known(self.module, self.function, *condition) {
                    Some(true) => self.of(accept),
                    Some(false) => self.of(reject),
                    None => self.of(accept),
                },
                Statement::Loop { body, .. } => {
                    let CellOperations { beside, .. } = self.of(body);
                    match self.function.name.as_deref() {
                        Some("integrate") => CellOperations {
                            beside: 0,
                            per_step: beside,
                        },
                        _ => CellOperations {
                            beside: ROUNDS * beside,
                            per_step: 0,
                        },
                    }
                }
                Statement::Call { function, .. } => {
                    let callee = Self {
                        function: &self.module.functions[*function],
                        types: &self.info[*function],
                        ..self
                    };
                    callee.of(&callee.function.body)
                }
                _ => CellOperations::default(),
            };
            sum.beside += more.beside;
            sum.per_step += more.per_step;
        }
        sum
    }

    fn of_expression(self, expression: Handle<Expression>) -> usize {
        let components = |expression: Handle<Expression>| {
            let inner = self.types[expression].ty.inner_with(&self.module.types);
            match inner {
                TypeInner::Scalar(scalar) if scalar.kind == ScalarKind::Float => 1,
                TypeInner::Vector { size, scalar } if scalar.kind == ScalarKind::Float => {
                    *size as usize
                }
                _ => 0,
            }
        };
        match &self.function.expressions[expression] {
            Expression::Binary {
                op:
                    BinaryOperator::Add
                    | BinaryOperator::Subtract
                    | BinaryOperator::Multiply
                    | BinaryOperator::Divide,
                ..
            } => components(expression),
            Expression::Math { fun, arg, .. } => match fun {
                MathFunction::Sqrt => components(expression),
                MathFunction::Dot => 2 * components(*arg) - 1,
                MathFunction::Length => 2 * components(*arg),
                _ => 0,
            },
            _ => 0,
        }
    }
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
