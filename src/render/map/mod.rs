//! The picture of a stored map: the regimes, or any channel.

mod boundary;
mod cells;
mod options;
mod panel;
mod scale;
mod shading;
mod sheet;

pub use options::MapOptions;

use super::error::Error;
use super::picture::Picture;
use crate::store::StoredMap;
use shading::Shading;
use sheet::Sheet;

/// Draws a map: codes with a legend, quantities with a colour bar. A map of several whiskers becomes a contact sheet.
///
/// # Errors
///
/// There is no such channel, it does not have the wanted colour scale, or the map is damaged.
pub fn map(map: &StoredMap, options: &MapOptions<'_>) -> Result<Picture, Error> {
    let channel = options.channel.unwrap_or("regime");
    let shading = Shading::of(map, channel, options)?;
    Sheet::of(map).draw(map, channel, &shading, options.width)
}
