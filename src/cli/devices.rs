//! `whiskmap devices`.

use super::engine::chosen;
use super::failure::Failure;
use std::io::Write;
use whiskmap::engine::EngineDescription;
use whiskmap::engine::gpu::{Precision, adapters};

/// Runs `devices`.
pub fn run() -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    let reports = adapters();
    let cpu = EngineDescription::of(None);
    let cpu = format!("{} on {}", cpu.engine, cpu.adapter);
    if reports.is_empty() {
        writeln!(out, "no GPU adapter found")?;
        writeln!(out, "--engine auto takes {cpu}")?;
        return Ok(());
    }
    let taken = chosen(&reports, None, Precision::F32);
    for (i, report) in reports.iter().enumerate() {
        let info = &report.info;
        let is_taken = matches!(taken, Ok(Some(taken)) if taken == i);
        let mark = if is_taken { "*" } else { " " };
        let has_f64 = if report.shader_f64 { "yes" } else { "no" };
        writeln!(
            out,
            "{mark} {i} {} ({}, {})",
            info.name,
            report.kind(),
            info.backend
        )?;
        writeln!(out, "    driver   {} {}", info.driver, info.driver_info)?;
        writeln!(out, "    f64      {has_f64}")?;
        writeln!(
            out,
            "    limits   {} MiB per storage buffer, {} workgroups per dispatch",
            report.most_storage_bytes >> 20,
            report.most_workgroups
        )?;
    }
    taken?;
    writeln!(out, "* is what --engine gpu takes")?;
    writeln!(
        out,
        "--engine auto times it and {cpu} on a sample of the scene, and takes the faster"
    )?;
    Ok(())
}
