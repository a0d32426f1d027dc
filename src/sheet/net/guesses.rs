//! Panels for guesses: tensors of `ln D`, `phi` and the determinant, by coarse trajectories. They give the Newton starts of cells, and show all
//! folds.
//!
//! `det J D^2` over its value at a load between first touch and the first fold is a smooth function of contact and load. Divided by the part of
//! the load that is left to the first fold, it is the clearance, which is positive where there is no other fold.

use super::bound::{MARGIN, larger};
use super::panel::{NetPanel, TOP, along, contacts_of};
use super::size::NetSize;
use super::{Attempt, PanelQueue, PanelRow, Panels};
use crate::sheet::case::SheetCase;
use crate::sheet::fold::contact_nodes::ContactNodes;
use crate::sheet::fold::coordinate::u_of;
use crate::sheet::fold::{directions, surely_stable};
use crate::sheet::{Crossing, Row};
use std::f64::consts::FRAC_PI_2;
use whiskmap_mechanics::numerics::expansion::{Chebyshev, MOST_POINTS, chebyshev_points};
use whiskmap_mechanics::numerics::tensor::ChebyshevTensor;
use whiskmap_mechanics::numerics::{LaneNumbers, WIDTH, nearest_turn};
use whiskmap_mechanics::rod::{Rod, arclength};
use whiskmap_mechanics::shooting::ShootingMap;

/// Largest errors of `ln D` and `phi` of guesses, estimated from the last coefficients. Panels have the second one if panels with the first one do not
/// show all folds. The error is mostly much smaller. The step of Newton's method from nearly every guess is then short enough to be the last.
/// The steps of coarse trajectories change with the load, which leaves up to 6e-6. With measured radii, states are not analytic where the contact
/// passes from one radius to the next, and few panels have the smaller error.
pub const GUESS_ERRORS: [f64; 2] = [3e-7, 1e-5];

/// [`GUESS_ERRORS`] of panels for known rows, of which few cells need guesses. From one guess in three, Newton's method takes a second trajectory.
pub const KNOWN_ROW_ERRORS: [f64; 1] = [GUESS_ERRORS[1]];

/// [`GUESS_ERRORS`] of panels that only show the folds. At the tip of a perfect cone, and with measured radii, panels need the smaller error. The
/// first size for 1e-3 has one load less, which is mostly not enough: a second try then takes as long as the first.
pub const FOLD_ERRORS: [f64; 2] = [9e-4, 1e-5];

/// Smallest number of points of contact and scale of the load as functions of `u`.
const ALONG: usize = 16;

/// Functions of a state, `[function]`: `ln D`, direction `phi` of the pole in radians, and minus the determinant `det J D^2` over the magnitude of its
/// value at a load between.
type Functions = [f64; 3];

/// Index of the determinant in [`Functions`].
const DETERMINANT: usize = 2;

/// Weights that convert errors of the functions to whisker lengths. The error of the determinant is a part of its certificate.
const WEIGHTS: Functions = [1.0, 1.0, 0.0];

/// Samples for each polynomial in both variables that are tried one after the other, with the smallest clearance, in parts of the largest, that
/// counts as positive between them: `(samples, clearance)`. A polynomial of degree `n` whose values at `m n` Chebyshev points are in `[-1, 1]` is
/// at most `1/cos(pi/(2 m))` between them (H. Ehlich and K. Zeller, Math. Z. 86, 41, 1964). So deviations of a polynomial of two variables from
/// the middle grow by at most 1.334 and 1.072. The clearance is nearly one: the fold divides it. This is a margin, not a
/// proof.
const SAMPLES: [(usize, f64); 2] = [(3, 0.143), (6, 0.035)];

/// Largest difference between the load of a fold by the panel and by the contact nodes, relative to the load.
const FOLD_OFF: f64 = 1e-2;

/// Panel for guesses.
#[derive(Clone, Debug)]
pub struct GuessPanel {
    pub(super) panel: NetPanel<3>,
    /// Error of `ln D` and `phi` by the coefficients left out.
    pub(super) error: f64,
}

impl Panels<GuessPanel> {
    /// Returns the panels of `rows` between `contacts`, with this `error` of `ln D` and `phi`.
    pub fn for_guesses(case: SheetCase, contacts: &ContactNodes, rows: &[Row], error: f64) -> Self {
        // The first contact node whose fold is farther than a row is beyond the row's last contact.
        let last = |row: &Row| {
            let mut folds = contacts.folds[..contacts.tip].iter();
            let fold = folds.find(|fold| fold.distance() > row.pole_distance);
            fold.map_or(case.rod.tau_tip(), |fold| fold.tau)
        };
        let places = rows.iter().enumerate();
        let places = places.filter_map(|(i, row)| PanelRow::new(case.rod, i, row, last(row), 0));
        let mut queue = PanelQueue::new(error, |_, _| true, rows.len(), places);
        while let Some(attempt) = queue.open.pop() {
            let Attempt { contacts: range, size, .. } = attempt;
            let along = along(case.rod, contacts, range, size.contacts.max(ALONG));
            let made = GuessPanel::new(case, range, along, size, error);
            queue.store(attempt, made);
        }
        queue.found
    }

    /// Returns true if the contact at `tau` of `rod` is in a panel.
    pub fn cover(&self, rod: &Rod, tau: f64) -> bool {
        let mut panels = self.panels.iter();
        panels.any(|panel| (0.0..=1.0).contains(&panel.panel.place(rod, tau)))
    }
}

impl GuessPanel {
    /// Computes the panel of `size` over the `range` of contacts.
    ///
    /// # Errors
    /// If the panel's error exceeds `most`: the size whose error is expected to be small enough, or `None` without such a size.
    fn new(
        case: SheetCase,
        range: [f64; 2],
        along: Chebyshev<2>,
        size: NetSize,
        most: f64,
    ) -> Result<Self, Option<NetSize>> {
        let tensor = tensor(case, size, &along);
        let panel = NetPanel::new(range, along, size, tensor, columns(size));
        let tails = panel.tails(&WEIGHTS);
        // NaN is not below any bound.
        let error = larger(tails[0].last, tails[1].last);
        let has_converged = error <= most;
        if has_converged {
            Ok(Self { panel, error })
        } else {
            Err(size.enough(tails, MARGIN * most))
        }
    }

    /// Returns a bound on the residual of all states along each of some rows from first touch to its only other end, in whisker lengths: `[row]`. It has
    /// the coefficients left out of the panel, and the misses of the panel at both ends, which are computed apart. NaN if a row is not in the panel.
    pub fn residuals(&self, case: SheetCase, rows: &[(&Row, &Crossing)]) -> Vec<f64> {
        let places = rows.iter().flat_map(|(row, end)| {
            let touch = row.first_touch(case.rod).x;
            let part = self.panel.part(case.rod, end);
            [(touch, 0.0), (end.tau, part)].map(|(tau, part)| {
                let place = [self.panel.place(case.rod, tau), part / TOP];
                let is_inside = place.iter().all(|place| (0.0..=1.0).contains(place));
                if is_inside { place } else { [f64::NAN; 2] }
            })
        });
        let states = self.panel.tensor.at(&places.collect::<Vec<_>>());
        let sign = case.side.sign();
        let residual = |((row, end), states): (&(&Row, &Crossing), &[[f64; 2]])| {
            let touch = nearest_turn(row.touch, states[0][1]);
            let level = libm::log(row.pole_distance);
            let ends = states.iter().zip([0.0, end.push]);
            let error = ends.fold(self.error, |error, ([ln_distance, phi], push)| {
                let turned = sign * (phi - touch);
                larger(error, larger((ln_distance - level).abs(), (turned - push).abs()))
            });
            MARGIN * error * row.pole_distance
        };
        rows.iter().zip(states.chunks(2)).map(residual).collect()
    }

    /// Returns true if the panel shows that no fold lies before the first folds of `contacts`: the determinant does not vanish at smaller loads,
    /// neither at the contact nodes nor between them.
    pub fn shows_folds(&self, rod: &Rod, contacts: &ContactNodes) -> bool {
        let [in_contact, in_load] = self.panel.tensor.tails().map(|[last, _]| last[DETERMINANT]);
        let error = MARGIN * larger(in_contact, in_load);
        let determinant = self.panel.tensor.transposed(DETERMINANT);
        SAMPLES.iter().any(|(over, smallest)| {
            let clearances = self.clearances(&determinant, *over, rod, contacts);
            clearances.is_some_and(|[least, largest]| least > smallest * largest + error)
        })
    }

    /// Returns the smallest and the largest clearance of a `determinant` over the parts of the ranges of loads and contacts at `over` samples for each
    /// polynomial. `None` if its zero next to first touch is not the fold of `contacts`.
    fn clearances(
        &self,
        determinant: &ChebyshevTensor<1>,
        over: usize,
        rod: &Rod,
        contacts: &ContactNodes,
    ) -> Option<[f64; 2]> {
        let [in_p, in_u] = determinant.counts();
        // Between the Chebyshev points are the contact nodes, where folds are exact.
        let [from, to] = self.panel.contacts;
        let folds = contacts.folds.iter();
        let at_folds = folds.map(|fold| (u_of(rod, fold.tau) - from) / (to - from));
        let inside = at_folds.filter(|place| (0.0..=1.0).contains(place));
        let places: Vec<f64> = points(over * in_u).chain(inside).collect();
        let columns = determinant.columns(&places);
        // The place in the range of loads itself is found along with the zeros of the determinant.
        let place = Chebyshev { coefficients: vec![[0.5], [0.5]] };
        let zeros = columns.level(0.0, &place)?;
        let folds: Vec<LaneNumbers> = zeros.iter().map(|zero| zero.along[0]).collect();
        let mut stable = 1.0;
        for (place, fold) in places.iter().zip(folds.as_flattened()) {
            let [surely_stable, known] = self.loads_at(rod, contacts, *place);
            // NaN is not near any load.
            let is_known = (fold - known).abs() <= FOLD_OFF * known;
            if !is_known {
                return None;
            }
            stable = f64::min(stable, surely_stable);
        }
        let samples = points(over * in_p).map(|part| stable + part * (1.0 - stable));
        let (mut least, mut largest) = ([f64::INFINITY; WIDTH], [-f64::INFINITY; WIDTH]);
        let mut sums = [0.0; WIDTH];
        let clearances = columns.quotients(&folds, &samples.collect::<Vec<_>>());
        for clearances in clearances.iter().flatten() {
            for (lane, clearance) in clearances.iter().enumerate() {
                least[lane] = least[lane].min(*clearance);
                largest[lane] = largest[lane].max(*clearance);
                sums[lane] += clearance;
            }
        }
        // A clearance that is NaN is in a sum, though not in a range.
        let are_known = sums.iter().all(|sum| sum.is_finite());
        let least = least.into_iter().fold(f64::INFINITY, f64::min);
        let largest = largest.into_iter().fold(-f64::INFINITY, f64::max);
        are_known.then_some([least, largest])
    }

    /// Returns two places in the range of loads of the contact at `place`: the end of the surely stable loads, and the first fold of `contacts`.
    fn loads_at(&self, rod: &Rod, contacts: &ContactNodes, place: f64) -> [f64; 2] {
        let [from, to] = self.panel.contacts;
        let [ln_tau, ln_q] = self.panel.along.at(place);
        let tau = libm::exp(ln_tau);
        let surely_stable = surely_stable(rod) * (tau / arclength(rod, tau)).powi(2);
        let fold = contacts.fold_ln_q(from + place * (to - from));
        [surely_stable * libm::exp(-ln_q) / TOP, libm::exp(fold - ln_q) / TOP]
    }
}

/// Returns the number of columns of a row in a panel of `size`: as many as lanes hold anyway. With the loads of the panel alone, 12 for an error of
/// 1e-5, the last coefficients of every second row exceeded it.
fn columns(size: NetSize) -> usize {
    size.loads.next_multiple_of(WIDTH).min(MOST_POINTS)
}

/// Returns `count` Chebyshev points of the first kind on `[0, 1]`.
fn points(count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |i| {
        let angle = (2 * i + 1) as f64 / (2 * count) as f64 * FRAC_PI_2;
        libm::sin(angle).powi(2)
    })
}

/// Returns the tensor of the functions of states.
fn tensor(case: SheetCase, size: NetSize, along: &Chebyshev<2>) -> ChebyshevTensor<3> {
    let loads = chebyshev_points(size.loads);
    let contacts = contacts_of(case, size, along);
    let nodes =
        contacts.iter().flat_map(|(tau, most)| loads.iter().map(move |part| (*tau, part * most)));
    let maps: Vec<ShootingMap> = case.shoot(nodes);
    let determinant = |map: &ShootingMap| -map.det() * map.pole.length_squared();
    let mut first = 0.0;
    let mut values: Vec<Functions> = Vec::with_capacity(size.loads);
    let rows = contacts.iter().zip(maps.chunks(size.loads)).map(|((_, most), maps)| {
        let between = determinant(&maps[size.loads / 2]).abs();
        let states = loads.iter().map(|part| part * most).zip(maps);
        values.clear();
        values.extend(directions(first, states).zip(maps).map(|(phi, map)| {
            let ln_distance = libm::log(map.pole.length());
            [ln_distance, phi, determinant(map) / between]
        }));
        // Directions are continuous from contact to contact at the smallest load, too.
        first = values[0][1];
        Chebyshev::through(&values)
    });
    ChebyshevTensor::through(&rows.collect::<Vec<_>>())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::sheet::Sheet;
    use crate::sheet::fold::contact_nodes::{Folds, SPACING};
    use crate::sheet::net::cone;
    use crate::sheet::net::guess_row::GuessRow;
    use whiskmap_mechanics::rod::{Rest, Side};
    use whiskmap_mechanics::shooting::batch::Method;

    /// Ends need no accurate panel: they are the same without guesses.
    #[test]
    fn ends_do_not_depend_on_guesses() {
        let rod = cone(Side::Cf);
        let distances = [0.3, 0.8, 0.99, 1.2];
        let [with, without] = [Sheet::new, Sheet::of_ends].map(|sheet| {
            let sheet = sheet(Method::fine(), &rod, Side::Cf, &distances);
            assert!(!sheet.is_continued());
            sheet.crossings
        });
        assert_eq!(with, without);
    }

    /// A spoiled direction is in the bound of a row, or leaves the panel without the row.
    #[test]
    fn a_spoiled_panel_contradicts_the_ends_of_its_rows() {
        let rod = cone(Side::Cb);
        let sheet = Sheet::new(Method::fine(), &rod, Side::Cb, &[0.3, 0.5, 0.7]);
        let samples = sheet.samples.as_ref().unwrap();
        let panel = samples.panels.as_ref().unwrap().of(1).unwrap();
        let spoiled = |function: usize, by: f64| {
            let mut tensor = panel.panel.tensor.clone();
            tensor.coefficients[0][0][function] += by;
            let NetPanel { contacts, along, size, .. } = panel.panel.clone();
            GuessPanel {
                panel: NetPanel::new(contacts, along, size, tensor, columns(size)),
                error: panel.error,
            }
        };
        let residual = |by: f64| {
            let ends = [None, sheet.simple_end(1)];
            let row = GuessRow::new(&spoiled(1, by), sheet.case(), &sheet.rows[1], ends);
            row.map(|row| row.residual)
        };
        // Without states of the row, too: whichever of its functions, the distance or the direction, is spoiled.
        let end = sheet.simple_end(1).unwrap();
        for function in [0, 1] {
            let residual = |by: f64| {
                let panel = spoiled(function, by);
                panel.residuals(sheet.case(), &[(&sheet.rows[1], end)])[0]
            };
            let [sound, wrong] = [0.0, 5e-5].map(residual);
            assert!(sound < MARGIN * 1e-6 && wrong > MARGIN * 4e-5 * 0.5, "{sound} {wrong}");
        }
        let outside = Row::new(&Rest::new(&rod), 0.05);
        assert!(panel.residuals(sheet.case(), &[(&outside, end)])[0].is_nan());
        let bound = |by: f64| MARGIN * by * sheet.rows[1].pole_distance;
        assert!(residual(0.0).unwrap() < bound(1e-5));
        assert!(residual(5e-5).unwrap() > bound(4e-5));
        assert_eq!(residual(2e-4), None);
    }

    /// A pair of folds between the nodes is found, however near to each other. A first fold that differs from the first fold of the contact nodes
    /// is refused.
    #[test]
    fn folds_that_nodes_do_not_show_are_found() {
        let rod = cone(Side::Cb);
        let case = SheetCase { method: Method::fine(), rod: &rod, side: Side::Cb };
        let rest = Rest::new(&rod);
        let rows: Vec<Row> = [0.3, 0.5, 0.7].map(|d| Row::new(&rest, d)).into();
        let contacts = ContactNodes::new(case, &rows[0], SPACING, Folds::Predicted).unwrap();
        let panels = Panels::for_guesses(case, &contacts, &rows, GUESS_ERRORS[0]);
        let panel = &panels.of_all_rows().unwrap()[0];
        assert!(panel.shows_folds(&rod, &contacts));
        let value = |x: f64, y: f64| {
            let in_y = |terms: &Vec<[f64; 1]>| Chebyshev { coefficients: terms.clone() };
            let determinant = panel.panel.tensor.transposed(DETERMINANT);
            let terms = determinant.coefficients.iter();
            let terms = terms.map(|terms| in_y(terms).at(x)).collect();
            in_y(&terms).at(y)[0]
        };
        let changed = |change: &dyn Fn(f64, f64) -> f64| {
            let rows = chebyshev_points(30).iter().map(|x| {
                let values = chebyshev_points(30).iter();
                let values = values.map(|y| [0.0, 0.0, change(*x, *y)]);
                Chebyshev::through(&values.collect::<Vec<_>>())
            });
            let mut panel = panel.clone();
            panel.panel.tensor = ChebyshevTensor::through(&rows.collect::<Vec<_>>());
            panel.shows_folds(&rod, &contacts)
        };
        assert!(changed(&value));
        for [x, y] in [[0.5, 0.7], [0.31, 0.83], [0.9, 0.62], [0.07, 0.9]] {
            let away = |at_x: f64, at_y: f64| (at_x - x).powi(2) + (at_y - y).powi(2);
            for depth in [1e-2, 1e-4, 1e-6] {
                let hidden = |x, y| value(x, y) * (away(x, y) - depth);
                assert!(!changed(&hidden), "{x} {y} {depth}");
            }
            let none = |x, y| value(x, y) * (0.3 + away(x, y));
            assert!(changed(&none), "{x} {y}");
        }
        assert!(!changed(&|_, _| f64::NAN));
        for part in [-0.03, 0.03] {
            let elsewhere = |x, y| value(x, y * (1.0 + part));
            assert!(!changed(&elsewhere), "{part}");
        }
    }
}
