//! The command line.

use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs a command line, of which the first text is the name of the program, and returns the exit code.
#[pyfunction]
pub fn run_command(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| whiskmap_cli::main(arguments))
}
