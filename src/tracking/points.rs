//! Points along the whisker: `x,y`, a file for each frame, or `frame,x,y`. The names may be in the first line.

use super::names::numbers_in;
use super::options::{ImagePole, TrackingError, TrackingOptions, refused};
use super::{ImageFrame, ImageFrames, PointOrder, Remarks};
use crate::input::{CsvError, CsvLine, CsvLines, shortened};
use crate::scene::digits;

/// Reads the frames of files. An empty file among several is a lost frame, and a point without numbers is a lost point.
pub(super) fn read(
    texts: &[(String, String)],
    options: &TrackingOptions,
) -> Result<ImageFrames, TrackingError> {
    let empty = |origin: &str| {
        Err(CsvError::whole(origin, "has no points: must have x,y or frame,x,y").into())
    };
    let nameless = |option, value: &str| {
        // A file without lines may be of any tracker.
        if let [(text, origin)] = texts
            && CsvLines::split(text, origin)?.lines.is_empty()
        {
            return empty(origin);
        }
        let must = "must be left out with points x,y: they have no names".to_owned();
        Err(refused(option, value, must))
    };
    if let Some(likelihood) = options.likelihood {
        let must = "must be left out with points x,y: they have no likelihoods".to_owned();
        return Err(refused("likelihood", &digits(likelihood), must));
    }
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
    let (files, note) = in_order(texts)?;
    for (file, (text, origin)) in files {
        let mut lines = CsvLines::split(text, origin)?;
        let names = [&["x", "y"][..], &["frame", "x", "y"]];
        let is_header = |line: &CsvLine| names.iter().any(|names| line.cells == **names);
        if lines.lines.first().is_some_and(is_header) {
            lines.lines.remove(0);
        }
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
            return empty(origin);
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
            add(file, &mut points.into_iter());
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
    let remarks = Remarks { notes: note.into_iter().collect(), ..Remarks::default() };
    Ok(ImageFrames { frames, order: PointOrder::Along, remarks })
}

/// File of a frame: the frame's number, and text and name of the file.
type FrameFile<'a> = (u64, &'a (String, String));

/// Returns the files by the numbers of their frames, which are in their names. Without numbers there, files are counted from 0, with a note if there are
/// several.
fn in_order(texts: &[(String, String)]) -> Result<(Vec<FrameFile<'_>>, Option<String>), CsvError> {
    let names: Vec<&str> = texts.iter().map(|(_, origin)| &**origin).collect();
    let Some(numbers) = numbers_in(&names) else {
        let note = (names.len() > 1).then(|| {
            format!("names of files have no numbers of frames: frame 0 is {}", shortened(names[0]))
        });
        return Ok(((0..).zip(texts).collect(), note));
    };
    let mut files: Vec<FrameFile> = numbers.into_iter().zip(texts).collect();
    files.sort_by_key(|(number, _)| *number);
    for pair in files.windows(2) {
        let [(number, (_, before)), (other, (_, origin))] = pair else { continue };
        if number == other {
            let what = format!(
                "is of frame {number}, as {} is: must be of another frame",
                shortened(before)
            );
            return Err(CsvError::whole(origin, what));
        }
    }
    Ok((files, None))
}
