//! Names of the regions of a plot or a heat map to the left and the right of 0, above the frame.

use super::heading::NAME;
use crate::picture::font::width;
use crate::picture::{Anchor, Area, Picture};

/// Space between the names of two regions, in units.
const GAP: f64 = 16.0;
/// Height of the space above the frame for names, in units.
const HEIGHT: f64 = 28.0;
/// Distance of the middle of the names from the frame, in units.
const ABOVE: f64 = 17.0;

/// A region of a plot or a heat map on one side of 0 on its horizontal axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Name of the region, such as `concave forward (CF)`.
    pub name: String,
    /// Name of the region where the long one has no room, such as `CF`.
    pub short: String,
}

/// The names of the regions, each with its middle as a fraction of the axis; none without room.
pub struct RegionNames(Vec<(String, f64)>);

impl RegionNames {
    /// Chooses the names of `[left, right]` on an axis of this length, on which 0 is at the fraction `zero`. Both names are long, or both
    /// are short.
    pub fn plan(regions: Option<&[Region; 2]>, zero: f64, length: f64) -> Self {
        let zero = zero.clamp(0.0, 1.0);
        let sides = [[0.0, zero], [zero, 1.0]];
        let regions: Vec<_> = regions.into_iter().flatten().zip(sides).collect();
        let has_room =
            |name: &str, [from, to]: [f64; 2]| width(name, NAME) + GAP <= length * (to - from);
        let is_long = regions
            .iter()
            .filter(|(region, side)| has_room(&region.short, *side))
            .all(|(region, side)| has_room(&region.name, *side));
        let names = regions.into_iter().filter_map(|(region, side)| {
            let name = if is_long { &region.name } else { &region.short };
            has_room(name, side).then(|| (name.clone(), 0.5 * (side[0] + side[1])))
        });
        Self(names.collect())
    }

    /// Returns the height of the names above the frame, in units.
    pub fn height(&self) -> f64 {
        if self.0.is_empty() { 0.0 } else { HEIGHT }
    }

    /// Draws the names above the frame of `body`.
    pub fn draw(&self, picture: &mut Picture, body: Area) {
        for (name, at) in &self.0 {
            let [x, y] = body.point(*at, 1.0);
            picture.text(name, [x, y - ABOVE], NAME, Anchor::Centre);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Region, RegionNames};

    #[test]
    fn names_are_long_where_both_have_room_and_absent_without() {
        let region = |name: &str, short: &str| Region {
            name: name.to_owned(),
            short: short.to_owned(),
        };
        let regions = [
            region("concave forward (CF)", "CF"),
            region("concave backward (CB)", "CB"),
        ];
        let names = |zero, length| {
            let names = RegionNames::plan(Some(&regions), zero, length).0;
            names.into_iter().map(|(name, _)| name).collect::<Vec<_>>()
        };
        assert_eq!(
            names(0.5, 1000.0),
            ["concave forward (CF)", "concave backward (CB)"]
        );
        assert_eq!(names(0.5, 300.0), ["CF", "CB"]);
        assert_eq!(names(0.1, 1000.0), ["CF", "CB"]);
        assert_eq!(names(-0.2, 1000.0), ["concave backward (CB)"]);
        assert_eq!(names(0.5, 20.0), [""; 0]);
        assert_eq!(RegionNames::plan(None, 0.5, 1000.0).height(), 0.0);
    }
}
