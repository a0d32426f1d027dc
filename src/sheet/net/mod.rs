//! The net of a whisker side: its stable sheet as tensors of trajectories.
//!
//! Coordinates are the contact `u = ln tau + tau` and the part `p` of the load, `|load| tau^2 = p exp(ln q(u))`. The scale `ln q` is a
//! polynomial near the logarithm of the fold's `|load| tau^2`. At a fixed contact every number of a state is an analytic function of the
//! load, through the fold and beyond, so a few trajectories at Chebyshev points of both coordinates represent the sheet, with
//! rows that end at the fold and rows that end at the tip alike. Nothing is solved: no trajectory belongs to a row.
//!
//! A panel is one tensor over the contacts of neighbouring rows. Guesses come from panels with the place of the pole and the Jacobian
//! (`guesses.rs`), which also show all folds. The values of cells come from panels of an engine's accuracy (`values.rs`). Their certificate
//! has three parts: the decay of the last coefficients in both coordinates, trajectories at places of their rows between the nodes, and the end
//! of every row, which is computed apart ([`Crossing`](crate::sheet::Crossing)).

mod bound;
mod certificate;
mod guesses;
mod panel;
mod row;
mod size;
mod values;

pub use bound::{MARGIN, VALUE_WEIGHT, larger, largest};
pub use row::{NetBlock, NetRow};
pub use values::ValueNet;

use crate::sheet::Row;
use crate::sheet::fold::coordinate::u_of;
use crate::sheet::row::REACH_SLACK;
pub use guesses::PUSH_MARGIN;
pub(super) use guesses::{FOLD_ERROR, GUESS_ERROR, GuessPanel};
use size::NetSize;
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
}

impl PanelRow {
    /// Returns the range of contacts of the `row` at `place`; `None` if it has none, as the pole is out of reach, or if the base may be inside the
    /// pole.
    ///
    /// The contact is at least as far along the whisker as it is from the base, and that is at least the pole's distance without its radius. It
    /// is at most that of first touch, or the `last`.
    fn new(rod: &Rod, row: usize, place: &Row, last: f64) -> Option<Self> {
        let reach = place.contact.min(place.end);
        let nearest = place.pole_distance - rod.pole.abs();
        let has_contacts = nearest > 0.0 && nearest <= place.end + REACH_SLACK;
        let nearest = nearest.min(reach);
        let last = last.max(rod.tau(reach));
        has_contacts.then(|| Self {
            row,
            contacts: [u_of(rod, rod.tau(nearest)), u_of(rod, last) + BEYOND],
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

/// Rows of a sheet that panels are made for.
struct PanelRows<'a> {
    rod: &'a Rod,
    /// All rows of the sheet.
    rows: &'a [Row],
    /// Error that the first size of a panel is chosen for, in whisker lengths.
    aim: f64,
}

impl PanelRows<'_> {
    /// Makes panels for those rows to which `last` gives the `tau` of a last contact.
    ///
    /// `make` computes the panel of a size for neighbouring rows over their range of contacts. If that is not accurate enough, it returns the size
    /// that is expected to be, if any. Sizes that do not pay are left out. Rows without a panel are halved and tried again.
    fn panels<P>(
        &self,
        last: impl Fn(usize, &Row) -> Option<f64>,
        pays: impl Fn(NetSize, &[PanelRow]) -> bool,
        make: impl Fn(&[PanelRow], [f64; 2], NetSize) -> Result<P, Option<NetSize>>,
    ) -> Panels<P> {
        let places = self.rows.iter().enumerate().filter_map(|(row, place)| {
            let last = last(row, place)?;
            PanelRow::new(self.rod, row, place, last)
        });
        // The contacts of a long row go to the tip of a perfect cone.
        let (mut long, mut places): (Vec<PanelRow>, Vec<PanelRow>) =
            places.partition(|own| own.contacts[1] - own.contacts[0] > WIDEST);
        for places in [&mut long, &mut places] {
            places.sort_by(|a, b| a.contacts[0].total_cmp(&b.contacts[0]));
        }
        let mut found = Panels {
            panels: Vec::new(),
            panel_of: vec![None; self.rows.len()],
            are_complete: true,
        };
        let mut open = vec![(&long[..], 0), (&places[..], HALVINGS)];
        while let Some((rows, halvings)) = open.pop() {
            let (Some(first), Some(last)) = (rows.first(), rows.last()) else {
                continue;
            };
            let contacts = rows.iter().fold(first.contacts, |[from, to], own| {
                [from, to.max(own.contacts[1])]
            });
            let middle = first.contacts[0].midpoint(last.contacts[0]);
            let (near, far) = rows.split_at(rows.partition_point(|own| own.contacts[0] < middle));
            let range = contacts[1] - contacts[0];
            let may_halve = halvings > 0 && !near.is_empty() && !far.is_empty();
            if may_halve && range > WIDEST {
                open.extend([(near, halvings), (far, halvings)]);
                continue;
            }
            let first_size = NetSize::first(self.aim, range);
            let mut size = Some(first_size);
            let made = (0..TRIES).find_map(|_| {
                let next = size.filter(|own| pays(*own, rows))?;
                make(rows, contacts, next)
                    .map_err(|enough| size = enough)
                    .ok()
            });
            if let Some(panel) = made {
                for own in rows {
                    found.panel_of[own.row] = Some(found.panels.len());
                }
                found.panels.push(panel);
            } else if may_halve && pays(first_size, rows) {
                open.extend([(near, halvings - 1), (far, halvings - 1)]);
            } else {
                found.are_complete = false;
            }
        }
        found
    }
}

impl<P> Panels<P> {
    /// Returns the panel of `row`; `None` if it has none.
    pub(super) fn of(&self, row: usize) -> Option<&P> {
        Some(&self.panels[self.panel_of[row]?])
    }

    /// Returns all panels if every row with contacts has one.
    pub(super) fn of_all_rows(&self) -> Option<&[P]> {
        self.are_complete.then_some(&self.panels[..])
    }
}
