//! The net of a whisker side: its stable sheet as tensors of trajectories.
//!
//! Coordinates are the contact `u = ln tau + tau` and the part `p` of the load, `|load| tau^2 = p exp(ln q(u))`. The scale `ln q` is a
//! polynomial near the logarithm of the fold's `|load| tau^2`. At a fixed contact every number of a state is an analytic function of the
//! load, through the fold and beyond, so a few plain trajectories at Chebyshev points of both coordinates represent the sheet, with
//! rows that end at the fold and rows that end at the tip alike. Nothing is solved: no trajectory belongs to a row.
//!
//! A panel is one tensor over the contacts of neighbouring rows. Its certificate has three parts: the decay of the last coefficients in
//! both coordinates, trajectories at places of its rows between the nodes, and the end of every row, which is computed apart
//! ([`Crossing`](crate::sheet::Crossing)).

mod bound;
mod certificate;
mod panel;
mod row;
mod size;

pub use bound::{MARGIN, VALUE_WEIGHT, larger, largest};
pub use row::{NetBlock, NetRow};

use crate::plan::net_cost;
use crate::sheet::fold::coordinate::u_of;
use crate::sheet::{Crossing, Sheet};
use certificate::certified_panel;
use panel::NetPanel;
use size::NetSize;

/// Maximum bound on the residual of a state of a net, in whisker lengths, where no tolerance is given.
pub const NET_RESIDUAL: f64 = 1e-10;

/// Smallest bound on the residual that trajectories of the finest steps allow, in whisker lengths: that of refined states.
const SMALLEST_RESIDUAL: f64 = 1e-12;

/// Largest range of contacts of a panel in `u`.
const WIDEST: f64 = 7.0;

/// Number of times that the rows of a panel without a certificate are halved.
const HALVINGS: u32 = 2;

/// Sizes that are tried for a panel: the first, and two that are expected to be enough.
const TRIES: usize = 3;

/// Net of a whisker side: certified panels, and the panel of each row.
#[derive(Clone, Debug)]
pub struct Net {
    panels: Vec<NetPanel>,
    /// Index of each row's panel; `None` for a row that the net does not have.
    panel_of: Vec<Option<usize>>,
}

/// A row of a panel.
#[derive(Clone, Copy, Debug)]
pub(in crate::sheet) struct PanelRow {
    /// Index of the row in its sheet.
    row: usize,
    /// Smallest and largest coordinate `u` of the contacts of the row.
    contacts: [f64; 2],
}

/// Range in `u` by which a panel extends beyond the contacts of its rows.
const BEYOND: f64 = 0.06;

impl PanelRow {
    /// Returns the range of contacts of a `row` of `sheet`; `None` if it has no simple span from first touch.
    ///
    /// The contact is at least as far along the whisker as it is from the base, and that is at least the pole's distance without its radius.
    fn new(sheet: &Sheet, row: usize) -> Option<Self> {
        let rod = &sheet.rod;
        let (end, place) = (simple_end(sheet, row)?, &sheet.rows[row]);
        let nearest = (place.pole_distance - rod.pole.abs()).min(place.contact);
        let touch = u_of(rod, rod.tau(place.contact.min(place.end)));
        let last = touch.max(u_of(rod, end.tau)) + BEYOND;
        let is_apart = nearest > 0.0;
        is_apart.then(|| Self {
            row,
            contacts: [u_of(rod, rod.tau(nearest)), last],
        })
    }
}

/// Returns the end of a `row` of `sheet`; `None` if it has no simple span from first touch.
#[must_use]
pub fn simple_end(sheet: &Sheet, row: usize) -> Option<&Crossing> {
    let [end] = &sheet.crossings[row][..] else {
        return None;
    };
    let is_simple = sheet.touches(row) && end.is_sound() && !end.is_at_touch();
    (is_simple && !sheet.is_continued()).then_some(end)
}

impl Net {
    /// Computes the net of `sheet` for rows with `cells(row)` cells, up to a residual of `most` whisker lengths, where that takes less time
    /// than the trajectories of the cells.
    ///
    /// A sheet with measured radii has none: states are not analytic where the contact passes from one radius to the next. `None` without a
    /// row, and where `most` is below the residual of refined states.
    #[must_use]
    pub fn new(sheet: &Sheet, cells: impl Fn(usize) -> usize, most: f64) -> Option<Self> {
        if sheet.rod.profile.is_some() || most < SMALLEST_RESIDUAL {
            return None;
        }
        let rows = (0..sheet.rows.len()).filter_map(|row| PanelRow::new(sheet, row));
        let mut rows: Vec<PanelRow> = rows.collect();
        rows.sort_by(|a, b| a.contacts[0].total_cmp(&b.contacts[0]));
        let mut net = Self {
            panels: Vec::new(),
            panel_of: vec![None; sheet.rows.len()],
        };
        net.cover(sheet, &rows, &cells, most, HALVINGS);
        (!net.panels.is_empty()).then_some(net)
    }

    /// Covers neighbouring rows with panels.
    fn cover(
        &mut self,
        sheet: &Sheet,
        rows: &[PanelRow],
        cells: &impl Fn(usize) -> usize,
        most: f64,
        halvings: u32,
    ) {
        let (Some(first), Some(last)) = (rows.first(), rows.last()) else {
            return;
        };
        let contacts = rows.iter().fold(first.contacts, |[from, to], own| {
            [from, to.max(own.contacts[1])]
        });
        let middle = first.contacts[0].midpoint(last.contacts[0]);
        let (near, far) = rows.split_at(rows.partition_point(|own| own.contacts[0] < middle));
        let may_halve = !near.is_empty() && !far.is_empty();
        if may_halve && contacts[1] - contacts[0] > WIDEST {
            self.cover(sheet, near, cells, most, halvings);
            self.cover(sheet, far, cells, most, halvings);
            return;
        }
        let count: usize = rows.iter().map(|own| cells(own.row)).sum();
        let pays = |size: NetSize| net_cost(size.states(), rows.len()) < count;
        if let Some(panel) = smallest_panel(sheet, rows, contacts, most, pays) {
            for own in rows {
                self.panel_of[own.row] = Some(self.panels.len());
            }
            self.panels.push(panel);
        } else if may_halve && halvings > 0 && pays(NetSize::first(most, contacts[1] - contacts[0]))
        {
            self.cover(sheet, near, cells, most, halvings - 1);
            self.cover(sheet, far, cells, most, halvings - 1);
        }
    }

    /// Returns the largest number of loads of a panel.
    #[must_use]
    pub fn loads(&self) -> usize {
        let loads = self.panels.iter().map(|panel| panel.size.loads);
        loads.max().unwrap_or(0)
    }

    /// Returns the states of `row` of `sheet`, with the bound on their residual in whisker lengths; `None` if the net does not have the row.
    #[must_use]
    pub fn row(&self, sheet: &Sheet, row: usize) -> Option<(NetRow, f64)> {
        let panel = &self.panels[self.panel_of[row]?];
        Some((panel.row(sheet, row)?, panel.residual))
    }
}

/// A certified panel over `contacts` with as few states as possible, found from small to large while the next size `pays`.
fn smallest_panel(
    sheet: &Sheet,
    rows: &[PanelRow],
    contacts: [f64; 2],
    most: f64,
    pays: impl Fn(NetSize) -> bool,
) -> Option<NetPanel> {
    let mut size = Some(NetSize::first(most, contacts[1] - contacts[0]));
    for _ in 0..TRIES {
        match certified_panel(sheet, rows, contacts, size.filter(|own| pays(*own))?, most) {
            Ok(panel) => return Some(panel),
            Err(enough) => size = enough,
        }
    }
    None
}
