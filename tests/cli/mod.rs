//! Tests of the program: arguments, files, messages, exit codes.
#![allow(clippy::unwrap_used, reason = "a test that cannot set up its files should stop")]

mod bench;
mod branch;
mod columns;
mod compare;
mod computed;
mod curve;
mod damage;
mod data;
mod design;
mod digits;
mod engine;
mod explore;
mod extract;
#[cfg(target_os = "linux")]
mod faults;
// Devices, named pipes and links.
#[cfg(unix)]
mod files;
mod fit;
mod force;
mod import;
mod integrity;
mod leftovers;
mod locate;
mod manual;
mod map;
mod marks;
mod numbers;
mod other;
mod paper;
mod pictures;
mod plan;
use crate::program;
// Links and modes.
#[cfg(unix)]
mod protected;
mod refused;
mod render;
use crate::sealed;
mod sensitivity;
mod shape;
mod signals;
// Redirection by a shell.
#[cfg(unix)]
mod stdout;
mod store;
// Slurm, and its shell.
#[cfg(unix)]
mod submit;
mod table;
#[cfg(unix)]
mod terminal;
mod texture;
mod tolerance;
mod traces;
mod uncertainty;
mod units;
mod verdict;
mod whisk;
#[cfg(windows)]
mod windows;
mod yields;

use program::{Place, Run, SCENE, names, no_file, no_folder, words};
