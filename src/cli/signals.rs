//! Interrupts: remove unfinished files, print one line, exit with 128 + the signal's number.

use std::io;
use whiskmap::store::TemporaryFiles;

/// Ends the process on SIGHUP, SIGINT or SIGTERM, removes the `temporary` files, and prints `advice`. A signal that is ignored, for
/// example by `nohup`, stays ignored.
///
/// # Errors
/// If the thread that waits for signals cannot be started.
#[cfg(unix)]
pub fn handle(temporary: TemporaryFiles, advice: &'static str) -> io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::{iterator::Signals, low_level};
    use std::io::IsTerminal;

    let handled = [SIGHUP, SIGINT, SIGTERM]
        .into_iter()
        .filter(|signal| !is_ignored(*signal));
    // Without handlers, the default action ends the process, and the next run removes its leftovers.
    let Ok(mut signals) = Signals::new(handled) else {
        return Ok(());
    };
    let wait = move || {
        let Some(signal) = signals.forever().next() else {
            return;
        };
        temporary.abandon();
        // The current line of a terminal may be a progress bar.
        if std::io::stderr().is_terminal() {
            super::failure::message("");
        }
        let name = low_level::signal_name(signal).unwrap_or("a signal");
        super::failure::message(&format!(
            "error: interrupted by {name}; unfinished files are removed{advice}"
        ));
        low_level::exit(128 + signal);
    };
    std::thread::Builder::new().spawn(wait).map(drop)
}

/// Does nothing on systems without these signals: the next run removes the leftovers of an interrupted run.
#[cfg(not(unix))]
pub fn handle(_: TemporaryFiles, _: &'static str) -> io::Result<()> {
    Ok(())
}

#[cfg(unix)]
#[allow(
    unsafe_code,
    reason = "no library returns the present action of a signal"
)]
fn is_ignored(signal: i32) -> bool {
    // SAFETY: zeros are a valid `sigaction`, and with no new action the call only writes the present one into it.
    unsafe {
        let mut present: libc::sigaction = std::mem::zeroed();
        libc::sigaction(signal, std::ptr::null(), &raw mut present) == 0
            && present.sa_sigaction == libc::SIG_IGN
    }
}
