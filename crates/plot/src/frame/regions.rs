//! Names of the regions of a plot or a heat map to the left and the right of 0, above the frame.

use super::heading::NAME;
use crate::picture::text::TextBlock;
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

/// Names of the regions left and right of 0, each in lines with its middle as a fraction of the axis; empty without room.
pub struct RegionNames(Vec<(TextBlock, f64)>);

impl RegionNames {
    /// Chooses the names of `[left, right]` on an axis of this length, on which 0 is at the fraction `zero`. Both names are long, or both
    /// are short; long ones may have two lines.
    pub fn plan(regions: Option<&[Region; 2]>, zero: f64, length: f64) -> Self {
        let zero = zero.clamp(0.0, 1.0);
        let sides = [[0.0, zero], [zero, 1.0]];
        let regions: Vec<_> = regions.into_iter().flatten().zip(sides).collect();
        let set = |name: &str, [from, to]: [f64; 2]| {
            let block = TextBlock::new(name, NAME, length * (to - from) - GAP);
            let is_whole = block.lines.len() < 3 && block.lines.join(" ") == name;
            is_whole.then_some((block, 0.5 * (from + to)))
        };
        let shown = regions.iter().filter(|(region, side)| set(&region.short, *side).is_some());
        let long: Option<Vec<_>> = shown.map(|(region, side)| set(&region.name, *side)).collect();
        Self(long.unwrap_or_else(|| {
            let short = regions.iter();
            short.filter_map(|(region, side)| set(&region.short, *side)).collect()
        }))
    }

    /// Returns the height of the regions' names above the frame, in units of the picture.
    pub fn height(&self) -> f64 {
        let heights = self.0.iter().map(|(block, _)| HEIGHT + block.below_first());
        heights.fold(0.0, f64::max)
    }

    /// Draws the regions' names above the frame of `body`, their last lines beside each other.
    pub fn draw(&self, picture: &mut Picture, body: Area) {
        for (block, at) in &self.0 {
            let [x, y] = body.point(*at, 1.0);
            picture.block(block, [x, y - ABOVE - block.below_first()], Anchor::Centre);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Region, RegionNames};

    #[test]
    fn names_are_long_where_both_have_room_and_absent_without() {
        let region =
            |name: &str, short: &str| Region { name: name.to_owned(), short: short.to_owned() };
        let regions = [region("concave forward (CF)", "CF"), region("concave backward (CB)", "CB")];
        let names = |zero, length| {
            let names = RegionNames::plan(Some(&regions), zero, length).0;
            names.into_iter().map(|(name, _)| name.lines.join("|")).collect::<Vec<_>>()
        };
        assert_eq!(names(0.5, 1000.0), ["concave forward (CF)", "concave backward (CB)"]);
        assert_eq!(names(0.5, 400.0), ["concave forward|(CF)", "concave backward|(CB)"]);
        assert_eq!(names(0.5, 200.0), ["CF", "CB"]);
        assert_eq!(names(0.1, 600.0), ["CF", "CB"]);
        assert_eq!(names(-0.2, 1000.0), ["concave backward (CB)"]);
        assert_eq!(names(0.5, 20.0), [""; 0]);
        assert_eq!(RegionNames::plan(None, 0.5, 1000.0).height(), 0.0);
    }
}
