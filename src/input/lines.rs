//! The lines of a CSV file, split into cells.

use csv::{ReaderBuilder, StringRecord, Trim};

/// The cells of one line of a file, and its number from 1.
#[derive(Clone, Debug)]
pub(super) struct CsvLine {
    pub number: usize,
    pub cells: StringRecord,
}

/// The separator of the columns of `text`: what its header has most of, outside of quotes.
pub(super) fn separator(text: &str) -> char {
    let is_header = |line: &&str| !line.trim().is_empty() && !line.trim_start().starts_with('#');
    let header = text.lines().find(is_header).unwrap_or_default();
    let count = |separator: &char| -> usize {
        let unquoted = header.split('"').step_by(2);
        unquoted.map(|part| part.matches(*separator).count()).sum()
    };
    let most = [';', '\t', ','].into_iter().max_by_key(count);
    most.unwrap_or(',')
}

/// The lines of `text` that are neither blank nor comments; a cell in quotes may have line breaks.
pub(super) fn lines(text: &str, separator: char) -> csv::Result<Vec<CsvLine>> {
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .delimiter(separator as u8)
        .trim(Trim::All)
        .from_reader(text.as_bytes());
    let mut lines = Vec::new();
    let (mut number, mut counted) = (1, 0);
    for cells in reader.records() {
        let cells = cells?;
        // A record's position is before the blank lines and comments that the reader has left out.
        let start = cells.position().map_or(0, |place| place.byte() as usize);
        number += text[counted..start].matches('\n').count();
        counted = start;
        let left_out = |line: &&str| line.is_empty() || line.starts_with('#');
        let above = text[start..].lines().take_while(left_out).count();
        let is_comment = cells.get(0).is_some_and(|cell| cell.starts_with('#'));
        if !is_comment && cells.iter().any(|cell| !cell.is_empty()) {
            lines.push(CsvLine {
                number: number + above,
                cells,
            });
        }
    }
    Ok(lines)
}
