//! Check of free disk space before a map is written.

use super::estimate::file_costs;
use super::failure::Failure;
use super::files::unwritten;
use super::map_format::MapFormat;
use indicatif::DecimalBytes;
use std::io;
use std::path::Path;
use whiskmap::plan::Plan;
use whiskmap::scene::Scene;

/// Bytes of one value that is not packed.
const VALUE_BYTES: u64 = 4;

/// Returns an error if the disk of `folder` has too little space for `cells` of a map. Their size is estimated from a packed
/// sample, which is only computed if the unpacked cells would not fit.
pub fn check(folder: &Path, format: MapFormat, scene: &Scene, plan: &Plan) -> Result<(), Failure> {
    // Without a number of the system, nothing is checked.
    let Ok(free) = fs4::available_space(folder) else {
        return Ok(());
    };
    let cells = plan.cells_of_parts();
    let channels = plan.channels.names().count() as u64;
    if cells as u64 * channels * VALUE_BYTES <= free {
        return Ok(());
    }
    let share = cells as f64 / plan.cells as f64;
    let files = file_costs(scene, plan, &[format])?;
    let bytes: f64 = files.iter().map(|files| files.bytes).sum();
    let needed = (share * bytes) as u64;
    if needed <= free {
        return Ok(());
    }
    let why = format!(
        "the map needs about {}, but {} are free; give a folder with more space, or --force",
        DecimalBytes(needed),
        DecimalBytes(free)
    );
    let full = io::Error::new(io::ErrorKind::StorageFull, why);
    Err(unwritten(folder)(full))
}
