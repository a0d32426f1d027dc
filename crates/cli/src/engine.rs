//! Selection of the engine of a map by options.

use super::adapter::{chosen, is_named};
use super::arguments::named;
use super::estimate::{compare, estimate};
use super::failure::{Failure, message};
use clap::{Args, ValueEnum};
use whiskmap::compute::PlannedMap;
use whiskmap::engine::gpu::{AdapterReport, Gpu, Precision, adapters};
use whiskmap::engine::{Engine, EngineDescription, EngineError, on_gpu};
use whiskmap::plan::ExpansionCount;

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum EngineChoice {
    /// Spectral or CPU by their counts of trajectories, or the GPU if it is faster on a sample of the scene
    Auto,
    /// f64 on all cores: a trajectory for each cell
    Cpu,
    /// f64 on all cores: certified polynomials along rows, a trajectory for each other cell
    Spectral,
    /// Compute shaders on an adapter, also a software adapter
    Gpu,
}

const PRECISION_HELP: [&str; 2] = [
    "Single precision, which every adapter supports",
    "Double precision, on Vulkan adapters with shaderFloat64",
];

#[derive(Clone, Debug, Default, Args)]
pub struct EngineArgs {
    /// Engine that solves the cells [default: auto]
    #[arg(long, value_enum)]
    engine: Option<EngineChoice>,
    /// Floating-point type of the shaders [default: f32]
    #[arg(long, value_parser = named(Precision::ALL, Precision::name, PRECISION_HELP))]
    precision: Option<Precision>,
    /// GPU adapter, by its number or a part of its name in `whiskmap devices` [default: the one marked there]
    #[arg(long, value_name = "N|NAME")]
    adapter: Option<String>,
}

/// Open engine that solves cells, `None` for the CPU alone, and the reason for the choice in one line.
pub type OpenEngine = (Option<Box<dyn Engine>>, String);

/// Seconds for samples that show whether a GPU is worth opening.
const FIRST_LOOK: f64 = 0.01;

/// Seconds for samples that compare GPU and CPU, unless the smallest ones take longer.
const COMPARISON: f64 = 0.04;

/// Seconds from opening a GPU to its first response, measured on lavapipe. A map that takes less time on all threads of the CPU opens no GPU.
const OPENING: f64 = 0.1;

impl EngineArgs {
    /// Opens the engine for a planned map.
    pub fn open(&self, map: &PlannedMap<'_>) -> Result<OpenEngine, Failure> {
        self.check()?;
        if self.may_use_gpu() {
            return self.open_gpu_or_auto(map);
        }
        let has_expansions = !map.plan.method.effects.profile || !map.plan.channels.needs_states();
        if self.choice() == EngineChoice::Spectral && !has_expansions {
            message(
                "warning: --engine spectral: a whisker with measured radii has no expansions; the CPU engine solves every cell",
            );
        }
        self.without_gpu(map)
    }

    /// Returns the engine whose cost an estimate measures, and why: the one that [`Self::open`] selects if there is no GPU.
    ///
    /// # Errors
    /// If the options contradict each other.
    pub fn without_gpu(&self, map: &PlannedMap<'_>) -> Result<OpenEngine, Failure> {
        self.check()?;
        let selected = || "selected by --engine".to_owned();
        Ok(match self.choice() {
            EngineChoice::Auto => {
                let (engine, _) = without_gpu(map);
                (engine, expansions(map))
            }
            EngineChoice::Spectral => (Some(Box::new(map.spectral())), selected()),
            EngineChoice::Cpu => (None, selected()),
            EngineChoice::Gpu => {
                (None, "in place of the GPU, which is not opened; the time is the CPU's".to_owned())
            }
        })
    }

    /// Returns the options of a task of `submit`: those given, with the CPU engine if none is named.
    pub fn of_task(&self) -> Self {
        Self { engine: self.engine.or(Some(EngineChoice::Cpu)), ..self.clone() }
    }

    /// Returns the name of the first option that is given; `None` without one.
    pub fn given(&self) -> Option<&'static str> {
        let engine = self.engine.map(|_| "--engine");
        let precision = self.precision.map(|_| "--precision");
        engine.or(precision).or(self.adapter.as_ref().map(|_| "--adapter"))
    }

    /// Returns true if the options name an engine.
    pub fn is_named(&self) -> bool {
        self.engine.is_some()
    }

    /// Returns true if the options name the GPU engine.
    pub fn names_gpu(&self) -> bool {
        self.choice() == EngineChoice::Gpu
    }

    /// Returns true if a GPU may solve cells.
    pub fn may_use_gpu(&self) -> bool {
        matches!(self.choice(), EngineChoice::Auto | EngineChoice::Gpu)
    }

    fn choice(&self) -> EngineChoice {
        self.engine.unwrap_or(EngineChoice::Auto)
    }

    /// Returns an error if the options contradict each other.
    fn check(&self) -> Result<(), Failure> {
        let why = match (self.choice(), self.precision, &self.adapter) {
            (EngineChoice::Cpu | EngineChoice::Spectral, Some(Precision::F32), _) => {
                "--precision f32: the CPU computes in f64; allowed with --engine gpu".to_owned()
            }
            (EngineChoice::Auto, Some(Precision::F32), _) => {
                "--precision f32: --engine auto may select the CPU, which computes in f64; allowed with --engine gpu"
                    .to_owned()
            }
            (EngineChoice::Cpu | EngineChoice::Spectral, _, Some(adapter)) => {
                let name = if self.choice() == EngineChoice::Cpu { "CPU" } else { "spectral" };
                format!(
                    "--adapter {adapter}: the {name} engine has none; allowed with --engine gpu and --engine auto"
                )
            }
            _ => return Ok(()),
        };
        Err(Failure::Input(why))
    }

    fn open_gpu_or_auto(&self, map: &PlannedMap<'_>) -> Result<OpenEngine, Failure> {
        // A named adapter that does not exist is an error, even if it would not be used.
        if is_named(self.adapter.as_deref()) {
            self.adapter()?;
        }
        match (self.choice(), self.refusal(map)) {
            (EngineChoice::Auto, Some(_)) => Ok(without_gpu(map)),
            (EngineChoice::Auto, None) => self.faster(map),
            (_, Some(why)) => {
                let (host, _) = without_gpu(map);
                Ok((host, format!("--engine gpu is not possible: {why}")))
            }
            (_, None) => {
                let adapter = self.adapter()?.map(|(index, _)| index);
                let gpu = self.gpu(adapter).map_err(|error| match error {
                    EngineError::Unsupported { .. } => Failure::Input(format!(
                        "--engine gpu --precision {}: {error}; --precision f32 works on every adapter",
                        self.precision()
                    )),
                    error => error.into(),
                })?;
                Ok((Some(gpu), "selected by --engine".to_owned()))
            }
        }
    }

    /// Returns the reason why the CPU solves every cell, on any GPU.
    fn refusal(&self, map: &PlannedMap<'_>) -> Option<String> {
        if !map.plan.channels.needs_states() {
            return Some("the map has no numbers of states".to_owned());
        }
        if let Err(why) = on_gpu(map.plan.method.effects) {
            return Some(why.to_owned());
        }
        let precision = self.precision();
        let bound_deg = map.excess_deg(precision.goal())?;
        Some(format!("gpu {precision} only bounds the push angle to {bound_deg:.1e} deg"))
    }

    fn precision(&self) -> Precision {
        self.precision.unwrap_or(Precision::F32)
    }

    /// Returns index and description of the adapter of a GPU engine, if there is one.
    fn adapter(&self) -> Result<Option<(usize, AdapterReport)>, Failure> {
        let mut reports = adapters();
        let index = chosen(&reports, self.adapter.as_deref(), self.precision())?;
        Ok(index.map(|index| (index, reports.swap_remove(index))))
    }

    fn gpu(&self, adapter: Option<usize>) -> Result<Box<dyn Engine>, EngineError> {
        Gpu::open(adapter, self.precision()).map(|gpu| Box::new(gpu) as _)
    }

    /// Opens the engine that is faster for the map, as estimated from samples of its scene.
    fn faster(&self, map: &PlannedMap<'_>) -> Result<OpenEngine, Failure> {
        let (mut host, why) = without_gpu(map);
        // Wall time would depend on what else the machine does.
        let cost = estimate(map.scene, &map.plan, &mut None, FIRST_LOOK)?;
        if cost.cpu_seconds < OPENING * rayon::current_num_threads() as f64 {
            return Ok((
                host,
                format!("{why}; a GPU is not timed below {OPENING} s on all threads"),
            ));
        }
        let (index, report) = self.adapter()?.unzip();
        let name = report.as_ref().map(|report| report.info.name.clone());
        let name = name.unwrap_or_default();
        if report.is_some_and(|report| report.is_software()) && !is_named(self.adapter.as_deref()) {
            return Ok((host, format!("{why}; {name} also computes on the CPU")));
        }
        let gpu = match self.gpu(index) {
            Ok(gpu) => gpu,
            Err(error) => return Ok((host, format!("{why}; {error}"))),
        };
        let gpu_name = format!("{} on {name}", gpu.describe().engine);
        let mut gpu = Some(gpu);
        match compare(map.scene, &map.plan, [&mut host, &mut gpu], COMPARISON) {
            Ok([on_host, on_gpu]) if on_gpu < on_host => {
                let other = EngineDescription::of(host.as_deref());
                let other = format!("{} on {}", other.engine, other.adapter);
                Ok((gpu, format!("auto: {:.1} times {other}", on_host / on_gpu)))
            }
            Ok([on_host, on_gpu]) => {
                let times = format!("{:.1} times {gpu_name}", on_gpu / on_host);
                Ok((host, format!("{why}; {times}")))
            }
            Err(Failure::Engine(error)) => Ok((host, format!("{why}; {error}"))),
            Err(failure) => Err(failure),
        }
    }
}

/// Returns the spectral engine, or the CPU engine where its trajectories take less time than expansions, as counted by the plan.
fn without_gpu(map: &PlannedMap<'_>) -> OpenEngine {
    let why = format!("auto: {}", expansions(map));
    let spectral = map.cheaper();
    (spectral.map(|engine| Box::new(engine) as _), why)
}

/// Returns why expansions pay for a map, or why they do not, in one line.
fn expansions(map: &PlannedMap<'_>) -> String {
    let Some(count) = map.plan.expansions(map.scene) else {
        return "measured radii have no expansions".to_owned();
    };
    let ExpansionCount { cells, cost } = count;
    format!("at most {cells} cells a side, expansions cost {cost}")
}
