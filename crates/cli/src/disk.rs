//! Check of free disk space before a map is written.

use super::estimate::files;
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
pub fn check(
    folder: &Path,
    format: MapFormat,
    scene: &Scene,
    plan: &Plan,
    cells: usize,
) -> Result<(), Failure> {
    let Some(free) = free(folder) else {
        return Ok(());
    };
    let channels = plan.channels.names().count() as u64;
    if cells as u64 * channels * VALUE_BYTES <= free {
        return Ok(());
    }
    let share = cells as f64 / plan.cells as f64;
    let files = files(scene, plan, &[format])?;
    let bytes: f64 = files.iter().map(|files| files.bytes).sum();
    let needed = (share * bytes) as u64;
    match lacking(needed, free) {
        None => Ok(()),
        Some(why) => Err(unwritten(folder)(io::Error::new(
            io::ErrorKind::StorageFull,
            why,
        ))),
    }
}

/// Returns the message for `needed` bytes, if fewer are `free`.
fn lacking(needed: u64, free: u64) -> Option<String> {
    (needed > free).then(|| {
        format!(
            "the map needs about {}, but {} are free; give a folder with more space, or --force",
            DecimalBytes(needed),
            DecimalBytes(free)
        )
    })
}

/// Free bytes for this user on the disk of `folder`; `None` if the system does not report them.
#[cfg(unix)]
fn free(folder: &Path) -> Option<u64> {
    let disk = rustix::fs::statvfs(folder).ok()?;
    disk.f_bavail.checked_mul(disk.f_frsize)
}

#[cfg(windows)]
#[allow(unsafe_code, reason = "only a call of the system returns the space")]
fn free(folder: &Path) -> Option<u64> {
    use std::os::windows::ffi::OsStrExt;
    #[link(name = "kernel32")]
    unsafe extern "system" {
        fn GetDiskFreeSpaceExW(
            folder: *const u16,
            for_user: *mut u64,
            disk: *mut u64,
            free: *mut u64,
        ) -> i32;
    }
    let name: Vec<u16> = folder.as_os_str().encode_wide().chain([0]).collect();
    let [mut for_user, mut disk, mut free] = [0; 3];
    // SAFETY: the name ends in 0, and each other pointer is to a number of 64 bits.
    let is_known = unsafe {
        GetDiskFreeSpaceExW(
            name.as_ptr(),
            &raw mut for_user,
            &raw mut disk,
            &raw mut free,
        )
    } != 0;
    is_known.then_some(for_user)
}

#[cfg(not(any(unix, windows)))]
fn free(_: &Path) -> Option<u64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_disk_is_refused_with_what_it_lacks() {
        let lacking = |needed| lacking(needed, 1_500_000_000);
        assert_eq!(lacking(1_500_000_000), None);
        assert_eq!(
            lacking(2_250_000_000).as_deref(),
            Some(
                "the map needs about 2.25 GB, but 1.50 GB are free; give a folder with more space, or --force"
            )
        );
    }
}
