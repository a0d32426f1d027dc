//! Command `whiskmap devices`.

use super::adapter::chosen;
use super::failure::Failure;
use std::io::Write;
use whiskmap::engine::EngineDescription;
use whiskmap::engine::gpu::{Precision, adapters, missing};
use whiskmap::terminal::StandardOutput;

pub fn run() -> Result<(), Failure> {
    let mut out = StandardOutput::open();
    let reports = adapters();
    if reports.is_empty() {
        let (why, cpu) = (missing(), EngineDescription::of(None).adapter);
        writeln!(
            out,
            "no GPU adapter found: {why}\n--engine auto selects the spectral or the CPU engine by the scene, both f64 on {cpu}"
        )?;
        return Ok(());
    }
    let selected = chosen(&reports, None, Precision::F32);
    for (i, report) in reports.iter().enumerate() {
        let (info, kind) = (&report.info, report.kind());
        let is_selected = matches!(selected, Ok(Some(selected)) if selected == i);
        let mark = if is_selected { "*" } else { " " };
        let has_f64 = if report.shader_f64 { "yes" } else { "no" };
        writeln!(out, "{mark} {i} {} ({kind}, {})", info.name, info.backend)?;
        writeln!(out, "    driver   {} {}", info.driver, info.driver_info)?;
        if !info.device_pci_bus_id.is_empty() {
            writeln!(out, "    PCI      {}", info.device_pci_bus_id)?;
        }
        writeln!(out, "    f64      {has_f64}")?;
        writeln!(
            out,
            "    limits   {} MiB per storage buffer, {} workgroups per dispatch",
            report.most_storage_bytes >> 20,
            report.most_workgroups
        )?;
    }
    selected?;
    writeln!(out, "* is the adapter of --engine gpu")?;
    writeln!(
        out,
        "--engine auto times it and an engine of the CPU on samples of a scene that takes at least 0.1 s, and selects the faster one"
    )?;
    Ok(())
}
