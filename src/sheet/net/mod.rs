//! The net of a whisker side: its stable sheet as tensors of trajectories.
//!
//! Coordinates are the contact `u = ln tau + tau` and the part `p` of the load, `|load| tau^2 = p exp(ln q(u))`. The scale `ln q` is a
//! polynomial near the logarithm of the fold's `|load| tau^2`. At a fixed contact every number of a state is an analytic function of the
//! load, through the fold and beyond, so a few trajectories at Chebyshev points of both coordinates represent the sheet, with
//! rows that end at the fold and rows that end at the tip alike. Nothing is solved: no trajectory belongs to a row.
//!
//! A panel is one tensor over the contacts of neighbouring rows. Guesses come from panels with the place of the pole and the Jacobian
//! (`guesses.rs`, `guess_row.rs`), which also show all folds. The values of cells come from panels of an engine's accuracy (`values.rs`). Their certificate
//! has three parts: the decay of the last coefficients in both coordinates, trajectories at places of their rows between the nodes, and the end
//! of every row, which is computed apart ([`Crossing`](crate::sheet::Crossing)).

mod bound;
mod certificate;
mod guess_row;
mod guesses;
mod panel;
mod row;
mod size;
mod values;

pub use bound::{MARGIN, VALUE_WEIGHT, larger, largest};
pub use row::{NetBlock, NetRow};
pub(crate) use values::ValueDraft;
pub use values::ValueNet;

use crate::sheet::Row;
use crate::sheet::fold::coordinate::u_of;
use crate::sheet::row::REACH_SLACK;
pub(super) use guess_row::GuessRow;
pub use guess_row::PUSH_MARGIN;
pub(super) use guesses::{FOLD_ERRORS, GUESS_ERRORS, GuessPanel, KNOWN_ROW_ERRORS};
use size::NetSize;
use std::ops::Range;
use whiskmap_mechanics::rod::Rod;

/// Maximum bound on the residual of a state of a net, in whisker lengths, where no tolerance is given.
pub const NET_RESIDUAL: f64 = 1e-10;

/// Largest range of contacts in `u` of a panel, and of a row that does not count as long.
const WIDEST: f64 = 7.0;

/// Number of times that the rows of a panel that is not accurate enough are halved.
const HALVINGS: u32 = 2;

/// Sizes that are tried for a panel: the first, and two that are expected to be enough.
const TRIES: usize = 3;

/// Range in `u` by which a panel extends beyond the contacts of its rows.
const BEYOND: f64 = 0.06;

/// A row of a panel.
#[derive(Clone, Copy, Debug)]
struct PanelRow {
    /// Index of the row in its sheet.
    row: usize,
    /// Smallest and largest coordinate `u` of the contacts of the row.
    contacts: [f64; 2],
    /// Number of cells of the row.
    cells: usize,
}

impl PanelRow {
    /// Returns the `row` at `place` with its range of contacts and its number of `cells`. `None` if it has no contacts: the pole is out of reach,
    /// or the base may be inside the pole.
    ///
    /// The contact is at least as far along the whisker as it is from the base, and this distance is at least the pole's distance without its
    /// radius. The contact is at most as far along as at first touch, or at the `last` contact.
    fn new(rod: &Rod, row: usize, place: &Row, last: f64, cells: usize) -> Option<Self> {
        let reach = place.contact.min(place.end);
        let nearest = place.pole_distance - rod.pole.abs();
        let has_contacts = nearest > 0.0 && nearest <= place.end + REACH_SLACK;
        let nearest = nearest.min(reach);
        let last = last.max(rod.tau(reach));
        has_contacts.then(|| Self {
            row,
            contacts: [u_of(rod, rod.tau(nearest)), u_of(rod, last) + BEYOND],
            cells,
        })
    }
}

/// Panels of a sheet, and the panel of each row.
#[derive(Clone, Debug)]
pub struct Panels<P> {
    panels: Vec<P>,
    /// Index of each row's panel; `None` for a row without one.
    panel_of: Vec<Option<usize>>,
    /// True if every row with contacts that a panel was made for has one.
    are_complete: bool,
}

/// Panel that is to be made next.
#[derive(Clone, Debug)]
struct Attempt {
    /// Indices of the panel's rows in its queue: neighbours.
    rows: Range<usize>,
    /// Range of the contacts of the rows in `u`.
    contacts: [f64; 2],
    size: NetSize,
    /// Number of sizes that have been tried.
    tries: usize,
    /// Number of times that the rows may still be halved.
    halvings: u32,
}

/// Panels of a sheet in the making. An attempt that is not accurate enough is followed by one with more states, or by one for each half of its
/// rows.
#[derive(Debug)]
struct PanelQueue<P> {
    /// Error that the first size of a panel is chosen for, in whisker lengths.
    aim: f64,
    /// Returns true if a panel of a size pays for its rows.
    pays: fn(NetSize, &[PanelRow]) -> bool,
    /// Rows with contacts, by their smallest contact; the long ones, which go to the tip of a perfect cone, come first.
    rows: Vec<PanelRow>,
    open: Vec<Attempt>,
    found: Panels<P>,
}

impl<P> PanelQueue<P> {
    /// Begins panels for some `rows` of a sheet that has `count` rows.
    fn new(
        aim: f64,
        pays: fn(NetSize, &[PanelRow]) -> bool,
        count: usize,
        rows: impl Iterator<Item = PanelRow>,
    ) -> Self {
        let is_long = |row: &PanelRow| row.contacts[1] - row.contacts[0] > WIDEST;
        let (mut rows, mut others): (Vec<_>, Vec<_>) = rows.partition(is_long);
        for rows in [&mut rows, &mut others] {
            rows.sort_by(|a, b| a.contacts[0].total_cmp(&b.contacts[0]));
        }
        let long = rows.len();
        rows.append(&mut others);
        let all = rows.len();
        let mut queue = Self {
            aim,
            pays,
            rows,
            open: Vec::new(),
            found: Panels { panels: Vec::new(), panel_of: vec![None; count], are_complete: true },
        };
        queue.begin(0..long, 0);
        queue.begin(long..all, HALVINGS);
        queue
    }

    /// Begins the panel of some `rows`, or two panels of half the rows where contacts are too far apart for one panel.
    fn begin(&mut self, rows: Range<usize>, halvings: u32) {
        let panel_rows = &self.rows[rows.clone()];
        let Some(first) = panel_rows.first() else {
            return;
        };
        let contacts = panel_rows
            .iter()
            .fold(first.contacts, |[from, to], row| [from, to.max(row.contacts[1])]);
        let range = contacts[1] - contacts[0];
        let size = NetSize::first(self.aim, range);
        match self.halves(&rows, halvings) {
            Some(halves) if range > WIDEST => {
                for half in halves {
                    self.begin(half, halvings);
                }
            }
            _ if (self.pays)(size, panel_rows) => {
                self.open.push(Attempt { rows, contacts, size, tries: 1, halvings })
            }
            _ => self.found.are_complete = false,
        }
    }

    /// Returns the two halves of `rows` by their contacts; `None` if one has no rows, or if they may not be halved.
    fn halves(&self, rows: &Range<usize>, halvings: u32) -> Option<[Range<usize>; 2]> {
        let panel_rows = &self.rows[rows.clone()];
        let (first, last) = (panel_rows.first()?, panel_rows.last()?);
        let middle = first.contacts[0].midpoint(last.contacts[0]);
        let near = panel_rows.partition_point(|row| row.contacts[0] < middle);
        let between = rows.start + near;
        let may_halve = halvings > 0 && (1..panel_rows.len()).contains(&near);
        may_halve.then_some([rows.start..between, between..rows.end])
    }

    /// Returns the rows of an attempt.
    fn rows_of(&self, attempt: &Attempt) -> &[PanelRow] {
        &self.rows[attempt.rows.clone()]
    }

    /// Stores the panel that was `made`, or opens the next attempts: the size that is expected to be accurate enough, or else both halves of the
    /// rows.
    fn store(&mut self, attempt: Attempt, made: Result<P, Option<NetSize>>) {
        match made {
            Ok(panel) => {
                for row in &self.rows[attempt.rows] {
                    self.found.panel_of[row.row] = Some(self.found.panels.len());
                }
                self.found.panels.push(panel);
            }
            Err(Some(size))
                if attempt.tries < TRIES && (self.pays)(size, self.rows_of(&attempt)) =>
            {
                self.open.push(Attempt { size, tries: attempt.tries + 1, ..attempt });
            }
            Err(_) => match self.halves(&attempt.rows, attempt.halvings) {
                Some(halves) => {
                    for half in halves {
                        self.begin(half, attempt.halvings - 1);
                    }
                }
                None => self.found.are_complete = false,
            },
        }
    }
}

impl<P> Panels<P> {
    /// Returns the panel of `row`; `None` if it has none.
    pub(super) fn of(&self, row: usize) -> Option<&P> {
        Some(&self.panels[self.panel_of[row]?])
    }

    /// Returns each panel with its rows among `rows`, as their places there.
    pub(super) fn with_rows(&self, rows: &[usize]) -> impl Iterator<Item = (&P, Vec<usize>)> {
        self.panels.iter().enumerate().map(move |(panel, found)| {
            let is_of_panel = |place: &usize| self.panel_of[rows[*place]] == Some(panel);
            (found, (0..rows.len()).filter(is_of_panel).collect())
        })
    }

    /// Returns all panels if every row with contacts has one.
    pub(super) fn of_all_rows(&self) -> Option<&[P]> {
        self.are_complete.then_some(&self.panels[..])
    }
}

/// Returns the cone of the paper on this side, for tests.
#[cfg(test)]
fn cone(side: whiskmap_mechanics::rod::Side) -> Rod {
    Rod { taper: 0.95, bend: 0.4, pole: 0.0125 * side.sign(), ..Rod::default() }
}
