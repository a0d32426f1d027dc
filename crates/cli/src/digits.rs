//! `--digits`.

use super::failure::Failure;
use clap::Args;
use std::str::FromStr;
use whiskmap::plan::{Channels, Digits};

#[derive(Debug, Args)]
pub struct DigitsArgs {
    /// Round stored quantities to N significant decimal digits, from 2 to 7; NAME=N for one channel; separated by commas
    /// [default: 7, all bits]
    #[arg(long, value_name = "LIST", value_parser = Digits::from_str)]
    digits: Option<Digits>,
}

impl DigitsArgs {
    /// Returns the digits of a map with these `channels`.
    ///
    /// # Errors
    /// If a named channel is not stored.
    pub fn of(&self, channels: Channels) -> Result<Digits, Failure> {
        let digits = self.digits.unwrap_or(Digits::ALL);
        match digits.not_in(channels) {
            None => Ok(digits),
            Some(name) => Err(Failure::Input(format!(
                "--digits {digits}: {name} is not stored, only {channels}; add it to --channels"
            ))),
        }
    }
}
