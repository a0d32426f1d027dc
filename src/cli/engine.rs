//! Which engine a command takes.

use super::failure::Failure;
use crate::integrate::gpu::{Gpu, Precision};
use crate::integrate::{Cpu, Engine, EngineError};
use clap::ValueEnum;

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

/// Precisions of the shaders by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Shaders {
    /// Every adapter
    F32,
    /// Vulkan adapters with shaderFloat64
    F64,
}

impl From<Shaders> for Precision {
    fn from(shaders: Shaders) -> Self {
        match shaders {
            Shaders::F32 => Self::F32,
            Shaders::F64 => Self::F64,
        }
    }
}

/// Opens the engine and says in one line what was chosen and why.
pub fn open(
    choice: Choice,
    shaders: Option<Shaders>,
) -> Result<(Box<dyn Engine>, String), Failure> {
    let precision = Precision::from(shaders.unwrap_or(Shaders::F32));
    match choice {
        Choice::Cpu if shaders == Some(Shaders::F32) => Err(Failure::Input(
            "--precision f32: the CPU engine computes in f64; allowed with --engine gpu".to_owned(),
        )),
        Choice::Cpu => Ok((Box::new(Cpu), "asked for".to_owned())),
        Choice::Gpu => match Gpu::new(precision) {
            Ok(gpu) => Ok((Box::new(gpu), "asked for".to_owned())),
            Err(error @ EngineError::Unsupported { .. }) => Err(Failure::Input(format!(
                "--engine gpu --precision {precision}: {error}; --precision f32 works on every adapter"
            ))),
            Err(error) => Err(error.into()),
        },
        Choice::Auto => match Gpu::new(precision) {
            Ok(gpu) if gpu.is_software() => {
                let why = format!(
                    "auto: {} is software, slower than the CPU engine",
                    gpu.describe().adapter
                );
                Ok((Box::new(Cpu), why))
            }
            Ok(gpu) => Ok((Box::new(gpu), "auto: a hardware adapter".to_owned())),
            Err(error) => Ok((Box::new(Cpu), format!("auto: {error}"))),
        },
    }
}
