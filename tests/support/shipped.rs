//! Files of the repository: scenes, pages, and data of tests.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};
use whiskmap::scene::Scene;

/// Returns the root of the repository.
pub fn root() -> &'static Path {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    package.ancestors().nth(2).unwrap()
}

/// Reads the scene `name` in the folder `scenes/`.
pub fn scene(name: &str) -> Scene {
    Scene::read(root().join(format!("scenes/{name}.toml"))).unwrap()
}

/// Returns the paths of all scenes in the folder `scenes/`, in order.
pub fn scene_paths() -> Vec<PathBuf> {
    let files = root().join("scenes").read_dir().unwrap();
    let mut paths: Vec<_> = files
        .map(|file| file.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .collect();
    paths.sort();
    paths
}

/// Reads all scenes in the folder `scenes/`.
pub fn scenes() -> Vec<Scene> {
    let paths = scene_paths().into_iter();
    paths.map(|path| Scene::read(path).unwrap()).collect()
}
