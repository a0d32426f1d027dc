//! Interrupts: unfinished files are removed, one line says so, and the exit code is 128 and the signal's number.

use std::sync::OnceLock;
use whiskmap::store::TemporaryFiles;

/// What an interrupted command says at last.
static ADVICE: OnceLock<&str> = OnceLock::new();

/// From now on an interrupt ends with this `advice`.
pub fn advise(advice: &'static str) {
    let _ = ADVICE.set(advice);
}

/// From now on SIGHUP, SIGINT and SIGTERM end the process at once, whatever its threads do. One that is ignored, as `nohup`
/// has it, stays so.
#[cfg(unix)]
pub fn handle(temporary: TemporaryFiles) {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::{iterator::Signals, low_level};
    use std::io::IsTerminal;

    let handled = [SIGHUP, SIGINT, SIGTERM]
        .into_iter()
        .filter(|signal| !is_ignored(*signal));
    // Without handlers the system's own end the process, and the next run finds what it leaves.
    let Ok(mut signals) = Signals::new(handled) else {
        return;
    };
    std::thread::spawn(move || {
        let Some(signal) = signals.forever().next() else {
            return;
        };
        temporary.abandon();
        // A terminal's line may hold a progress bar.
        let is_watched = std::io::stderr().is_terminal();
        let start = if is_watched { "\n" } else { "" };
        let name = low_level::signal_name(signal).unwrap_or("a signal");
        super::failure::say(&format!(
            "{start}error: interrupted by {name}; unfinished files are removed{}",
            ADVICE
                .get()
                .map_or_else(String::new, |advice| format!("; {advice}"))
        ));
        low_level::exit(128 + signal);
    });
}

/// Elsewhere the next run finds what an interrupted one leaves.
#[cfg(not(unix))]
pub fn handle(_: TemporaryFiles) {}

#[cfg(unix)]
#[allow(unsafe_code, reason = "no library tells how a signal is handled now")]
fn is_ignored(signal: i32) -> bool {
    // SAFETY: zeros are a valid `sigaction`, and with no new action the call only writes the present one into it.
    unsafe {
        let mut present: libc::sigaction = std::mem::zeroed();
        libc::sigaction(signal, std::ptr::null(), &raw mut present) == 0
            && present.sa_sigaction == libc::SIG_IGN
    }
}
