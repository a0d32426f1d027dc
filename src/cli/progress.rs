//! Progress on standard error, on a terminal only.

use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use std::fmt::Write;

/// A bar over so many `things`, such as cells, with rate and time left; hidden when standard error is not a terminal.
pub fn bar(count: usize, things: &str) -> ProgressBar {
    let rate = |state: &ProgressState, out: &mut dyn Write| {
        let _ = write!(out, "{:.0}", state.per_sec());
    };
    let template = format!("{{wide_bar}} {{percent:>3}} %, {{rate}} {things}/s, {{eta}} left");
    let style = ProgressStyle::with_template(&template);
    let bar = ProgressBar::new(count as u64);
    match style {
        Ok(style) => bar.with_style(style.with_key("rate", rate)),
        Err(_) => bar,
    }
}
