//! Angles that go on growing.

use std::f64::consts::TAU;

/// `angle` plus the whole turns that bring it nearest to `near`.
#[must_use]
pub fn nearest_turn(angle: f64, near: f64) -> f64 {
    angle + TAU * ((near - angle) / TAU).round()
}
