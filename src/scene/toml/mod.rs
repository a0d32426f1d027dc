//! TOML files of scenes: reading, writing and editing of the text.

mod place;
mod read;
mod rows;
mod tables;
mod write;

pub use write::SceneText;
