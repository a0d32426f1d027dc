//! Points of several whiskers, which a column of their file names.

use super::{MeasuredPoint, MeasuredPoints};
use crate::input::{CsvError, shortened};
use crate::scene::SweepPlace;

impl MeasuredPoints {
    /// Returns the points of the whisker at a place of a sweep, as points without names; all points if their file names no whiskers.
    ///
    /// # Errors
    /// The place is not on an axis of whiskers, or no point belongs to its whisker.
    pub fn at(&self, place: &SweepPlace) -> Result<Self, CsvError> {
        if self.whiskers.is_empty() {
            return Ok(self.clone());
        }
        let Some(name) = place.whisker() else {
            return Err(self.without_table());
        };
        let index = self.whiskers.iter().position(|known| known == name);
        let measured = index.map(|index| self.of_whisker(index));
        measured.filter(|measured| !measured.points.is_empty()).ok_or_else(|| {
            let what = format!("has no point of the whisker {}", shortened(name));
            CsvError::whole(&self.origin, what)
        })
    }

    /// Returns the points of the whisker with this index, as points without names.
    pub(super) fn of_whisker(&self, index: usize) -> Self {
        let of_index = |points: &[MeasuredPoint]| {
            let selected = points.iter().filter(|point| point.whisker == index);
            selected.map(|point| MeasuredPoint { whisker: 0, ..*point }).collect()
        };
        Self {
            origin: self.origin.clone(),
            note: self.note.clone(),
            whiskers: Vec::new(),
            points: of_index(&self.points),
            incomplete: of_index(&self.incomplete),
            ..*self
        }
    }

    pub(super) fn without_table(&self) -> CsvError {
        let must = "has a column whisker: the scene must have a table of whiskers, and no other sweep axis; for points of one whisker, \
             give the column another name, such as animal";
        CsvError::whole(&self.origin, must)
    }
}
