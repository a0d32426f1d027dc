//! Input text: files of bounded length, CSV tables, numbers with units, and names that are nearly right.

mod columns;
mod lines;
mod names;
mod quantity;
mod source;
mod table;

pub use columns::ColumnName;
pub use names::{did_you_mean, each_once};
pub use quantity::Quantity;
pub use table::{CsvError, CsvTable};

pub(crate) use lines::CsvLine;
pub(crate) use names::{misnamed, shortened};
#[cfg(feature = "gpu")]
pub(crate) use source::read;
pub(crate) use source::{TEXT_MIB, bounded, open, open_regular};
pub(crate) use table::{CsvLines, MOST_SECONDS, STDIN, is_missing, read_bytes, text_of};
