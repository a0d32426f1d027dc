//! The picture of a stored map: the regimes, or any channel.

mod boundary;
mod cells;
mod histogram;
mod options;
mod panel;
mod scale;
mod shading;
mod sheet;

pub use options::MapOptions;

use super::error::Error;
use super::picture::Picture;
use crate::store::Slice;
use shading::Shading;
use sheet::Sheet;

/// Draws a map: codes with a legend, quantities with a colour bar. A map of several whiskers becomes a contact sheet.
///
/// # Errors
///
/// More than two sweep axes are left, there is no such channel, it does not have the wanted colour scale, or the map is
/// damaged.
pub fn map(map: &Slice, options: &MapOptions<'_>) -> Result<Picture, Error> {
    if map.grid().sweep.len() > 2 {
        let axes = map.grid().sweep.iter().map(|axis| axis.parameter.axis());
        return Err(Error::TooManyAxes(axes.collect::<Vec<_>>().join(", ")));
    }
    let channel = options.channel.unwrap_or("regime");
    let shading = Shading::of(map, channel, options)?;
    Sheet::of(map).draw(map, channel, &shading, options.width)
}
