//! Selection of a GPU adapter, by an option or the environment.

use super::failure::Failure;
use std::env;
use whiskmap::engine::gpu::{AdapterReport, Precision, named, preferred};

/// Environment variable that also other programs with wgpu use to select an adapter.
const ADAPTER_VARIABLE: &str = "WGPU_ADAPTER_NAME";

/// Returns true if an option or the environment names an adapter.
pub fn is_named(wanted: Option<&str>) -> bool {
    wanted.is_some() || variable().is_some()
}

/// Returns the value of the environment variable; `None` if it is not set, or empty.
fn variable() -> Option<String> {
    env::var(ADAPTER_VARIABLE).ok().filter(|name| !name.is_empty())
}

/// Returns the index of the `wanted` adapter, else of the one named by `WGPU_ADAPTER_NAME`, else of the preferred one; `None`
/// without an adapter.
///
/// # Errors
/// If the wanted or named adapter is not among the `reports`.
pub fn chosen(
    reports: &[AdapterReport],
    wanted: Option<&str>,
    precision: Precision,
) -> Result<Option<usize>, Failure> {
    let (what, found) = match (wanted, variable()) {
        (Some(wanted), _) => {
            let found = match wanted.parse::<usize>() {
                Ok(number) => (number < reports.len()).then_some(number),
                Err(_) => named(reports, wanted, precision),
            };
            (format!("--adapter {wanted}"), found)
        }
        (None, Some(name)) => {
            (format!("{ADAPTER_VARIABLE}={name}"), named(reports, &name, precision))
        }
        (None, None) => {
            let preferred = |precision| preferred(reports, precision);
            return Ok(preferred(precision).or_else(|| preferred(Precision::F32)));
        }
    };
    if found.is_some() {
        return Ok(found);
    }
    let list: Vec<String> = reports
        .iter()
        .enumerate()
        .map(|(i, report)| match &report.info.device_pci_bus_id[..] {
            "" => format!("{i} ({})", report.info.name),
            address => format!("{i} ({}) at {address}", report.info.name),
        })
        .collect();
    let allowed = match &list[..] {
        [] => "there is none".to_owned(),
        list => format!("must be one of {}", list.join(", ")),
    };
    let why = format!("{what}: no such GPU adapter; {allowed}");
    Err(Failure::Input(why))
}
