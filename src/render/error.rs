//! What can go wrong with a picture.

use crate::store;
use std::path::PathBuf;

/// A picture that cannot be drawn. Every message is complete; there is no chain of sources to print.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The map does not have what is to be drawn.
    #[error(transparent)]
    Map(#[from] store::Error),
    /// The picture cannot be written.
    #[error("cannot write {}: {cause}", path.display())]
    Write {
        /// The picture.
        path: PathBuf,
        /// What the system said.
        cause: std::io::Error,
    },
    /// The built-in font cannot be used.
    #[error("cannot draw the text {text:?}: {cause}")]
    Font {
        /// The text.
        text: String,
        /// What the drawing library said.
        cause: String,
    },
}
