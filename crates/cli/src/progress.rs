//! Progress on standard error: a bar on a terminal, elsewhere a line every 30 seconds.

use super::failure::message;
use indicatif::{HumanDuration, ProgressBar, ProgressState, ProgressStyle};
use std::fmt::Write;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Progress of a count of things, such as cells, on standard error; any number of threads may advance it.
pub struct Progress {
    bar: ProgressBar,
    lines: Mutex<ProgressLines>,
    start: Instant,
}

impl Progress {
    /// Creates the progress of `count` things.
    pub fn over(count: usize, things: &'static str) -> Self {
        Self::new(Some(count as u64), things)
    }

    /// Creates the progress of a number of things that is not known before the end.
    pub fn counting(things: &'static str) -> Self {
        Self::new(None, things)
    }

    fn new(count: Option<u64>, things: &'static str) -> Self {
        Self {
            bar: bar(count, things),
            lines: Mutex::new(ProgressLines::new(count, things)),
            start: Instant::now(),
        }
    }

    pub fn inc(&self, more: usize) {
        self.bar.inc(more as u64);
        if self.bar.is_hidden() {
            let mut lines = self.lines.lock().unwrap_or_else(PoisonError::into_inner);
            let line = lines.due(self.bar.position(), self.start.elapsed());
            line.iter().for_each(|line| message(line));
        }
    }

    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// Creates a bar with rate and time left, or without a `count` a line with number and rate; it is hidden if standard error is not a terminal.
fn bar(count: Option<u64>, things: &str) -> ProgressBar {
    let rate = |state: &ProgressState, out: &mut dyn Write| {
        let _ = write!(out, "{:.0}", state.per_sec());
    };
    let (bar, template) = match count {
        Some(count) => (
            ProgressBar::new(count),
            format!("{{wide_bar}} {{percent:>3}} %, {{rate}} {things}/s, {{eta}} left"),
        ),
        None => (ProgressBar::no_length(), format!("{{pos}} {things}, {{rate}} {things}/s")),
    };
    let style = ProgressStyle::with_template(&template);
    let bar = match style {
        Ok(style) => bar.with_style(style.with_key("rate", rate)),
        Err(_) => bar,
    };
    bar.tick();
    bar
}

/// Time from one line to the next.
const INTERVAL: Duration = Duration::from_secs(30);

/// Progress lines for a standard error that is not a terminal.
struct ProgressLines {
    /// Number of all things; `None` if it is not known.
    count: Option<u64>,
    things: &'static str,
    /// Time of the next line, since the start.
    next: Duration,
}

impl ProgressLines {
    const fn new(count: Option<u64>, things: &'static str) -> Self {
        Self { count, things, next: INTERVAL }
    }

    /// Returns the line that is due at `time` since the start, if any, when `done` are done.
    fn due(&mut self, done: u64, time: Duration) -> Option<String> {
        if time < self.next || done == 0 {
            return None;
        }
        self.next = time + INTERVAL;
        let rate = done as f64 / time.as_secs_f64();
        let things = self.things;
        let Some(count) = self.count else {
            return Some(format!("{done} {things}, {rate:.0} {things}/s"));
        };
        let left = Duration::try_from_secs_f64((count - done) as f64 / rate);
        Some(format!(
            "{:.0} % of {count} {things}, {rate:.0} {things}/s, {} left",
            100.0 * done as f64 / count as f64,
            HumanDuration(left.unwrap_or(Duration::MAX)),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_appears_every_half_minute() {
        let mut lines = ProgressLines::new(Some(1000), "cells");
        let mut due = |done, seconds| lines.due(done, Duration::from_secs(seconds));
        assert_eq!(due(10, 29), None);
        assert_eq!(due(0, 30), None);
        let line = "10 % of 1000 cells, 2 cells/s, 7 minutes left";
        assert_eq!(due(100, 45).as_deref(), Some(line));
        assert_eq!(due(200, 74), None);
        let line = "75 % of 1000 cells, 10 cells/s, 25 seconds left";
        assert_eq!(due(750, 75).as_deref(), Some(line));
    }

    #[test]
    fn a_count_without_an_end_has_number_and_rate() {
        let mut lines = ProgressLines::new(None, "pushes");
        let line = lines.due(240, Duration::from_secs(30));
        assert_eq!(line.as_deref(), Some("240 pushes, 8 pushes/s"));
    }
}
