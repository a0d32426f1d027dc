//! Reasons why a run has no plan.

use super::MEMORY_LIMIT;

/// Error of a run that takes more than [`MEMORY_LIMIT`], or that has no such channels.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum PlanError {
    /// One panel takes more memory than is allowed.
    #[error(
        "grid: {push_angles} push angles x {distances} distances make a panel of {cells} cells that takes \
         {needed} MiB: must be at most {limit} MiB; lower grid.push_angle_deg.count or grid.distance_mm.count",
        cells = push_angles * distances,
        limit = MEMORY_LIMIT >> 20
    )]
    Panel {
        /// Number of push angles of the grid.
        push_angles: usize,
        /// Number of distances of the grid.
        distances: usize,
        /// Memory of the run, in MiB.
        needed: u64,
    },
    /// The panels of all whiskers together take more memory than is allowed.
    #[error(
        "grid: {whiskers} panels of {cells} cells take {needed} MiB in memory: must be at most {limit} MiB; \
         take one panel at a time with `for_each_panel`, or lower the counts of the axes",
        limit = MEMORY_LIMIT >> 20
    )]
    AllPanels {
        /// Number of whiskers of the sweep.
        whiskers: usize,
        /// Number of cells of one panel.
        cells: usize,
        /// Memory of the run, in MiB.
        needed: u64,
    },
    /// The derivatives of the panels take more memory than is allowed.
    #[error(
        "channels: with {derivatives} derivatives, {cells} cells in memory take {needed} MiB: must be at most {limit} MiB; \
         select fewer derivatives",
        limit = MEMORY_LIMIT >> 20
    )]
    Derivatives {
        /// Number of parameters by which there are derivatives.
        derivatives: usize,
        /// Number of cells in memory together.
        cells: usize,
        /// Memory of the run, in MiB.
        needed: u64,
    },
    /// A derivative is by a number that the scene does not give.
    #[error("channels: {name} has no values: the scene has derivatives by {given}")]
    NotGiven {
        /// Name of the channel.
        name: &'static str,
        /// Names of the parameters by which there are derivatives.
        given: String,
    },
}
