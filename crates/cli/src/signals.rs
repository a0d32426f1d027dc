//! Interrupts: remove unfinished files, print one line, exit with 128 + the signal's number, or with the code of Windows.

use super::failure::message;
use std::io::{self, IsTerminal};
#[cfg(unix)]
use std::sync::Arc;
use whiskmap::store::TemporaryFiles;

/// Ends the process on a signal whose default action ends it without a core dump, removes the `temporary` files, and prints `advice`. A signal that is
/// ignored, for example by `nohup`, stays ignored. Beyond the limit of the size of files, a write fails, and no signal ends the process.
///
/// # Errors
/// If the thread that waits for signals cannot be started.
#[cfg(unix)]
pub fn handle(temporary: TemporaryFiles, advice: &'static str) -> io::Result<()> {
    use signal_hook::consts::{
        SIGALRM, SIGHUP, SIGINT, SIGPROF, SIGTERM, SIGUSR1, SIGUSR2, SIGVTALRM,
    };
    use signal_hook::{flag, iterator::Signals, low_level};

    let all = [SIGHUP, SIGINT, SIGTERM, SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF];
    let handled = all.into_iter().chain([libc::SIGXCPU]).filter(|signal| !is_ignored(*signal));
    if !is_ignored(libc::SIGXFSZ) {
        flag::register(libc::SIGXFSZ, Arc::default())?;
    }
    // Without handlers, the default action ends the process, and the next run removes its leftovers.
    let Ok(mut signals) = Signals::new(handled) else {
        return Ok(());
    };
    let wait = move || {
        let Some(signal) = signals.forever().next() else {
            return;
        };
        let name = low_level::signal_name(signal).unwrap_or("a signal");
        clean_up(&temporary, name, advice);
        low_level::exit(128 + signal);
    };
    std::thread::Builder::new().spawn(wait).map(drop)
}

/// Ends the process on Ctrl-C, Ctrl-Break or when its console is closed, removes the `temporary` files, and prints `advice`. The exit code
/// is the same as without a handler.
#[cfg(windows)]
pub fn handle(temporary: TemporaryFiles, advice: &'static str) -> io::Result<()> {
    const STATUS_CONTROL_C_EXIT: u32 = 0xC000_013A;
    // Without the handler, the system ends the process, and the next run removes its leftovers.
    let _ = ctrlc::set_handler(move || {
        clean_up(&temporary, "Ctrl-C", advice);
        std::process::exit(STATUS_CONTROL_C_EXIT.cast_signed());
    });
    Ok(())
}

/// Removes the unfinished files of a process that `what` ends, and prints `advice`.
fn clean_up(temporary: &TemporaryFiles, what: &str, advice: &str) {
    temporary.abandon();
    // The current line of a terminal may be a progress bar.
    if io::stderr().is_terminal() {
        message("");
    }
    message(&format!("error: interrupted by {what}; unfinished files are removed{advice}"));
}

#[cfg(unix)]
#[allow(unsafe_code, reason = "no library returns the present action of a signal")]
fn is_ignored(signal: i32) -> bool {
    // SAFETY: zeros are a valid `sigaction`, and with no new action the call only writes the present one into it.
    unsafe {
        let mut present: libc::sigaction = std::mem::zeroed();
        libc::sigaction(signal, std::ptr::null(), &raw mut present) == 0
            && present.sa_sigaction == libc::SIG_IGN
    }
}
