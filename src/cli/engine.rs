//! Which engine a command takes.

use super::failure::Failure;
use clap::ValueEnum;
use whiskmap::integrate::gpu::{Gpu, Precision, adapters, preferred};
use whiskmap::integrate::{Engine, EngineError};

/// Engines by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Choice {
    /// A hardware GPU if there is one, else the CPU
    Auto,
    /// f64 on all cores
    Cpu,
    /// Compute shaders on the preferred adapter, a software one too
    Gpu,
}

/// Opens what shoots before the refinement, nothing for the CPU alone, and says in one line why.
pub fn open(
    choice: Choice,
    asked: Option<Precision>,
) -> Result<(Option<Box<dyn Engine>>, String), Failure> {
    let precision = asked.unwrap_or(Precision::F32);
    match choice {
        Choice::Cpu if asked == Some(Precision::F32) => Err(Failure::Input(
            "--precision f32: the CPU engine computes in f64; allowed with --engine gpu".to_owned(),
        )),
        Choice::Cpu => Ok((None, "asked for".to_owned())),
        Choice::Gpu => match Gpu::new(precision) {
            Ok(gpu) => Ok((Some(Box::new(gpu)), "asked for".to_owned())),
            Err(error @ EngineError::Unsupported { .. }) => Err(Failure::Input(format!(
                "--engine gpu --precision {precision}: {error}; --precision f32 works on every adapter"
            ))),
            Err(error) => Err(error.into()),
        },
        Choice::Auto => Ok(automatic(precision)),
    }
}

/// A hardware adapter with this precision, or else the CPU, always in f64.
fn automatic(precision: Precision) -> (Option<Box<dyn Engine>>, String) {
    let reports = adapters();
    let why = match preferred(&reports, precision).map(|i| &reports[i]) {
        Some(report) if !report.is_software() => match Gpu::new(precision) {
            Ok(gpu) => return (Some(Box::new(gpu)), "auto: a hardware adapter".to_owned()),
            Err(error) => format!("auto: {error}"),
        },
        Some(report) => format!(
            "auto: {} is software, slower than the CPU engine",
            report.info.name
        ),
        None => format!("auto: no GPU adapter with {precision}"),
    };
    (None, why)
}
