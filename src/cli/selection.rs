//! `--at`: the part of a grid at some values of its axes.

use super::failure::Failure;
use std::str::FromStr;
use whiskmap::scene::{Grid, digits};

/// A value on an axis, as the user wants it.
#[derive(Clone, Debug)]
pub struct At {
    name: String,
    value: f64,
}

impl FromStr for At {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('=');
        let at = parts.and_then(|(name, value)| {
            let value: f64 = value.trim().parse().ok()?;
            let name = name.trim().to_owned();
            value.is_finite().then_some(Self { name, value })
        });
        at.ok_or_else(|| "must be AXIS=VALUE, such as taper=0.9".to_owned())
    }
}

/// The part of a grid that is wanted.
pub struct Selection {
    /// What is left of the grid: an axis of the sweep with one value is none, of the panel it has this value.
    pub grid: Grid,
    /// Rows and columns of each panel.
    pub rows: Vec<usize>,
    pub columns: Vec<usize>,
    /// Values taken, by the names of their axes.
    pub taken: Vec<(&'static str, f64)>,
    /// The whole grid.
    whole: Grid,
    /// The index taken on each of its sweep axes, if one was.
    fixed: Vec<Option<usize>>,
}

impl Selection {
    /// The part of `whole` at some values, the nearest ones or, with `exact`, these alone.
    pub fn new(whole: &Grid, wanted: &[At], exact: bool) -> Result<Self, Failure> {
        let mut selection = Self {
            grid: whole.clone(),
            rows: (0..whole.distance_mm.len()).collect(),
            columns: (0..whole.push_angle_deg.len()).collect(),
            taken: Vec::new(),
            whole: whole.clone(),
            fixed: vec![None; whole.sweep.len()],
        };
        for at in wanted {
            let axes = whole.sweep.iter();
            let axes = axes.map(|axis| (axis.parameter.axis(), &axis.values));
            let inside = [
                ("distance_mm", &whole.distance_mm),
                ("push_angle_deg", &whole.push_angle_deg),
            ];
            let axes: Vec<(&'static str, &Vec<f64>)> = axes.chain(inside).collect();
            let Some(place) = axes.iter().position(|(name, _)| *name == at.name) else {
                let names: Vec<&str> = axes.iter().map(|(name, _)| *name).collect();
                let (name, names) = (&at.name, names.join(", "));
                let must = format!("--at {name}: must be one of the axes, {names}");
                return Err(Failure::Input(must));
            };
            let (name, values) = axes[place];
            let index = nearest(values, at.value);
            let value = values[index];
            if exact && value != at.value {
                return Err(Failure::Input(format!(
                    "--at {name}={}: is no value of the axis, and --exact is given; the nearest is {}",
                    digits(at.value),
                    digits(value)
                )));
            }
            if selection.taken.iter().any(|(other, _)| *other == name) {
                return Err(Failure::Input(format!("--at {name}: is given twice")));
            }
            selection.taken.push((name, value));
            match name {
                "distance_mm" => {
                    selection.rows = vec![index];
                    selection.grid.distance_mm = vec![value];
                }
                "push_angle_deg" => {
                    selection.columns = vec![index];
                    selection.grid.push_angle_deg = vec![value];
                }
                _ => {
                    selection.fixed[place] = Some(index);
                    let sweep = &mut selection.grid.sweep;
                    sweep.retain(|axis| axis.parameter.axis() != name);
                }
            }
        }
        Ok(selection)
    }

    /// The index in the whole sweep of whisker `index` of what is left.
    pub fn whisker(&self, index: usize) -> usize {
        let mut left = self.grid.indices(index).into_iter();
        let (mut whisker, mut stride) = (0, 1);
        for (axis, fixed) in self.whole.sweep.iter().zip(&self.fixed) {
            let at = fixed.or_else(|| left.next()).unwrap_or_default();
            whisker += at * stride;
            stride *= axis.values.len();
        }
        whisker
    }

    /// The whiskers that are left, the last axis varying fastest.
    pub fn whiskers(&self) -> Vec<usize> {
        let mut left: Vec<usize> = (0..self.grid.whisker_count()).collect();
        left.sort_by_key(|index| self.grid.indices(*index));
        left.into_iter().map(|index| self.whisker(index)).collect()
    }

    /// The values of a whisker on the axes of the whole sweep.
    pub fn place(&self, whisker: usize) -> Vec<(&'static str, f64)> {
        let place = self.whole.place(whisker);
        let values = place.values();
        values
            .map(|(parameter, value)| (parameter.axis(), value))
            .collect()
    }

    /// Those of a panel's cells that are wanted.
    pub fn cells(&self) -> impl Iterator<Item = usize> {
        let width = self.whole.push_angle_deg.len();
        self.rows.iter().flat_map(move |row| {
            let columns = self.columns.iter();
            columns.map(move |column| row * width + column)
        })
    }

    /// Sizes of the axes that are left, as `whiskers` and `cells` go through them.
    pub fn shape(&self) -> Vec<usize> {
        let axes = self.grid.sweep.iter().map(|axis| axis.values.len());
        let inside = [
            ("distance_mm", self.rows.len()),
            ("push_angle_deg", self.columns.len()),
        ];
        let is_left = |name: &str| self.taken.iter().all(|(taken, _)| *taken != name);
        let inside = inside.into_iter().filter(|(name, _)| is_left(name));
        axes.chain(inside.map(|(_, size)| size)).collect()
    }
}

/// The place of the value nearest to `wanted`.
fn nearest(values: &[f64], wanted: f64) -> usize {
    let apart = |value: &f64| (value - wanted).abs();
    let places = values.iter().enumerate();
    let nearest = places.min_by(|(_, a), (_, b)| apart(a).total_cmp(&apart(b)));
    nearest.map_or(0, |(place, _)| place)
}
