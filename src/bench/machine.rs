//! Machines of the model of large maps, with their published peak rates.

use serde::Serialize;

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
