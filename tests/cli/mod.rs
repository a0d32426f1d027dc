//! Tests of the program: arguments, files, messages, exit codes.
#![allow(
    clippy::unwrap_used,
    reason = "a test that cannot set up its files should stop"
)]

mod bench;
mod branch;
mod compare;
mod curve;
#[cfg(unix)]
mod damage;
mod data;
mod design;
#[cfg(unix)]
mod digits;
mod engine;
mod explore;
mod extract;
#[cfg(target_os = "linux")]
mod faults;
#[cfg(unix)]
mod files;
mod fit;
mod force;
#[cfg(unix)]
mod integrity;
#[cfg(unix)]
mod leftovers;
mod manual;
mod map;
mod marks;
mod other;
mod paper;
mod pictures;
mod plan;
use crate::program;
#[cfg(unix)]
mod protected;
mod refused;
mod render;
use crate::sealed;
mod sensitivity;
mod shape;
#[cfg(unix)]
mod signals;
#[cfg(unix)]
mod stdout;
#[cfg(unix)]
mod store;
#[cfg(unix)]
mod submit;
mod sweep;
#[cfg(unix)]
mod terminal;
mod texture;
mod tolerance;
mod traces;
mod uncertainty;
mod units;
mod verdict;
mod whisk;

use program::{Place, Run, SCENE, names};
