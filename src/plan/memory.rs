//! Memory of runs: the limit, and bytes of cells, sides, threads and a GPU.

use super::Plan;
use crate::scene::Scene;

/// Limit on the memory of a run, in bytes; a plan that takes more is refused.
pub const MEMORY_LIMIT: u64 = 4 << 30;

/// Bytes of a channel per cell of a panel.
pub const BYTES_PER_VALUE: u64 = 4;

/// Bytes per cell of a panel without derivatives: 14 channels.
pub const BYTES_PER_CELL: u64 = 14 * BYTES_PER_VALUE;

/// Bytes per cell of a packed panel. The shipped scenes take 21 to 32.
pub const PACKED_BYTES_PER_CELL: u64 = 32;

/// Bytes of a whisker side: its sheet, and the net of an engine.
const SIDE_BYTES: u64 = 256 << 10;

/// Bytes of the cells in flight on a thread: targets, states and results.
pub const BYTES_PER_THREAD: u64 = 4 << 20;

/// Threads beyond which cells in flight take no more memory: [`CELLS_IN_FLIGHT`](super::CELLS_IN_FLIGHT) are shared by all.
const THREADS_IN_FLIGHT: u64 = 16;

/// Bytes per cell in flight with a GPU: the expansions and cells of three row batches, and the trajectories of nets. Four maps on an NVIDIA H100
/// took 90 to 380.
pub const BYTES_ON_GPU: u64 = 512;

/// Bytes of the driver of a GPU: 156 MB of an NVIDIA H100.
pub const DRIVER_BYTES: u64 = 160 << 20;

/// Returns true if a run with `bytes` for panels and `gpu_bytes` for a GPU takes at most [`MEMORY_LIMIT`], on any number of threads.
pub const fn fits(bytes: u64, gpu_bytes: u64) -> bool {
    bytes + THREADS_IN_FLIGHT * BYTES_PER_THREAD + gpu_bytes <= MEMORY_LIMIT
}

/// Returns the memory of the sheets of this number of `whiskers`, in bytes.
pub fn bytes_of_sheets(scene: &Scene, whiskers: usize) -> u64 {
    (whiskers * Plan::sides(scene).len()) as u64 * SIDE_BYTES
}
