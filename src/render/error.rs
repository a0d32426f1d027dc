//! What can go wrong with a picture.

use crate::store;

/// A picture that cannot be drawn. Every message is complete; there is no chain of sources to print.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The map does not have what is to be drawn, or the picture cannot be written.
    #[error(transparent)]
    Store(#[from] store::Error),
    /// The wanted colour scale cannot be had; the text says why, and what is allowed.
    #[error("{0}")]
    Scale(String),
    /// A picture has room for two sweep axes; those that there are.
    #[error(
        "a picture has room for two sweep axes, there are {0}; choose a value of each other one by --at"
    )]
    TooManyAxes(String),
    /// The pixels cannot be encoded.
    #[error("cannot encode the picture as PNG: {0}")]
    Encode(#[from] png::EncodingError),
}
