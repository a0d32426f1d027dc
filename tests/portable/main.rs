//! Tests that need no feature of the library, for `tests/portable/run.sh`.

#[path = "../bytes.rs"]
mod bytes;
#[path = "../physics.rs"]
mod physics;
