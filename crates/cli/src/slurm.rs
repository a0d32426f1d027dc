//! Times and sizes of memory in the formats of Slurm.

/// Message about a time that Slurm refuses.
const TIMES: &str = "must be minutes, minutes:seconds, hours:minutes:seconds, days-hours, days-hours:minutes or \
                     days-hours:minutes:seconds, such as 30, 1:00:00 or 1-12";

/// Returns `text` if it is a time that `sbatch --time` accepts, otherwise what is allowed.
pub fn time(text: &str) -> Result<String, String> {
    let (days, rest) = match text.split_once('-') {
        Some((days, rest)) => (Some(days), rest),
        None => (None, text),
    };
    let is_number = |text: &str| is_digits(text) && text.parse::<u32>().is_ok();
    let is_time = days.is_none_or(is_number)
        && rest.split(':').all(is_number)
        && rest.split(':').count() <= 3;
    is_time.then(|| text.to_owned()).ok_or_else(|| TIMES.to_owned())
}

/// Returns `text` if it is a size of memory that `sbatch --mem` accepts, otherwise what is allowed.
pub fn memory(text: &str) -> Result<String, String> {
    let number = text.strip_suffix(|c: char| "KMGTkmgt".contains(c));
    let is_size = is_digits(number.unwrap_or(text));
    let must = "must be a whole number with K, M (the default), G or T, such as 500M";
    is_size.then(|| text.to_owned()).ok_or_else(|| must.to_owned())
}

fn is_digits(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| c.is_ascii_digit())
}

/// Formats a time of at least `seconds` for `sbatch --time`, in whole minutes.
pub fn time_of(seconds: f64) -> String {
    let minutes = (seconds / 60.0).ceil() as u64;
    let (days, hours, minutes) = (minutes / 1440, minutes / 60 % 24, minutes % 60);
    match days {
        0 => format!("{hours}:{minutes:02}:00"),
        _ => format!("{days}-{hours:02}:{minutes:02}:00"),
    }
}

/// Formats a size of at least `bytes` for `sbatch --mem`, in hundreds of mebibytes.
pub fn memory_of(bytes: u64) -> String {
    format!("{}M", bytes.div_ceil(100 << 20) * 100)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The six formats are those of the manual page of `sbatch`.
    #[test]
    fn slurm_times() {
        for good in ["30", "30:00", "1:00:00", "1-12", "1-12:30", "1-12:30:15", "0", "120:00"] {
            assert_eq!(time(good), Ok(good.to_owned()));
        }
        for bad in [
            "",
            "1h",
            "1:00:00:00",
            "-5",
            "1-",
            "1--2",
            ":30",
            "30:",
            "1-2-3",
            "1.5",
            "1 h",
            "+1",
            "1-2:3:4:5",
            "99999999999",
            "1:-2",
            "\u{661}",
        ] {
            assert!(time(bad).is_err(), "{bad}");
        }
        for (seconds, text) in [(0.1, "0:01:00"), (3600.0, "1:00:00"), (90_061.0, "1-01:02:00")] {
            assert_eq!(time_of(seconds), text);
            assert!(time(text).is_ok());
        }
    }

    #[test]
    fn slurm_memory() {
        for good in ["500M", "500", "2G", "1t"] {
            assert!(memory(good).is_ok(), "{good}");
        }
        for bad in ["", "M", "1.5G", "2GB", "-1", "1 G"] {
            assert!(memory(bad).is_err(), "{bad}");
        }
        assert_eq!(
            [memory_of(1), memory_of(100 << 20), memory_of(101 << 20)],
            ["100M", "100M", "200M"]
        );
    }
}
