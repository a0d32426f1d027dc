//! Option `--data`: measured detachments, and messages about them.

use super::failure::{Failure, message};
use super::files::{Files, STDOUT};
use std::path::Path;
use whiskmap::input::{ColumnName, CsvTable};
use whiskmap::measured::{Comparison, MeasuredPoints};
use whiskmap::scene::{digits, rounded};

/// Returns an error if both the scene and the points are standard input.
pub fn check_stdin(scene: &Path, data: &Path) -> Result<(), Failure> {
    if [scene, data] == [Path::new(STDOUT); 2] {
        let why = "--data -: standard input is the scene, and can be read once; name a file";
        return Err(Failure::Input(why.to_owned()));
    }
    Ok(())
}

/// Reads measured points from the input `path`, of which columns may have own names. Prints unused columns, and the number of points with a missing value, and of those whose angle
/// has the other side's sign.
pub fn read(
    files: &mut Files,
    path: &Path,
    columns: &[ColumnName],
) -> Result<MeasuredPoints, Failure> {
    let table = CsvTable::input(path)?.renamed(columns, &MeasuredPoints::COLUMNS)?;
    let points = MeasuredPoints::of(&table)?;
    files.input(path);
    if let Some(note) = &points.note {
        message(&format!("note: {note}"));
    }
    for warning in [points.missing(), points.crossed()].into_iter().flatten() {
        message(&format!("warning: {warning}"));
    }
    Ok(points)
}

/// Prints the measured points that are left out because their side never detaches by theory.
pub fn name_left_out(points: &MeasuredPoints, comparison: &Comparison) {
    for warning in points.left_out(comparison) {
        message(&format!("warning: {warning}"));
    }
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
    let residuals = [
        ("RMS", comparison.rms_deg()),
        ("bias", comparison.bias_deg()),
    ];
    let residuals = residuals.map(|(name, value)| Some((name, degrees(value?))));
    let count = Some(("points compared", count));
    [count].into_iter().chain(residuals).flatten().collect()
}
