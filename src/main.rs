//! The command `whiskmap`: see `whiskmap --help`.

mod cli;

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    quiet_wayland();
    cli::main()
}

/// Vulkan drivers ask for a Wayland display, and its library complains on standard error where this variable is not an
/// absolute path. In the folder `/` nobody but an administrator makes sockets, so none is found.
#[allow(
    unsafe_code,
    reason = "the environment is changed before there is a thread"
)]
fn quiet_wayland() {
    const FOLDER: &str = "XDG_RUNTIME_DIR";
    if std::env::var_os(FOLDER).is_none_or(|folder| !Path::new(&folder).is_absolute()) {
        // SAFETY: this is the only thread, so that none reads the environment at the same time.
        unsafe { std::env::set_var(FOLDER, "/") };
    }
}
