//! Command `whiskmap verify`.

use super::failure::Failure;
use std::io::Write;
use whiskmap::paper::{CheckVerdict, ExpectedNumber, checks};
use whiskmap::terminal::StandardOutput;

pub fn run() -> Result<(), Failure> {
    let checks = checks();
    let mut out = StandardOutput::open();
    let wide = |texts: &mut dyn Iterator<Item = usize>| texts.max().unwrap_or_default();
    let case = wide(&mut checks.iter().map(|check| check.case.len()));
    let quantity = wide(&mut checks.iter().map(|check| check.quantity.len()));
    writeln!(
        out,
        "{:case$}  {:quantity$}  {:11}  {:>15}  {:>17}  {:>10}  {:>9}",
        "case", "quantity", "source", "expected", "computed", "difference", "allowed"
    )?;
    for check in &checks {
        let (expected, allowed) = match check.expected {
            ExpectedNumber::Near(value, tolerance) => {
                (format!("{value}"), format!("{tolerance:.1e}"))
            }
            ExpectedNumber::Above(bound) => (format!("> {bound}"), String::new()),
        };
        writeln!(
            out,
            "{:case$}  {:quantity$}  {:11}  {:>15.15}  {:>17}  {:>10}  {:>9}  {}",
            check.case,
            check.quantity,
            check.source,
            expected,
            format!("{:.11}", check.computed),
            format!("{:.1e}", check.difference()),
            allowed,
            match check.verdict() {
                CheckVerdict::Pass => "PASS",
                CheckVerdict::Differs => "DIFFERS",
                CheckVerdict::Fail => "FAIL",
            }
        )?;
    }
    let count = |verdict| checks.iter().filter(|check| check.verdict() == verdict).count();
    writeln!(
        out,
        "{} of {} checks pass; {} DIFFERS: an independent solver also contradicts the source",
        count(CheckVerdict::Pass),
        checks.len(),
        count(CheckVerdict::Differs)
    )?;
    let failed = count(CheckVerdict::Fail);
    if failed > 0 {
        return Err(Failure::Checks { failed, all: checks.len() });
    }
    Ok(())
}
