//! Texts in the space that they have: shrunk, wrapped between words, and at last cut.

use super::font::width;

/// Smallest font size of a text, in units of the picture. Subscripts are smaller.
pub const SMALLEST: f64 = 18.0;
/// Distance of the lines of a text, in font sizes.
const LEADING: f64 = 1.25;
/// The end of a text that is cut.
const ELLIPSIS: &str = "\u{2026}";

/// A text cut to its space, and its font size in units of the picture.
pub type FittedText = (String, f64);

/// Fits a text into one line of length `room`, in units of the picture. It shrinks the font from `largest` to no less than [`SMALLEST`], and cuts the
/// text if that does not suffice.
pub fn fitted(text: &str, largest: f64, room: f64) -> FittedText {
    let size = shrunk(text, largest, room);
    if fits(text, size, room) {
        return (text.to_owned(), size);
    }
    let mut kept = String::new();
    for c in text.chars() {
        kept.push(c);
        if !fits(&format!("{kept}{ELLIPSIS}"), size, room) {
            kept.pop();
            break;
        }
    }
    (kept + ELLIPSIS, size)
}

/// The font size with which a text fits into `room`, or the smallest.
fn shrunk(text: &str, largest: f64, room: f64) -> f64 {
    let part = room / width(text, largest).max(1.0);
    (largest * part).clamp(SMALLEST.min(largest), largest)
}

fn fits(text: &str, size: f64, room: f64) -> bool {
    text.is_empty() || width(text, size) <= room + 1.0
}

/// A text set into lines of one font size.
#[derive(Clone, Debug, PartialEq)]
pub struct TextBlock {
    pub lines: Vec<String>,
    /// Font size of all lines of a text, in units of the picture.
    pub size: f64,
}

impl TextBlock {
    /// Sets a text into lines of length `room`: in one line, shrunk from `largest` if necessary, or in several of the smallest size. A line
    /// does not end beside `=`, before a unit or between two words in parentheses, unless the name and its value are longer than a line. Words that are longer than a line are cut.
    pub fn new(text: &str, largest: f64, room: f64) -> Self {
        let size = shrunk(text, largest, room);
        if fits(text, size, room) {
            return Self { lines: vec![text.to_owned()], size };
        }
        let mut lines: Vec<String> = Vec::new();
        let words = kept_together(text).into_iter().flat_map(|words| {
            let is_line = fits(&words.join(" "), size, room);
            if is_line {
                vec![words.join(" ")]
            } else {
                words.into_iter().map(str::to_owned).collect()
            }
        });
        for word in words {
            let longer = lines.last().map(|line| format!("{line} {word}"));
            match (lines.last_mut(), longer) {
                (Some(last), Some(longer)) if fits(&longer, size, room) => *last = longer,
                _ => lines.push(fitted(&word, size, room).0),
            }
        }
        Self { lines, size }
    }

    /// Returns the distance from the first to the last line of the text, in units of the picture.
    pub fn below_first(&self) -> f64 {
        self.leading() * self.lines.len().saturating_sub(1) as f64
    }

    /// Returns the distance from one line of the text to the next, in units of the picture.
    pub fn leading(&self) -> f64 {
        LEADING * self.size
    }
}

/// Units before which no line ends.
const UNITS: [&str; 4] = ["mm", "deg", "%", "pt"];

/// Returns the words of a text in groups that stay in one line: name, `=` and value, and a number with its unit.
fn kept_together(text: &str) -> Vec<Vec<&str>> {
    let mut groups: Vec<Vec<&str>> = Vec::new();
    for word in text.split(' ') {
        let is_unit = UNITS.contains(&word.trim_end_matches([',', ';', ')', '.']));
        match groups.last_mut() {
            Some(last) if word == "=" || is_unit || last.last() == Some(&"=") => last.push(word),
            // A unit of two parts, such as (nN m).
            Some(last)
                if word.ends_with(')') && last.last().is_some_and(|word| word.starts_with('(')) =>
            {
                last.push(word);
            }
            _ => groups.push(vec![word]),
        }
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_text_is_cut_where_its_room_ends() {
        let (whole, size) = fitted("short", 20.0, 400.0);
        assert_eq!((&*whole, size), ("short", 20.0));
        for text in ["m".repeat(1000), "i".repeat(500), "\u{9b0d}".repeat(90)] {
            let (cut, size) = fitted(&text, 20.0, 400.0);
            let kept = cut.strip_suffix(ELLIPSIS).unwrap_or_default();
            assert!(size == SMALLEST && text.starts_with(kept), "{cut}");
            let one: String = text.chars().take(1).collect();
            let [cut, one] = [&*cut, &*one].map(|text| width(text, size));
            assert!(cut <= 401.0 && cut + one > 401.0, "{cut}");
        }
        assert_eq!(fitted("wide", 20.0, 1.0).0, ELLIPSIS);
        assert_eq!(fitted("", 20.0, -20.0).0, "");
    }

    #[test]
    fn a_unit_of_two_parts_stays_in_one_line() {
        let lines = TextBlock::new("bending moment at the base (nN m)", 20.0, 270.0).lines;
        assert_eq!(lines, ["bending moment at the base", "(nN m)"]);
    }

    #[test]
    fn a_long_text_is_wrapped_between_words_and_loses_none() {
        let text = "distance of the pole from the base at first touch (mm)";
        assert_eq!(TextBlock::new(text, 23.0, 900.0).lines, [text]);
        assert_eq!(TextBlock::new(text, 23.0, 900.0).size, 23.0);
        let block = TextBlock::new(text, 23.0, 260.0);
        assert_eq!((block.lines.join(" "), block.size), (text.to_owned(), SMALLEST));
        assert!(block.lines.len() > 1 && block.below_first() > SMALLEST);
        assert!(block.lines.iter().all(|line| width(line, SMALLEST) <= 261.0));
        assert_eq!(TextBlock::new("", 23.0, 260.0).lines, [""]);
    }

    #[test]
    fn a_name_and_its_value_stay_in_one_line() {
        let text = "Taper and curvature, taper = 0.99, curvature_per_mm = 0.02, touched at 15.66 mm, and more";
        for room in 200..600 {
            let lines = TextBlock::new(text, 23.0, f64::from(room)).lines;
            assert_eq!(lines.join(" "), text);
            let ends = ["taper", "=", "curvature_per_mm", "15.66"];
            let breaks = lines.iter().filter(|line| ends.iter().any(|end| line.ends_with(end)));
            assert_eq!(breaks.count(), usize::from(room < 242), "{room}: {lines:?}");
        }
    }
}
