//! The spread of detachment curves as bands of a chart.

use super::chart::{Band, Shade};
use crate::uncertainty::Spread;

/// Bands over the distance of `rows`, of one side after the other, each at growing distances: from the 5th to the 95th
/// percentile, and over it from the 25th to the 75th.
#[must_use]
pub fn bands(rows: &[Spread]) -> Vec<Band> {
    type Ends = fn(&Spread) -> [Option<f64>; 2];
    let kinds: [(Shade, &str, Ends); 2] = [
        (Shade::Light, "5 to 95 % of samples", |row| {
            [row.p5_deg, row.p95_deg]
        }),
        (Shade::Dark, "25 to 75 % of samples", |row| {
            [row.p25_deg, row.p75_deg]
        }),
    ];
    let sides = rows.chunk_by(|a, b| a.side == b.side && a.distance_mm < b.distance_mm);
    let sides: Vec<&[Spread]> = sides.collect();
    let bands = kinds.into_iter().flat_map(|(shade, name, ends)| {
        sides.iter().map(move |side| Band {
            points: side
                .iter()
                .map(|row| {
                    let [low, high] = ends(row).map(|end| end.unwrap_or(f64::NAN));
                    [row.distance_mm, low, high]
                })
                .collect(),
            shade,
            name: Some(name.to_owned()),
        })
    });
    bands.collect()
}
