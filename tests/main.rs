//! All tests that need no special machine, in one program: linking the library once saves most of the build.
//!
//! `cargo test --test suite MODULE::` runs one module. `machine` needs a GPU; `portable` needs no features.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod accuracy;
mod cli;
mod design;
mod docs;
mod effects;
mod explore;
mod figures;
mod fit;
mod follicle;
mod force;
mod friction;
mod hard_cases;
mod hard_maps;
mod jumps;
mod locate;
mod maps;
mod plan;
mod regimes;
mod render;
mod scene;
mod sensitivity;
mod shaders;
mod store;
mod support;
mod table;
mod texture;
mod ties;
mod traced;
mod traces;
mod tracking;
mod uncertainty;
mod variations;
mod whisk;
mod yields;

use support::{compute, effect_sets, map, program, random_rods, sealed, shipped};
