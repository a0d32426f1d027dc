//! Which adapter is taken.

use wgpu::{AdapterInfo, Backend, DeviceType};
use whiskmap::integrate::gpu::{AdapterReport, Precision, preferred};

fn report(kind: DeviceType) -> AdapterReport {
    AdapterReport {
        info: AdapterInfo::new(kind, Backend::Noop),
        shader_f64: false,
        most_storage_bytes: 0,
        most_workgroups: 0,
    }
}

#[test]
fn software_comes_last_and_the_first_of_equals_wins() {
    let kinds = [
        DeviceType::Cpu,
        DeviceType::IntegratedGpu,
        DeviceType::DiscreteGpu,
        DeviceType::DiscreteGpu,
    ];
    assert_eq!(preferred(&kinds.map(report), Precision::F32), Some(2));
    assert_eq!(
        preferred(&[report(DeviceType::Cpu)], Precision::F32),
        Some(0)
    );
    assert_eq!(preferred(&[], Precision::F32), None);
}

#[test]
fn f64_is_asked_of_an_adapter_that_has_it() {
    let mut reports = [DeviceType::DiscreteGpu, DeviceType::Cpu].map(report);
    assert_eq!(preferred(&reports, Precision::F64), None);
    reports[1].shader_f64 = true;
    assert_eq!(preferred(&reports, Precision::F64), Some(1));
}
