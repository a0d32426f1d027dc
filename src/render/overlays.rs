//! Marks on plots of detachment curves: measured detachments with error bars, and percentiles of samples.

use crate::measured::ComparedPoint;
use crate::trace::DetachmentKind;
use crate::uncertainty::EndSpread;
use whiskmap_plot::{Band, Dot, Ink, Line, Shade, Stroke};

/// Returns measured detachments as dots at `[angle (deg), distance (mm)]`: slip-off open, pull-off filled, grey where the kind is
/// unknown. Points with a missing angle or distance have none.
#[must_use]
pub fn measured(points: &[ComparedPoint]) -> Vec<Dot> {
    let dots = points.iter().filter_map(|point| {
        let (ink, open, name) = measured_look(point);
        Some(Dot {
            at: [point.measured_deg?, point.distance_mm?],
            ink,
            open,
            name: Some(match point.sd_deg {
                Some(_) => format!("{name} \u{b1} standard deviation"),
                None => name.to_owned(),
            }),
        })
    });
    dots.collect()
}

/// Returns the error bars of measured detachments: lines of one standard deviation to the left and right, `[angle (deg), distance (mm)]`.
/// Points without a standard deviation have none. The names of the dots explain the bars.
#[must_use]
pub fn error_bars(points: &[ComparedPoint]) -> Vec<Line> {
    let bars = points.iter().filter_map(|point| {
        let sd = point.sd_deg?;
        let [angle, distance] = [point.measured_deg?, point.distance_mm?];
        let ends = [-sd, sd].map(|end| [angle + end, distance]);
        let (ink, ..) = measured_look(point);
        Some(Line::new(ends.to_vec(), ink, Stroke::Solid))
    });
    bars.collect()
}

/// Returns bands along the distance (mm), across `[value, distance]`: from the 5th to the 95th percentile, and over them from the 25th
/// to the 75th. `percentiles` returns the 5th, 25th, 75th and 95th. `rows` has one side after the other, each in order of increasing distance.
#[must_use]
pub fn bands(rows: &[EndSpread], percentiles: fn(&EndSpread) -> [Option<f64>; 4]) -> Vec<Band> {
    let kinds = [
        (Shade::Light, "5 to 95 % of samples", [0, 3]),
        (Shade::Dark, "25 to 75 % of samples", [1, 2]),
    ];
    let mut bands = Vec::new();
    for (shade, name, ends) in kinds {
        for side in rows.chunk_by(|a, b| a.side == b.side && a.distance_mm < b.distance_mm) {
            let point = |row: &EndSpread| {
                let all = percentiles(row);
                let ends = ends.map(|end| all[end].unwrap_or(f64::NAN));
                ends.map(|end| [end, row.distance_mm])
            };
            let points: Vec<[[f64; 2]; 2]> = side.iter().map(point).collect();
            // Rows out of reach have no percentiles.
            if points.iter().any(|[low, high]| low[0].is_finite() && high[0].is_finite()) {
                bands.push(Band { points, shade, name: Some(name.to_owned()) });
            }
        }
    }
    bands
}

/// The ink of a measured detachment, true if its dot is open, and its name.
const fn measured_look(point: &ComparedPoint) -> (Ink, bool, &'static str) {
    match point.kind {
        Some(DetachmentKind::SlipOff) => (Ink::Black, true, "measured slip-off"),
        Some(DetachmentKind::PullOff) => (Ink::Blue, false, "measured pull-off"),
        _ => (Ink::Grey, false, "measured"),
    }
}
