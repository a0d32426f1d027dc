//! From a CSV file to checked points; whatever is refused becomes one message with file, line and value.

use super::{Angle, Point, Points};
use crate::rod::{Rest, Side};
use crate::scene::{NEAREST, Pole, Whisker, bounded, digits, shortened};
use crate::sheet::Row;
use crate::trace::DetachmentKind;
use csv::StringRecord;
use std::fs::File;
use std::io;
use std::path::Path;

/// Columns that a file may have, in any order.
const COLUMNS: [&str; 6] = [
    "side",
    "distance_mm",
    Angle::Push.column(),
    Angle::Chord.column(),
    "kind",
    "sd_deg",
];

/// What is wrong with a file of points.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {what}")]
pub struct PointsError {
    place: String,
    what: String,
}

impl PointsError {
    fn whole(origin: &str, what: impl Into<String>) -> Self {
        Self {
            place: origin.to_owned(),
            what: what.into(),
        }
    }

    fn at(origin: &str, line: usize, what: impl Into<String>) -> Self {
        Self::whole(&format!("{origin}:{line}"), what)
    }
}

impl Points {
    /// Reads the points of a CSV file; `-` is standard input.
    ///
    /// # Errors
    /// If the file cannot be read, is longer than 1 MiB, is not UTF-8, or for the reasons of [`Points::parse`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, PointsError> {
        let path = path.as_ref();
        let (origin, bytes) = if path == Path::new("-") {
            ("<stdin>".into(), bounded(io::stdin().lock()))
        } else {
            (path.to_string_lossy(), File::open(path).and_then(bounded))
        };
        let unreadable = |why| PointsError::whole(&origin, format!("cannot be read: {why}"));
        let bytes = bytes.map_err(unreadable)?;
        let text = str::from_utf8(&bytes).map_err(|why| {
            let before = &bytes[..why.valid_up_to()];
            let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
            let byte = bytes[before.len()];
            PointsError::at(&origin, line, format!("not UTF-8 text: byte 0x{byte:02X}"))
        })?;
        Self::parse(text, &origin)
    }

    /// Checks the text of a CSV file. Messages call it `origin`. Lines that are blank or begin with `#` are left out.
    ///
    /// ```
    /// use whiskmap::measured::Points;
    ///
    /// let text = "side, distance_mm, push_angle_deg, kind\ncb, 15.66, 15.6, slip-off\n";
    /// assert_eq!(Points::parse(text, "points.csv")?.points[0].angle_deg, 15.6);
    /// let why = Points::parse(&text.replace("cb", "left"), "points.csv").unwrap_err();
    /// assert_eq!(why.to_string(), "points.csv:2: side = left: must be cb or cf");
    /// # Ok::<(), whiskmap::measured::PointsError>(())
    /// ```
    ///
    /// # Errors
    /// If columns are unknown, missing or twice there, a cell is no number or out of its range, or there is no point.
    pub fn parse(text: &str, origin: &str) -> Result<Self, PointsError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let lines = text.lines().enumerate().map(|(i, line)| (i + 1, line));
        let mut lines = lines.filter(|(_, line)| {
            let line = line.trim_start();
            !line.is_empty() && !line.starts_with('#')
        });
        let columns = COLUMNS.join(", ");
        let (line, header) = lines.next().ok_or_else(|| {
            PointsError::whole(origin, format!("is empty: must have columns of {columns}"))
        })?;
        let refuse = |line, what: String| PointsError::at(origin, line, what);
        let header = cells(header).map_err(|what| refuse(line, what))?;
        let angle = angle(&header).map_err(|what| refuse(line, what))?;
        let points = lines.map(|(line, text)| {
            let cells = cells(text).and_then(|cells| Cells::new(&header, cells));
            let point = cells.and_then(|cells| cells.point(line, angle));
            point.map_err(|what| refuse(line, what))
        });
        let points: Vec<Point> = points.collect::<Result<_, _>>()?;
        if points.is_empty() {
            let what = "has no points: must have at least one line below its header";
            return Err(PointsError::whole(origin, what));
        }
        Ok(Self {
            origin: origin.to_owned(),
            angle,
            have_deviations: header.iter().any(|name| name == "sd_deg"),
            points,
        })
    }

    /// Refuses points at which the resting `whisker` cannot touch the `pole`.
    ///
    /// # Errors
    /// With the first such point.
    pub fn check_reach(&self, whisker: &Whisker, pole: &Pole) -> Result<(), PointsError> {
        let rest = Rest::new(&whisker.rod(pole, Side::Cb));
        let (tip, _) = rest.at_arclength(rest.end());
        let nearest = whisker.length_mm / NEAREST;
        let is_allowed = |distance_mm: f64| {
            distance_mm >= nearest
                && distance_mm > pole.radius_mm
                && Row::new(&rest, distance_mm / whisker.length_mm).is_reached()
        };
        let mut points = self.points.iter();
        let Some(point) = points.find(|point| !is_allowed(point.distance_mm)) else {
            return Ok(());
        };
        let what = format!(
            "distance_mm = {}: must be between {} (length_mm / 1000) and {} (the tip of the resting whisker), and more than \
             {} (pole.radius_mm)",
            digits(point.distance_mm),
            digits(nearest),
            digits(tip.length() * whisker.length_mm),
            digits(pole.radius_mm)
        );
        Err(PointsError::at(&self.origin, point.line, what))
    }
}

/// The cells of one line.
fn cells(line: &str) -> Result<StringRecord, String> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .trim(csv::Trim::All)
        .from_reader(line.as_bytes());
    let mut record = StringRecord::new();
    let read = reader.read_record(&mut record);
    read.map_err(|why| why.to_string())?;
    Ok(record)
}

/// The angle that the columns have, if they are right.
fn angle(header: &StringRecord) -> Result<Angle, String> {
    let count = |column: &str| header.iter().filter(|name| *name == column).count();
    if let Some(unknown) = header.iter().find(|name| !COLUMNS.contains(name)) {
        return Err(format!(
            "unknown column {:?}: must be one of {}",
            shortened(unknown),
            COLUMNS.join(", ")
        ));
    }
    if let Some(twice) = COLUMNS.iter().find(|column| count(column) > 1) {
        return Err(format!("column {twice}: must be there once"));
    }
    if let Some(missing) = COLUMNS[..2].iter().find(|column| count(column) == 0) {
        return Err(format!("missing column {missing}"));
    }
    match [Angle::Push, Angle::Chord].map(|angle| count(angle.column())) {
        [1, 0] => Ok(Angle::Push),
        [0, 1] => Ok(Angle::Chord),
        [0, _] => Err("missing column push_angle_deg, or push_chord_deg in its place".to_owned()),
        _ => Err("push_angle_deg and push_chord_deg: must be one of them".to_owned()),
    }
}

/// The cells of one line under their header.
struct Cells<'a> {
    header: &'a StringRecord,
    cells: StringRecord,
}

impl<'a> Cells<'a> {
    fn new(header: &'a StringRecord, cells: StringRecord) -> Result<Self, String> {
        let (has, must) = (cells.len(), header.len());
        if has == must {
            return Ok(Self { header, cells });
        }
        Err(format!("has {has} cells: must have {must}, one a column"))
    }

    /// The cell in `column`; `None` without such a column.
    fn cell(&self, column: &str) -> Option<&str> {
        let place = self.header.iter().position(|name| name == column)?;
        self.cells.get(place)
    }

    /// The number in `column`, if it is `allowed`; `absent` without such a column.
    fn number(
        &self,
        column: &str,
        absent: f64,
        must: &str,
        allowed: impl Fn(f64) -> bool,
    ) -> Result<f64, String> {
        let Some(cell) = self.cell(column) else {
            return Ok(absent);
        };
        let number = cell.parse().ok().filter(|number| allowed(*number));
        number.ok_or_else(|| format!("{column} = {}: must be {must}", shortened(cell)))
    }

    fn point(&self, line: usize, angle: Angle) -> Result<Point, String> {
        let must_be = |column: &str, cell: &str, must: &str| {
            Err(format!("{column} = {}: must be {must}", shortened(cell)))
        };
        let side = match self.cell("side").unwrap_or_default() {
            "cb" => Side::Cb,
            "cf" => Side::Cf,
            cell => return must_be("side", cell, "cb or cf"),
        };
        let kind = match self.cell("kind").unwrap_or_default() {
            "" => None,
            "slip-off" => Some(DetachmentKind::SlipOff),
            "pull-off" => Some(DetachmentKind::PullOff),
            cell => return must_be("kind", cell, "slip-off, pull-off or empty"),
        };
        let is_positive = |number: f64| number > 0.0 && number.is_finite();
        let turn = "a number between -360 and 360";
        let is_turn = |number: f64| number.abs() <= 360.0;
        Ok(Point {
            line,
            side,
            distance_mm: self.number("distance_mm", f64::NAN, "a positive number", is_positive)?,
            angle_deg: self.number(angle.column(), f64::NAN, turn, is_turn)?,
            kind,
            sd_deg: self.number("sd_deg", 1.0, "a positive number", is_positive)?,
        })
    }
}
