//! Numbers of cells of each regime and status.

use super::StoreError;
use crate::classify::{Regime, Status, cells_by_code};
use crate::map::{Audit, EngineCells, Panel};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Code of a cell of a store, in the channels of codes, that is not computed yet.
pub const NOT_COMPUTED: u8 = 254;

/// Counts of the cells of a map: its attribute `counts`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CellCounts {
    /// Number of cells of each regime, by the regime's name.
    pub regimes: BTreeMap<String, u64>,
    /// Number of cells of each status, by the status' name.
    pub statuses: BTreeMap<String, u64>,
    /// Largest residual of a cell of the map, in whisker lengths; `None` if no cell is in contact.
    pub worst_residual: Option<f64>,
    /// Number of cells of the map by their outcome in the engine.
    pub engine_cells: EngineCells,
    /// Result of the audit of the map's engine.
    pub audit: Audit,
}

impl CellCounts {
    /// Adds the cells of `panel`, which has this index in the sweep. A code without a name is an error.
    pub(super) fn add(&mut self, index: usize, panel: &Panel) -> Result<(), StoreError> {
        let unknown = |channel| move |code| StoreError::UnknownCode { index, channel, code };
        add(&mut self.regimes, regimes(), &panel.regime).map_err(unknown("regime"))?;
        add(&mut self.statuses, statuses(), &panel.status).map_err(unknown("status"))?;
        let cells = panel.residual.iter().zip(&panel.regime);
        let solved = cells.filter(|(residual, regime)| {
            !residual.is_nan() && **regime != Regime::Unresolved.code()
        });
        self.worst_residual = solved
            .map(|(residual, _)| f64::from(*residual))
            .chain(self.worst_residual)
            .reduce(f64::max);
        Ok(())
    }
}

/// Returns the names of the regimes by code.
pub(super) fn regimes() -> BTreeMap<u32, &'static str> {
    Regime::ALL.map(|regime| (regime.code(), regime.name())).into()
}

/// Returns the names of the statuses by code.
pub(super) fn statuses() -> BTreeMap<u32, &'static str> {
    Status::ALL.map(|status| (status.code(), status.name())).into()
}

/// Adds to `cells`, by name, the number of cells with each of the `codes`. A code without a name is an error.
fn add(
    cells: &mut BTreeMap<String, u64>,
    names: BTreeMap<u32, &'static str>,
    codes: &[u32],
) -> Result<(), u32> {
    for name in names.values() {
        cells.entry((*name).to_owned()).or_default();
    }
    for (code, count) in cells_by_code(codes) {
        let name = names.get(&code).ok_or(code)?;
        *cells.entry((*name).to_owned()).or_default() += count;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_counted_by_name_and_a_code_without_a_name_is_an_error() {
        let [free, contact] = [Regime::ALL[0], Regime::ALL[1]];
        let mut cells = BTreeMap::new();
        let codes = [contact.code(), free.code(), contact.code()];
        assert_eq!(add(&mut cells, regimes(), &codes), Ok(()));
        let counted = [free, contact].map(|regime| cells[regime.name()]);
        assert_eq!(counted, [1, 2]);
        assert_eq!(add(&mut cells, regimes(), &[free.code(), 99]), Err(99));
    }
}
