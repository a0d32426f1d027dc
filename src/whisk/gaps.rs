//! Gaps of a course: samples whose angles are missing.

use super::course::AngleCourse;
use super::readings::missing;
use super::rows::{Undecided, WhiskSample};
use crate::scene::{digits, rounded};
use std::ops::Range;

/// Gap of a course: neighbouring samples whose angles are missing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CourseGap {
    /// Index of the first sample whose angle is missing.
    pub begin: usize,
    /// Index of the first sample after the gap; `None` if the gap lasts to the end of the course.
    pub end: Option<usize>,
    /// Number of samples whose angles are missing.
    pub count: usize,
    /// Time of the first sample whose angle is missing, in s.
    pub time_s: f64,
    /// Time between the angles before and after the gap, in s; `None` if one of them does not exist.
    pub length_s: Option<f64>,
    /// True if the course continues across the gap along a straight line.
    pub is_bridged: bool,
}

impl CourseGap {
    /// Returns the samples of the gap, without states: `[sample]`. `times_s` are the times of the course.
    pub(super) fn samples<'a>(
        &self,
        times_s: &'a [f64],
    ) -> impl Iterator<Item = WhiskSample> + use<'a> {
        let reason = match self.is_bridged {
            true => Undecided::Bridged,
            false => Undecided::Missing,
        };
        let times = times_s[self.begin..self.begin + self.count].iter();
        times.map(move |time_s| missing(*time_s, reason))
    }
}

impl AngleCourse {
    /// Returns the indices of the samples with an angle, `[index]`: at least two.
    pub(super) fn known(&self) -> Vec<usize> {
        let angles = self.angles_deg.iter().enumerate();
        let known = angles.filter(|(_, angle)| !angle.is_nan());
        known.map(|(i, _)| i).collect()
    }

    /// Returns the gaps of the course, `[gap]`. Gaps of at most `bridge_s` are bridged.
    pub(super) fn gaps(&self, bridge_s: f64) -> Vec<CourseGap> {
        let known = self.known();
        let count = self.times_s.len();
        let before = known.iter().map(|i| Some(*i));
        let after = known.iter().map(|i| Some(*i)).chain([None]);
        let pairs = [None].into_iter().chain(before).zip(after);
        let gap = |(before, after): (Option<usize>, Option<usize>)| {
            let inside: Range<usize> = before.map_or(0, |i| i + 1)..after.unwrap_or(count);
            let ends = before.zip(after);
            let times = ends.map(|(before, after)| [self.times_s[before], self.times_s[after]]);
            let is_short = |[from, to]: [f64; 2]| {
                let rounding = f64::EPSILON * (from.abs() + to.abs());
                to - from <= bridge_s + rounding
            };
            (!inside.is_empty()).then(|| CourseGap {
                begin: inside.start,
                end: after,
                count: inside.len(),
                time_s: self.times_s[inside.start],
                length_s: times.map(|[from, to]| to - from),
                is_bridged: bridge_s > 0.0 && times.is_some_and(is_short),
            })
        };
        pairs.filter_map(gap).collect()
    }
}

/// Returns one line for the gaps that are bridged, and one for those that are not; none without gaps. `samples` are of the whole
/// course.
pub(super) fn warnings(
    gaps: &[CourseGap],
    samples: &[WhiskSample],
) -> impl Iterator<Item = String> {
    let is_undecided = |gap: &CourseGap| {
        let after = gap.end.and_then(|end| samples.get(end));
        after.is_some_and(|sample| sample.reason == Some(Undecided::AfterGap))
    };
    [true, false].into_iter().filter_map(move |is_bridged| {
        let selected = gaps.iter().filter(|gap| gap.is_bridged == is_bridged);
        let (count, first) = (selected.clone().count(), selected.clone().next()?);
        let missing: usize = selected.clone().map(|gap| gap.count).sum();
        let longest = selected.filter_map(|gap| gap.length_s).reduce(f64::max);
        let seconds = |number: f64| digits(rounded(number, 6));
        let what = format!("missing angles: {missing}, gaps: {count}, the first at {} s", seconds(first.time_s));
        let longest = longest.map(seconds);
        if is_bridged {
            let longest = longest?;
            return Some(format!("{what}: the course continues along straight lines across them, the longest of {longest} s"));
        }
        let bridge = longest.map(|longest| format!("a bridge continues it, which for the longest must have {longest} s"));
        // A bridge serves no gap at the beginning, and a start no other gap.
        let needs_start = first.begin == 0 && is_undecided(first);
        let start = needs_start.then(|| "choose the start `contact` or `free`".to_owned());
        let advice: Vec<String> = start.into_iter().chain(bridge).collect();
        Some(match &advice[..] {
            [] => what,
            advice => format!("{what}: after them the course is undecided until only one state is possible; {}", advice.join("; ")),
        })
    })
}
