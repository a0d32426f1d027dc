//! Command `whiskmap locate`.

use super::arguments::column_help;
use super::data::ColumnArgs;
use super::failure::{Failure, notes, warnings};
use super::files::Files;
use super::marks::{STRAIN_MARKS, marked};
use super::outputs::OutputArgs;
use super::pole::WhiskerArgs;
use clap::{ArgGroup, Args};
use std::path::PathBuf;
use whiskmap::input::Quantity;
use whiskmap::locate::{
    self, BaseReading, BaseReadings, LocatedState, Locator, MOST_ANGLE, MOST_LOAD,
    SensorDeviations, SharedState,
};
use whiskmap::render::{contacts, shared_states};
use whiskmap::scene::digits;
use whiskmap::yields::StrainMark;

const EXAMPLES: &str = "\
Examples:
  whiskmap locate scenes/cone.toml --base-moment 60nNm --base-force-y 6uN --angle 30deg
  whiskmap locate scenes/cone.toml --readings scenes/readings.csv --moment-sd 0.5nNm --force-sd 0.05uN --plot locate.svg
  whiskmap locate scenes/cone.toml --map --plot determined.png

FILE has at least two of the columns base_moment_nnm, base_force_x_un and base_force_y_un, and may have angle_deg, the angle of the base \
in the laboratory. A number that was not measured is an empty cell, NaN or NA. Moment and force are those of the pole on the base, in the frame of \
the base: the first axis is the base's tangent. In a follicle, the frame is that of the follicle.

Each stable state with the numbers of a reading is a row. With all three numbers, it is the state nearest to them, by the standard \
deviations if these are given.";

/// Most push angles and distances of --map.
const MAP_SIZE: [usize; 2] = [96, 48];

/// Options of a single reading.
const LOAD_OPTIONS: [&str; 4] = ["base_moment", "base_force_x", "base_force_y", "angle"];

#[derive(Debug, Args)]
#[command(
    group(ArgGroup::new("numbers").required(true).multiple(true).args(["map", "readings", "base_moment", "base_force_x", "base_force_y"])),
    after_help = EXAMPLES,
    after_long_help = column_help(EXAMPLES, &[("Columns", LocatedState::COLUMNS), STRAIN_MARKS, ("Columns with --map", SharedState::COLUMNS)])
)]
pub struct LocateArgs {
    #[command(flatten)]
    whisker: WhiskerArgs,
    /// Show where two numbers determine the contact, and where several states share them, over the push angles and distances of the scene
    #[arg(long, conflicts_with_all = LOAD_OPTIONS, conflicts_with_all = ["readings", "moment_sd", "force_sd"])]
    map: bool,
    /// CSV file of readings of the sensor; - is standard input
    #[arg(long, value_name = "FILE", group = "table", conflicts_with_all = LOAD_OPTIONS)]
    readings: Option<PathBuf>,
    #[command(flatten)]
    columns: ColumnArgs,
    /// Moment of the pole on the base, in nN m or with a unit, such as 0.3uNm: positive turns it to the left
    #[arg(long, value_name = "MOMENT", allow_hyphen_values = true, value_parser = moment)]
    base_moment: Option<f64>,
    /// Force of the pole on the base along the base's tangent, in uN or with a unit, such as 0.5mN
    #[arg(long, value_name = "FORCE", allow_hyphen_values = true, value_parser = force)]
    base_force_x: Option<f64>,
    /// Force of the pole on the base to the left of its tangent, in uN or with a unit, such as 0.5mN
    #[arg(long, value_name = "FORCE", allow_hyphen_values = true, value_parser = force)]
    base_force_y: Option<f64>,
    /// Angle of the base's tangent in the laboratory, in degrees or with a unit, such as 0.5rad
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, value_parser = base_angle)]
    angle: Option<f64>,
    /// Standard deviation of the sensor's moment, in nN m or with a unit
    #[arg(long, value_name = "MOMENT", requires = "force_sd", allow_hyphen_values = true, value_parser = moment_sd)]
    moment_sd: Option<f64>,
    /// Standard deviation of each component of the sensor's force, in uN or with a unit
    #[arg(long, value_name = "FORCE", requires = "moment_sd", allow_hyphen_values = true, value_parser = force_sd)]
    force_sd: Option<f64>,
    #[command(flatten)]
    outputs: OutputArgs,
}

/// Parses a number of `quantity` whose size is at most `most`.
fn bounded(quantity: Quantity, text: &str, most: f64) -> Result<f64, String> {
    let number = quantity.parse(text)?;
    let unit = quantity.unit().unwrap_or_default();
    match number.abs() <= most {
        true => Ok(number),
        false => {
            let most = digits(most);
            Err(format!("must be between -{most} {unit} and {most} {unit}"))
        }
    }
}

fn moment(text: &str) -> Result<f64, String> {
    bounded(Quantity::MomentNnm, text, MOST_LOAD)
}

fn force(text: &str) -> Result<f64, String> {
    bounded(Quantity::ForceUn, text, MOST_LOAD)
}

fn base_angle(text: &str) -> Result<f64, String> {
    bounded(Quantity::AngleDeg, text, MOST_ANGLE)
}

/// Returns a standard deviation if it is positive.
fn positive(number: Result<f64, String>) -> Result<f64, String> {
    let must = || "must be more than 0".to_owned();
    number.and_then(|number| if number > 0.0 { Ok(number) } else { Err(must()) })
}

fn moment_sd(text: &str) -> Result<f64, String> {
    positive(moment(text))
}

fn force_sd(text: &str) -> Result<f64, String> {
    positive(force(text))
}

impl LocateArgs {
    /// Returns the readings of the file, or the one of the options.
    fn readings(&self) -> Result<Vec<BaseReading>, Failure> {
        let Some(path) = &self.readings else {
            let reading = BaseReading {
                moment_nnm: self.base_moment,
                force_x_un: self.base_force_x,
                force_y_un: self.base_force_y,
                angle_deg: self.angle,
            };
            return Ok(vec![reading]);
        };
        let read = self.columns.read(path, &BaseReadings::COLUMNS, BaseReadings::of)?;
        notes(&read.note);
        Ok(read.readings)
    }

    /// Returns an error if the options give one number of the base.
    fn check_numbers(&self) -> Result<(), Failure> {
        let options = [
            ("--base-moment", self.base_moment),
            ("--base-force-x", self.base_force_x),
            ("--base-force-y", self.base_force_y),
        ];
        let mut given = options.iter().filter_map(|(name, value)| Some((name, (*value)?)));
        match (given.next(), given.next()) {
            (Some((name, value)), None) => {
                let value = digits(value);
                let why = format!(
                    "{name} {value}: must come with another of --base-moment, --base-force-x and --base-force-y; one number \
                     determines no contact"
                );
                Err(Failure::Input(why))
            }
            _ => Ok(()),
        }
    }
}

pub fn run(args: &LocateArgs, files: &mut Files) -> Result<(), Failure> {
    args.check_numbers()?;
    files.inputs("--readings", &args.readings)?;
    let (scene, whisker) = args.whisker.without_friction(files, "locate")?;
    if args.map {
        let mut outputs = args.outputs.open(files)?;
        let locator = Locator::new(&whisker, &scene.pole);
        let grid = &scene.thinned_to(MAP_SIZE, 1).grid;
        let map = locator.shared_states(&whisker, &scene.pole, grid);
        if map.states.is_empty() {
            let why = "--map: no distance and push angle of the grid has a stable state";
            return Err(Failure::Input(why.to_owned()));
        }
        outputs.rows(&map.states)?;
        let is_straight = scene.is_straight();
        let picture = |size| Ok(shared_states(&scene.title, grid, &map, is_straight, size)?);
        return outputs.finish_picture(picture, []);
    }
    let readings = args.readings()?;
    let mut outputs = args.outputs.open(files)?;
    let deviations = args.moment_sd.zip(args.force_sd);
    let deviations =
        deviations.map(|(moment_nnm, force_un)| SensorDeviations { moment_nnm, force_un });
    let locator = Locator::new(&whisker, &scene.pole);
    let located = locator.locate(&readings, deviations);
    warnings(locate::warning(&located));
    let marks = StrainMark::of_rows(&whisker, &scene.pole, &located);
    outputs.rows(marked(&located, marks))?;
    outputs.finish(scene.title.clone(), || contacts(&locator, &located))
}
