//! Rows of a panel for guesses: the states of one row as polynomials of its part of the load, or of the load itself.

use super::bound::{MARGIN, larger, largest};
use super::guesses::GuessPanel;
use super::panel::TOP;
use crate::sheet::case::SheetCase;
use crate::sheet::{Crossing, Row};
use glam::DVec2;
use whiskmap_mechanics::numerics::expansion::{Chebyshev, chebyshev_points};
use whiskmap_mechanics::numerics::inverse::Inverse;
use whiskmap_mechanics::numerics::{
    LaneNumbers, Lanes, SimdTask, Unit, WIDTH, illinois, keep, nearest_turn, pack,
};
use whiskmap_mechanics::rod::{Rod, arclength};
use whiskmap_mechanics::shooting::contact::exp;

/// Push angle beyond the ends of a row, in radians, up to which cells get guesses. It is many times the error of a guess; a row with a missed
/// cell is followed by continuation.
pub const PUSH_MARGIN: f64 = 1e-4;

/// Largest last coefficient of a row as polynomials of the part of the load, beyond twice the error of its panel. A row with a larger one becomes
/// polynomials of the load, which are found in 30 us. Newton's method needs a second trajectory from guesses with this error. Misses at the
/// ends do not count: those of the panel remain in a row of the load.
const ROW_ERROR: f64 = 1e-5;

/// Relative error of the load that is allowed at the nearest contact, where a search for a row's states by their loads begins.
const LOAD_TOLERANCE: f64 = 1e-3;

/// States of a row between two of its ends, by a panel for guesses.
#[derive(Clone, Debug)]
pub struct GuessRow {
    /// Magnitude of the push angle since first touch in radians, `tau`, and signed load.
    inverse: Inverse<3>,
    /// True if the row has arclengths in whisker lengths in place of `tau`.
    is_by_load: bool,
    /// Push angle of the first state by the panel, in radians.
    first: f64,
    /// Magnitudes of the push angles at the ends, which are computed apart, in radians.
    ends: [f64; 2],
    /// Largest of the last coefficients, relative to the state at the last end.
    left_out: f64,
    /// Expected residual of the states, in whisker lengths: by the coefficients left out of the panel and of the row, and by the differences from
    /// the ends.
    pub(super) residual: f64,
}

impl GuessRow {
    /// Returns the states along `row` by a panel for `guesses`, from one of its `ends` to the other. Without its first end, the row begins at first
    /// touch.
    ///
    /// `None` if the row is not in the panel, if its push angle does not grow throughout, or if it contradicts the ends, which are computed apart.
    pub fn new(
        guesses: &GuessPanel,
        case: SheetCase,
        row: &Row,
        ends: [Option<&Crossing>; 2],
    ) -> Option<Self> {
        let by_part = Self::by_part(guesses, case, row, ends);
        let most = 2.0f64.mul_add(guesses.error, ROW_ERROR);
        let is_accurate = |row: &Self| row.left_out <= most;
        if by_part.as_ref().is_some_and(is_accurate) {
            return by_part;
        }
        let by_load = Self::by_load(guesses, case, row, ends);
        let both = [by_part, by_load].into_iter().flatten();
        both.min_by(|a, b| a.residual.total_cmp(&b.residual))
    }

    /// Returns the states along `row` at parts of the load, as [`Self::new`] does.
    fn by_part(
        guesses: &GuessPanel,
        case: SheetCase,
        row: &Row,
        ends: [Option<&Crossing>; 2],
    ) -> Option<Self> {
        let part =
            |end: Option<&Crossing>| end.map_or(0.0, |end| guesses.panel.part(case.rod, end));
        let line = guesses.panel.line(row, ends.map(part))?;
        let (unit, sign) = (Unit::detect(), case.side.sign());
        let blocks = line.points.iter().zip(line.parts.chunks(WIDTH));
        let states = blocks.flat_map(|(points, of_block)| {
            let mut parts = [0.0; WIDTH];
            parts[..of_block.len()].copy_from_slice(of_block);
            let [tau, load] =
                unit.run(ContactsAndLoads { along: &points.along, parts: &parts, sign });
            let phi = points.values[1];
            (0..points.count).map(move |lane| [phi[lane], tau[lane], load[lane]])
        });
        Self::joined(guesses, case, row, ends, states.collect(), line.end)
    }

    /// Returns the states along `row` at loads, with arclengths in place of contacts, as [`Self::new`] does.
    ///
    /// Next to the tip of a perfect cone, the contact moves far almost without a change of the load, and the part of the load falls there. But the
    /// arclength is a smooth function of the load.
    fn by_load(
        guesses: &GuessPanel,
        case: SheetCase,
        row: &Row,
        ends: [Option<&Crossing>; 2],
    ) -> Option<Self> {
        let tip = guesses.panel.place(case.rod, case.rod.tau_tip()).min(1.0);
        let level = libm::log(row.pole_distance);
        let [first, last] = ends.map(|end| end.map_or(0.0, |end| end.load));
        let loads = chebyshev_points(guesses.panel.size.loads).iter();
        let states = loads.map(|point| {
            let load = first + point * (last - first);
            let part = |place: f64| {
                let [ln_tau, ln_q] = guesses.panel.along.at(place);
                load.abs() * libm::exp(2.0 * ln_tau - ln_q) / TOP
            };
            let over = |place| part(place) - 1.0;
            if over(tip) >= 0.0 {
                return None;
            }
            // At a contact nearer to the base, this load exceeds the largest load of the panel.
            let nearest = if over(0.0) > 0.0 {
                let bracket = [0.0, tip].map(|place| [place, over(place)]);
                illinois(bracket, LOAD_TOLERANCE, |place| Some(over(place)))?.x
            } else {
                0.0
            };
            let states_at = |places: &[f64]| {
                let places = places.iter().map(|place| [*place, part(*place)]);
                guesses.panel.tensor.at::<2>(&places.collect::<Vec<_>>())
            };
            let place = level_place(nearest, tip, |places| {
                let misses = states_at(places).into_iter();
                misses.map(|[ln_distance, _]| ln_distance - level).collect()
            })?;
            let [ln_distance, phi] = states_at(&[place])[0];
            let is_on_level = (ln_distance - level).abs() <= MARGIN * guesses.error;
            if !(part(place) <= 1.0 && is_on_level) {
                return None;
            }
            let [ln_tau, _] = guesses.panel.along.at(place);
            Some([phi, arclength(case.rod, libm::exp(ln_tau)), load])
        });
        let states: Option<Vec<[f64; 3]>> = states.collect();
        let mut row = Self::joined(guesses, case, row, ends, states?, 1.0)?;
        row.is_by_load = true;
        Some(row)
    }

    /// Joins the `states` of a row, `[direction of the pole, contact, load]` at Chebyshev points of a parameter. The parameter is 0 at the first of the
    /// `ends` and `end` at the other.
    fn joined(
        guesses: &GuessPanel,
        case: SheetCase,
        row: &Row,
        ends: [Option<&Crossing>; 2],
        mut states: Vec<[f64; 3]>,
        end: f64,
    ) -> Option<Self> {
        let ends = ends.map(|end| end.map_or(0.0, |end| end.push));
        let sign = case.side.sign();
        // The first state is next to the first end.
        let near = row.touch + sign * ends[0];
        let turned = row.touch + nearest_turn(near, states[0][0]) - near;
        for [phi, ..] in &mut states {
            *phi = sign * (*phi - turned);
        }
        let functions: Chebyshev<3> = Chebyshev::through(&states);
        let [[first, ..], [last, contact, load]] = [functions.at(0.0), functions.at(end)];
        let off = larger((first - ends[0]).abs(), (last - ends[1]).abs());
        let [tail, _] = functions.tails();
        let left_out = largest(&tail, &[1.0, 1.0 / contact, 1.0 / load.abs()]);
        let error = larger(larger(guesses.error, left_out), off);
        let inverse = |functions| Inverse::new(functions, end);
        Some(Self {
            inverse: (off <= PUSH_MARGIN).then(|| inverse(functions)).flatten()?,
            is_by_load: false,
            first,
            ends,
            left_out,
            residual: MARGIN * error * row.pole_distance,
        })
    }

    /// Writes missing `guesses` `(tau, load)`, `[push_angle]`, for the growing `pushes` near the row of `rod` between its ends. Push angles are magnitudes
    /// in radians.
    pub fn write_guesses(&self, rod: &Rod, pushes: &[f64], guesses: &mut [Option<DVec2>]) {
        let from = pushes.partition_point(|push| *push < self.ends[0] - PUSH_MARGIN);
        let to = pushes.partition_point(|push| *push <= self.ends[1] + PUSH_MARGIN);
        let targets = pushes[from..to].iter().map(|push| push.max(self.first));
        let targets: Vec<f64> = targets.collect();
        let wanted = [true; 3];
        let tip = arclength(rod, rod.tau_tip());
        self.inverse.solve(&targets, &wanted, |index, count, block| {
            for (lane, guess) in guesses[from + index..][..count].iter_mut().enumerate() {
                let [_, contact, load] = block.values.map(|values| values[lane]);
                let tau = if self.is_by_load { rod.tau(contact.min(tip)) } else { contact };
                guess.get_or_insert(DVec2::new(tau, load));
            }
        });
    }
}

/// Contacts `tau` and signed loads of a block of columns, from `ln tau` and the scale `ln q` of the load there, and its parts.
struct ContactsAndLoads<'a> {
    along: &'a [LaneNumbers; 2],
    parts: &'a LaneNumbers,
    sign: f64,
}

impl SimdTask for ContactsAndLoads<'_> {
    type Output = [LaneNumbers; 2];

    #[inline(always)]
    fn run<T: Lanes>(self) -> Self::Output {
        let [mut taus, mut loads] = [[0.0; WIDTH]; 2];
        for from in (0..WIDTH).step_by(T::LANES) {
            let [ln_tau, ln_q] = self.along.each_ref().map(|lanes| pack::<T>(lanes, from));
            let part: T = pack(self.parts, from);
            keep(&mut taus, from, exp(ln_tau));
            keep(&mut loads, from, T::of(self.sign) * part * exp(ln_q - ln_tau - ln_tau));
        }
        [taus, loads]
    }
}

/// Places in a range that are evaluated at once, as many as lanes hold.
const PLACES: usize = WIDTH;

/// Rounds of a search, each of which finds the two of the places between which a zero lies. Linear interpolation between the last two leaves 1e-9 of the
/// range.
const ROUNDS: usize = 4;

/// Returns the first place from `from` to `to` where `misses` become positive, or `to` where they do not: next to the tip, the error of a panel decides
/// on which side of it a state is. `None` if the first miss is positive.
fn level_place(from: f64, to: f64, misses: impl Fn(&[f64]) -> Vec<f64>) -> Option<f64> {
    let (mut from, mut to) = (from, to);
    let mut zero = to;
    for _ in 0..ROUNDS {
        let part = |i: usize| i as f64 / (PLACES - 1) as f64;
        let places: [f64; PLACES] = std::array::from_fn(|i| from + part(i) * (to - from));
        let found = misses(&places);
        let Some(after) = found.iter().position(|miss| *miss > 0.0) else {
            return Some(to);
        };
        let before = after.checked_sub(1)?;
        [from, to] = [places[before], places[after]];
        zero = from + found[before] / (found[before] - found[after]) * (to - from);
    }
    Some(zero)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::sheet::net::cone;
    use crate::sheet::{Edge, Sheet, pieces};
    use whiskmap_mechanics::rod::Side;
    use whiskmap_mechanics::shooting::ShootingMap;
    use whiskmap_mechanics::shooting::batch::Method;

    /// Along rows that end at either edge, and between two ends of rows out of reach, the pole of a guess is where it is wanted: also where a
    /// contact moves from the tip of a perfect cone without a change of the load.
    #[test]
    fn guesses_are_next_to_states() {
        for taper in [0.95, 1.0] {
            let (mut ends, mut detached) = ([0; 2], 0);
            for side in Side::BOTH {
                let rod = Rod { taper, ..cone(side) };
                let distances: Vec<f64> = (0..184).map(|i| 0.1 + 0.005 * f64::from(i)).collect();
                let sheet = Sheet::new(Method::fine(), &rod, side, &distances);
                for (row, place) in sheet.rows.iter().enumerate() {
                    for (first, end) in pieces(sheet.touches(row), &sheet.crossings[row]) {
                        assert!(!end.is_at_touch());
                        let from = first.map_or(0.0, |first| first.push);
                        ends[usize::from(end.edge == Edge::Tip)] += 1;
                        detached += usize::from(first.is_some());
                        let part = |i| f64::from(i) / 40.0;
                        let pushes = (0..=40).map(|i| from + part(i) * (end.push - from));
                        let pushes: Vec<f64> = pushes.collect();
                        let guesses = sheet.guesses(row, &pushes);
                        let points = guesses.iter().map(|guess| guess.map(<(f64, f64)>::from));
                        let points: Option<Vec<(f64, f64)>> = points.collect();
                        let maps: Vec<ShootingMap> = sheet.case().shoot(points.unwrap());
                        let panel = sheet.samples.as_ref().unwrap().panels.as_ref();
                        let states = panel.unwrap().of(row).unwrap();
                        let states = GuessRow::new(states, sheet.case(), place, [first, Some(end)]);
                        let most = states.unwrap().residual;
                        for (map, push) in maps.iter().zip(&pushes) {
                            let off = map.pole.distance(place.pole(side.sign() * push));
                            assert!(off < most.min(1e-6), "{taper} {row} {push}: {off:e}");
                        }
                        let beyond = [end.push + 2.0 * PUSH_MARGIN];
                        assert_eq!(sheet.guesses(row, &beyond), [None]);
                    }
                }
            }
            let is_each = ends.iter().all(|count| *count > 0) && detached > 2;
            assert!(is_each, "{taper} {ends:?} {detached}");
        }
    }

    /// A pole out of reach leaves the rows within reach their panel, also where the rod is continued to no radius or no modulus.
    #[test]
    fn rows_out_of_reach_need_no_panel() {
        for (taper, gradient) in [(0.95, 0.0), (1.0, 0.0), (0.3, -0.9)] {
            let rod = Rod { taper, gradient, ..cone(Side::Cb) };
            let sheet = Sheet::new(Method::fine(), &rod, Side::Cb, &[0.5, 1.2, 5.0, 10.0]);
            assert!(!sheet.is_continued(), "{taper} {gradient}");
            let found = |row| sheet.guesses(row, &[0.1])[0].is_some();
            assert_eq!([0, 1, 2, 3].map(found), [true, false, false, false]);
        }
    }
}
