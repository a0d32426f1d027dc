//! Detection of a standard output that was closed when the process began.
//!
//! Before `main`, Rust's runtime opens `/dev/null` in its place, and every write to that succeeds. Only a constructor runs
//! earlier, and a constructor has no arguments, so its finding is in a static.

use std::io;

/// Returns an error if standard output was closed when the process began.
#[cfg(unix)]
pub fn check() -> io::Result<()> {
    if WAS_CLOSED.load(Ordering::Relaxed) {
        return Err(io::Error::from_raw_os_error(libc::EBADF));
    }
    Ok(())
}

/// Returns no error on other systems, which cannot detect a closed standard output.
#[cfg(not(unix))]
pub fn check() -> io::Result<()> {
    Ok(())
}

#[cfg(unix)]
use std::sync::atomic::{AtomicBool, Ordering};

/// Written once by the constructor, read by [`check`] alone.
#[cfg(unix)]
static WAS_CLOSED: AtomicBool = AtomicBool::new(false);

/// Constructor that the system calls before Rust's runtime starts.
#[cfg(unix)]
#[allow(
    unsafe_code,
    reason = "only a constructor runs before Rust's runtime, and no safe function reads a descriptor that may be closed"
)]
#[used]
// SAFETY: this section holds pointers to functions without arguments, and this is one that needs no runtime.
#[cfg_attr(not(target_vendor = "apple"), unsafe(link_section = ".init_array"))]
#[cfg_attr(
    target_vendor = "apple",
    unsafe(link_section = "__DATA,__mod_init_func,mod_init_funcs")
)]
static LOOK: extern "C" fn() = {
    extern "C" fn look() {
        // SAFETY: the call only reads the flags of a descriptor, which may be closed.
        let flags = unsafe { libc::fcntl(libc::STDOUT_FILENO, libc::F_GETFD) };
        WAS_CLOSED.store(flags == -1, Ordering::Relaxed);
    }
    look
};
