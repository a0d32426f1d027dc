//! Output of a slice as a table with one line per cell.

use super::super::failure::Failure;
use super::super::files::Files;
use super::super::outputs::OutputTable;
use serde::ser::{Serialize, SerializeStruct, Serializer};
use std::collections::BTreeMap;
use std::path::Path;
use whiskmap::scene::Coordinate;
use whiskmap::store::{ChannelValues, MapSlice};

/// Names of the codes of a channel, by code.
type CodeNames = BTreeMap<u32, String>;

struct CellLine<'a> {
    axes: &'a [(&'static str, Coordinate)],
    channels: &'a [&'static str],
    /// Names of the codes of `regime` and `status`.
    names: [&'a CodeNames; 2],
    samples: &'a [ChannelValues],
    cell: usize,
}

impl Serialize for CellLine<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let count = self.axes.len() + self.channels.len();
        let mut columns = serializer.serialize_struct("CellLine", count)?;
        for (name, value) in self.axes {
            columns.serialize_field(name, value)?;
        }
        for (name, samples) in self.channels.iter().zip(self.samples) {
            match samples {
                ChannelValues::U32(codes) => {
                    let code = codes[self.cell];
                    columns.serialize_field(name, &code)?;
                    let [regimes, statuses] = self.names;
                    match *name {
                        "regime" => columns.serialize_field("regime_name", &regimes.get(&code))?,
                        "status" => columns.serialize_field("status_name", &statuses.get(&code))?,
                        _ => {}
                    }
                }
                ChannelValues::F32(values) => {
                    let value = Some(values[self.cell]).filter(|value| !value.is_nan());
                    columns.serialize_field(name, &value)?;
                }
            }
        }
        columns.end()
    }
}

pub fn table(
    slice: &MapSlice,
    channels: &[&'static str],
    path: &Path,
    files: &mut Files,
) -> Result<(), Failure> {
    let mut table = OutputTable::new(files.output("--output", path)?);
    let names = ["regime", "status"].map(|name| slice.names(name).unwrap_or_default());
    let grid = slice.grid();
    for whisker in slice.whiskers() {
        let samples = channels.iter().map(|name| slice.read_panel(name, whisker));
        let samples: Vec<ChannelValues> = samples.collect::<Result<_, _>>()?;
        let place = slice.place(whisker);
        let rows = grid.distance_mm.iter();
        let cells =
            rows.flat_map(|row| grid.push_angle_deg.iter().map(move |column| (row, column)));
        for (cell, (distance, push_angle)) in cells.enumerate() {
            let mut axes = place.clone();
            axes.push(("distance_mm", Coordinate::Number(*distance)));
            axes.push(("push_angle_deg", Coordinate::Number(*push_angle)));
            let line = CellLine {
                axes: &axes,
                channels,
                names: names.each_ref(),
                samples: &samples,
                cell,
            };
            table.rows([line])?;
        }
    }
    table.finish().map(drop)
}
