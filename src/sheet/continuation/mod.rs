//! Continuation along `D = const`: the states in front of one pole.

pub mod branch_steps;
pub mod level_curve;
pub mod pieces;
mod state_at_push;
