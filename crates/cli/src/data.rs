//! Tables that commands read: own names of columns, measured detachments, and messages about them.

use super::failure::{Failure, notes, warnings};
use clap::Args;
use std::path::Path;
use whiskmap::input::{ColumnName, CsvError, CsvTable};
use whiskmap::measured::{Comparison, MeasuredPoints};
use whiskmap::scene::{Scene, digits, rounded};

// Option of all commands that read a table. In each of these commands, the options that name a table are the group `table`.
#[derive(Debug, Args)]
pub struct ColumnArgs {
    /// Names of own columns in place of expected ones, separated by commas: push=angle takes the column `angle` for push_angle_deg
    #[arg(long, value_name = "NAME=COLUMN", value_delimiter = ',', requires = "table")]
    columns: Vec<ColumnName>,
}

impl ColumnArgs {
    /// Reads the table in the input `path`, with the `expected` names of columns in place of the names in the file, and returns what `read` makes of
    /// it. The error of a table that lacks columns names --columns.
    pub fn read<T>(
        &self,
        path: &Path,
        expected: &[&str],
        read: impl FnOnce(&CsvTable) -> Result<T, CsvError>,
    ) -> Result<T, Failure> {
        let table = CsvTable::input(path)?.renamed(&self.columns, expected)?;
        read(&table).map_err(|why| match why.lacks_columns() {
            true => Failure::Input(format!("{why}; --columns NAME=COLUMN takes own names")),
            false => why.into(),
        })
    }
}

/// Reads measured points from the input `path`, whose `columns` may have other names. Prints unused columns, the number of points with a
/// missing value, and the number of points whose angle has the sign of the other side.
pub fn read(path: &Path, columns: &ColumnArgs) -> Result<MeasuredPoints, Failure> {
    let points = columns.read(path, &MeasuredPoints::COLUMNS, MeasuredPoints::of)?;
    notes(&points.note);
    warnings([points.missing(), points.crossed()].into_iter().flatten());
    Ok(points)
}

/// Prints to which angles measured ones are compared, if the scene has an elastic follicle.
pub fn note_follicle(scene: &Scene) {
    let mut whiskers = scene.whiskers().flatten();
    let turns = whiskers.any(|swept| swept.whisker.follicle_stiffness_nnm_per_rad.is_some());
    notes(turns.then_some(
        "whisker.follicle: angles are those of the follicle's axis; a film shows those of the whisker's base, which bends away from it",
    ));
}

/// Prints the measured points that are left out because their side never detaches by theory.
pub fn name_left_out(points: &MeasuredPoints, comparison: &Comparison) {
    warnings(points.left_out(comparison));
}

/// Number of significant digits of statistics in text. JSON has all digits.
pub const STATISTIC_DIGITS: usize = 4;

/// Returns name and value of each figure of a comparison as text, `[figure]`: number of points, RMS and bias in degrees.
pub fn summary(comparison: &Comparison) -> Vec<(&'static str, String)> {
    let count = format!(
        "{}, {} left out, {} of another kind than predicted",
        comparison.count(),
        comparison.left_out().count(),
        comparison.of_another_kind()
    );
    let degrees = |value: f64| format!("{} deg", digits(rounded(value, STATISTIC_DIGITS)));
    let residuals = [("RMS", comparison.rms_deg()), ("bias", comparison.bias_deg())]
        .map(|(name, value)| Some((name, degrees(value?))));
    let count = Some(("points compared", count));
    [count].into_iter().chain(residuals).flatten().collect()
}
