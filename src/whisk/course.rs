//! Angle of the base over time.

use crate::input::{CsvError, CsvTable, MOST_SECONDS};
use std::f64::consts::TAU;

/// Angle of the base over time: samples, joined by straight lines.
#[derive(Clone, Debug, PartialEq)]
pub struct AngleCourse {
    /// Times of the samples in s; they grow.
    pub(super) times_s: Vec<f64>,
    /// Angles of the base in degrees, `[time]`: 0 at first touch on CB; NaN where one is missing.
    pub(super) angles_deg: Vec<f64>,
    /// Note about columns of a file that are not used; `None` without such columns.
    pub note: Option<String>,
}

/// Error of a course that is not one.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CourseError {
    /// A course needs as many angles as times, at least two.
    #[error("{times} times and {angles} angles: must be at least 2 of each, and equally many")]
    Count {
        /// Number of times of the course.
        times: usize,
        /// Number of angles of the course.
        angles: usize,
    },
    /// Almost all angles are missing.
    #[error("{known} of {angles} angles are not missing: must be at least 2")]
    Missing {
        /// Number of angles of the course that are not missing.
        known: usize,
        /// Number of angles of the course.
        angles: usize,
    },
    /// A time does not grow.
    #[error("time_s[{index}] = {time_s}: must be more than the time before it, {before_s} s")]
    Time {
        /// Index of the sample that does not grow.
        index: usize,
        /// Time of the sample that does not grow, in s.
        time_s: f64,
        /// Time of the sample before the one that does not grow, in s.
        before_s: f64,
    },
    /// A time is out of its range.
    #[error("time_s[{index}] = {time_s:?}: must be between -{MOST_SECONDS:e} and {MOST_SECONDS:e}")]
    TimeRange {
        /// Index of the sample whose time is out of range.
        index: usize,
        /// Time of the sample, in s.
        time_s: f64,
    },
    /// An angle is beyond a turn, or no number.
    #[error("angle_deg[{index}] = {angle_deg}: must be between -360 and 360")]
    Angle {
        /// Index of the sample whose angle is out of range.
        index: usize,
        /// Angle of the sample, in degrees.
        angle_deg: f64,
    },
    /// A sine has fewer than two samples in a period.
    #[error(
        "frequency {frequency_hz} Hz with {rate_hz} samples per second: must be at most half as large"
    )]
    Frequency {
        /// Frequency of the sine, in Hz.
        frequency_hz: f64,
        /// Sampling rate of the course, in samples per second.
        rate_hz: f64,
    },
    /// A sine would have too many samples.
    #[error("{0:.0} samples: must be between 2 and {MOST_SAMPLES}")]
    Samples(f64),
}

/// Largest number of samples of a sine.
const MOST_SAMPLES: f64 = 1e6;

impl AngleCourse {
    /// Creates a course through `angles_deg`, in degrees, at `times_s`, in s. A missing angle is NaN.
    ///
    /// # Errors
    /// If there are fewer than two samples with an angle, times do not grow, or a number is out of range.
    pub fn new(times_s: Vec<f64>, angles_deg: Vec<f64>) -> Result<Self, CourseError> {
        let [times, angles] = [times_s.len(), angles_deg.len()];
        if times < 2 || times != angles {
            return Err(CourseError::Count { times, angles });
        }
        if let Some(index) =
            times_s.iter().position(|time| !(-MOST_SECONDS..=MOST_SECONDS).contains(time))
        {
            let time_s = times_s[index];
            return Err(CourseError::TimeRange { index, time_s });
        }
        let is_refused = |angle: &f64| !(angle.is_nan() || is_angle(*angle));
        if let Some(index) = angles_deg.iter().position(is_refused) {
            let angle_deg = angles_deg[index];
            return Err(CourseError::Angle { index, angle_deg });
        }
        let known = angles_deg.iter().filter(|angle| !angle.is_nan()).count();
        if known < 2 {
            return Err(CourseError::Missing { known, angles });
        }
        if let Some(before) = times_s.windows(2).position(|pair| pair[1] <= pair[0]) {
            let [before_s, time_s] = [times_s[before], times_s[before + 1]];
            let index = before + 1;
            return Err(CourseError::Time { index, time_s, before_s });
        }
        Ok(Self { times_s, angles_deg, note: None })
    }

    /// Creates the course `amplitude sin(2 pi frequency t)` from 0 s on for `seconds`, with `rate` samples per second.
    ///
    /// # Errors
    /// If a number is out of range, or there are fewer than 2 or more than 1,000,000 samples.
    pub fn sine(
        amplitude_deg: f64,
        frequency_hz: f64,
        seconds: f64,
        rate_hz: f64,
    ) -> Result<Self, CourseError> {
        let intervals = (seconds * rate_hz).round();
        if !(1.0..MOST_SAMPLES).contains(&intervals) {
            return Err(CourseError::Samples(intervals + 1.0));
        }
        if frequency_hz > 0.5 * rate_hz {
            return Err(CourseError::Frequency { frequency_hz, rate_hz });
        }
        let times: Vec<f64> = (0..=intervals as u64).map(|i| i as f64 / rate_hz).collect();
        let angle = |time: &f64| amplitude_deg * libm::sin(TAU * frequency_hz * time);
        let angles = times.iter().map(angle).collect();
        Self::new(times, angles)
    }

    /// Names of the columns of a file of a course, `[column]`.
    pub const COLUMNS: [&str; 2] = ["time_s", "angle_deg"];

    /// Returns the course of a CSV table with the columns `time_s` and `angle_deg`. A missing angle is an empty cell or `NaN`.
    ///
    /// # Errors
    /// If a column is missing, a cell is no number or out of its range, or a time does not grow.
    pub fn of(table: &CsvTable) -> Result<Self, CsvError> {
        let [time, angle] = Self::COLUMNS;
        let note = table.require(&[&[time], &[angle]], &[])?;
        let times_s = table.times_s()?;
        let angles_deg =
            table.measurements("angle_deg", "a number between -360 and 360", is_angle)?;
        let course = Self::new(times_s, angles_deg.unwrap_or_default())
            .map_err(|why| CsvError::whole(&table.origin, why.to_string()))?;
        Ok(Self { note, ..course })
    }

    /// Returns the times of the course's samples, in s: `[sample]`.
    #[must_use]
    pub fn times_s(&self) -> &[f64] {
        &self.times_s
    }

    /// Returns the angles of the base at the course's samples, in degrees: `[sample]`. A missing angle is NaN.
    #[must_use]
    pub fn angles_deg(&self) -> &[f64] {
        &self.angles_deg
    }
}

fn is_angle(angle_deg: f64) -> bool {
    angle_deg.abs() <= 360.0
}
