//! Seconds of large maps on machines that were not measured: a roofline model from operations, bytes and published rates.
//!
//! Rates are peaks, so the seconds of devices, buses and disks are lower bounds. The host's part is measured on this machine.

use super::Report;
use super::cell_work::{CellWork, SolvedOn};
use super::machine::{MACHINES, Machine};
use super::task::Task;
use crate::engine::Precision;
use crate::plan::USUAL_NET;
use crate::shooting::batch::Method;
use serde::Serialize;

/// Number of cells of each map in the model.
pub const CELLS: f64 = 1e9;

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
    let terms = USUAL_NET[1] as f64;
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
}
