//! Tests of the mechanics, without scenes, maps and devices.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod batches;
mod bytes;
mod chebyshev;
mod contact;
mod derivatives;
mod effects;
mod integrators;
mod radius;
mod resolution;
mod rest;
mod roots;
mod rough;
mod sensitivities;
mod strain;
