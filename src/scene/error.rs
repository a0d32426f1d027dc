//! Errors of scenes: what is wrong, where, which value, and what is allowed.

use std::ops::Range;

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use thiserror::Error;

use crate::input::{did_you_mean, shortened};
use crate::terminal::{escaped, escaped_but};

/// Error of a scene that cannot be read or is refused.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{}", self.render(false))]
pub struct SceneError {
    origin: String,
    text: String,
    span: Option<Range<usize>>,
    message: String,
    fault: Option<Box<SceneFault>>,
}

impl SceneError {
    /// Creates an error about a part of a scene's text.
    pub(super) fn at(
        origin: &str,
        text: &str,
        span: Option<Range<usize>>,
        message: impl Into<String>,
    ) -> Self {
        Self {
            origin: origin.to_owned(),
            text: text.to_owned(),
            span: span.and_then(|span| within_a_line(text, span)),
            message: message.into(),
            fault: None,
        }
    }

    /// Creates an error from one of the TOML reader, in the terms of TOML rather than of Rust. `places_of` returns the places in a scene file of a name.
    pub(super) fn of_toml(
        origin: &str,
        text: &str,
        why: &toml_edit::de::Error,
        places_of: fn(&str) -> Vec<String>,
    ) -> Self {
        let message = match why.message().rsplit_once(", expected ") {
            Some((found, expected)) => {
                let found = match found {
                    "invalid type: sequence" => "invalid type: a list".to_owned(),
                    "invalid type: map" => "invalid type: a table or a date".to_owned(),
                    _ => shortened(found),
                };
                let expected = match expected {
                    "f64" => "a number",
                    "i64" => "a whole number",
                    kind if kind == "a map" || kind.starts_with("struct ") => "a table",
                    _ => expected,
                };
                let hint = suggestion(&found, expected, places_of);
                format!("{found}, expected {expected}{hint}")
            }
            None => shortened(why.message()),
        };
        let hint = match why.span() {
            Some(span) if why.message().starts_with("invalid length") => {
                has_tight_comma(&text[span]).then(|| DECIMAL_POINTS.to_owned())
            }
            Some(span) if !why.message().starts_with("unknown field") => {
                let number = decimal_comma(text, span.start);
                number.map(|number| format!("; write a decimal point, not a comma: {number}"))
            }
            _ => None,
        };
        Self::at(origin, text, why.span(), message + &hint.unwrap_or_default())
    }

    /// Creates an error about a refused value of a scene: `key = value: must ...`.
    pub(super) fn of_fault(origin: &str, text: &str, fault: SceneFault) -> Self {
        let SceneFault { key, value, must } = &fault;
        let message = match value {
            Some(value) => format!("{key} = {value}: {must}"),
            None => format!("{key}: {must}"),
        };
        Self { fault: Some(Box::new(fault)), ..Self::at(origin, text, None, message) }
    }

    /// Returns the key of the refused value in a scene file, such as `whisker.length_mm`; `None` if the text is no scene.
    #[must_use]
    pub fn key(&self) -> Option<&str> {
        self.fault.as_ref().map(|fault| &*fault.key)
    }

    /// Returns the refused value as text; `None` if it is missing or too long for a sentence, or the text is no scene.
    #[must_use]
    pub fn value(&self) -> Option<&str> {
        self.fault.as_ref()?.value.as_deref()
    }

    /// Returns what is wrong with the value, and what is allowed; `None` if the text is no scene.
    #[must_use]
    pub fn allowed(&self) -> Option<&str> {
        self.fault.as_ref().map(|fault| &*fault.must)
    }

    /// Returns the error with a range of bytes in the scene's text.
    pub(super) fn with_span(mut self, span: Option<Range<usize>>) -> Self {
        self.span = span.and_then(|span| within_a_line(&self.text, span));
        self
    }

    /// Creates an error about a scene file as a whole.
    pub(super) fn whole(origin: &str, message: impl Into<String>) -> Self {
        Self::at(origin, "", None, message)
    }

    /// Returns the message of the error over several lines: what is wrong, then file, line and column, and the line itself with a mark.
    /// It begins with `error: `; colours are ANSI escapes, and control characters are escaped.
    #[must_use]
    pub fn render(&self, color: bool) -> String {
        let renderer = if color { Renderer::styled() } else { Renderer::plain() };
        let [origin, message] = [&self.origin, &self.message].map(|text| escaped(text));
        let Some(span) = &self.span else {
            let message = match origin.as_str() {
                "" => message,
                origin => format!("{origin}: {message}"),
            };
            let title = Level::ERROR.primary_title(message);
            return renderer.render(&[Group::with_title(title)]);
        };
        // The renderer itself has signs for the control characters of ASCII.
        let shown = |text: &str| escaped_but(text, |c| c.is_ascii());
        let start = shown(&self.text[..span.start]).len();
        let end = start + shown(&self.text[span.clone()]).len();
        let snippet = Snippet::source(shown(&self.text))
            .path(origin)
            .annotation(AnnotationKind::Primary.span(start..end));
        let title = Level::ERROR.primary_title(message);
        renderer.render(&[title.element(snippet)])
    }
}

/// The end of a message about an unknown field: the places of a scene that have its name, or else the key among those expected that resembles it, if
/// one does.
fn suggestion(found: &str, expected: &str, places_of: fn(&str) -> Vec<String>) -> String {
    // TOML quotes every key in backticks.
    let keys = |text: &'_ str| text.split('`').skip(1).step_by(2).map(str::to_owned).collect();
    let (found, expected): (Vec<String>, Vec<String>) = (keys(found), keys(expected));
    let found = found.first().map_or("", String::as_str);
    let places: Vec<String> =
        places_of(found).into_iter().map(|place| format!("`{place}`")).collect();
    if let Some((last, others)) = places.split_last() {
        let others = others.join(", ");
        let or = if others.is_empty() { "" } else { " or " };
        return format!("; did you mean {others}{or}{last}?");
    }
    did_you_mean(found, expected.iter().map(String::as_str))
}

/// End of a message about a list of numbers that seem to have decimal commas.
pub(super) const DECIMAL_POINTS: &str = "; numbers have decimal points, and commas separate values";

/// Returns true if a comma stands between two digits of a text.
pub(super) fn has_tight_comma(text: &str) -> bool {
    let digit = |byte: &u8| byte.is_ascii_digit();
    let mut windows = text.as_bytes().windows(3);
    windows.any(|three| three[1] == b',' && digit(&three[0]) && digit(&three[2]))
}

/// The number with a decimal comma that a line of `text` gives a key, with a point; `place` is anywhere in the line. In
/// quotes, nothing else stands.
fn decimal_comma(text: &str, place: usize) -> Option<String> {
    let start = text.get(..place)?.rfind('\n').map_or(0, |end| end + 1);
    let line = text[start..].lines().next()?;
    line.split('=').skip(1).find_map(|value| {
        let value = value.trim_start();
        let number = if let Some(quote) = value.chars().next().filter(|c| "\"'".contains(*c)) {
            value[1..].split_once(quote)?.0
        } else {
            let is_other = |c: char| !(c.is_ascii_digit() || "+-.,eE".contains(c));
            value.split(is_other).next()?.trim_end_matches(',')
        };
        let with_point = number.replacen(',', ".", 1);
        let is_number = number.contains(',') && with_point.parse::<f64>().is_ok();
        is_number.then_some(with_point)
    })
}

/// The part of a span on its first line: a mark under a whole table would bury the message.
fn within_a_line(text: &str, span: Range<usize>) -> Option<Range<usize>> {
    let line = text.get(span.clone())?.lines().next().unwrap_or_default();
    Some(span.start..span.start + line.len())
}

/// Fault of a scene: a value that the checks refuse, without the file's name and text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct SceneFault {
    /// Key of the refused value in a scene file.
    pub key: String,
    /// Text of the refused value; `None` if it is missing or too long for a sentence.
    pub value: Option<String>,
    /// Message of the fault: what is wrong, and what is allowed.
    pub must: String,
}

impl SceneFault {
    /// Creates a fault of a key whose value is missing, or too long for a sentence.
    pub fn new(key: impl Into<String>, must: impl Into<String>) -> Self {
        Self { key: key.into(), value: None, must: must.into() }
    }

    /// Creates a fault of a value that is not allowed.
    pub fn of_value(key: impl Into<String>, value: String, must: impl Into<String>) -> Self {
        Self { value: Some(value), ..Self::new(key, must) }
    }
}

#[cfg(test)]
mod tests {
    use super::suggestion;
    use serde::de::value::Error;

    /// The keys are read from the text of serde.
    #[test]
    fn messages_of_serde_have_keys_in_backticks() {
        let lists: [&'static [&str]; 3] =
            [&["length_mm"], &["length_mm", "title"], &["title", "length_mm", "grid"]];
        for known in lists {
            let why: Error = serde::de::Error::unknown_field("lenght_mm", known);
            let why = why.to_string();
            let (found, expected) = why.rsplit_once(", expected ").unwrap_or_default();
            let hint = suggestion(found, expected, |_| Vec::new());
            assert_eq!(hint, "; did you mean `length_mm`?", "{why}");
        }
    }
}
