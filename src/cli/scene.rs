//! Scenes of commands.

use super::failure::{Failure, say};
use std::path::Path;
use whiskmap::scene::Scene;

/// Reads a scene, and prints what is not used of its files and which numbers look as if they were in another unit.
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
