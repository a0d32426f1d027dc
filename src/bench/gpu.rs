//! x
use super::task::Task;
use super::Report;
pub fn measure(_: &Task, _: usize, _: &mut Report, _: &mut dyn FnMut(&str)) {}
