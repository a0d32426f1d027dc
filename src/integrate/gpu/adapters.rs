//! Which adapters there are, and which one is taken.

use super::Precision;
use std::fmt;

/// What an adapter is, in order of preference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum AdapterKind {
    /// A card of its own.
    Discrete,
    /// Part of the processor.
    Integrated,
    /// Lent by a hypervisor.
    Virtual,
    /// The driver does not say.
    Other,
    /// A program on the CPU: right answers, but slower than the CPU engine.
    Software,
}

impl From<wgpu::DeviceType> for AdapterKind {
    fn from(kind: wgpu::DeviceType) -> Self {
        match kind {
            wgpu::DeviceType::DiscreteGpu => Self::Discrete,
            wgpu::DeviceType::IntegratedGpu => Self::Integrated,
            wgpu::DeviceType::VirtualGpu => Self::Virtual,
            wgpu::DeviceType::Other => Self::Other,
            wgpu::DeviceType::Cpu => Self::Software,
        }
    }
}

impl fmt::Display for AdapterKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Discrete => "discrete GPU",
            Self::Integrated => "integrated GPU",
            Self::Virtual => "virtual GPU",
            Self::Other => "GPU of unknown kind",
            Self::Software => "software",
        })
    }
}

/// An adapter as a person wants to see it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterReport {
    /// Its name.
    pub name: String,
    /// The interface: `vulkan`, `metal`, `dx12`.
    pub backend: String,
    /// What it is.
    pub kind: AdapterKind,
    /// Driver.
    pub driver: String,
    /// Version and whatever else the driver tells.
    pub driver_info: String,
    /// Whether shaders can compute in `f64`.
    pub shader_f64: bool,
    /// Largest storage buffer that a shader can see, in bytes.
    pub most_storage_bytes: u64,
    /// Workgroups per dispatch.
    pub most_workgroups: u32,
}

impl AdapterReport {
    pub(super) fn new(adapter: &wgpu::Adapter) -> Self {
        let info = adapter.get_info();
        let limits = adapter.limits();
        Self {
            name: info.name,
            backend: info.backend.to_string(),
            kind: info.device_type.into(),
            driver: info.driver,
            driver_info: info.driver_info,
            shader_f64: adapter.features().contains(wgpu::Features::SHADER_F64),
            most_storage_bytes: limits.max_storage_buffer_binding_size,
            most_workgroups: limits.max_compute_workgroups_per_dimension,
        }
    }
}

/// Every adapter that a driver offers.
pub(super) fn enumerate() -> Vec<wgpu::Adapter> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()))
}

/// Every adapter of every interface, for people to see.
#[must_use]
pub fn adapters() -> Vec<AdapterReport> {
    enumerate().iter().map(AdapterReport::new).collect()
}

/// Which adapter the engine takes: the first of the best kind among those with this precision.
#[must_use]
pub fn preferred(reports: &[AdapterReport], precision: Precision) -> Option<usize> {
    (0..reports.len())
        .filter(|&i| precision == Precision::F32 || reports[i].shader_f64)
        .min_by_key(|&i| reports[i].kind)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report(kind: AdapterKind) -> AdapterReport {
        AdapterReport {
            name: String::new(),
            backend: String::new(),
            kind,
            driver: String::new(),
            driver_info: String::new(),
            shader_f64: false,
            most_storage_bytes: 0,
            most_workgroups: 0,
        }
    }

    #[test]
    fn software_comes_last_and_the_first_of_equals_wins() {
        let kinds = [
            AdapterKind::Software,
            AdapterKind::Integrated,
            AdapterKind::Discrete,
            AdapterKind::Discrete,
        ];
        assert_eq!(preferred(&kinds.map(report), Precision::F32), Some(2));
        assert_eq!(
            preferred(&[report(AdapterKind::Software)], Precision::F32),
            Some(0)
        );
        assert_eq!(preferred(&[], Precision::F32), None);
    }

    #[test]
    fn f64_is_asked_of_an_adapter_that_has_it() {
        let mut reports = [AdapterKind::Discrete, AdapterKind::Software].map(report);
        assert_eq!(preferred(&reports, Precision::F64), None);
        reports[1].shader_f64 = true;
        assert_eq!(preferred(&reports, Precision::F64), Some(1));
    }
}
