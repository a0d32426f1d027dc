//! The theory of the paper's figures, panel by panel, each with its table of values.
//!
//! The push angle is the rotation of the base since first touch, except in the drawing of Fig. 1D. `d` is the distance from the
//! base to the contact at first touch, so that a row of Fig. 3E is the pole of Figs. 3B-D.

mod detachment;
mod drawing;
mod fig1;
mod fig2;
mod fig3;
mod fig6;
mod fig7;
mod motion;

pub use detachment::Measurements;

use crate::render::{Chart, Plot};
use crate::store::TableFile;
use crate::texture::TextureError;
use crate::trace::NoState;
use crate::whisk::{CourseError, WhiskError};
use serde::Serialize;
use std::io;

/// Figure of the paper: a chart, and the tables of its panels.
pub struct Figure {
    /// Stem of the name of the figure's file.
    pub name: &'static str,
    /// Chart of the figure, one plot for each panel.
    pub chart: Chart,
    /// Tables of the figure, `[table]`: the stem of the file's name, and the function that writes the rows.
    pub tables: Vec<(String, TableRows)>,
}

/// Error of a figure that cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FigureError {
    /// A state on a branch is not found.
    #[error(transparent)]
    State(#[from] NoState),
    /// The angles of a course are not accepted.
    #[error(transparent)]
    Course(#[from] CourseError),
    /// The course of a whisker against a pole is not found.
    #[error(transparent)]
    Whisk(#[from] WhiskError),
    /// The course of a whisker behind a surface is not found.
    #[error(transparent)]
    Texture(#[from] TextureError),
}

/// Function that writes the rows of one panel into a table.
pub type TableRows = Box<dyn Fn(&mut TableFile) -> io::Result<()>>;

/// A panel: its letter, its plot and its table.
struct FigurePanel {
    letter: &'static str,
    plot: Plot,
    rows: TableRows,
}

impl FigurePanel {
    fn new<R: Serialize + 'static>(letter: &'static str, plot: Plot, rows: Vec<R>) -> Self {
        Self { letter, plot, rows: Box::new(move |table| table.rows(&rows)) }
    }
}

/// Computes every figure of the paper that shows theory, with measured detachments where the paper shows them, `[figure]`.
///
/// # Errors
/// A branch or a course cannot be followed.
pub fn figures(measured: &Measurements) -> Result<Vec<Figure>, FigureError> {
    Ok(vec![
        fig1::fig1()?,
        fig2::fig2()?,
        fig3::fig3()?,
        motion::fig4b()?,
        detachment::fig4d(&measured.fig4d),
        motion::fig5b()?,
        detachment::fig5c(measured),
        fig6::fig6()?,
        fig7::fig7b()?,
    ])
}

/// A figure of panels in two columns, each with the stem of its table.
fn figure(
    name: &'static str,
    title: &str,
    caption: Vec<String>,
    panels: Vec<(String, FigurePanel)>,
) -> Figure {
    let panels = panels.into_iter().map(|(table, panel)| {
        let letter = Some(panel.letter.to_owned());
        let plot = Plot { letter, ..panel.plot };
        (plot, (table, panel.rows))
    });
    let (plots, tables) = panels.unzip();
    let chart = Chart { title: title.to_owned(), caption, plots, columns: 2 };
    Figure { name, chart, tables }
}

/// A figure whose tables are named by the figure and the letter of the panel.
fn lettered(
    name: &'static str,
    title: &str,
    caption: Vec<String>,
    panels: Vec<FigurePanel>,
) -> Figure {
    let table = |panel: &FigurePanel| format!("{name}{}", panel.letter.to_lowercase());
    let panels = panels.into_iter().map(|panel| (table(&panel), panel));
    figure(name, title, caption, panels.collect())
}

/// The definition of the push angle, for captions.
const PUSH: &str = "Push angle \u{3b8}_{p}: rotation of the base since first touch; CF left (negative), CB right (positive).";
