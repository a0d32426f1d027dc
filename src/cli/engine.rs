//! Which engine a command takes.

use super::estimate::{compare, estimate};
use super::failure::Failure;
use clap::{Args, ValueEnum};
use std::env;
use whiskmap::engine::gpu::{AdapterReport, Gpu, Precision, adapters, named, preferred};
use whiskmap::engine::{Engine, EngineDescription, EngineError, on_gpu};
use whiskmap::plan::Plan;
use whiskmap::scene::Scene;

/// Engines by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Choice {
    /// The faster one on a sample of the scene
    Auto,
    /// f64 on all cores
    Cpu,
    /// Compute shaders on an adapter, a software one too
    Gpu,
}

/// Options that choose an engine.
#[derive(Debug, Args)]
pub struct EngineOptions {
    /// What solves the cells
    #[arg(long, value_enum, default_value = "auto")]
    engine: Choice,
    /// Scalar of the shaders [default: f32]
    #[arg(long, value_enum)]
    precision: Option<Precision>,
    /// Adapter of the GPU, by its number or a part of its name in `whiskmap devices` [default: the one marked there]
    #[arg(long, value_name = "N|NAME")]
    adapter: Option<String>,
}

/// What solves cells, nothing for the CPU alone, and in one line why it was taken.
pub type Opened = (Option<Box<dyn Engine>>, String);

/// Seconds that samples may take to see whether a GPU is worth starting.
const FIRST_LOOK: f64 = 0.01;

/// Seconds that samples may take to compare it with the CPU, unless the smallest ones take longer.
const COMPARISON: f64 = 0.04;

/// Seconds from nothing to the first answer of a GPU, measured on lavapipe: a map that takes the CPU less does not wait for one.
const OPENING: f64 = 0.1;

impl EngineOptions {
    /// Opens the engine for a map of `scene` as in `plan`, with push angles exact to `tolerance_deg`, if that was asked.
    pub fn open(
        &self,
        scene: &Scene,
        plan: &Plan,
        tolerance_deg: Option<f64>,
    ) -> Result<Opened, Failure> {
        let asked = || "asked for".to_owned();
        match (self.engine, self.precision, &self.adapter) {
            (Choice::Cpu, Some(Precision::F32), _) => Err(Failure::Input(
                "--precision f32: the CPU engine computes in f64; allowed with --engine gpu"
                    .to_owned(),
            )),
            (Choice::Auto, Some(Precision::F32), _) => Err(Failure::Input(
                "--precision f32: --engine auto may take the CPU engine, which computes in f64; allowed with --engine gpu"
                    .to_owned(),
            )),
            (Choice::Cpu, _, Some(adapter)) => Err(Failure::Input(format!(
                "--adapter {adapter}: the CPU engine has none; allowed with --engine gpu and --engine auto"
            ))),
            (Choice::Cpu, ..) => Ok((None, asked())),
            (Choice::Gpu | Choice::Auto, ..) => {
                // Who names an adapter is told that there is none, even where it would not be used.
                if self.adapter.is_some() || env::var_os(NAME).is_some() {
                    self.adapter()?;
                }
                match (self.engine, self.refusal(scene, plan, tolerance_deg)) {
                    (Choice::Auto, Some(why)) => Ok((None, format!("auto: {why}"))),
                    (Choice::Auto, None) => self.faster(scene, plan),
                    (_, Some(why)) => Ok((None, format!("a GPU was asked for, but {why}"))),
                    (_, None) => self.asked_for().map(|gpu| (Some(gpu), asked())),
                }
            }
        }
    }

    /// The GPU that was asked for.
    fn asked_for(&self) -> Result<Box<dyn Engine>, Failure> {
        let adapter = self.adapter()?.map(|(index, _)| index);
        self.gpu(adapter).map_err(|error| match error {
            EngineError::Unsupported { .. } => Failure::Input(format!(
                "--engine gpu --precision {}: {error}; --precision f32 works on every adapter",
                self.precision()
            )),
            error => error.into(),
        })
    }

    /// Why the CPU solves every cell whatever a GPU can.
    fn refusal(&self, scene: &Scene, plan: &Plan, tolerance_deg: Option<f64>) -> Option<String> {
        if let Err(why) = on_gpu(plan.method.effects) {
            return Some(why.to_owned());
        }
        let precision = self.precision();
        let bound_deg = bound_deg(scene, precision.goal());
        let is_coarser = tolerance_deg.is_some_and(|tolerance| bound_deg > tolerance);
        is_coarser
            .then(|| format!("gpu {precision} only bounds the push angle to {bound_deg:.1e} deg"))
    }

    fn precision(&self) -> Precision {
        self.precision.unwrap_or(Precision::F32)
    }

    /// The adapter that a GPU engine takes, if there is any, and its name.
    fn adapter(&self) -> Result<Option<(usize, String)>, Failure> {
        let reports = adapters();
        let index = chosen(&reports, self.adapter.as_deref(), self.precision())?;
        Ok(index.map(|index| (index, reports[index].info.name.clone())))
    }

    fn gpu(&self, adapter: Option<usize>) -> Result<Box<dyn Engine>, EngineError> {
        let gpu = match adapter {
            Some(index) => Gpu::at(index, self.precision()),
            None => Gpu::new(self.precision()),
        };
        gpu.map(|gpu| Box::new(gpu) as _)
    }

    /// The engine that is expected to be done first with `plan`, by what samples of `scene` take.
    fn faster(&self, scene: &Scene, plan: &Plan) -> Result<Opened, Failure> {
        if estimate(scene, plan, FIRST_LOOK)?.seconds < OPENING {
            return Ok((None, "auto: done before a GPU has started".to_owned()));
        }
        let (index, name) = self.adapter()?.unzip();
        let gpu = match self.gpu(index) {
            Ok(gpu) => gpu,
            Err(error) => return Ok((None, format!("auto: {error}"))),
        };
        let gpu_name = format!("{} on {}", gpu.describe().engine, name.unwrap_or_default());
        let mut engine = Some(gpu);
        match compare(scene, plan, &mut engine, COMPARISON) {
            Ok([cpu, gpu]) if gpu < cpu => {
                let alone = EngineDescription::of(None);
                let alone = format!("{} on {}", alone.engine, alone.adapter);
                Ok((engine, format!("auto: {:.1} times {alone}", cpu / gpu)))
            }
            Ok([cpu, gpu]) => Ok((None, format!("auto: {:.1} times {gpu_name}", gpu / cpu))),
            Err(Failure::Engine(error)) => Ok((None, format!("auto: {error}"))),
            Err(failure) => Err(failure),
        }
    }
}

/// To how many degrees an engine bounds push angles: its `goal`, as seen from the base at the nearest distance.
pub fn bound_deg(scene: &Scene, goal: f64) -> f64 {
    let nearest = scene
        .grid
        .distance_mm
        .iter()
        .copied()
        .fold(f64::INFINITY, f64::min);
    let lengths = scene.corner_whiskers().map(|own| own.whisker.length_mm);
    let longest = lengths.fold(0.0, f64::max);
    (goal * longest / nearest).to_degrees()
}

/// The variable by which other programs that use wgpu choose an adapter, too.
const NAME: &str = "WGPU_ADAPTER_NAME";

/// Which adapter is taken: the one `asked` for, the one named by `WGPU_ADAPTER_NAME`, or else the preferred one; `None` without any.
///
/// # Errors
/// When the one that was asked for or named is not among the `reports`.
pub fn chosen(
    reports: &[AdapterReport],
    asked: Option<&str>,
    precision: Precision,
) -> Result<Option<usize>, Failure> {
    let (what, found) = match (asked, env::var(NAME)) {
        (Some(asked), _) => {
            let number = asked.parse::<usize>().ok();
            let found = match number {
                Some(number) => (number < reports.len()).then_some(number),
                None => named(reports, asked, precision),
            };
            (format!("--adapter {asked}"), found)
        }
        (None, Ok(name)) => (format!("{NAME}={name}"), named(reports, &name, precision)),
        (None, Err(_)) => {
            let preferred = |precision| preferred(reports, precision);
            return Ok(preferred(precision).or_else(|| preferred(Precision::F32)));
        }
    };
    if found.is_some() {
        return Ok(found);
    }
    let list = reports.iter().enumerate();
    let list: Vec<String> = list
        .map(|(i, report)| format!("{i} ({})", report.info.name))
        .collect();
    let allowed = match &list[..] {
        [] => "there is none".to_owned(),
        list => format!("must be one of {}", list.join(", ")),
    };
    Err(Failure::Input(format!(
        "{what}: no such GPU adapter; {allowed}"
    )))
}
