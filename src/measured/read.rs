//! Reader of CSV files of measured points.

use super::{MeasuredAngle, MeasuredPoint, MeasuredPoints};
use crate::input::{CsvError, CsvTable, is_missing};
use crate::scene::{NEAREST, Pole, Whisker, digits};
use crate::sheet::Row;
use crate::trace::{DetachmentKind, reach_mm};
use std::path::Path;
use whiskmap_mechanics::rod::{Rest, Side};

/// Required columns of a file: one of each group.
const NEEDED: [&[&str]; 3] =
    [&["side"], &["distance_mm"], &[MeasuredAngle::Push.column(), MeasuredAngle::Chord.column()]];

/// Optional columns of a file.
const OPTIONAL: [&str; 3] = ["kind", "sd_deg", "whisker"];

/// Least standard deviation of an angle, in degrees: far below what any instrument resolves.
const LEAST_SD_DEG: f64 = 1e-6;

impl MeasuredPoints {
    /// Names of the columns of a file of points, `[column]`.
    pub const COLUMNS: [&str; 7] = [
        "side",
        "distance_mm",
        MeasuredAngle::Push.column(),
        MeasuredAngle::Chord.column(),
        OPTIONAL[0],
        OPTIONAL[1],
        OPTIONAL[2],
    ];

    /// Reads the points of a CSV file; `-` is standard input.
    ///
    /// # Errors
    /// If the file cannot be read, is longer than 32 MiB, or is neither UTF-8 nor UTF-16 with a byte order mark. Also for the reasons of
    /// [`MeasuredPoints::parse`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, CsvError> {
        Self::of(&CsvTable::input(path)?)
    }

    /// Reads points from the text of a CSV file, as [`CsvTable`] splits it. Messages call the text `origin`. Numbers and kinds may be missing, as
    /// in [`CsvTable::measurements`].
    ///
    /// ```
    /// use whiskmap::measured::MeasuredPoints;
    ///
    /// let text = "side, distance_mm, push_angle_deg, kind\ncb, 15.66, 15.6, slip-off\n";
    /// assert_eq!(MeasuredPoints::parse(text, "points.csv")?.points[0].angle_deg, 15.6);
    /// let why = MeasuredPoints::parse(&text.replace("cb", "left"), "points.csv").unwrap_err();
    /// assert_eq!(why.to_string(), "points.csv:2: side = left: must be cb or cf");
    /// # Ok::<(), whiskmap::input::CsvError>(())
    /// ```
    ///
    /// # Errors
    /// If columns are missing or twice there, a cell is no number or out of its range, or no point has all of its values.
    pub fn parse(text: &str, origin: &str) -> Result<Self, CsvError> {
        Self::of(&CsvTable::parse(text, origin)?)
    }

    /// Returns the points of a CSV table.
    ///
    /// # Errors
    /// Fails as [`MeasuredPoints::parse`] does.
    pub fn of(table: &CsvTable) -> Result<Self, CsvError> {
        let note = table.require(&NEEDED, &OPTIONAL)?;
        let angle = match table.has(MeasuredAngle::Push.column()) {
            true => MeasuredAngle::Push,
            false => MeasuredAngle::Chord,
        };
        let sides = table.values("side", "cb or cf", |cell| match &*cell.to_lowercase() {
            "cb" => Some(Side::Cb),
            "cf" => Some(Side::Cf),
            _ => None,
        })?;
        let kinds = "slip-off, pull-off or empty";
        let kinds = table.values("kind", kinds, |cell| match &*cell.to_lowercase() {
            cell if is_missing(cell) => Some(None),
            "slip-off" => Some(Some(DetachmentKind::SlipOff)),
            "pull-off" => Some(Some(DetachmentKind::PullOff)),
            _ => None,
        })?;
        let is_positive = |number: f64| number > 0.0 && number.is_finite();
        let distances_mm = table.measurements("distance_mm", "a positive number", is_positive)?;
        let is_deviation = |number: f64| (LEAST_SD_DEG..=360.0).contains(&number);
        let must = format!("a number between {} and 360", digits(LEAST_SD_DEG));
        let deviations_deg = table.measurements("sd_deg", &must, is_deviation)?;
        let turn = "a number between -360 and 360";
        let angles_deg =
            table.measurements(angle.column(), turn, |number| number.abs() <= 360.0)?;
        let names = table.values("whisker", "the name of a whisker", |cell| {
            Some(cell.to_owned()).filter(|name| !name.is_empty())
        })?;
        let mut whiskers: Vec<String> = Vec::new();
        let mut index_of = |name: String| {
            let index = whiskers.iter().position(|known| *known == name);
            index.unwrap_or_else(|| {
                whiskers.push(name);
                whiskers.len() - 1
            })
        };
        let indices: Option<Vec<usize>> =
            names.map(|names| names.into_iter().map(&mut index_of).collect());
        let rows = table
            .lines()
            .zip(sides.unwrap_or_default())
            .zip(distances_mm.unwrap_or_default().into_iter().zip(angles_deg.unwrap_or_default()));
        let points =
            rows.enumerate().map(|(i, ((line, side), (distance_mm, angle_deg)))| MeasuredPoint {
                line,
                whisker: indices.as_ref().map_or(0, |all| all[i]),
                side,
                distance_mm,
                angle_deg,
                kind: kinds.as_ref().and_then(|kinds| kinds[i]),
                sd_deg: deviations_deg.as_ref().map_or(1.0, |all| all[i]),
            });
        let (points, incomplete): (Vec<_>, Vec<_>) = points.partition(|point| {
            let numbers = [point.distance_mm, point.angle_deg, point.sd_deg];
            !numbers.into_iter().any(f64::is_nan)
        });
        if points.is_empty() {
            let what = format!(
                "has no row with all of its values: must have at least one with {}",
                NEEDED.map(|group| group.join(" or ")).join(", ")
            );
            return Err(CsvError::whole(&table.origin, what));
        }
        Ok(Self {
            origin: table.origin.clone(),
            note,
            angle,
            have_deviations: deviations_deg.is_some(),
            whiskers,
            points,
            incomplete,
        })
    }

    /// Checks that the resting `whisker` touches the `pole` at the distance of every point.
    ///
    /// # Errors
    /// The first point that is out of reach.
    pub fn check_reach(&self, whisker: &Whisker, pole: &Pole) -> Result<(), CsvError> {
        let Some(point) = self.first_out_of_reach(whisker, pole) else {
            return Ok(());
        };
        let reach_mm = reach_mm(whisker, pole, Side::Cb);
        let what = format!(
            "distance_mm = {}: must be between {} (length_mm / 1000) and {} (the tip of the resting whisker), and more than \
             {} (pole.radius_mm)",
            digits(point.distance_mm),
            digits(whisker.length_mm / NEAREST),
            digits(reach_mm),
            digits(pole.radius_mm)
        );
        Err(CsvError::at(&self.origin, point.line, what))
    }

    /// Returns the first point whose distance the resting `whisker` does not touch the `pole` at; `None` if all are within reach.
    pub(crate) fn first_out_of_reach(
        &self,
        whisker: &Whisker,
        pole: &Pole,
    ) -> Option<&MeasuredPoint> {
        let rest = Rest::new(&whisker.rod(pole, Side::Cb));
        let is_allowed = |distance_mm: f64| {
            distance_mm >= whisker.length_mm / NEAREST
                && distance_mm <= 2.0 * whisker.length_mm
                && distance_mm > pole.radius_mm
                && Row::new(&rest, distance_mm / whisker.length_mm).is_reached()
        };
        let mut points = self.points.iter();
        points.find(|point| !is_allowed(point.distance_mm))
    }
}
