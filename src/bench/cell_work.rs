//! Work of each engine per cell: operations, and bytes of memory, buses and files.

use super::WholeMap;
use crate::engine::Precision;
use crate::plan::STATE_CHANNELS;
use serde::Serialize;

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
    pub fn of_shader(precision: Precision, steps: f64, states: f64) -> Self {
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
    pub fn of_expansions(terms: f64, states: f64) -> Self {
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
    pub fn beside(self, map: &WholeMap, cells: usize, threads: usize) -> Self {
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

#[cfg(test)]
mod tests {
    use super::*;

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
