//! Keys of blocks: trajectories with equal keys may share a block.

use super::{InitialCondition, Method};
use crate::rod::Effects;
use std::sync::Arc;

/// Properties that all trajectories of a block have in common.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct BlockKey {
    /// Effects of the block's kernel: the effects of the method and of the rod. A profile counts only if it is the rod's own. Where a
    /// straight rod needs all derivatives, [`Effects::reaching`] adds `gradient`.
    pub effects: Effects,
    /// Address of the profile; 0 without one.
    profile: usize,
    /// Number of steps of each trajectory of the block; 0 with a profile, along which each lane takes its own steps.
    pub steps: u32,
}

impl BlockKey {
    /// Returns the block key of an initial condition whose trajectory takes `steps` steps.
    #[inline]
    pub fn new(
        method: Method,
        InitialCondition { rod, tau, .. }: &InitialCondition,
        steps: u32,
    ) -> Self {
        let profile = rod.profile.as_ref();
        Self {
            effects: Effects {
                // Rods without a profile never use its kernels.
                profile: profile.is_some(),
                ..method.effects.and(rod).reaching(rod, *tau)
            },
            profile: profile.map_or(0, |profile| Arc::as_ptr(profile).addr()),
            steps,
        }
    }

    /// Returns true if trajectories with both keys can share a padded block, whatever their numbers of steps.
    pub fn may_pad(&self, other: &Self) -> bool {
        let but_steps = |key: &Self| (key.effects, key.profile);
        but_steps(self) == but_steps(other)
    }
}

/// List of the different block keys of a batch.
pub struct BlockKeys {
    /// Block keys of the batch, each once, in the order of appearance: `[key]`.
    pub all: Vec<BlockKey>,
    /// `[steps modulo 64]`: the index of the last key with such a number of steps.
    likely: [usize; 64],
}

impl Default for BlockKeys {
    fn default() -> Self {
        Self { all: Vec::new(), likely: [0; 64] }
    }
}

impl BlockKeys {
    /// Returns the index of `key` in [`BlockKeys::all`]. A new key is appended.
    #[inline]
    pub fn index(&mut self, key: BlockKey) -> usize {
        let likely = &mut self.likely[key.steps as usize % 64];
        if self.all.get(*likely) != Some(&key) {
            let index = self.all.iter().position(|other| *other == key);
            *likely = index.unwrap_or_else(|| {
                self.all.push(key);
                self.all.len() - 1
            });
        }
        *likely
    }
}
