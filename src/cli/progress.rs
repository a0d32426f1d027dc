//! Progress on standard error, on a terminal only.

use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use std::fmt::Write;

/// A bar over `cells` with rate and time left; hidden when standard error is not a terminal.
pub fn bar(cells: u64) -> ProgressBar {
    let rate = |state: &ProgressState, out: &mut dyn Write| {
        let _ = write!(out, "{:.0}", state.per_sec());
    };
    let template = "{wide_bar} {percent:>3} %, {rate} cells/s, {eta} left";
    let style = ProgressStyle::with_template(template);
    let bar = ProgressBar::new(cells);
    match style {
        Ok(style) => bar.with_style(style.with_key("rate", rate)),
        Err(_) => bar,
    }
}
