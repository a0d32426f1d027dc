//! Files, read no farther than a scene, a table of radii or one of points may reach.

use std::io::{self, Read};

/// A scene is a page of text, radii are a short table; anything longer was picked by mistake.
const MOST_BYTES: u64 = 1 << 20;

/// All of a source that is no longer than a page or a table is.
pub(crate) fn bounded(source: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    source.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(io::Error::new(
            io::ErrorKind::FileTooLarge,
            "longer than 1 MiB",
        ));
    }
    Ok(bytes)
}
