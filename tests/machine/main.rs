//! Tests that need something of the machine. A GPU: one contract in every precision, faults, row batches, whole maps and the
//! program.
//!
//! A test that cannot run here is ignored with the reason, which needs a harness other than that of the standard library.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

/// The tests of a module: their names, and what each group of them needs.
macro_rules! tests {
    ($($needs:ident: $($test:ident),+;)+) => {
        pub const TESTS: &[(&str, crate::MachineTest)] = &[$($(
            (concat!(module_path!(), "::", stringify!($test)), crate::MachineTest::$needs($test)),
        )+)+];
    };
}

mod adapters;
mod bound;
mod by_cpu;
#[path = "../hard_cases/case.rs"]
mod case;
mod choice;
mod contract;
mod faults;
mod hard_cases;
mod kinds;
mod maps;
#[path = "../hard_cases/named.rs"]
mod named;
mod nodes;
mod pipeline;
#[path = "../hard_cases/random.rs"]
mod random;
mod shoot;
mod spectral;
mod states;
#[path = "../support/mod.rs"]
mod support;

use libtest_mimic::{Arguments, Completion, Trial};
use std::process::ExitCode;
use support::{cells, compute, effect_sets, program, random_rods, shipped};
use whiskmap::engine::gpu::{Gpu, Precision};
use whiskmap::engine::{Cpu, Engine, EngineError, Spectral};

/// A test by what it needs.
#[derive(Clone, Copy)]
pub enum MachineTest {
    /// Nothing: runs on every machine.
    Nothing(fn()),
    /// An adapter.
    Adapter(fn()),
    /// For each precision, an adapter that computes in it.
    Precision(fn(Precision)),
    /// For each engine, its adapter; engines of the CPU need none.
    Engine(fn(&mut dyn Engine)),
    /// The library of a Vulkan driver, which a driver that fails calls.
    #[cfg(target_os = "linux")]
    Driver(fn()),
}

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let missing = [Precision::F32, Precision::F64].map(missing_adapter);
    let modules = [
        adapters::TESTS,
        bound::TESTS,
        choice::TESTS,
        contract::TESTS,
        #[cfg(target_os = "linux")]
        faults::driver::TESTS,
        faults::kernel::TESTS,
        faults::lost::TESTS,
        hard_cases::TESTS,
        maps::TESTS,
        pipeline::TESTS,
        nodes::TESTS,
        shoot::TESTS,
        spectral::TESTS,
        states::TESTS,
    ];
    let tests = modules.concat().into_iter();
    let trials = tests.flat_map(|(path, test)| {
        let name = path.trim_start_matches("machine::");
        match test {
            MachineTest::Nothing(run) => vec![trial(&arguments, name, None, run)],
            MachineTest::Adapter(run) => vec![trial(&arguments, name, missing[0].as_deref(), run)],
            #[cfg(target_os = "linux")]
            MachineTest::Driver(run) => {
                let missing = faults::driver::real_driver().err();
                vec![trial(&arguments, name, missing.as_deref(), run)]
            }
            MachineTest::Engine(run) => {
                let on_cpu = [
                    trial(&arguments, &format!("{name}::cpu"), None, move || {
                        run(&mut Cpu::default());
                    }),
                    trial(&arguments, &format!("{name}::spectral"), None, move || {
                        run(&mut Spectral::default());
                    }),
                ];
                let gpus = [Precision::F32, Precision::F64].iter().zip(&missing);
                let gpus = gpus.map(|(&precision, missing)| {
                    let name = format!("{name}::{precision}");
                    trial(&arguments, &name, missing.as_deref(), move || {
                        run(&mut compute::open(precision));
                    })
                });
                on_cpu.into_iter().chain(gpus).collect()
            }
            MachineTest::Precision(run) => [Precision::F32, Precision::F64]
                .iter()
                .zip(&missing)
                .map(|(&precision, missing)| {
                    let name = format!("{name}::{precision}");
                    trial(&arguments, &name, missing.as_deref(), move || run(precision))
                })
                .collect(),
        }
    });
    libtest_mimic::run(&arguments, trials.collect()).exit_code()
}

/// Why no adapter computes in `precision`, or `None` if one does or fails otherwise.
fn missing_adapter(precision: Precision) -> Option<String> {
    match Gpu::open(None, precision).err()? {
        error @ (EngineError::NoAdapter(_) | EngineError::Unsupported { .. }) => {
            Some(error.to_string())
        }
        _ => None,
    }
}

/// The test `name`, which is ignored if something is `missing` and `arguments` do not include ignored tests.
///
/// Lists mark the test as ignored, which `cargo nextest` reads; a run prints the reason.
fn trial(
    arguments: &Arguments,
    name: &str,
    missing: Option<&str>,
    run: impl FnOnce() + Send + 'static,
) -> Trial {
    let is_included = arguments.ignored || arguments.include_ignored;
    let is_marked = missing.is_some() && (arguments.list || is_included);
    let reason = missing.filter(|_| !is_included).map(str::to_owned);
    let trial = Trial::ignorable_test(name, || match reason {
        Some(reason) => Ok(Completion::ignored_with(reason)),
        None => {
            run();
            Ok(Completion::Completed)
        }
    });
    trial.with_ignored_flag(is_marked)
}
