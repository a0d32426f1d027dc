//! What the columns of a table mean, for `--help`.

use std::fmt::Write;

/// The `examples` of a command, and its tables by title, each with its columns and what they mean.
pub fn help(examples: &str, tables: &[(&str, &[(&str, &str)])]) -> String {
    let mut help = examples.to_owned();
    for (title, columns) in tables {
        let wide = columns.iter().map(|(name, _)| name.len()).max();
        let wide = wide.unwrap_or_default();
        // Writing to a String cannot fail.
        let _ = write!(help, "\n\n{title}:");
        for (name, meaning) in *columns {
            let _ = write!(help, "\n  {name:wide$} {meaning}");
        }
    }
    help
}
