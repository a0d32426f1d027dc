//! Detects a standard output that was closed when the process began. Before `main`, Rust's runtime opens `/dev/null` in its
//! place, and every write to that succeeds.

use std::io;

/// Checks that standard output was open when the process began.
///
/// # Errors
///
/// It was closed, so nothing that a command prints would be read.
#[cfg(unix)]
pub fn check() -> io::Result<()> {
    if WAS_CLOSED.load(Ordering::Relaxed) {
        return Err(io::Error::from_raw_os_error(libc::EBADF));
    }
    Ok(())
}

/// Elsewhere a closed standard output is not noticed.
#[cfg(not(unix))]
pub fn check() -> io::Result<()> {
    Ok(())
}

#[cfg(unix)]
use std::sync::atomic::{AtomicBool, Ordering};

#[cfg(unix)]
static WAS_CLOSED: AtomicBool = AtomicBool::new(false);

/// The system calls this function before Rust's runtime begins.
#[cfg(unix)]
#[allow(
    unsafe_code,
    reason = "only a constructor runs before Rust's runtime, and no safe function looks at a descriptor that may be closed"
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
