//! Names and values in messages: shortened, or beside the known name that resembles them.

/// The similarity from which on a name is suggested, as in clap.
const SIMILAR: f64 = 0.7;

/// The name among `known` that resembles `name` most, by Jaro's similarity of lower-case names; `None` where none does.
pub(crate) fn similar<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let name = name.to_lowercase();
    let known = known.into_iter();
    let scored = known.map(|other| (strsim::jaro(&name, &other.to_lowercase()), other));
    let scored = scored.filter(|(score, _)| *score > SIMILAR);
    let best = scored.max_by(|(one, _), (other, _)| one.total_cmp(other));
    best.map(|(_, other)| other)
}

/// The end of a message about an unknown `name`: a suggestion among the `known` names, or nothing.
///
/// ```
/// use whiskmap::input::did_you_mean;
///
/// let known = ["tip_radius_um", "base_radius_um"];
/// assert_eq!(did_you_mean("tip_radius", known), "; did you mean `tip_radius_um`?");
/// assert_eq!(did_you_mean("colour", known), "");
/// ```
#[must_use]
pub fn did_you_mean<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let found = similar(name, known);
    found.map_or_else(String::new, |known| format!("; did you mean `{known}`?"))
}

/// The most characters that a message quotes of a text, at its beginning and at its end.
const QUOTED: [usize; 2] = [60, 20];

/// A text that may quote a value or a key of any length, without its middle where it is long.
pub(crate) fn shortened(text: &str) -> String {
    let [head, tail] = QUOTED;
    let count = text.chars().count();
    if count <= head + tail {
        return text.to_owned();
    }
    let part = |from, length| text.chars().skip(from).take(length).collect::<String>();
    format!("{}...{}", part(0, head), part(count - tail, tail))
}
