//! Intervals of rows, and the coordinate of a row in a patch.
//!
//! For rows that end at the fold, the coordinate is the logarithm of `tau` at first touch. For rows that end at the tip, it is the load
//! there. In these coordinates every number is analytic, the fold and the turning point of the distance along the tip included.

use super::exact_row::simple_end;
use crate::rod::{Rest, arclength};
use crate::sheet::{Edge, Row, Sheet};
use crate::shooting::ShootingMap;
use crate::shooting::batch::{Batch, InitialCondition, Method};

/// Interval of rows that end at one edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RowInterval {
    /// Edge of the sheet at which the rows of the interval end.
    pub edge: Edge,
    /// Coordinates of the first and of the last row of the interval: `[first, last]`.
    pub ends: [f64; 2],
}

impl RowInterval {
    /// Returns the coordinate of a row of `sheet` in a patch, with the edge where it ends; `None` if it has no simple span from first
    /// touch.
    pub fn coordinate(sheet: &Sheet, row: usize) -> Option<(Edge, f64)> {
        let end = simple_end(sheet, row)?;
        let coordinate = match end.edge {
            Edge::Fold => libm::log(sheet.rod.tau(sheet.rows[row].contact)),
            Edge::Tip => end.load,
        };
        Some((end.edge, coordinate))
    }

    /// Returns the rows at parts of the interval.
    pub fn rows(&self, method: Method, sheet: &Sheet, parts: &[f64]) -> Vec<Row> {
        let (rod, rest) = (&sheet.rod, Rest::new(&sheet.rod));
        let [from, to] = self.ends;
        let coordinates = parts.iter().map(|part| from + part * (to - from));
        match self.edge {
            Edge::Fold => {
                let contacts = coordinates.map(|ln_tau| arclength(rod, libm::exp(ln_tau)));
                let distances = contacts.map(|contact| rest.at_arclength(contact).0.length());
                distances
                    .map(|distance| Row::new(&rest, distance))
                    .collect()
            }
            Edge::Tip => {
                let tau = rod.tau_tip();
                let at_tip = coordinates.map(|load| InitialCondition { rod, tau, load });
                let maps: Vec<ShootingMap> = Batch::new(method).shoot(&at_tip.collect::<Vec<_>>());
                let distances = maps
                    .iter()
                    .map(|map| rest.distance_of_pole(map.pole.length()));
                distances
                    .map(|distance| Row::new(&rest, distance))
                    .collect()
            }
        }
    }
}
