//! GPU adapters of this machine, and the choice of the one that the engine uses.

use super::Precision;
use wgpu::{AdapterInfo, DeviceType};

/// Description of a GPU adapter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterReport {
    /// Name, interface, kind and driver of the adapter.
    pub info: AdapterInfo,
    /// True if shaders of the adapter can compute in `f64`.
    pub shader_f64: bool,
    /// Size in bytes of the largest storage buffer of the adapter that a shader can access.
    pub most_storage_bytes: u64,
    /// Maximum number of workgroups per dispatch of the adapter.
    pub most_workgroups: u32,
}

impl AdapterReport {
    pub(super) fn new(adapter: &wgpu::Adapter) -> Self {
        let limits = adapter.limits();
        Self {
            info: adapter.get_info(),
            shader_f64: adapter.features().contains(wgpu::Features::SHADER_F64),
            most_storage_bytes: limits.max_storage_buffer_binding_size,
            most_workgroups: limits.max_compute_workgroups_per_dimension,
        }
    }

    /// Rank of the adapter's kind in the order of preference, and the kind's name.
    const fn ranked_kind(&self) -> (u8, &'static str) {
        match self.info.device_type {
            DeviceType::DiscreteGpu => (0, "discrete GPU"),
            DeviceType::IntegratedGpu => (1, "integrated GPU"),
            DeviceType::VirtualGpu => (2, "virtual GPU"),
            DeviceType::Other => (3, "GPU of unknown kind"),
            DeviceType::Cpu => (4, "software"),
        }
    }

    /// Returns the name of the adapter's kind, such as integrated or software.
    #[must_use]
    pub const fn kind(&self) -> &'static str {
        self.ranked_kind().1
    }

    /// Returns true if the adapter computes on the CPU.
    #[must_use]
    pub fn is_software(&self) -> bool {
        self.info.device_type == DeviceType::Cpu
    }

    fn computes_in(&self, precision: Precision) -> bool {
        precision == Precision::F32 || self.shader_f64
    }
}

/// Returns every adapter that a driver offers.
pub(super) fn enumerate() -> Vec<wgpu::Adapter> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()))
}

/// Returns a description of every adapter of every interface, `[adapter]`.
#[must_use]
pub fn adapters() -> Vec<AdapterReport> {
    enumerate().iter().map(AdapterReport::new).collect()
}

/// Index of the first `good` adapter of the best kind.
fn best(reports: &[AdapterReport], good: impl Fn(&AdapterReport) -> bool) -> Option<usize> {
    (0..reports.len()).filter(|&i| good(&reports[i])).min_by_key(|&i| reports[i].ranked_kind().0)
}

/// Returns the index of the adapter that the engine uses by default: the first of the best kind that has this precision; `None` without
/// one.
#[must_use]
pub fn preferred(reports: &[AdapterReport], precision: Precision) -> Option<usize> {
    best(reports, |report| report.computes_in(precision))
}

/// Returns the index of the adapter with `part` in its name or at this PCI address, ignoring case: the first of the best kind, with this precision
/// if there is one. `None` without one, and for an empty `part`.
#[must_use]
pub fn named(reports: &[AdapterReport], part: &str, precision: Precision) -> Option<usize> {
    let part = part.to_lowercase();
    let is_named = |report: &AdapterReport| {
        let AdapterInfo { name, device_pci_bus_id, .. } = &report.info;
        let is_part = name.to_lowercase().contains(&part);
        !part.is_empty() && (is_part || device_pci_bus_id.to_lowercase() == part)
    };
    best(reports, |report| is_named(report) && report.computes_in(precision))
        .or_else(|| best(reports, is_named))
}
