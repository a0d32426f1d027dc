//! Texts in the space that they have: shrunk, wrapped between words, and at last cut.

use super::font::width;

/// Smallest font size of a text, in units of the picture. Subscripts are smaller.
pub const SMALLEST: f64 = 18.0;
/// Distance of the lines of a text, in font sizes.
const LEADING: f64 = 1.25;
/// The end of a text that is cut.
const ELLIPSIS: &str = "\u{2026}";

/// A text cut to its space, and its font size.
pub type FittedText = (String, f64);

/// Fits a text into one line of length `room`: shrinks the font from `largest` to no less than [`SMALLEST`], and cuts the text if that
/// does not suffice.
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
    width(text, size) <= room + 1.0
}

/// A text in lines.
#[derive(Clone, Debug, PartialEq)]
pub struct TextBlock {
    pub lines: Vec<String>,
    /// Font size of all lines.
    pub size: f64,
}

impl TextBlock {
    /// Sets a text into lines of length `room`: in one line, shrunk from `largest` if necessary, or in several of the smallest size. Words
    /// that are longer than a line are cut.
    pub fn new(text: &str, largest: f64, room: f64) -> Self {
        let size = shrunk(text, largest, room);
        if fits(text, size, room) {
            return Self {
                lines: vec![text.to_owned()],
                size,
            };
        }
        let mut lines: Vec<String> = Vec::new();
        for word in text.split(' ') {
            let longer = lines.last().map(|line| format!("{line} {word}"));
            match (lines.last_mut(), longer) {
                (Some(last), Some(longer)) if fits(&longer, size, room) => *last = longer,
                _ => lines.push(fitted(word, size, room).0),
            }
        }
        Self { lines, size }
    }

    /// Returns the distance from the first to the last line.
    pub fn below_first(&self) -> f64 {
        self.leading() * self.lines.len().saturating_sub(1) as f64
    }

    /// Returns the distance from one line to the next.
    pub fn leading(&self) -> f64 {
        LEADING * self.size
    }
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
    }

    #[test]
    fn a_long_text_is_wrapped_between_words_and_loses_none() {
        let text = "distance of the pole from the base at first touch (mm)";
        assert_eq!(TextBlock::new(text, 23.0, 900.0).lines, [text]);
        assert_eq!(TextBlock::new(text, 23.0, 900.0).size, 23.0);
        let block = TextBlock::new(text, 23.0, 260.0);
        assert_eq!(
            (block.lines.join(" "), block.size),
            (text.to_owned(), SMALLEST)
        );
        assert!(block.lines.len() > 1 && block.below_first() > SMALLEST);
        assert!(
            block
                .lines
                .iter()
                .all(|line| width(line, SMALLEST) <= 261.0)
        );
        assert_eq!(TextBlock::new("", 23.0, 260.0).lines, [""]);
    }
}
