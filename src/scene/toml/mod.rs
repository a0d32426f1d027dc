//! TOML as a front of scenes: text to a description, a description to text, and edited text.

mod read;
mod rows;
mod tables;
mod write;

pub use write::SceneText;
