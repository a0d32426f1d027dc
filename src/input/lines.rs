//! The lines of a CSV file, split into cells.

use csv::{ReaderBuilder, StringRecord};

/// Line of a CSV file: its cells, and its number from 1.
#[derive(Clone, Debug)]
pub(crate) struct CsvLine {
    pub number: usize,
    pub cells: StringRecord,
}

/// Separators of columns. The first two are preferred, because decimal commas may stand between them.
const SEPARATORS: [char; 3] = [';', '\t', ','];

/// Returns the text of a CSV file with one kind of line end, and without the byte order mark.
pub(super) fn normalised(text: &str) -> String {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    text.replace("\r\n", "\n").replace('\r', "\n")
}

/// The separator that the first line of `text` declares, as spreadsheet programs do with `sep=;`.
fn declared(text: &str) -> Option<char> {
    let line = text.lines().next()?.to_lowercase();
    let separator = line.trim_end_matches(' ').strip_prefix("sep=")?;
    SEPARATORS.into_iter().find(|known| separator.trim_start_matches(' ') == known.to_string())
}

/// Returns the separator of the columns of a CSV text: the declared one, or the most frequent one of its header, outside of quotes. If the
/// header has no letters, the function returns the first of [`SEPARATORS`] in the header.
pub(super) fn separator(text: &str) -> char {
    if let Some(separator) = declared(text) {
        return separator;
    }
    let is_header = |line: &&str| !line.trim().is_empty() && !line.trim_start().starts_with('#');
    let header = text.lines().find(is_header).unwrap_or_default();
    // A line of numbers, without a header, may have decimal commas.
    if !header.contains(char::is_alphabetic)
        && let Some(first) = SEPARATORS.into_iter().find(|known| header.contains(*known))
    {
        return first;
    }
    let count = |separator: &char| -> usize {
        let unquoted = header.split('"').step_by(2);
        unquoted.map(|part| part.matches(*separator).count()).sum()
    };
    // `max_by_key` returns the last of several greatest counts.
    let most = SEPARATORS.into_iter().rev().max_by_key(count);
    most.unwrap_or(',')
}

/// Line behind a text whose quotes are all closed. In an open quote, it would be a part of the last cell.
const SENTINEL: [&str; 2] = ["\n\"", "end"];

/// Splits a CSV text into lines that are neither blank nor comments nor declare the separator; a cell in quotes may have line breaks.
///
/// # Errors
/// The number of the line with a quote that is not closed, from 1, and a message about it.
pub(super) fn lines(text: &str, separator: char) -> Result<Vec<CsvLine>, (usize, String)> {
    let guarded = [text, &SENTINEL.concat()].concat();
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .delimiter(separator as u8)
        .from_reader(guarded.as_bytes());
    let mut lines = Vec::new();
    let has_declaration = declared(text).is_some();
    let (mut number, mut counted) = (1, 0);
    let mut last = (1, StringRecord::new());
    for cells in reader.records() {
        let mut cells = cells.map_err(|why| (number, why.to_string()))?;
        // A record's position is before the blank lines and comments that the reader has left out.
        let start = cells.position().map_or(0, |place| place.byte() as usize);
        number += guarded[counted..start].matches('\n').count();
        counted = start;
        let left_out = |line: &&str| line.is_empty() || line.starts_with('#');
        let above = guarded[start..].lines().take_while(left_out).count();
        last = (number + above, cells.clone());
        cells.trim();
        let is_comment = cells.get(0).is_some_and(|cell| cell.starts_with('#'));
        let is_declaration = has_declaration && start == 0;
        if !is_comment && !is_declaration && cells.iter().any(|cell| !cell.is_empty()) {
            lines.push(CsvLine { number: number + above, cells });
        }
    }
    match last {
        (_, cells) if cells == [SENTINEL[1]][..] => {
            lines.pop();
            Ok(lines)
        }
        (line, _) => Err((line, OPEN_QUOTE.to_owned())),
    }
}

/// Message about a cell whose closing quote is missing.
const OPEN_QUOTE: &str = "has a cell that begins with a quote: must have a quote at its end, too";

#[cfg(test)]
mod tests {
    use super::lines;

    #[test]
    fn a_quote_that_is_not_closed_is_found() {
        for (text, line) in [
            ("a,b\n1,\"2", 2),
            ("a,b\n\"1,2\n3,4\n", 2),
            ("a,b\n1,2\n\"", 3),
            ("a,b\n\n# \"\n1,\"2\"\"\n", 4),
            ("\"a,b\n1,2", 1),
        ] {
            let why = lines(text, ',').map(|lines| lines.len());
            let line = why.map_err(|(found, _)| assert_eq!(found, line, "{text:?}"));
            assert_eq!(line, Err(()), "{text:?}");
        }
    }

    #[test]
    fn closed_quotes_are_read() {
        for (text, last) in [
            ("a,b\n1,\"2\"", "2"),
            ("a,b\n1,\"2\"\"\"\n", "2\""),
            ("a,b\n1,\"\nend\"\n# \"", "end"),
            ("a,b\n1,2\"\n\n", "2\""),
            ("a,b\n1,\" 2 \"\n# \"end\n", "2"),
            ("a,b\nend,end", "end"),
        ] {
            let lines = lines(text, ',').unwrap_or_default();
            assert_eq!(lines.len(), 2, "{text:?}");
            assert_eq!(lines[1].cells.get(1), Some(last), "{text:?}");
        }
        let single = lines("end\nend", ',').unwrap_or_default();
        assert_eq!(single.len(), 2);
    }
}
