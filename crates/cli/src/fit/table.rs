//! Table of `whiskmap fit`, with the digits that standard errors leave.

use super::super::data;
use std::io::{self, Write};
use whiskmap::fit::{Estimate, Fit, FitLoss};
use whiskmap::scene::{digits, rounded};
use whiskmap::terminal::StandardOutput;

/// Number of rows with the strongest pulls that are printed.
const PULLS: usize = 3;

/// Returns the text of a missing standard error in the table.
fn no_error(fit: &Fit, estimate: &Estimate) -> &'static str {
    match fit.not_a_fit {
        Some(_) => "not a fit",
        None if estimate.is_at_limit => "at its limit",
        None => "not determined",
    }
}

/// Formats a value and its standard error with the digits that the error leaves, by the rule of the Particle Data Group. The rule looks at
/// the first three digits of the error. It keeps two digits below 355 and one digit below 950; a greater error is rounded up to 1000.
///
/// Review of Particle Physics, section 5.3 of the introduction.
fn with_error(value: f64, error: f64) -> [String; 2] {
    if !(error.is_normal() && value.is_finite()) {
        return [value, error].map(digits);
    }
    let three = format!("{error:.2e}");
    let (leading, exponent) = three.split_once('e').unwrap_or((&three, "0"));
    let exponent: i32 = exponent.parse().unwrap_or_default();
    let is_long = leading.parse::<f64>().is_ok_and(|leading| leading < 3.55);
    let places = i32::from(is_long) - exponent;
    [value, error].map(|number| {
        if places >= 0 {
            return format!("{number:.*}", places as usize);
        }
        let unit = 10_f64.powi(-places);
        format!("{:.0}", (number / unit).round() * unit)
    })
}

/// Formats a value without a standard error with six significant digits.
pub fn six_digits(value: f64) -> String {
    digits(rounded(value, 6))
}

/// Prints the table of a fit; the JSON has all digits of the values.
pub fn table(title: &str, fit: &Fit) -> io::Result<()> {
    let mut out = StandardOutput::open();
    writeln!(out, "{title}")?;
    if fit.not_a_fit.is_some() {
        writeln!(out, "not a fit")?;
    }
    writeln!(out, "{:19} value +- standard error", "parameter")?;
    for estimate in &fit.estimates {
        let name = estimate.parameter.name();
        match estimate.standard_error {
            Some(error) => {
                let [value, error] = with_error(estimate.value, error);
                writeln!(out, "{name:19} {value} +- {error}")?;
            }
            None => {
                let value = six_digits(estimate.value);
                writeln!(out, "{name:19} {value}, {}", no_error(fit, estimate))?;
            }
        }
    }
    for (i, estimate) in fit.estimates.iter().enumerate() {
        for (other, correlation) in fit.estimates[..i].iter().zip(&fit.correlation[i]) {
            let [first, second] = [other, estimate].map(|estimate| estimate.parameter.name());
            if let Some(correlation) = correlation.map(statistic) {
                writeln!(out, "correlation of {first} and {second}: {correlation}")?;
            }
        }
    }
    let (chi_square, freedom) = (statistic(fit.chi_square), fit.degrees_of_freedom);
    let name = match fit.loss {
        FitLoss::Squares => "chi-square".to_owned(),
        loss => format!("sum of the {} losses", loss.name()),
    };
    writeln!(out, "{name}: {chi_square}, {freedom} degrees of freedom")?;
    for (name, value) in data::summary(&fit.comparison) {
        writeln!(out, "{name}: {value}")?;
    }
    if !fit.pulls.is_empty() {
        let strongest = fit.pulls.iter().take(PULLS);
        let texts: Vec<String> = strongest
            .map(|pull| {
                let moved = rounded(pull.standard_errors, 2);
                format!(
                    "line {} ({} by {moved:+} standard errors)",
                    pull.line,
                    pull.parameter.name()
                )
            })
            .collect();
        writeln!(out, "without these rows, values would move most: {}", texts.join(", "))?;
    }
    Ok(())
}

/// Formats a statistic for the table.
fn statistic(value: f64) -> String {
    digits(rounded(value, data::STATISTIC_DIGITS))
}

#[cfg(test)]
mod tests {
    use super::with_error;

    /// The first two are the examples of the Review of Particle Physics.
    #[test]
    fn values_have_the_digits_that_their_error_leaves() {
        for (value, error, expected) in [
            (0.827, 0.119, "0.83 +- 0.12"),
            (0.827, 0.367, "0.8 +- 0.4"),
            (14.3456, 0.9512, "14.3 +- 1.0"),
            (2.486_722_579_745_257_5, 0.082_870_272_725, "2.49 +- 0.08"),
            (0.017_435_134_7, 0.000_724_921, "0.0174 +- 0.0007"),
            (-1234.5, 355.0, "-1200 +- 400"),
            (1234.5, 12.3, "1234 +- 12"),
            (9.99e-7, 9.96e-9, "0.000000999 +- 0.000000010"),
            (1.5, 0.0, "1.5 +- 0"),
        ] {
            assert_eq!(with_error(value, error).join(" +- "), expected);
        }
    }
}
