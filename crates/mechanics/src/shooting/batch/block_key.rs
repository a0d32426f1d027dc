//! Which trajectories may share a block.

use super::{InitialCondition, Method};
use crate::rod::Effects;
use std::sync::Arc;

/// What the trajectories of a block have in common.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct BlockKey {
    /// Those of the kernel: the method's, and all of the rod's own; a profile only if it is the rod's own.
    pub effects: Effects,
    /// The address of the profile; 0 without one.
    profile: usize,
    /// Steps of a trajectory; 0 with a profile, along which each lane takes steps of its own.
    pub steps: u32,
}

impl BlockKey {
    /// That of a condition that takes so many `steps`.
    #[inline]
    pub fn new(
        method: Method,
        InitialCondition { rod, tau, .. }: &InitialCondition,
        steps: u32,
    ) -> Self {
        let profile = rod.profile.as_ref();
        Self {
            effects: Effects {
                // Pieces are integrated in a way of their own.
                profile: profile.is_some(),
                ..method.effects.and(rod).reaching(rod.taper * tau)
            },
            profile: profile.map_or(0, |profile| Arc::as_ptr(profile).addr()),
            steps,
        }
    }

    /// Whether the two can share a padded block, which takes the steps of the one that needs more.
    pub fn may_pad(&self, other: &Self) -> bool {
        let but_steps = |key: &Self| (key.effects, key.profile);
        but_steps(self) == but_steps(other)
    }
}

/// The keys of a batch.
pub struct BlockKeys {
    /// Each of them once.
    pub all: Vec<BlockKey>,
    /// The index of the last one with as many steps, give or take multiples of 64.
    likely: [usize; 64],
}

impl Default for BlockKeys {
    fn default() -> Self {
        Self {
            all: Vec::new(),
            likely: [0; 64],
        }
    }
}

impl BlockKeys {
    /// The index of `key` among all; it is the last one if it is new.
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
