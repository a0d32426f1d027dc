//! Comparison of two maps of the same scene and grid, channel by channel.
//!
//! Maps are read block by block, so that memory does not grow with the number of whiskers, and no whisker is computed twice.

mod agree;
mod codes;
mod quantity;
mod within;

pub use self::agree::{Mismatch, check_same};
pub use self::codes::{CodeComparison, CodePair, DifferentCodes};
pub use self::quantity::QuantityComparison;
pub use self::within::Within;

use crate::scene::{Coordinate, Grid};
use crate::store::{MapSource, StoreError, ZarrStore};
use serde::ser::{Serialize, SerializeMap, Serializer};
use std::fmt;
use std::ops::Range;

/// Comparison of two maps, the first and the second one.
#[derive(Clone, Debug, serde::Serialize)]
#[non_exhaustive]
pub struct MapComparison {
    /// Number of cells of each map.
    pub cells: u64,
    /// Comparisons of `regime` and `status`, `[channel]`, if both maps have them.
    pub codes: Vec<CodeComparison>,
    /// Comparisons of all other channels that both maps have: `[channel]`.
    pub quantities: Vec<QuantityComparison>,
    /// Names of the channels that only one map has: `[map][channel]`, the first map first.
    pub only_in: [Vec<&'static str>; 2],
}

/// Error of two maps that cannot be compared.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CompareError {
    /// The maps have different scenes or grids.
    #[error(transparent)]
    Mismatch(#[from] Mismatch),
    /// A map cannot be read.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// Place of a cell: names and values of the sweep axes, the distance in mm and the push angle in degrees.
#[derive(Clone, Debug, PartialEq)]
pub struct CellPlace(pub Vec<(&'static str, Coordinate)>);

impl CellPlace {
    /// Returns the place of a cell of `grid` with this index, `[whisker][distance][push angle]`.
    fn of(grid: &Grid, cell: usize) -> Self {
        let (columns, rows) = (grid.push_angle_deg.len(), grid.distance_mm.len());
        let whisker = grid.place(cell / (rows * columns));
        let inside = [
            ("distance_mm", grid.distance_mm[cell / columns % rows]),
            ("push_angle_deg", grid.push_angle_deg[cell % columns]),
        ]
        .map(|(name, value)| (name, Coordinate::Number(value)));
        Self(whisker.coordinates().chain(inside).collect())
    }
}

impl fmt::Display for CellPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let values = self.0.iter();
        let values = values.map(|(name, value)| format!("{name} = {}", value.rounded(4)));
        f.write_str(&values.collect::<Vec<_>>().join(", "))
    }
}

impl Serialize for CellPlace {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, value) in &self.0 {
            map.serialize_entry(name, value)?;
        }
        map.end()
    }
}

/// Compares two maps. Values that are rounded in a file may differ by what the rounding explains, see
/// [`QuantityComparison::beyond_rounding`].
///
/// # Errors
/// The maps have different scenes or grids, or one of them is incomplete or damaged.
pub fn compare(maps: [&MapSource; 2]) -> Result<MapComparison, CompareError> {
    agree::check(maps)?;
    let [first, second] = maps.map(MapSource::channels);
    let lacks = |one: &[&'static str], other: &[&'static str]| -> Vec<&'static str> {
        let lacking = one.iter().filter(|name| !other.contains(name));
        lacking.copied().collect()
    };
    let mut comparison = MapComparison {
        cells: 0,
        codes: Vec::new(),
        quantities: Vec::new(),
        only_in: [lacks(&first, &second), lacks(&second, &first)],
    };
    let grid = maps[0].grid();
    comparison.cells = (grid.panel_cells() * grid.whisker_count()) as u64;
    let (mut codes, mut quantities) = (Vec::new(), Vec::new());
    let rounding = [maps[0].digits()?, maps[1].digits()?];
    for name in first.into_iter().filter(|name| second.contains(name)) {
        match maps[0].names(name) {
            Some(names) => codes.push(CodeComparison::new(name, names)),
            None => quantities.push(QuantityComparison::new(name, rounding)),
        }
    }
    for whiskers in ZarrStore::blocks(grid) {
        for code in &mut codes {
            let (channel, add) = (code.channel, |cell, values| code.add(grid, cell, values));
            each_cell(maps, channel, &whiskers, add)?;
        }
        for quantity in &mut quantities {
            let (channel, add) = (quantity.channel, |cell, values| quantity.add(cell, values));
            each_cell(maps, channel, &whiskers, add)?;
        }
    }
    let codes = codes.into_iter().map(CodeComparison::finish);
    comparison.codes = codes.collect();
    let quantities = quantities.into_iter().map(|quantity| quantity.finish(grid));
    comparison.quantities = quantities.collect();
    Ok(comparison)
}

/// Passes index and values of each cell of a channel of consecutive `whiskers`, in order, to `add`.
fn each_cell(
    maps: [&MapSource; 2],
    channel: &str,
    whiskers: &Range<usize>,
    mut add: impl FnMut(usize, [f64; 2]),
) -> Result<(), StoreError> {
    let first = whiskers.start * maps[0].grid().panel_cells();
    let read = |map: &MapSource| map.read_panels(channel, whiskers.clone());
    let (one, other) = rayon::join(|| read(maps[0]), || read(maps[1]));
    let (one, other) = (one?, other?);
    for (cell, values) in (first..).zip(one.values().zip(other.values())) {
        add(cell, values.into());
    }
    Ok(())
}
