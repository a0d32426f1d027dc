//! Responses to requests of the page.

use serde_json::Value;

/// Largest number of points of a branch or a curve, and of cells of a map along one axis.
pub const MOST: usize = 1024;

/// Response to a request.
pub struct Response {
    /// Result or error, as JSON.
    pub text: Value,
    /// Numbers of a map, `[array][distance][push_angle]`, or of shapes, `[sample][point][x, y]`; empty for other tasks.
    pub numbers: Vec<f32>,
}

impl From<Value> for Response {
    fn from(text: Value) -> Self {
        Self { text, numbers: Vec::new() }
    }
}
