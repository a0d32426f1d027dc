//! The mechanics by themselves: no scene, no map, no device.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod batches;
mod bytes;
mod contact;
mod effects;
mod integrators;
mod radius;
mod resolution;
mod rest;
mod rough;
