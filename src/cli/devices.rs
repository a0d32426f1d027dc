//! `whiskmap devices`.

use super::engine::{self, Choice};
use super::failure::Failure;
use std::io::Write;
use whiskmap::integrate::Description;
use whiskmap::integrate::gpu::{Precision, adapters, preferred};

/// Runs `devices`.
pub fn run() -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    let reports = adapters();
    if reports.is_empty() {
        writeln!(out, "no GPU adapter found")?;
    }
    let taken = preferred(&reports, Precision::F32);
    for (i, report) in reports.iter().enumerate() {
        let info = &report.info;
        let mark = if taken == Some(i) { "*" } else { " " };
        let has_f64 = if report.shader_f64 { "yes" } else { "no" };
        writeln!(
            out,
            "{mark} {} ({}, {})",
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
    if taken.is_some() {
        writeln!(out, "* is what --engine gpu takes")?;
    }
    let (engine, why) = engine::open(Choice::Auto, None)?;
    let description = Description::of(engine.as_deref());
    writeln!(
        out,
        "--engine auto takes {} on {} ({why})",
        description.engine, description.adapter
    )?;
    Ok(())
}
