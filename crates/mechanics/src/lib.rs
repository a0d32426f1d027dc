//! Mechanics of one whisker in front of one pole: [`numerics`], the [`rod`], and its integration from contact to base ([`shooting`]).
//! `whiskmap` builds sheets, maps and curves from it.

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod numerics;
pub mod rod;
pub mod shooting;
