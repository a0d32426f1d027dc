//! Points along the whisker without a header: `x,y`, a file for each frame, or `frame,x,y`.

use super::options::{ImagePole, TrackingError, TrackingOptions, refused};
use super::{ImageFrame, ImageFrames, PointOrder, Remarks};
use crate::input::{CsvError, CsvLine, CsvLines};

/// Reads the frames of files. An empty file among several is a lost frame, and a point without numbers is a lost point.
pub(super) fn read(
    texts: &[(String, String)],
    options: &TrackingOptions,
) -> Result<ImageFrames, TrackingError> {
    let nameless = |option, value: &str| {
        let must = "must be left out with points without a header: they have no names".to_owned();
        Err(refused(option, value, must))
    };
    if let Some(whisker) = options.whisker {
        return nameless("whisker", &whisker.to_string());
    }
    if let [first, ..] = &options.points[..] {
        return nameless("points", first);
    }
    let pole_px = match &options.pole {
        Some(ImagePole::Part(name)) => return nameless("pole", name),
        Some(ImagePole::At(at)) => Some(*at),
        None => None,
    };
    let mut frames: Vec<ImageFrame> = Vec::new();
    for (file, (text, origin)) in texts.iter().enumerate() {
        let lines = CsvLines::split(text, origin)?;
        let columns = lines.lines.first().map_or(2, |line| line.cells.len());
        let names: &[&str] = match columns {
            2 => &["x", "y"],
            3 if texts.len() == 1 => &["frame", "x", "y"],
            _ => {
                let allowed = if texts.len() == 1 { "x,y or frame,x,y" } else { "x,y" };
                let what = format!("has {columns} cells: must have {allowed}");
                return Err(CsvError::at(origin, lines.lines[0].number, what).into());
            }
        };
        let is_lost = lines.lines.is_empty();
        if is_lost && texts.len() == 1 {
            return Err(CsvError::whole(origin, "has no points: must have x,y or frame,x,y").into());
        }
        let header = CsvLine { number: 0, cells: names.to_vec().into() };
        let table = lines.table(header, origin)?;
        let must = "a number between -1e6 and 1e6";
        let column =
            |name: &str| table.measurements(name, must, |coordinate| coordinate.abs() <= 1e6);
        let (x, y) = (column("x")?.unwrap_or_default(), column("y")?.unwrap_or_default());
        let whole = "a whole number of at least 0";
        let numbers = table.values("frame", whole, |cell| cell.parse::<u64>().ok())?;
        let mut add = |number: u64, points: &mut dyn Iterator<Item = Option<[f64; 2]>>| match frames
            .last_mut()
        {
            Some(frame) if frame.number == number => frame.points_px.extend(points),
            _ => {
                frames.push(ImageFrame { number, points_px: points.collect(), bend: None, pole_px })
            }
        };
        let is_known = |point: &[f64; 2]| point.iter().all(|coordinate| !coordinate.is_nan());
        let points = x.into_iter().zip(y).map(|(x, y)| Some([x, y]).filter(is_known));
        let Some(numbers) = numbers else {
            add(file as u64, &mut points.into_iter());
            continue;
        };
        let mut before = 0;
        for ((number, point), line) in numbers.into_iter().zip(points).zip(table.lines()) {
            if number < before {
                let what =
                    format!("frame = {number}: must be at least {before} of the line before");
                return Err(CsvError::at(origin, line, what).into());
            }
            before = number;
            add(number, &mut std::iter::once(point));
        }
    }
    Ok(ImageFrames { frames, order: PointOrder::Along, remarks: Remarks::default() })
}
