//! Whether a disk has room for what will be written.

use super::estimate::{Format, files};
use super::failure::Failure;
use indicatif::DecimalBytes;
use std::path::Path;
use whiskmap::plan::Plan;
use whiskmap::scene::Scene;

/// Bytes of a channel of a cell that is not packed.
const SAMPLE_BYTES: u64 = 4;

/// Refuses to write so many `cells` of a map below `folder` where the disk cannot hold them. Only if it could not hold
/// them unpacked is a sample computed and packed.
pub fn check(
    folder: &Path,
    format: Format,
    scene: &Scene,
    plan: &Plan,
    cells: usize,
) -> Result<(), Failure> {
    let Some(free) = free(folder) else {
        return Ok(());
    };
    let channels = plan.channels.names().count() as u64;
    if cells as u64 * channels * SAMPLE_BYTES <= free {
        return Ok(());
    }
    let share = cells as f64 / plan.cells as f64;
    let files = files(scene, plan, &[format])?;
    let bytes: f64 = files.iter().map(|files| files.bytes).sum();
    let needed = (share * bytes) as u64;
    refused(folder, needed, free).map_or(Ok(()), |message| Err(Failure::Input(message)))
}

/// Why a folder cannot take so many bytes, if it cannot.
fn refused(folder: &Path, needed: u64, free: u64) -> Option<String> {
    (needed > free).then(|| {
        format!(
            "--output {}: the map needs about {}, {} are free; give a folder with more room, or --force",
            folder.display(),
            DecimalBytes(needed),
            DecimalBytes(free)
        )
    })
}

/// Bytes that are left below `folder` for this user, where the system tells.
#[cfg(unix)]
fn free(folder: &Path) -> Option<u64> {
    let disk = rustix::fs::statvfs(folder).ok()?;
    disk.f_bavail.checked_mul(disk.f_frsize)
}

#[cfg(not(unix))]
fn free(_: &Path) -> Option<u64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_disk_is_refused_with_what_it_lacks() {
        let refused = |needed| refused(Path::new("maps"), needed, 1_500_000_000);
        assert_eq!(refused(1_500_000_000), None);
        assert_eq!(
            refused(2_250_000_000).as_deref(),
            Some(
                "--output maps: the map needs about 2.25 GB, 1.50 GB are free; give a folder with more room, or --force"
            )
        );
    }
}
