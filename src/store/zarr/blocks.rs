//! Blocks of a sweep: whiskers that share a file of each Zarr array, and that a run finishes together.

use crate::plan::rows_of_band;
use crate::scene::Grid;
use std::ops::Range;

/// Fewest and most cells of a block: an interruption loses seconds of work, and the panels of a block take 120 MB of memory.
const CELLS: [usize; 2] = [1 << 14, 1 << 21];

/// Number of blocks of a sweep if their size lies between these limits; each block has a file for each array.
const WANTED: usize = 128;

/// Blocks of a sweep. They depend on its grid alone, so that any number of processes agree on them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Blocks {
    /// Number of values of each sweep axis of the store: `[axis]`.
    pub(super) axes: Vec<usize>,
    /// Number of values of each sweep axis in a block: `[axis]`; the last block of an axis may have fewer.
    pub(super) shape: Vec<usize>,
    /// Numbers of distances and of push angles of a panel: `[distances, push_angles]`.
    pub(super) panel: [usize; 2],
}

impl Blocks {
    /// Returns the blocks of `grid`. A block has all values of the first sweep axes, some values of one axis, and one value of each of
    /// the rest: its whiskers follow one another.
    pub(super) fn of(grid: &Grid) -> Self {
        let axes: Vec<usize> = grid.sweep.iter().map(|axis| axis.values.len()).collect();
        let panel = [grid.distance_mm.len(), grid.push_angle_deg.len()];
        let cells = panel[0] * panel[1];
        let wanted = cells * grid.whisker_count() / WANTED;
        let mut room = (wanted.clamp(CELLS[0], CELLS[1]) / cells).max(1);
        let shape = axes.iter().map(|&values| {
            let taken = values.min(room);
            room = if taken == values { room / values } else { 1 };
            room = room.max(1);
            taken
        });
        Self { shape: shape.collect(), axes, panel }
    }

    /// Returns the number of blocks of the sweep.
    pub(super) fn count(&self) -> usize {
        self.blocks_per_axis().product()
    }

    fn blocks_per_axis(&self) -> impl Iterator<Item = usize> {
        let axes = self.axes.iter().zip(&self.shape);
        axes.map(|(values, block)| values.div_ceil(*block))
    }

    /// Returns the indices of a block on the sweep axes of an array: `[axis]`.
    pub(super) fn place(&self, block: usize) -> Vec<usize> {
        let mut rest = block;
        let on_axes = self.blocks_per_axis().map(|blocks| {
            let at = rest % blocks;
            rest /= blocks;
            at
        });
        on_axes.collect()
    }

    /// Returns the indices in the sweep of the whiskers of a block.
    pub(super) fn whiskers(&self, block: usize) -> Range<usize> {
        let (mut first, mut count, mut stride) = (0, 1, 1);
        for (axis, at) in self.place(block).into_iter().enumerate() {
            let (values, block) = (self.axes[axis], self.shape[axis]);
            first += at * block * stride;
            count *= block.min(values - at * block);
            stride *= values;
        }
        first..first + count
    }

    /// Returns the block of a whisker, and the whisker's index in the block.
    pub(super) fn find(&self, whisker: usize) -> (usize, usize) {
        let (mut rest, mut block, mut stride) = (whisker, 0, 1);
        let axes = self.axes.iter().zip(&self.shape);
        for ((values, taken), blocks) in axes.zip(self.blocks_per_axis()) {
            block += rest % values / taken * stride;
            rest /= values;
            stride *= blocks;
        }
        (block, whisker - self.whiskers(block).start)
    }

    /// Returns the slot of whisker `index` of `block` in its files, which the last axis varies fastest.
    pub(super) fn slot(&self, block: usize, index: usize) -> usize {
        let mut rest = index;
        let at = self.place(block);
        let mut slot = 0;
        for (axis, room) in self.shape.iter().enumerate() {
            let here = (*room).min(self.axes[axis] - at[axis] * room);
            slot = slot * room + rest % here;
            rest /= here;
        }
        slot
    }

    /// Returns the number of slots, each for one whisker, of the file of a block.
    pub(super) fn slots(&self) -> usize {
        self.shape.iter().product()
    }

    /// Returns the number of distances of a chunk, and of a panel filled up to whole chunks. A chunk, which is packed and read as a whole,
    /// is a band of the panel: 1 MB of a quantity, or 16 lines of a wide panel.
    pub(super) fn distances(&self) -> [usize; 2] {
        let chunk = rows_of_band(self.panel);
        [chunk, self.panel[0].next_multiple_of(chunk)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Parameter, SweepAxis};

    fn grid(axes: &[usize], panel: [usize; 2]) -> Grid {
        let values = |count: usize| (0..count).map(|i| i as f64).collect();
        let axes = axes.iter().zip(Parameter::SWEPT);
        Grid {
            push_angle_deg: values(panel[1]),
            distance_mm: values(panel[0]),
            sweep: axes
                .map(|(&count, parameter)| SweepAxis {
                    variable: parameter.into(),
                    values: values(count),
                })
                .collect(),
        }
    }

    /// In a block, as in the sweep, the first axis varies fastest; in its files it varies slowest.
    #[test]
    fn every_whisker_is_in_one_place() {
        for (axes, panel) in [
            (&[][..], [7, 5]),
            (&[5], [64, 64]),
            (&[4, 7, 3], [64, 64]),
            (&[4, 7, 12], [8, 8]),
            (&[3, 1, 4, 2], [128, 128]),
            (&[100, 9], [2048, 2048]),
        ] {
            let grid = grid(axes, panel);
            let blocks = Blocks::of(&grid);
            let mut next = 0;
            for block in 0..blocks.count() {
                let whiskers = blocks.whiskers(block);
                assert_eq!(whiskers.start, next);
                next = whiskers.end;
                let at = blocks.place(block);
                let mut slots: Vec<usize> = Vec::new();
                for (index, whisker) in whiskers.enumerate() {
                    assert_eq!(blocks.find(whisker), (block, index));
                    let inside = grid.indices(whisker);
                    let mut slot = 0;
                    for (axis, room) in blocks.shape.iter().enumerate() {
                        slot = slot * room + inside[axis] - at[axis] * room;
                    }
                    assert_eq!(blocks.slot(block, index), slot);
                    slots.push(slot);
                }
                slots.sort_unstable();
                slots.dedup();
                assert_eq!(slots.len(), blocks.whiskers(block).len());
                assert!(slots.iter().all(|slot| *slot < blocks.slots()));
            }
            assert_eq!(next, grid.whisker_count());
        }
    }

    #[test]
    fn large_panels_are_cut_into_chunks() {
        let blocks = Blocks::of(&grid(&[2], [3000, 2000]));
        assert_eq!(blocks.distances(), [144, 3024]);
        assert_eq!(Blocks::of(&grid(&[2], [300, 200])).distances(), [300, 300]);
    }
}
