//! The command `whiskmap`: see `whiskmap --help`.

use std::process::ExitCode;

fn main() -> ExitCode {
    whiskmap::cli::main()
}
