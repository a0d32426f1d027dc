//! Numbers of cells of each regime and status.

use crate::classify::{Regime, Status};
use crate::map::{Audit, EngineCells};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The attribute `counts` of a map.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CellCounts {
    /// Cells of each regime, by name.
    pub regimes: BTreeMap<String, u64>,
    /// Cells of each status, by name.
    pub statuses: BTreeMap<String, u64>,
    /// The greatest residual, relative to the whisker's length; `None` where no cell is in contact.
    pub worst_residual: Option<f64>,
    /// Cells by what the engine did with them.
    pub engine_cells: EngineCells,
    /// Result of the engine's audit.
    pub audit: Audit,
}

/// Names of the regimes by code.
pub(super) fn regimes() -> BTreeMap<u32, &'static str> {
    Regime::ALL.map(|own| (own.code(), own.name())).into()
}

/// Names of the statuses by code.
pub(super) fn statuses() -> BTreeMap<u32, &'static str> {
    Status::ALL.map(|own| (own.code(), own.name())).into()
}

/// Adds the number of `codes` of each name to `cells`. A code without a name is an error.
pub(super) fn add(
    cells: &mut BTreeMap<String, u64>,
    names: BTreeMap<u32, &'static str>,
    codes: &[u32],
) -> Result<(), u32> {
    if let Some(unknown) = codes.iter().find(|code| !names.contains_key(code)) {
        return Err(*unknown);
    }
    for (code, name) in names {
        let own = codes.iter().filter(|other| **other == code).count();
        *cells.entry(name.to_owned()).or_default() += own as u64;
    }
    Ok(())
}
