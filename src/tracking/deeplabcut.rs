//! CSV files of DeepLabCut: the rows `scorer`, `bodyparts` and `coords`, then a row for each frame.

use super::names::numbers_in;
use super::options::{ImagePole, TrackingError, TrackingOptions, refused, unknown};
use super::{FRAME_NUMBERS, ImageFrame, ImageFrames, PointOrder, Remarks, frame_number};
use crate::input::{CsvError, CsvLine, CsvLines, CsvTable, each_once, shortened};
use crate::scene::digits;
use std::sync::atomic::{AtomicBool, Ordering};

/// Names of the rows of the header.
const HEADER: [&str; 3] = ["scorer", "bodyparts", "coords"];

/// Least likelihood of a point where the options give none.
const LIKELIHOOD: f64 = 0.9;

/// Reads the frames of a file, until `cancel` becomes true. Points below the likelihood are lost.
pub(super) fn read(
    mut lines: CsvLines,
    origin: &str,
    options: &TrackingOptions,
    cancel: &AtomicBool,
) -> Result<ImageFrames, TrackingError> {
    if let Some(whisker) = options.whisker {
        let must =
            "must be left out with files of DeepLabCut: they have body parts, and no identities"
                .to_owned();
        return Err(refused("whisker", &whisker.to_string(), must));
    }
    check_header(&lines, origin)?;
    if let Some(likelihood) = options.likelihood
        && lines.lines[2].cells.iter().all(|coord| coord != "likelihood")
    {
        let must = "must be left out: the file has no column likelihood".to_owned();
        return Err(refused("likelihood", &digits(likelihood), must));
    }
    let least_likelihood = options.likelihood.unwrap_or(LIKELIHOOD);
    let header: Vec<CsvLine> = lines.lines.drain(..HEADER.len()).collect();
    // Newer versions name an image in three columns: two folders, and the file.
    let folders = header[1].cells.iter().skip(1).take_while(|part| part.is_empty()).count();
    let names = header[1].cells.iter().skip(1 + folders);
    let columns: Vec<String> = names
        .clone()
        .zip(header[2].cells.iter().skip(1 + folders))
        .map(|(name, coord)| format!("{name} {coord}"))
        .collect();
    let parts: Vec<&str> = each_once(&names.collect::<Vec<_>>());
    let table = lines.table(
        CsvLine {
            number: header[2].number,
            cells: std::iter::repeat_n("folder", folders)
                .chain(std::iter::once("frame"))
                .chain(columns.iter().map(String::as_str))
                .collect(),
        },
        origin,
    )?;
    let pole = match &options.pole {
        Some(ImagePole::Part(name)) if !parts.contains(&name.as_str()) => {
            return Err(unknown("pole", name, &parts));
        }
        Some(ImagePole::Part(name)) => Some(name.as_str()),
        _ => None,
    };
    let along: Vec<&str> = match options.points.is_empty() {
        true => parts.iter().copied().filter(|part| Some(*part) != pole).collect(),
        false => options.points.iter().map(String::as_str).collect(),
    };
    if let Some(name) = along.iter().find(|name| !parts.contains(name)) {
        return Err(unknown("points", name, &parts));
    }
    let positions = |part: &str| match cancel.load(Ordering::Relaxed) {
        true => Err(TrackingError::Cancelled),
        false => Ok(positions(&table, part, header[2].number, least_likelihood)?),
    };
    let along = along.into_iter().map(|part| Ok((part, positions(part)?)));
    let along = along.collect::<Result<Vec<PartPositions>, TrackingError>>()?;
    let pole = pole.map(|part| Ok::<PartPositions, TrackingError>((part, positions(part)?)));
    let pole = pole.transpose()?;
    let fixed = match options.pole {
        Some(ImagePole::At(at)) => Some(at),
        _ => None,
    };
    Ok(ImageFrames {
        frames: frames(&table, &along, pole.as_ref(), fixed)?,
        remarks: remarks(origin, &parts, &along, pole.as_ref(), least_likelihood),
        order: match options.points.is_empty() {
            true => PointOrder::Named(along.iter().map(|(part, _)| (*part).to_owned()).collect()),
            false => PointOrder::FromBase,
        },
    })
}

/// Checks that the rows of the header have their names, and that frames follow.
fn check_header(lines: &CsvLines, origin: &str) -> Result<(), CsvError> {
    for (name, line) in HEADER.iter().zip(&lines.lines) {
        let found = line.cells.get(0).unwrap_or_default();
        if found != *name {
            let hint = match found {
                "individuals" => "; export the file of one individual",
                _ => "",
            };
            let found = shortened(found);
            let what = format!("begins with {found}: must begin with {name}{hint}");
            return Err(CsvError::at(origin, line.number, what));
        }
    }
    if lines.lines.len() <= HEADER.len() {
        let what = "has no frames: must have at least one row below scorer, bodyparts and coords";
        return Err(CsvError::whole(origin, what));
    }
    Ok(())
}

/// Name of a body part, and its positions in pixels, `[frame][x, y]`; `None` where it is lost.
type PartPositions<'a> = (&'a str, Vec<Option<[f64; 2]>>);

/// Returns the positions of a body part, whose coordinates are named in this line. Positions below the likelihood are lost.
fn positions(
    table: &CsvTable,
    part: &str,
    line: usize,
    likelihood: f64,
) -> Result<Vec<Option<[f64; 2]>>, CsvError> {
    let column = |coord: &str, must: &str, is_allowed: fn(f64) -> bool| {
        table.measurements(&format!("{part} {coord}"), must, is_allowed)
    };
    let must = "a number between -1e6 and 1e6";
    let [x, y] = ["x", "y"].map(|coord| {
        column(coord, must, |coordinate| coordinate.abs() <= 1e6)?.ok_or_else(|| {
            let what = format!("has no column {coord} of {part}: must have x and y");
            CsvError::at(&table.origin, line, what)
        })
    });
    let likelihoods = column("likelihood", "a number between 0 and 1", |likelihood| {
        (0.0..=1.0).contains(&likelihood)
    })?;
    let is_known =
        |i: usize| likelihoods.as_ref().is_none_or(|likelihoods| likelihoods[i] >= likelihood);
    let pairs = x?.into_iter().zip(y?).enumerate();
    let position = |(i, (x, y)): (usize, (f64, f64))| {
        Some([x, y]).filter(|_| !x.is_nan() && !y.is_nan() && is_known(i))
    };
    Ok(pairs.map(position).collect())
}

/// Returns the frames of the table, with points `along` the whisker, and with a `pole` that moves or is `fixed`.
fn frames(
    table: &CsvTable,
    along: &[PartPositions],
    pole: Option<&PartPositions>,
    fixed: Option<[f64; 2]>,
) -> Result<Vec<ImageFrame>, CsvError> {
    let is_number = |cell: &String| cell.replace(',', ".").parse::<f64>().is_ok();
    let cells = table.values("frame", "", |cell| Some(cell.to_owned()))?.unwrap_or_default();
    // Labelled images have the names of files instead of numbers.
    let numbers: Vec<u64> = if cells.iter().any(is_number) {
        table.values("frame", FRAME_NUMBERS, frame_number)?.unwrap_or_default()
    } else {
        let names: Vec<&str> = cells.iter().map(String::as_str).collect();
        numbers_in(&names).unwrap_or_else(|| (0..names.len() as u64).collect())
    };
    let mut frames: Vec<ImageFrame> = Vec::with_capacity(numbers.len());
    for ((i, line), number) in table.lines().enumerate().zip(numbers) {
        if let Some(before) = frames.last().filter(|frame| frame.number >= number) {
            let what =
                format!("frame {number}: must be more than {} of the line before", before.number);
            return Err(CsvError::at(&table.origin, line, what));
        }
        frames.push(ImageFrame {
            number,
            points_px: along.iter().map(|(_, positions)| positions[i]).collect(),
            bend: None,
            pole_px: pole.map_or(fixed, |(_, positions)| positions[i]),
        });
    }
    Ok(frames)
}

/// Returns a note of the body `parts` that are not used, and a warning for each used one that is lost in all frames.
fn remarks(
    origin: &str,
    parts: &[&str],
    along: &[PartPositions],
    pole: Option<&PartPositions>,
    likelihood: f64,
) -> Remarks {
    let used = || along.iter().chain(pole);
    let unused: Vec<&str> =
        parts.iter().copied().filter(|part| used().all(|(name, _)| name != part)).collect();
    let unused = (!unused.is_empty()).then(|| {
        let names = unused.join(", ");
        format!("{origin}: body parts that are not used: {}", shortened(&names))
    });
    let lost = used().filter(|(_, positions)| positions.iter().all(Option::is_none));
    let lost = lost.map(|(name, _)| {
        let what = match pole {
            Some((pole, _)) if name == pole => "contacts are not known",
            _ => "the whisker is traced without it",
        };
        let name = shortened(name);
        format!(
            "body part {name}: lost in all frames, at a likelihood of at least {likelihood}: {what}"
        )
    });
    Remarks { notes: unused.into_iter().collect(), warnings: lost.collect() }
}
