//! Reading of scenes, with their notes and warnings.

use super::failure::{Failure, message, notes, warnings};
use std::path::Path;
use whiskmap::scene::{Scene, digits, rounded};
use whiskmap::traced::TracedShape;

/// Largest number of rows without a whisker that a warning names.
const MOST_REFUSED: usize = 10;

/// Reads a scene; prints notes about unused columns and warnings about values that look like another unit.
pub fn read_scene(path: &Path) -> Result<Scene, Failure> {
    let scene = Scene::read(path)?;
    notes(scene.notes());
    if let Some(traced) = scene.traced() {
        let length_mm = scene.whisker.length_mm;
        message(&format!("note: whisker.rest: {}", fitted(traced, length_mm)));
    }
    if let Some(smooth) = scene.smooth_radii() {
        message(&format!(
            "note: whisker.profile: radii of degree {}, chosen by cross-validation; {} rows, rms residual {} um",
            smooth.degree,
            smooth.rows.len(),
            digits(rounded(smooth.rms_um, 3))
        ));
    }
    warnings(without_whisker(&scene));
    warnings(scene.warnings());
    Ok(scene)
}

/// Describes the rows of a table of whiskers that have no whisker; `None` if all have one.
fn without_whisker(scene: &Scene) -> Option<String> {
    let count = scene.refused().count();
    let rows: Vec<String> = scene
        .refused()
        .take(MOST_REFUSED)
        .map(|(name, reason)| format!("{name} ({reason})"))
        .collect();
    let more = match count.saturating_sub(MOST_REFUSED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    (count > 0).then(|| {
        format!(
            "whiskers.table: {count} of {} rows have no whisker: {}{more}",
            scene.table.len(),
            rows.join(", ")
        )
    })
}

/// Returns an error if a scene that must be complete has a row without a whisker.
pub fn check_strict(is_strict: bool, scene: &Scene) -> Result<(), Failure> {
    match without_whisker(scene) {
        Some(rows) if is_strict => Err(Failure::Input(format!("--strict: {rows}"))),
        _ => Ok(()),
    }
}

/// Describes the fit to traced points of a whisker with this length.
fn fitted(traced: &TracedShape, length_mm: f64) -> String {
    let TracedShape { degree, rms_mm, points_mm, .. } = traced;
    let chosen = if traced.is_degree_chosen { ", chosen by cross-validation" } else { "" };
    let length = rounded(traced.length_mm, 6);
    let scaled = if length_mm == traced.length_mm {
        String::new()
    } else {
        format!(", at the scale of length_mm = {}", digits(length_mm))
    };
    format!(
        "curvature of degree {degree}{chosen}; {} points, rms distance {} mm, length {length} mm{scaled}",
        points_mm.len(),
        digits(rounded(*rms_mm, 3))
    )
}
