//! Measurements of `whisk`, the tracker of Janelia, as CSV: a row for each traced segment.
//!
//! Clack et al. (2012), PLoS Comput. Biol. 8, e1002591. A row has the number of the frame (`fid`), the number of the segment in it (`wid`), the
//! identity of its whisker (`label`, -1 if it is none), position of follicle and tip in pixels, angle at the follicle in degrees, and the mean
//! curvature in 1/px. Tables of `ndx-whisk` call the first two `frame_id` and `whisker_id`.

use super::options::{ImagePole, TrackingError, TrackingOptions, refused};
use super::{
    FRAME_NUMBERS, ImageFrame, ImageFrames, PointOrder, Remarks, frame_number, whole_number,
};
use crate::input::{CsvError, CsvTable};
use crate::scene::digits;
use std::collections::BTreeMap;

/// Required columns: one of each group.
const NEEDED: [&[&str]; 7] = [
    &["fid", "frame_id", "frame"],
    &["angle"],
    &["curvature"],
    &["follicle_x"],
    &["follicle_y"],
    &["tip_x"],
    &["tip_y"],
];

/// Columns of the identity of a whisker, of which the first one that identifies any counts.
const IDENTITY: [&str; 3] = ["label", "wid", "whisker_id"];

/// Other columns of the format.
const OTHERS: [&str; 6] = ["face_x", "face_y", "length", "pixel_length", "score", "chunk_start"];

/// Largest size of a position in pixels, and of a curvature in 1/px.
const MOST: f64 = 1e6;

/// Reads the frames of one whisker. Of several segments in a frame with its identity, the one with the longest chord counts.
pub(super) fn read(
    text: &str,
    origin: &str,
    options: &TrackingOptions,
) -> Result<ImageFrames, TrackingError> {
    refuse_points(options)?;
    let table = CsvTable::parse(text, origin)?;
    // Absent columns are not passed, so that no other column is refused for them.
    let optional = IDENTITY.into_iter().chain(OTHERS);
    let optional: Vec<&str> = optional.filter(|name| table.has(name)).collect();
    let note = table.require(&NEEDED, &optional)?;
    let numbers = NEEDED[0]
        .iter()
        .find_map(|name| table.values(name, FRAME_NUMBERS, frame_number).transpose());
    let numbers = numbers.transpose()?.unwrap_or_default();
    let (column, identities) = identities(&table)?;
    let whisker = match options.whisker {
        Some(whisker) if whisker >= 0 && identities.contains(&whisker) => whisker,
        given => only(given, column, &identities)?,
    };
    let number = |name: &str| {
        let must = "a number between -1e6 and 1e6";
        let numbers = table.measurements(name, must, |number| number.abs() <= MOST)?;
        Ok::<_, CsvError>(numbers.unwrap_or_default())
    };
    let [angle, curvature] = [number("angle")?, number("curvature")?];
    let [x, y] = [number("follicle_x")?, number("follicle_y")?];
    let [tip_x, tip_y] = [number("tip_x")?, number("tip_y")?];
    let pole_px = match options.pole {
        Some(ImagePole::At(at)) => Some(at),
        _ => None,
    };
    let mut frames: BTreeMap<u64, (f64, ImageFrame)> = BTreeMap::new();
    let ends = [numbers.iter().min(), numbers.iter().max()].map(|end| end.copied());
    let mut doubles = 0;
    for (i, (frame, identity)) in numbers.into_iter().zip(identities).enumerate() {
        let (follicle, tip, bend) = ([x[i], y[i]], [tip_x[i], tip_y[i]], [angle[i], curvature[i]]);
        let is_known = [follicle, tip, bend].concat().iter().all(|number| !number.is_nan());
        if identity != whisker || !is_known {
            continue;
        }
        let chord = libm::hypot(tip[0] - follicle[0], tip[1] - follicle[1]);
        let segment = ImageFrame {
            number: frame,
            points_px: vec![Some(follicle), Some(tip)],
            bend: Some(bend),
            pole_px,
        };
        let before = frames.get(&frame).map(|(chord, _)| *chord);
        doubles += usize::from(before.is_some());
        if before.is_none_or(|before| chord > before) {
            frames.insert(frame, (chord, segment));
        }
    }
    // The film begins and ends where the file does, also where this whisker is lost.
    for number in ends.into_iter().flatten() {
        let lost = || ImageFrame { number, points_px: Vec::new(), bend: None, pole_px };
        frames.entry(number).or_insert_with(|| (0.0, lost()));
    }
    let doubles = (doubles > 0).then(|| {
        format!("{origin}: {doubles} segments are shorter than another one of whisker {whisker} in their frame, and not used")
    });
    Ok(ImageFrames {
        frames: frames.into_values().map(|(_, frame)| frame).collect(),
        order: PointOrder::FromBase,
        remarks: Remarks { notes: note.into_iter().chain(doubles).collect(), ..Remarks::default() },
    })
}

/// Refuses options of formats with points.
fn refuse_points(options: &TrackingOptions) -> Result<(), TrackingError> {
    let TrackingOptions {
        curvature_at_mm,
        fit_to_mm,
        degree,
        taper,
        follicle_px,
        points,
        likelihood,
        pole,
        ..
    } = options;
    let of_curvature = "their curvature is the mean of the whisker";
    let without_points = "they have no points";
    let follicle = follicle_px.map(|[x, y]| format!("{x},{y}"));
    let given = [
        ("curvature_at_mm", curvature_at_mm.map(digits), of_curvature),
        ("fit_to_mm", fit_to_mm.map(digits), without_points),
        ("degree", degree.as_ref().map(usize::to_string), without_points),
        ("taper", taper.map(digits), without_points),
        ("follicle_px", follicle, "they name the follicle"),
        ("points", points.first().cloned(), "they have no body parts"),
        ("likelihood", likelihood.map(digits), "they have no likelihoods"),
    ];
    for (option, value, why) in given {
        if let Some(value) = value {
            let must = format!("must be left out with measurements of whisk: {why}");
            return Err(refused(option, &value, must));
        }
    }
    match pole {
        Some(ImagePole::Part(name)) => {
            let must = "must be X,Y in pixels: measurements of whisk have no body parts".to_owned();
            Err(refused("pole", name, must))
        }
        _ => Ok(()),
    }
}

/// Returns the identity of the whisker of each row, with the name of its column. Without such a column, all rows are of one whisker.
fn identities(table: &CsvTable) -> Result<(&'static str, Vec<i64>), CsvError> {
    for column in IDENTITY {
        let labels = table.values(column, "a whole number", whole_number)?;
        if let Some(labels) = labels.filter(|labels| labels.iter().any(|label| *label >= 0)) {
            return Ok((column, labels));
        }
    }
    Ok((IDENTITY[0], vec![0; table.lines().count()]))
}

/// Returns the only whisker among `identities`; -1 is none.
fn only(given: Option<i64>, column: &str, identities: &[i64]) -> Result<i64, TrackingError> {
    let mut counts: BTreeMap<i64, usize> = BTreeMap::new();
    for label in identities.iter().filter(|label| **label >= 0) {
        *counts.entry(*label).or_default() += 1;
    }
    match (given, counts.len()) {
        (None, 1) => Ok(counts.into_keys().next().unwrap_or_default()),
        _ => {
            let shown =
                counts.iter().take(10).map(|(label, count)| format!("{label} ({count} rows)"));
            let more = if counts.len() > 10 { ", ..." } else { "" };
            let must = format!(
                "must be an identity in the column {column}: {}{more}",
                shown.collect::<Vec<_>>().join(", ")
            );
            let given = given.map_or_else(|| "(left out)".to_owned(), |label| label.to_string());
            Err(refused("whisker", &given, must))
        }
    }
}
