//! Which adapter is taken.

use wgpu::{AdapterInfo, Backend, DeviceType};
use whiskmap::engine::gpu::{AdapterReport, Precision, named, preferred};

tests! {
    Nothing:
        software_comes_last_and_the_first_of_equals_wins,
        f64_is_asked_of_an_adapter_that_has_it,
        a_part_of_a_name_is_enough_whatever_the_case;
}

fn report(kind: DeviceType) -> AdapterReport {
    AdapterReport {
        info: AdapterInfo::new(kind, Backend::Noop),
        shader_f64: false,
        most_storage_bytes: 0,
        most_workgroups: 0,
    }
}

fn software_comes_last_and_the_first_of_equals_wins() {
    let kinds = [
        DeviceType::Cpu,
        DeviceType::IntegratedGpu,
        DeviceType::DiscreteGpu,
        DeviceType::DiscreteGpu,
    ];
    assert_eq!(preferred(&kinds.map(report), Precision::F32), Some(2));
    assert_eq!(preferred(&[report(DeviceType::Cpu)], Precision::F32), Some(0));
    assert_eq!(preferred(&[], Precision::F32), None);
}

fn f64_is_asked_of_an_adapter_that_has_it() {
    let mut reports = [DeviceType::DiscreteGpu, DeviceType::Cpu].map(report);
    assert_eq!(preferred(&reports, Precision::F64), None);
    reports[1].shader_f64 = true;
    assert_eq!(preferred(&reports, Precision::F64), Some(1));
}

fn a_part_of_a_name_is_enough_whatever_the_case() {
    let mut reports = [DeviceType::Cpu, DeviceType::IntegratedGpu, DeviceType::Cpu].map(report);
    for (report, name) in reports.iter_mut().zip(["llvmpipe", "Iris Xe", "Pipe"]) {
        name.clone_into(&mut report.info.name);
    }
    assert_eq!(named(&reports, "IRIS", Precision::F32), Some(1));
    assert_eq!(named(&reports, "pipe", Precision::F32), Some(0));
    assert_eq!(named(&reports, "abacus", Precision::F32), None);
    // Equal cards have equal names, but no address is that of two.
    "0000:C1:00.0".clone_into(&mut reports[2].info.device_pci_bus_id);
    assert_eq!(named(&reports, "0000:c1:00.0", Precision::F32), Some(2));
    assert_eq!(named(&reports, "0000:c1", Precision::F32), None);
    // Without `f64` anywhere the name decides, and opening it says what is missing.
    assert_eq!(named(&reports, "pipe", Precision::F64), Some(0));
    reports[2].shader_f64 = true;
    assert_eq!(named(&reports, "pipe", Precision::F64), Some(2));
}
