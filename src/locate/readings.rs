//! Reader of CSV files of readings.

use super::BaseReading;
use crate::input::{CsvError, CsvTable};
use crate::scene::digits;

/// Readings of a sensor at the base.
#[derive(Clone, Debug, PartialEq)]
pub struct BaseReadings {
    /// Readings in the order of the file, `[reading]`.
    pub readings: Vec<BaseReading>,
    /// Note about columns of the file that are not used; `None` without such columns.
    pub note: Option<String>,
}

/// Largest size of a moment in nN m and of a force in uN: beyond the loads of every whisker of a scene.
pub const MOST_LOAD: f64 = 1e18;

/// Largest size of an angle of the base, in degrees.
pub const MOST_ANGLE: f64 = 360.0;

impl BaseReadings {
    /// Names of the columns of a file of readings, in the order of the fields of [`BaseReading`]: `[column]`.
    pub const COLUMNS: [&str; 4] =
        ["base_moment_nnm", "base_force_x_un", "base_force_y_un", "angle_deg"];

    /// Returns the readings of a CSV table with at least two of the columns `base_moment_nnm`, `base_force_x_un` and `base_force_y_un`, and
    /// optionally `angle_deg`. A missing value, as in [`CsvTable::measurements`], is a number that was not measured.
    ///
    /// # Errors
    /// If two of the columns are missing, or a cell is no number or out of its range.
    pub fn of(table: &CsvTable) -> Result<Self, CsvError> {
        let [moment, x, y, angle] = Self::COLUMNS;
        let note = table.require(&[], &Self::COLUMNS)?;
        let loads = [moment, x, y];
        if loads.into_iter().filter(|name| table.has(name)).count() < 2 {
            let others = note.map_or(String::new(), |note| format!("; {note}"));
            let what =
                format!("must have at least two of the columns {moment}, {x} and {y}{others}");
            return Err(CsvError::whole(&table.origin, what).of_columns());
        }
        let numbers = |name: &str, most: f64| {
            let end = digits(most);
            let must = format!("a number between -{end} and {end}");
            let values = table
                .measurements(name, &must, |number| number.abs() <= most)?
                .unwrap_or_else(|| vec![f64::NAN; table.lines().count()]);
            let measured = |number: f64| (!number.is_nan()).then_some(number);
            Ok::<_, CsvError>(values.into_iter().map(measured).collect::<Vec<_>>())
        };
        let [moments, xs, ys] = loads.map(|name| numbers(name, MOST_LOAD));
        let (moments, xs, ys) = (moments?, xs?, ys?);
        let angles = numbers(angle, MOST_ANGLE)?;
        let readings = (0..moments.len()).map(|i| BaseReading {
            moment_nnm: moments[i],
            force_x_un: xs[i],
            force_y_un: ys[i],
            angle_deg: angles[i],
        });
        Ok(Self { readings: readings.collect(), note })
    }
}
