//! Angles beyond a full turn.

use std::f64::consts::TAU;

/// `angle` plus the number of full turns that brings it nearest to `near`, all in radians.
#[must_use]
pub fn nearest_turn(angle: f64, near: f64) -> f64 {
    angle + TAU * ((near - angle) / TAU).round()
}
