//! Seconds of large maps on machines that were not measured: a roofline model from operations, bytes and published rates.
//!
//! Rates are peaks, so the seconds of devices, buses and disks are lower bounds. The host's part is measured on this machine.

use super::task::Task;
use super::{Report, WholeMap};
use crate::engine::Precision;
use crate::plan::{STATE_CHANNELS, USUAL_PATCH};
use crate::shooting::batch::Method;
use serde::Serialize;

/// Number of cells of each map in the model.
pub const CELLS: f64 = 1e9;

/// Bytes of a cell in the shaders' output: 9 channel values, residual, outcome and padding.
const SHADER_CELL_BYTES: f64 = 48.0;

/// Numbers of a base point, and of the start of each step, in the shaders' input.
const BASE_POINT_NUMBERS: f64 = 100.0;
const STEP_NUMBERS: f64 = 8.0;

/// Cells of a base point: a workgroup.
const CELLS_PER_BASE_POINT: f64 = 32.0;

/// Bytes of a cell in the host's memory traffic: 14 channels of 4 bytes, fetched, written, and read to be packed.
const PANEL_BYTES: f64 = 3.0 * 14.0 * 4.0;

/// Operations per term of the expansions: two steps of 13 for the inverse, and 3 for each function, which are the push angle, `tau`, the load
/// and the channels.
const SPECTRAL_OPERATIONS: f64 = 2.0 * 13.0 + 3.0 * (3 + STATE_CHANNELS.len()) as f64;

/// A machine with published peak rates.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Machine {
    /// The GPU and the host.
    pub name: &'static str,
    /// Number of cores of the host, each as fast as one thread of the machine that measures.
    pub cores: f64,
    /// Billions of `f64` operations per second of one core.
    pub core_gflops: f64,
    /// Gigabytes per second of the host's memory.
    pub host_gb_s: f64,
    /// Billions of `f32` operations per second of the GPU.
    pub gpu_f32_gflops: f64,
    /// Billions of `f64` operations per second of the GPU.
    pub gpu_f64_gflops: f64,
    /// Gigabytes per second of the GPU's memory.
    pub gpu_gb_s: f64,
    /// Gigabytes per second between host and GPU, in one direction.
    pub bus_gb_s: f64,
    /// Gigabytes per second that the disk writes.
    pub disk_gb_s: f64,
}

/// A data-centre GPU, a laptop's, and an integrated one. An addition and a multiplication of a fused operation count 1 each.
///
/// H200: NVIDIA's data sheet of the H200 SXM (67 and 34 Tflop/s, 4.8 TB/s), PCIe 5.0 x16, host with 16 cores of 2 AVX-512 units at 3 GHz.
/// RTX 4060 Laptop: 3072 cores at the boost clock of 2.37 GHz (NVIDIA's specification), `f64` at 1/64 (CUDA C++ Programming Guide, compute
/// capability 8.9), 128 bits of GDDR6 at 16 Gbit/s, PCIe 4.0 x8. Radeon 780M: 12 compute units of 64 lanes at 2.7 GHz without dual issue (AMD's
/// specification of the Ryzen 7 7840U), `f64` at 1/16, both channels of DDR5-5600, which are also the bus. Cores of both laptops have
/// 2 AVX2 units at 3.5 GHz. Disks: a data centre's NVMe drive on PCIe 4.0 x4, and a laptop's.
pub const MACHINES: [Machine; 3] = [
    Machine {
        name: "H200",
        cores: 16.0,
        core_gflops: 96.0,
        host_gb_s: 300.0,
        gpu_f32_gflops: 67e3,
        gpu_f64_gflops: 34e3,
        gpu_gb_s: 4800.0,
        bus_gb_s: 64.0,
        disk_gb_s: 5.0,
    },
    Machine {
        name: "RTX 4060 Laptop",
        cores: 8.0,
        core_gflops: 56.0,
        host_gb_s: 90.0,
        gpu_f32_gflops: 14.6e3,
        gpu_f64_gflops: 228.0,
        gpu_gb_s: 256.0,
        bus_gb_s: 16.0,
        disk_gb_s: 3.0,
    },
    Machine {
        name: "Radeon 780M",
        cores: 8.0,
        core_gflops: 56.0,
        host_gb_s: 90.0,
        gpu_f32_gflops: 4.15e3,
        gpu_f64_gflops: 259.0,
        gpu_gb_s: 90.0,
        bus_gb_s: 90.0,
        disk_gb_s: 3.0,
    },
];

/// Processor that solves the cells of an engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum SolvedOn {
    /// The host's cores, in `f64`.
    Host,
    /// The GPU, in `f32`.
    GpuF32,
    /// The GPU, in `f64`.
    GpuF64,
}

/// Work of an engine per cell of a map, in the mean of cells with and without a state.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CellWork {
    /// Processor that solves the cells.
    pub solved_on: SolvedOn,
    /// Number of floating-point operations per cell that solve it.
    pub operations: f64,
    /// Bytes per cell read and written in the memory of the device that solves.
    pub memory_bytes: f64,
    /// Bytes per cell between host and device, both directions together; 0 on the host.
    pub bus_bytes: f64,
    /// Microseconds of one core per cell for all other stages but packing.
    pub host_us: f64,
    /// Microseconds of one core per cell for packing.
    pub packing_us: f64,
    /// Bytes per cell of the packed map.
    pub packed_bytes: f64,
}

impl CellWork {
    /// The work of a shader: `steps` is the mean number of steps, `states` the part of the cells that have a state.
    ///
    /// Operations with taper and parabola are those of `cargo bench --bench effects`. Cells are written, and copied to a buffer for the host;
    /// base points are written and read.
    fn of_shader(precision: Precision, steps: f64, states: f64) -> Self {
        let (solved_on, beside, of_step, number) = match precision {
            Precision::F32 => (SolvedOn::GpuF32, 1331.0, 2168.0, 4.0),
            Precision::F64 => (SolvedOn::GpuF64, 1592.0, 2402.0, 8.0),
        };
        let up = number * (BASE_POINT_NUMBERS + STEP_NUMBERS * steps) / CELLS_PER_BASE_POINT;
        Self {
            solved_on,
            operations: states * (beside + of_step * steps),
            memory_bytes: states * (2.0 * up + 3.0 * SHADER_CELL_BYTES),
            bus_bytes: states * (up + SHADER_CELL_BYTES),
            host_us: 0.0,
            packing_us: 0.0,
            packed_bytes: 0.0,
        }
    }

    /// The work of the spectral engine with `terms` per expansion; `states` is the part of the cells that have a state.
    fn of_expansions(terms: f64, states: f64) -> Self {
        Self {
            solved_on: SolvedOn::Host,
            operations: states * SPECTRAL_OPERATIONS * terms,
            memory_bytes: PANEL_BYTES,
            bus_bytes: 0.0,
            host_us: 0.0,
            packing_us: 0.0,
            packed_bytes: 0.0,
        }
    }

    /// This work with the host's part as in a measured map on `threads` threads. Stages that solve cells are not the host's.
    fn beside(self, map: &WholeMap, cells: usize, threads: usize) -> Self {
        let us_per_ms = 1e3 / cells as f64;
        let of = |stage: &str| us_per_ms * map.stages_ms.get(stage).copied().unwrap_or_default();
        let stages = [
            "sheets",
            "base_points",
            "guesses",
            "refinement",
            "classification",
        ];
        Self {
            host_us: threads as f64 * stages.map(of).iter().sum::<f64>(),
            packing_us: of("packing"),
            packed_bytes: map.packed_bytes_per_cell,
            ..self
        }
    }
}

/// Times of the parts of a map, in seconds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MapParts {
    /// Seconds of the operations on all cells, at the peak rate.
    pub compute: f64,
    /// Seconds of the traffic to the memory of the device that solves, at its peak rate.
    pub memory: f64,
    /// Seconds of the transfer over the bus between host and GPU.
    pub bus: f64,
    /// Seconds of sheets, base points, fallback and classification on all cores.
    pub host: f64,
    /// Seconds of packing on all cores.
    pub packing: f64,
    /// Seconds of writing to the disk.
    pub disk: f64,
}

impl MapParts {
    /// Computes the times of the parts of a map of `cells` cells.
    #[must_use]
    pub fn new(work: &CellWork, machine: &Machine, cells: f64) -> Self {
        let (gflops, gb_s) = match work.solved_on {
            SolvedOn::Host => (machine.cores * machine.core_gflops, machine.host_gb_s),
            SolvedOn::GpuF32 => (machine.gpu_f32_gflops, machine.gpu_gb_s),
            SolvedOn::GpuF64 => (machine.gpu_f64_gflops, machine.gpu_gb_s),
        };
        let billions = 1e-9 * cells;
        let on_cores = |us: f64| 1e-6 * cells * us / machine.cores;
        Self {
            compute: billions * work.operations / gflops,
            memory: billions * work.memory_bytes / gb_s,
            bus: billions * work.bus_bytes / machine.bus_gb_s,
            host: on_cores(work.host_us),
            packing: on_cores(work.packing_us),
            disk: billions * work.packed_bytes / machine.disk_gb_s,
        }
    }

    /// Returns the seconds of the map with the name of its longest part: parts on the same cores add up, all others overlap.
    #[must_use]
    pub fn total(&self, solved_on: SolvedOn) -> (f64, &'static str) {
        let compute = ("compute", self.compute);
        let mut on_cores = vec![("host", self.host), ("packing", self.packing)];
        let mut apart = vec![
            ("memory", self.memory),
            ("bus", self.bus),
            ("disk", self.disk),
        ];
        match solved_on {
            SolvedOn::Host => on_cores.push(compute),
            SolvedOn::GpuF32 | SolvedOn::GpuF64 => apart.push(compute),
        }
        let sum = on_cores.iter().map(|(_, seconds)| seconds).sum();
        let longest =
            |a: (&'static str, f64), b: (&'static str, f64)| if b.1 > a.1 { b } else { a };
        let (name, _) = on_cores.into_iter().fold(("host", 0.0), longest);
        let (name, seconds) = apart.into_iter().fold((name, sum), longest);
        (seconds, name)
    }
}

/// A map of [`CELLS`] cells by an engine on a machine: computed, not measured.
#[derive(Clone, Debug, Serialize)]
pub struct ComputedMap {
    /// Name of the machine for which the map is computed.
    pub machine: &'static str,
    /// Name of the engine that solves the computed map.
    pub engine: &'static str,
    /// Work of the engine per cell of the computed map.
    pub work: CellWork,
    /// Times of the parts of the computed map, in seconds.
    pub parts: MapParts,
    /// Time of the whole computed map, in seconds.
    pub seconds: f64,
    /// Name of the part that takes the longest time of the computed map.
    pub bound_by: &'static str,
}

/// Computes the maps of each engine that has a whole map in `report`, on all [`MACHINES`]. `states` is the part of the cells that have a
/// state.
pub fn computed(task: &Task, states: f64, threads: usize, report: &Report) -> Vec<ComputedMap> {
    let shader = |precision: Precision| {
        let resolution = precision.resolution(Method::fine().resolution);
        CellWork::of_shader(precision, task.mean_steps(resolution), states)
    };
    let terms = USUAL_PATCH[1] as f64;
    let engines = [
        ("gpu f32", shader(Precision::F32)),
        ("gpu f64", shader(Precision::F64)),
        ("spectral", CellWork::of_expansions(terms, states)),
    ];
    let mut maps = Vec::new();
    for machine in &MACHINES {
        for (engine, work) in engines {
            let measured = report
                .maps
                .iter()
                .find(|map| map.engine.starts_with(engine));
            maps.extend(measured.map(|map| {
                let work = work.beside(map, report.map_cells, threads);
                let parts = MapParts::new(&work, machine, CELLS);
                let (seconds, bound_by) = parts.total(work.solved_on);
                ComputedMap {
                    machine: machine.name,
                    engine,
                    work,
                    parts,
                    seconds,
                    bound_by,
                }
            }));
        }
    }
    maps
}

#[cfg(test)]
mod tests {
    use super::*;

    const MACHINE: Machine = Machine {
        name: "by hand",
        cores: 4.0,
        core_gflops: 10.0,
        host_gb_s: 20.0,
        gpu_f32_gflops: 1000.0,
        gpu_f64_gflops: 100.0,
        gpu_gb_s: 200.0,
        bus_gb_s: 10.0,
        disk_gb_s: 2.0,
    };

    const WORK: CellWork = CellWork {
        solved_on: SolvedOn::GpuF32,
        operations: 6000.0,
        memory_bytes: 200.0,
        bus_bytes: 50.0,
        host_us: 0.04,
        packing_us: 0.02,
        packed_bytes: 18.0,
    };

    #[test]
    fn seconds_are_those_computed_by_hand() {
        let total = |work: &CellWork| {
            let parts = MapParts::new(work, &MACHINE, 1e9);
            (parts, parts.total(work.solved_on))
        };
        let (parts, all) = total(&WORK);
        let wanted = MapParts {
            compute: 6.0,
            memory: 1.0,
            bus: 5.0,
            host: 10.0,
            packing: 5.0,
            disk: 9.0,
        };
        for (found, wanted) in [
            (parts.compute, wanted.compute),
            (parts.memory, wanted.memory),
            (parts.bus, wanted.bus),
            (parts.host, wanted.host),
            (parts.packing, wanted.packing),
            (parts.disk, wanted.disk),
        ] {
            assert!((found - wanted).abs() < 1e-9, "{found} {wanted}");
        }
        // Host and packing share the cores.
        assert!((all.0 - 15.0).abs() < 1e-9 && all.1 == "host", "{all:?}");
        let double = CellWork {
            solved_on: SolvedOn::GpuF64,
            ..WORK
        };
        let (_, all) = total(&double);
        assert!((all.0 - 60.0).abs() < 1e-9 && all.1 == "compute", "{all:?}");
        // The host's cores solve as well: 150 + 10 + 5.
        let on_host = CellWork {
            solved_on: SolvedOn::Host,
            ..WORK
        };
        let (parts, all) = total(&on_host);
        assert!((parts.memory - 10.0).abs() < 1e-9);
        assert!(
            (all.0 - 165.0).abs() < 1e-9 && all.1 == "compute",
            "{all:?}"
        );
    }

    #[test]
    fn work_is_that_counted_by_hand() {
        let f32 = CellWork::of_shader(Precision::F32, 4.0, 0.5);
        assert_eq!(f32.operations, 0.5 * (1331.0 + 4.0 * 2168.0));
        // A base point of 100 numbers and 4 starts of 8 numbers for 32 cells: 16.5 bytes.
        assert_eq!(f32.bus_bytes, 0.5 * (16.5 + 48.0));
        assert_eq!(f32.memory_bytes, 0.5 * (33.0 + 144.0));
        assert_eq!(
            CellWork::of_expansions(32.0, 0.5).operations,
            0.5 * 32.0 * 62.0
        );
    }
}
