//! `--data`: measured detachments, and what is said of them.

use super::failure::{Failure, say};
use super::files::{Files, STDOUT};
use std::path::Path;
use whiskmap::measured::{Comparison, Points};
use whiskmap::scene::digits;

/// Refuses to read both the scene and the points from standard input.
pub fn check_stdin(scene: &Path, data: &Path) -> Result<(), Failure> {
    if [scene, data] == [Path::new(STDOUT); 2] {
        let what = "--data -: standard input is the scene, and can be read once; name a file";
        return Err(Failure::Input(what.to_owned()));
    }
    Ok(())
}

/// Reads the points of `path`, an input; columns that are not used, and points whose angle has the sign of the other side, are
/// named on standard error.
pub fn read(files: &mut Files, path: &Path) -> Result<Points, Failure> {
    let points = Points::read(path)?;
    files.input(path);
    if let Some(note) = &points.note {
        say(&format!("note: {note}"));
    }
    let all = points.points.len();
    let signs = points.points.iter();
    let crossed = signs.filter(|point| point.side.sign() * point.angle_deg < 0.0);
    let crossed = crossed.count();
    if crossed > 0 {
        say(&format!(
            "warning: {crossed} of {all} points in {} have an angle of the other side's sign: it is positive for cb, negative \
             for cf",
            points.origin
        ));
    }
    Ok(points)
}

/// Names the points that are left out because the theory has no detachment for them.
pub fn name_left_out(points: &Points, comparison: &Comparison) {
    for row in comparison.left_out() {
        say(&format!(
            "warning: {}:{}: left out: by theory this side never detaches at {} mm",
            points.origin,
            row.line,
            digits(row.distance_mm)
        ));
    }
}

/// How well points and theory agree, line by line.
pub fn summary(comparison: &Comparison) -> Vec<(&'static str, String)> {
    let count = format!(
        "{}, {} left out, {} of another kind than predicted",
        comparison.count(),
        comparison.left_out().count(),
        comparison.of_another_kind()
    );
    let degrees = |value: f64| format!("{} deg", digits(value));
    let residuals = [
        ("RMS", comparison.rms_deg()),
        ("bias", comparison.bias_deg()),
    ];
    let residuals = residuals.map(|(name, value)| Some((name, degrees(value?))));
    let count = Some(("points compared", count));
    [count].into_iter().chain(residuals).flatten().collect()
}
