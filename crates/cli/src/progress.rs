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
    pub fn over(count: usize, things: &'static str) -> Self {
        Self {
            bar: bar(count, things),
            lines: Mutex::new(ProgressLines::over(count as u64, things)),
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

/// Creates a bar with rate and time left; it is hidden if standard error is not a terminal.
fn bar(count: usize, things: &str) -> ProgressBar {
    let rate = |state: &ProgressState, out: &mut dyn Write| {
        let _ = write!(out, "{:.0}", state.per_sec());
    };
    let template = format!("{{wide_bar}} {{percent:>3}} %, {{rate}} {things}/s, {{eta}} left");
    let style = ProgressStyle::with_template(&template);
    let bar = ProgressBar::new(count as u64);
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
    count: u64,
    things: &'static str,
    /// Time of the next line, since the start.
    next: Duration,
}

impl ProgressLines {
    const fn over(count: u64, things: &'static str) -> Self {
        Self { count, things, next: INTERVAL }
    }

    /// Returns the line that is due at `time` since the start, if any, when `done` are done.
    fn due(&mut self, done: u64, time: Duration) -> Option<String> {
        if time < self.next || done == 0 {
            return None;
        }
        self.next = time + INTERVAL;
        let rate = done as f64 / time.as_secs_f64();
        let left = Duration::try_from_secs_f64((self.count - done) as f64 / rate);
        Some(format!(
            "{:.0} % of {} {things}, {rate:.0} {things}/s, {} left",
            100.0 * done as f64 / self.count as f64,
            self.count,
            HumanDuration(left.unwrap_or(Duration::MAX)),
            things = self.things,
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_appears_every_half_minute() {
        let mut lines = ProgressLines::over(1000, "cells");
        let mut due = |done, seconds| lines.due(done, Duration::from_secs(seconds));
        assert_eq!(due(10, 29), None);
        assert_eq!(due(0, 30), None);
        let line = "10 % of 1000 cells, 2 cells/s, 7 minutes left";
        assert_eq!(due(100, 45).as_deref(), Some(line));
        assert_eq!(due(200, 74), None);
        let line = "75 % of 1000 cells, 10 cells/s, 25 seconds left";
        assert_eq!(due(750, 75).as_deref(), Some(line));
    }
}
