//! Scenes of commands.

use super::failure::{Failure, say};
use std::path::Path;
use whiskmap::scene::Scene;

/// Reads a scene; prints notes about unused columns and warnings about numbers that look like another unit.
pub fn read(path: &Path) -> Result<Scene, Failure> {
    let scene = Scene::read(path)?;
    if let Some(note) = &scene.note {
        say(&format!("note: {note}"));
    }
    for warning in scene.warnings() {
        say(&format!("warning: {warning}"));
    }
    Ok(scene)
}
