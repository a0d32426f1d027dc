//! Progress on standard error, on a terminal only.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;

/// A bar over `cells` with rate and time left; hidden when standard error is not a terminal.
pub fn bar(cells: u64) -> ProgressBar {
    let target = if std::io::stderr().is_terminal() {
        ProgressDrawTarget::stderr()
    } else {
        ProgressDrawTarget::hidden()
    };
    let bar = ProgressBar::with_draw_target(Some(cells), target);
    if let Ok(style) =
        ProgressStyle::with_template("{wide_bar} {percent:>3} % {per_sec:.0} cells, {eta} left")
    {
        bar.set_style(style);
    }
    bar
}
