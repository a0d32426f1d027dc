//! The program `whiskmap`: see `whiskmap --help`.

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    quiet_wayland();
    ExitCode::from(whiskmap_cli::main(std::env::args_os()))
}

/// Sets `XDG_RUNTIME_DIR` to `/` unless it is an absolute path. This is the only environment variable that the program sets.
///
/// Vulkan drivers open a Wayland display, and its library prints an error without an absolute path. Only an administrator can
/// create sockets in `/`, so no display is found there.
#[allow(unsafe_code, reason = "the environment is changed before any thread is started")]
fn quiet_wayland() {
    const FOLDER: &str = "XDG_RUNTIME_DIR";
    if std::env::var_os(FOLDER).is_none_or(|folder| !Path::new(&folder).is_absolute()) {
        // SAFETY: this is the only thread, so that none reads the environment at the same time.
        unsafe { std::env::set_var(FOLDER, "/") };
    }
}
