//! Reader of CSV files of frames.

use super::{CurvatureFrame, ForceMethod, FrameContact};
use crate::input::{CsvError, CsvTable};

/// Frames of a film.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvatureFrames {
    /// Name of the file of frames in messages.
    pub origin: String,
    /// Frames in the order of time, `[frame]`.
    pub frames: Vec<CurvatureFrame>,
    /// True if the file has the column `contact`, which gives the frames without contact.
    pub have_contacts: bool,
    /// Note about columns of the file that are not used; `None` without such columns.
    pub note: Option<String>,
}

/// Required columns of a file.
const NEEDED: [&[&str]; 5] = [
    &["time_s"],
    &["curvature_per_mm"],
    &["at_arc_length_mm"],
    &["contact_x_mm"],
    &["contact_y_mm"],
];

/// Column that the method [`ForceMethod::Lever`] needs, too.
const ANGLE: &str = "contact_angle_deg";

/// Optional columns: the position of the measured point.
const AT: [&str; 2] = ["at_x_mm", "at_y_mm"];

/// Optional column: whether the whisker is in contact.
const CONTACT: &str = "contact";

/// Largest size of a position in mm and of a curvature in 1/mm. The largest whisker has 1e5 mm, and the largest curvature of a scene is 1e6.
const MOST: f64 = 1e6;

impl CurvatureFrames {
    /// Names of the columns of a file of frames, `[column]`.
    pub const COLUMNS: [&str; 9] = [
        NEEDED[0][0],
        NEEDED[1][0],
        NEEDED[2][0],
        NEEDED[3][0],
        NEEDED[4][0],
        ANGLE,
        AT[0],
        AT[1],
        CONTACT,
    ];

    /// Returns the frames of a CSV table for a whisker of `length_mm`. Frames without contact have empty cells for it, or 0 in the column
    /// `contact`. Other empty cells, and those with `NaN`, are missing values.
    ///
    /// # Errors
    /// If a column that `method` needs is missing, a cell is no number or out of its range, or a time does not grow.
    pub fn of(table: &CsvTable, length_mm: f64, method: ForceMethod) -> Result<Self, CsvError> {
        let angle: &[&str] = &[ANGLE];
        let (needed, optional) = match method {
            ForceMethod::Lever => {
                ([&NEEDED[..], &[angle]].concat(), [&AT[..], &[CONTACT]].concat())
            }
            ForceMethod::Model => {
                // The model has no use for the angle: another column is not meant as it.
                let unused = angle.iter().filter(|name| table.has(name));
                let used = AT.iter().chain([&CONTACT]);
                (NEEDED.to_vec(), used.chain(unused).copied().collect())
            }
        };
        let note = table.require(&needed, &optional)?;
        if table.has(AT[0]) != table.has(AT[1]) {
            let what = format!("has one of {} and {}: must have both, or none", AT[0], AT[1]);
            return Err(CsvError::whole(&table.origin, what));
        }
        let times = table.times_s()?;
        let must = format!("a number between -{MOST:e} and {MOST:e}");
        let number = |name: &str| table.measurements(name, &must, |number| number.abs() <= MOST);
        let curvatures = number("curvature_per_mm")?.unwrap_or_default();
        let at = number(AT[0])?.zip(number(AT[1])?);
        let on_whisker =
            format!("a number of at least 0 and less than {length_mm}, the whisker's length in mm");
        let is_on_whisker = |mm: f64| (0.0..length_mm).contains(&mm);
        let places =
            table.measurements("at_arc_length_mm", &on_whisker, is_on_whisker)?.unwrap_or_default();
        let [xs, ys] = ["contact_x_mm", "contact_y_mm"].map(number);
        let (xs, ys) = (xs?.unwrap_or_default(), ys?.unwrap_or_default());
        let turn = "a number between -360 and 360";
        let angles = table.measurements(ANGLE, turn, |angle| angle.abs() <= 360.0)?;
        let contacts = table.measurements(CONTACT, "0 or 1", |cell| [0.0, 1.0].contains(&cell))?;
        let mut frames = Vec::with_capacity(times.len());
        for (i, line) in table.lines().enumerate() {
            let contact_mm = [xs[i], ys[i]];
            let angle = angles.as_ref().map(|angles| angles[i]);
            // Without the column `contact`, a frame in which no position was measured has no contact.
            let is_free = match &contacts {
                Some(contacts) => contacts[i] == 0.0,
                None => contact_mm.into_iter().all(f64::is_nan),
            };
            let contact = (!is_free).then_some(FrameContact {
                is_known: contacts.as_ref().is_none_or(|contacts| !contacts[i].is_nan()),
                contact_mm,
                contact_angle_deg: angle,
            });
            frames.push(CurvatureFrame {
                line,
                time_s: times[i],
                curvature_per_mm: curvatures[i],
                at_arc_length_mm: places[i],
                at_mm: at.as_ref().map(|(x, y)| [x[i], y[i]]),
                contact,
            });
        }
        Ok(Self { origin: table.origin.clone(), frames, have_contacts: contacts.is_some(), note })
    }
}
