//! The mechanics of one whisker in front of one pole: [`numerics`], the [`rod`], and how it is shot from its contact
//! ([`shooting`]). `whiskmap` builds sheets, maps and curves from it. [`account`] tells what threads spend their time on.

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod account;
pub mod numerics;
pub mod rod;
pub mod shooting;
