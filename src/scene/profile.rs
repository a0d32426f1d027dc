//! Radii: base and tip of a cone, or a measured profile, whose rows stand in the scene or in a CSV file that it names.

use std::fmt::{self, Write};
use std::path::Path;

use serde::Deserialize;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Deserializer, SeqAccess, Visitor};
use toml::Spanned;

use super::SceneError;
use super::error::Fault;
use super::file::{SceneTable, WhiskerTable};
use super::limits::Limits;

/// Rows of a profile. A trajectory takes at least two steps from row to row.
const MOST_ROWS: usize = 256;

/// How far, relative to the length, the last row may be from the tip: tables are rounded.
const END_SLACK: f64 = 1e-9;

/// A tip that is thinner than the base over this is a perfect cone, which needs no table.
const SHARPEST_TIP: f64 = 1000.0;

/// `rows` of `[whisker.profile]`: `[arc_length_mm, radius_um]` each, or the name of a CSV file with these columns.
pub(super) enum Rows {
    File(String),
    Listed(Vec<Spanned<[f64; 2]>>),
}

impl<'de> Deserialize<'de> for Rows {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either;

        impl<'de> Visitor<'de> for Either {
            type Value = Rows;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the name of a CSV file or a list of [arc_length_mm, radius_um]")
            }

            fn visit_str<E>(self, name: &str) -> Result<Rows, E> {
                Ok(Rows::File(name.to_owned()))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Rows, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(seq)).map(Rows::Listed)
            }
        }

        deserializer.deserialize_any(Either)
    }
}

/// A row of the CSV file; other columns are left alone.
#[derive(Deserialize)]
struct Measured {
    arc_length_mm: f64,
    radius_um: f64,
}

/// The scene with the rows of the CSV file in place of its name, so that it stands for itself; `None` if it names none.
/// The file is looked for where the scene, `origin`, is.
pub(super) fn inline(
    table: &SceneTable,
    text: &str,
    origin: &str,
) -> Result<Option<String>, SceneError> {
    let Some(rows) = table.whisker.profile.as_ref().map(|table| &table.rows) else {
        return Ok(None);
    };
    let Rows::File(name) = rows.get_ref() else {
        return Ok(None);
    };
    let folder = Path::new(origin).parent().unwrap_or(Path::new(""));
    let refused = |why: &dyn fmt::Display| {
        let message = format!("whisker.profile.rows = {name:?}: {why}");
        SceneError::at(origin, text, Some(rows.span()), message)
    };
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_path(folder.join(name))
        .map_err(|why| refused(&why))?;
    let mut list = String::from("[\n");
    for row in reader.deserialize() {
        let Measured {
            arc_length_mm,
            radius_um,
        } = row.map_err(|why| refused(&why))?;
        // Writing to a String cannot fail.
        let _ = writeln!(list, "    [{arc_length_mm:?}, {radius_um:?}],");
    }
    list.push(']');
    let mut inlined = text.to_owned();
    inlined.replace_range(rows.span(), &list);
    Ok(Some(inlined))
}

/// What the scene says of the radii.
pub(super) struct Radii {
    pub base_radius_um: f64,
    pub tip_radius_um: f64,
    /// Rows of arclength and radius as fractions of the length and the base radius.
    pub profile: Option<Vec<[f64; 2]>>,
}

/// The radii of a whisker of `length_mm`.
pub(super) fn radii(table: &WhiskerTable, length_mm: f64) -> Result<Radii, Fault> {
    let ends = [
        ("whisker.base_radius_um", &table.base_radius_um),
        ("whisker.tip_radius_um", &table.tip_radius_um),
    ];
    if let Some(profile) = &table.profile {
        if let Some((key, Some(number))) = ends.iter().find(|(_, number)| number.is_some()) {
            let must = "must be left out: the radii are those of whisker.profile";
            return Err(Fault::new(*key, number.span(), must));
        }
        return measured(&profile.rows, length_mm);
    }
    let [base, tip] = ends.map(|(key, number)| {
        let absent = || Fault::absent(key, "is left out, and there is no whisker.profile");
        number.as_ref().ok_or_else(absent)
    });
    let base_radius_um = Limits::between(1e-3, 1e5).check(ends[0].0, base?)?;
    let tip_radius_um =
        Limits::between(0.0, ("base_radius_um", base_radius_um)).check(ends[1].0, tip?)?;
    Ok(Radii {
        base_radius_um,
        tip_radius_um,
        profile: None,
    })
}

fn measured(rows: &Spanned<Rows>, length_mm: f64) -> Result<Radii, Fault> {
    let key = "whisker.profile.rows";
    let listed: &[Spanned<[f64; 2]>] = match rows.get_ref() {
        Rows::Listed(listed) => listed,
        Rows::File(_) => &[],
    };
    if !(2..=MOST_ROWS).contains(&listed.len()) {
        let must = format!("must be 2 to {MOST_ROWS} rows, are {}", listed.len());
        return Err(Fault::new(key, rows.span(), must));
    }
    let mut before = f64::NEG_INFINITY;
    for (i, row) in listed.iter().enumerate() {
        let [s, radius] = *row.get_ref();
        let refused = |must: String| Err(Fault::new(format!("{key}[{i}]"), row.span(), must));
        if !(s > before && s <= length_mm * (1.0 + END_SLACK)) {
            return refused(format!(
                "the arclength must grow from row to row, from 0 to length_mm ({length_mm})"
            ));
        }
        if !(1e-3..=1e5).contains(&radius) {
            return refused("the radius must be between 0.001 and 100000".to_owned());
        }
        before = s;
    }
    let ([first, base_radius_um], [last, tip_radius_um]) =
        (*listed[0].get_ref(), *listed[listed.len() - 1].get_ref());
    if first != 0.0 || (last - length_mm).abs() > END_SLACK * length_mm {
        let must = format!(
            "must begin at the base, at 0, and end at the tip, at length_mm ({length_mm}); \
             they go from {first} to {last}"
        );
        return Err(Fault::new(key, rows.span(), must));
    }
    if !(base_radius_um / SHARPEST_TIP <= tip_radius_um && tip_radius_um <= base_radius_um) {
        let must = format!(
            "the radius at the tip must be between a thousandth of that at the base and that at the base \
             ({base_radius_um})"
        );
        return Err(Fault::new(key, listed[listed.len() - 1].span(), must));
    }
    let mut profile: Vec<[f64; 2]> = listed
        .iter()
        .map(|row| {
            let [s, radius] = *row.get_ref();
            [s / length_mm, radius / base_radius_um]
        })
        .collect();
    if let Some([end, _]) = profile.last_mut() {
        *end = 1.0;
    }
    Ok(Radii {
        base_radius_um,
        tip_radius_um,
        profile: Some(profile),
    })
}
