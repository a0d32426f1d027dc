//! Text from outside on a terminal: control characters are escaped, so that the terminal does not obey them.
//!
//! Messages are escaped always ([`escaped`]), results only on a terminal ([`StandardOutput`]): a pipe gets them as they are.

use std::io::{self, IsTerminal, Write};

/// Returns true for a character that changes how a terminal shows other ones: a control character of C0 or C1, or a mark, an
/// embedding, an override or an isolate of bidirectional text.
fn is_control(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Returns a text as one line for a message: a control character is shown as in Rust, such as `\n` or `\u{1b}`.
///
/// ```
/// use whiskmap::terminal::escaped;
///
/// assert_eq!(escaped("a\u{1b}[31mb\n\u{9b}\u{202e}"), r"a\u{1b}[31mb\n\u{9b}\u{202e}");
/// ```
#[must_use]
pub fn escaped(text: &str) -> String {
    escaped_but(text, |_| false)
}

/// Returns a text of several lines for a terminal: [`escaped`], but for line breaks and tabs.
fn escaped_lines(text: &str) -> String {
    escaped_but(text, |c| matches!(c, '\n' | '\t'))
}

/// Returns a text with all control characters escaped that are not `kept`.
pub(crate) fn escaped_but(text: &str, kept: impl Fn(char) -> bool) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        if is_control(c) && !kept(c) {
            shown.extend(c.escape_default());
        } else {
            shown.push(c);
        }
    }
    shown
}

/// Standard output for results. On a terminal, control characters other than line breaks and tabs are escaped.
#[derive(Debug)]
pub struct StandardOutput {
    /// First bytes of a character whose last ones are not written yet; `None` where the output is no terminal.
    unfinished: Option<Vec<u8>>,
}

impl StandardOutput {
    /// Opens standard output for results.
    #[must_use]
    pub fn open() -> Self {
        Self { unfinished: io::stdout().is_terminal().then(Vec::new) }
    }
}

impl Write for StandardOutput {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let Some(text) = &mut self.unfinished else {
            return io::stdout().write(bytes);
        };
        text.extend_from_slice(bytes);
        io::stdout().write_all(shown(text).as_bytes())?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        io::stdout().flush()
    }
}

/// Removes all whole characters from `text` and returns them for a terminal.
fn shown(text: &mut Vec<u8>) -> String {
    let whole = match str::from_utf8(text) {
        Err(why) if why.error_len().is_none() => why.valid_up_to(),
        _ => text.len(),
    };
    let rest = text.split_off(whole);
    let shown = escaped_lines(&String::from_utf8_lossy(text));
    *text = rest;
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn characters_in_pieces_are_escaped_as_a_whole() {
        let text = "a\u{9b}31m\u{202e}b\r\n\tc \u{b5}";
        let expected = "a\\u{9b}31m\\u{202e}b\\r\n\tc \u{b5}";
        for size in 1..text.len() {
            let mut unfinished = Vec::new();
            let pieces = text.as_bytes().chunks(size).map(|piece| {
                unfinished.extend_from_slice(piece);
                shown(&mut unfinished)
            });
            assert_eq!(pieces.collect::<String>(), expected, "{size}");
        }
        assert_eq!(shown(&mut b"a\xffb\xe2".to_vec()), "a\u{fffd}b\u{fffd}");
    }
}
