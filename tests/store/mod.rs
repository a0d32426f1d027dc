//! What is written comes back, whole or not at all.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that cannot set up its files should stop"
)]

mod comes_back;
mod computed;
mod damage;
mod flipped_bits;
mod identity;
mod made_up;
mod refused;
// Windows replaces no file that is open.
#[cfg(unix)]
mod replaced;

use crate::map;
use crate::sealed;

type Swept = Option<Vec<f64>>;

/// One whisker, and an atlas of three tapers by two curvatures.
fn sweeps() -> [(Swept, Swept); 2] {
    [(None, None), (Some(vec![0.5, 0.75, 0.95]), Some(vec![0.0, 0.012]))]
}
